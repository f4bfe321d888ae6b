//! Expressions as numbers and pictures of a material file.

use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

use super::document::Files;
use super::expression::{Affine, Expression, Image, Op, Program, placed};
use super::value::Value;
use crate::draft::number;
use crate::pictures::{Pictures, Texels, quantised};
use crate::rules;

/// Most texels on a side of a computed picture.
const SIDE_MAX: u32 = 4096;

/// Most steps of nodes for a computed picture, over all its texels.
const WORK_MAX: u64 = 1 << 29;

/// Most texels of the pictures of a graph together.
const TEXELS_MAX: u64 = 1 << 28;

/// Texels on a side of a picture that has none of its own.
const SIDE: u32 = 512;

/// Largest scale of a placement, and 1 over the smallest.
const SCALE_MAX: f64 = 1e6;

/// A value as a number of a file, and a picture that scales it.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Scaled {
    pub(super) factor: Value,
    /// The picture, as TOML.
    pub(super) map: Option<String>,
    /// Losses on the way.
    pub(super) notes: Vec<&'static str>,
    /// Whether the picture is computed.
    pub(super) is_computed: bool,
}

impl Scaled {
    fn constant(factor: Value) -> Self {
        Self { factor, map: None, notes: Vec::new(), is_computed: false }
    }
}

/// The pictures of an import.
pub(super) struct Pictured<'a> {
    files: Files<'a>,
    pictures: Pictures,
    /// Numbers of pictures by path.
    numbers: BTreeMap<String, usize>,
}

/// Texels of an expression.
struct Grid {
    width: u32,
    height: u32,
    values: Vec<[f32; 3]>,
    /// The placement of the picture, as TOML.
    transform: Option<String>,
    notes: BTreeSet<&'static str>,
}

impl<'a> Pictured<'a> {
    pub(super) fn new(files: Files<'a>) -> Self {
        Self { files, pictures: Pictures::default(), numbers: BTreeMap::new() }
    }

    pub(super) fn into_files(self) -> BTreeMap<String, Vec<u8>> {
        self.pictures.into_files()
    }

    /// One white texel, as TOML.
    pub(super) fn white(&mut self) -> Result<String, String> {
        let path = self.pictures.computed("white", "white", [None, None], |_, _| [1.0])?;
        Ok(rules::picture(&path, []))
    }

    /// One or three numbers that may vary, up to a limit. A picture stays as it is where the file can say what is done to it; else it is computed in 16 bits, over its largest value.
    pub(super) fn scaled(
        &mut self,
        name: &str,
        expression: &Arc<Expression>,
        channels: usize,
        limit: f64,
    ) -> Result<Scaled, String> {
        if let Some(factor) = expression.constant() {
            return Ok(Scaled::constant(factor.fitted(channels)));
        }
        if let Some(unchanged) = self.unchanged(expression, channels, limit)? {
            return Ok(unchanged);
        }
        let mut grid = self.grid(expression)?;
        let is_beyond = |v: &f32| f64::from(*v) > limit + 1e-3 || *v < -1e-3;
        if grid.values.iter().any(|texel| texel[..channels].iter().any(is_beyond)) {
            grid.notes.insert("texels beyond what is read are held to it");
        }
        grid.values.iter_mut().for_each(|texel| *texel = texel.map(|v| v.clamp(0.0, limit as f32)));
        let most = grid.values.iter().fold([0.0_f32; 3], |most, texel| [0, 1, 2].map(|c: usize| most[c].max(texel[c])));
        let factor = Value::rgb(most.map(f64::from)).fitted(channels);
        let over = |c: usize, v: f32| if most[c] > 0.0 { f64::from(v / most[c]) } else { 0.0 };
        Ok(Scaled { factor, ..self.ship(name, &grid, channels, over)? })
    }

    /// A value from its least to its greatest, and the picture that goes from 0 to 1 between them, where they differ. The picture has no placement: one is told.
    pub(super) fn spread(&mut self, name: &str, expression: &Arc<Expression>) -> Result<([f64; 2], Scaled), String> {
        let mut grid = self.grid(expression)?;
        let values = grid.values.iter().map(|texel| texel[0]);
        let [least, most] = values.fold([f32::INFINITY, f32::NEG_INFINITY], |[a, b], v| [a.min(v), b.max(v)]);
        let over = |_: usize, v: f32| f64::from((v - least) / (most - least));
        let range = [least, most].map(f64::from);
        if most <= least {
            return Ok((range, Scaled::constant(Value::number(1.0))));
        }
        if grid.transform.take().is_some() {
            grid.notes.insert("its placement is left out");
        }
        Ok((range, self.ship(name, &grid, 1, over)?))
    }

    /// A normal map and its factor on slopes.
    pub(super) fn normals(&mut self, expression: &Arc<Expression>) -> Result<Scaled, String> {
        if let Expression::Apply(Op::Normals, inputs, _) = &**expression
            && let (Expression::Image(image), Some(scale)) = (&*inputs[0], inputs[1].constant())
            && image.space.is_linear()
            && let Some(transform) = transform(&image.placement)
            && (0.0..=100.0).contains(&scale.first())
        {
            let path = self.copied(image)?;
            let scale = (scale.first() != 1.0).then(|| format!("scale = {}", number(scale.first())));
            return Ok(Scaled {
                factor: Value::number(1.0),
                map: Some(rules::picture(&path, [scale, transform])),
                notes: ends(image),
                is_computed: false,
            });
        }
        let grid = self.grid(expression)?;
        self.ship("normal", &grid, 3, |_, v| 0.5 + 0.5 * f64::from(v))
    }

    /// A picture of three numbers as they are, from 0 to 1.
    pub(super) fn plain(&mut self, name: &str, expression: &Arc<Expression>) -> Result<Scaled, String> {
        let grid = self.grid(expression)?;
        self.ship(name, &grid, 3, |_, v| f64::from(v))
    }

    fn unchanged(
        &mut self,
        expression: &Arc<Expression>,
        channels: usize,
        limit: f64,
    ) -> Result<Option<Scaled>, String> {
        let Some((factor, image, channel)) = expression.scaled() else { return Ok(None) };
        let is_known = image.space.is_linear() || image.space.is_srgb();
        let is_held = factor.all().iter().all(|v| (0.0..=limit.min(1.0)).contains(v));
        let fits =
            if channels == 1 { image.count == 1 || channel.is_some() } else { image.count >= 3 && channel.is_none() };
        let Some(transform) = transform(&image.placement).filter(|_| is_known && is_held && fits) else {
            return Ok(None);
        };
        let path = self.copied(image)?;
        let letter = ["r", "g", "b", "a"][channel.unwrap_or(0)];
        let words = [
            (channels == 1).then(|| format!("channel = \"{letter}\"")),
            (image.space.is_srgb() && channel != Some(3)).then(|| "srgb = true".to_owned()),
            transform,
        ];
        let map = Some(rules::picture(&path, words));
        Ok(Some(Scaled { factor: factor.fitted(channels), map, notes: ends(image), is_computed: false }))
    }

    fn number_of(&mut self, path: &str) -> usize {
        let next = self.numbers.len();
        *self.numbers.entry(path.to_owned()).or_insert(next)
    }

    fn copied(&mut self, image: &Image) -> Result<String, String> {
        let (number, files) = (self.number_of(&image.path), self.files);
        self.pictures.unchanged(number, stem(&image.path), || bytes(files, &image.path))
    }

    fn texels(&mut self, image: &Image) -> Result<Arc<Texels>, String> {
        let (number, files) = (self.number_of(&image.path), self.files);
        self.pictures.texels(number, || bytes(files, &image.path))
    }

    /// The values of an expression: over the picture where all pictures of it lie alike, else over one repeat of texture coordinates.
    fn grid(&mut self, expression: &Arc<Expression>) -> Result<Grid, String> {
        let program = Program::new(expression).ok_or("its graph has too many nodes")?;
        let mut texels = Vec::new();
        let mut count = 0;
        for image in &program.images {
            let found = self.texels(image)?;
            count += found.size().iter().map(|side| u64::from(*side)).product::<u64>();
            if count > TEXELS_MAX && !texels.is_empty() {
                return Err(format!("the pictures of its graph have more than {TEXELS_MAX} texels together"));
            }
            texels.push(found);
        }
        let mut notes = BTreeSet::new();
        if program.images.iter().any(|image| !image.repeats) {
            notes.insert(ENDS);
        }
        let first = program.images.first().map(|image| image.placement);
        let shared =
            first.filter(|first| !program.has_texcoord && program.images.iter().all(|image| image.placement == *first));
        let shared = shared.and_then(|shared| transform(&shared));
        let extent = |axis: usize| {
            let sizes = program.images.iter().zip(&texels).map(|(image, texels)| {
                let size = f64::from(texels.size()[axis]);
                let [a, b] = [0, 1].map(|c: usize| image.placement[c][axis].abs());
                if shared.is_some() { size } else { size * a.max(b) }
            });
            let most = sizes.fold(0.0, f64::max);
            let most = if most < 1.0 { f64::from(SIDE) } else { libm::ceil(most) };
            (most.min(f64::from(SIDE_MAX)) as u32, most > f64::from(SIDE_MAX))
        };
        let ((mut width, is_wide), (mut height, is_high)) = (extent(0), extent(1));
        let mut is_reduced = is_wide || is_high;
        while u64::from(width) * u64::from(height) * program.len() as u64 > WORK_MAX && width.max(height) > 1 {
            (width, height, is_reduced) = (width.div_ceil(2), height.div_ceil(2), true);
        }
        if is_reduced {
            notes.insert("the computed picture has fewer texels than its sources");
        }
        if shared.is_none() {
            let is_whole = |v: f64| (v - libm::round(v)).abs() < 1e-9;
            let repeats = program
                .images
                .iter()
                .all(|image| image.placement.iter().all(|row| is_whole(row[0]) && is_whole(row[1])));
            if !repeats || program.has_texcoord {
                notes.insert("it is computed for texture coordinates from 0 to 1, and repeats beyond them");
            }
        }
        let value = |x: u32, y: u32, room: &mut [Vec<Value>; 2]| {
            let place = [(f64::from(x) + 0.5) / f64::from(width), (f64::from(y) + 0.5) / f64::from(height)];
            // v grows upwards in the format, downwards in pictures.
            let uv = [place[0], 1.0 - place[1]];
            let image = |number: usize| {
                let (image, texels): (&Image, &Texels) = (&program.images[number], &texels[number]);
                let stored = if shared.is_some() {
                    if texels.size() == [width, height] { texels.texel(x, y) } else { texels.at(place) }
                } else {
                    let [s, t] = placed(&image.placement, uv);
                    texels.at([s, 1.0 - t])
                };
                let linear = image.space.linear(stored);
                Value::new(&linear[..image.count])
            };
            let [a, b, c] = program.at(uv, image, room).three();
            [a, b, c].map(|v| if v.is_finite() { v as f32 } else { 0.0 })
        };
        let values = (0..height).into_par_iter().flat_map_iter(|y| {
            let mut room = Default::default();
            (0..width).map(|x| value(x, y, &mut room)).collect::<Vec<_>>()
        });
        let values = values.collect();
        Ok(Grid { width, height, values, transform: shared.flatten(), notes })
    }

    /// The picture of texels, over nothing.
    fn ship(
        &mut self,
        name: &str,
        grid: &Grid,
        channels: usize,
        of: impl Fn(usize, f32) -> f64,
    ) -> Result<Scaled, String> {
        let samples = grid
            .values
            .iter()
            .flat_map(|texel| texel.iter().take(channels).enumerate().map(|(c, v)| quantised(of(c, *v))));
        let samples: Vec<u16> = samples.collect();
        let path = self.pictures.drawn(name, [grid.width, grid.height], channels as u32, samples)?;
        let map = Some(rules::picture(&path, [grid.transform.clone()]));
        Ok(Scaled { factor: Value::number(1.0), map, notes: grid.notes.iter().copied().collect(), is_computed: true })
    }
}

/// The note on pictures that do not repeat.
const ENDS: &str = "the picture ends or is mirrored at its edge: maps repeat";

fn ends(image: &Image) -> Vec<&'static str> {
    if image.repeats { Vec::new() } else { vec![ENDS] }
}

fn bytes(files: Files<'_>, path: &str) -> Result<Vec<u8>, String> {
    files(path).map_err(|error| format!("`{path}`: {error}"))
}

/// The name of a file without its folder and ending.
fn stem(path: &str) -> &str {
    let name = path.rsplit_once('/').map_or(path, |(_, name)| name);
    name.rsplit_once('.').map_or(name, |(stem, _)| stem)
}

/// A placement as TOML: texture coordinates are scaled, then turned, then moved, and v grows downwards. `Some(None)` moves nothing; `None` is a placement that no file can say.
fn transform(&[[a, b, c], [d, e, f]]: &Affine) -> Option<Option<String>> {
    let turn = libm::atan2(-d, a);
    let (sin, cos) = libm::sincos(turn);
    let scale = [libm::hypot(a, d), b * sin + e * cos];
    let is_sheared = (e * sin - b * cos).abs() > 1e-9 * (1.0 + b.abs().max(e.abs()));
    if is_sheared || scale.iter().any(|s| s.abs() > SCALE_MAX || s.abs() * SCALE_MAX < 1.0) {
        return None;
    }
    let offset = [b + c, 1.0 - e - f].map(|v| {
        let v = v - v.floor();
        if v > 1.0 - 1e-9 { 0.0 } else { v }
    });
    // Arithmetic leaves the last digits.
    let near = |value: f64, wanted: f64| if (value - wanted).abs() < 1e-9 { wanted } else { value };
    Some(rules::placement(offset.map(|v| near(v, 0.0)), near(turn, 0.0).to_degrees(), scale.map(|s| near(s, 1.0))))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn placements_are_scaled_turned_and_moved() {
        let of = |matrix: Affine| transform(&matrix);
        assert_eq!(of([[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]]), Some(None));
        // Whole tiles stay where they are, although v is turned over.
        assert_eq!(of([[4.0, 0.0, 0.0], [0.0, 4.0, 0.0]]), Some(Some("transform = { scale = [4.0, 4.0] }".to_owned())));
        let half = Some(Some("transform = { offset = [0.25, 0.5], scale = [1.0, 0.5] }".to_owned()));
        assert_eq!(of([[1.0, 0.0, 0.25], [0.0, 0.5, 0.0]]), half);
        assert_eq!(of([[1.0, 0.5, 0.0], [0.0, 1.0, 0.0]]), None);
    }

    /// A placement read as the material file means it shows the texel that the format means.
    #[test]
    fn a_turn_is_the_same_turn() {
        let (sin, cos) = libm::sincos(0.6);
        let matrix = [[2.0 * cos, 3.0 * sin, 0.1], [-2.0 * sin, 3.0 * cos, 0.2]];
        let text = of_text(&transform(&matrix).unwrap().unwrap());
        let ([ou, ov], turn, [su, sv]) = text;
        let (sin, cos) = libm::sincos(turn.to_radians());
        for [u, v] in [[0.3, 0.8], [0.9, 0.1]] {
            let [s, t] = placed(&matrix, [u, 1.0 - v]);
            let [x, y] = [u * su, v * sv];
            let found = [cos * x - sin * y + ou, sin * x + cos * y + ov];
            for (found, wanted) in found.iter().zip([s, 1.0 - t]) {
                let apart = (found - wanted).rem_euclid(1.0);
                assert!(apart.min(1.0 - apart) < 1e-4, "{found} {wanted}");
            }
        }
    }

    fn of_text(text: &str) -> ([f64; 2], f64, [f64; 2]) {
        let numbers: Vec<f64> = text
            .split(|c: char| !(c.is_ascii_digit() || ".-".contains(c)))
            .filter_map(|word| word.parse().ok())
            .collect();
        ([numbers[0], numbers[1]], numbers[2], [numbers[3], numbers[4]])
    }
}
