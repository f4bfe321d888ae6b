//! Scan of thickness tiles against the maps of material files, and check of their ranges and normalisation.

use std::f64::consts::TAU;

use luthier_layers::noise::perlin::Octaves;
use luthier_lut::{AtlasLayout, Image, WeightBits, bilinear};
use luthier_optics::stack::FilmThickness;

use super::{Measured, Scan, User, coordinate};
use crate::measure::scan::report::Curves;
use crate::measure::subject::{FilmMap, FilmSource, Subject, Table};
use crate::measure::table_terms::Weights;
use crate::text::format::number;

/// Largest relative error of a shipped value: half a unit in the last place of a half float, with room for one more rounding.
const HALF_FLOAT: f64 = 1e-3;

/// Points along each axis.
const POINTS: u32 = 64;

/// Half the step, in repeats, of the central differences by which the slopes of a map are defined.
const SLOPE_STEP: f64 = 1.0 / 4096.0;

/// Compares a thickness tile with the map of every film that reads it, between nodes and at nodes. `None` if the subject has no such map.
pub(super) fn scan(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Option<Measured> {
    let AtlasLayout { x, y: Some(y), .. } = &table.entry.layout else { return None };
    let channels = table.texels.channels.min(4) as usize;
    let mut scan = Scan::default();
    let mut is_known = false;
    for &(material, layer) in users {
        let of_layer = |map: &&FilmMap| (map.material as usize, map.layer as usize) == (material, layer);
        let Some(map) = subject.films.iter().find(of_layer) else { continue };
        let film = subject.stacks[material].layers.get(layer).and_then(|l| l.films.first())?;
        let field = Field::new(map, film.thickness, [x.size, y.size]);
        is_known = true;
        let between =
            (0..POINTS).flat_map(|j| (0..POINTS).map(move |i| [coordinate(i, POINTS), coordinate(j, POINTS)]));
        let stride = |size: u32| (size / POINTS).max(1) as usize;
        let nodes = (0..y.size).step_by(stride(y.size));
        let nodes = nodes.flat_map(|j| (0..x.size).step_by(stride(x.size)).map(move |i| [x.node(i), y.node(j)]));
        for at in between.chain(nodes) {
            let (expected, sampled) = (field.record(at), table.read(tile, at, Weights::EightBit));
            for channel in 0..channels {
                scan.add(&at, channel, expected[channel], sampled[channel]);
            }
        }
    }
    is_known.then_some(Measured { scan, curves: Curves::None, uncertainty: None })
}

/// The map of a film with its thicknesses.
struct Field<'a> {
    map: &'a FilmMap,
    thickness: FilmThickness,
    octaves: Octaves,
    /// Values that are stretched to 0 and 1.
    range: [f64; 2],
}

impl<'a> Field<'a> {
    fn new(map: &'a FilmMap, thickness: FilmThickness, [width, height]: [u32; 2]) -> Self {
        let octaves = match map.source {
            FilmSource::Noise { seed, octaves, .. } => Octaves::new(seed, octaves),
            FilmSource::Image(_) => Octaves::new(0, 0),
        };
        let mut field = Self { map, thickness, octaves, range: [0.0, 1.0] };
        if let FilmSource::Noise { .. } = map.source {
            let nodes = (0..height).flat_map(|j| (0..width).map(move |i| [(i, width), (j, height)]));
            let values = nodes.map(|node| field.raw(node.map(|(i, size)| f64::from(i) / f64::from(size))));
            field.range = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], v| [low.min(v), high.max(v)]);
        }
        field
    }

    /// The source at a point; both coordinates repeat after 1.
    fn raw(&self, uv: [f64; 2]) -> f64 {
        match &self.map.source {
            FilmSource::Noise { frequency, .. } => {
                // Two circles whose circumference is the frequency: noise along them repeats.
                let [u, v] = uv.map(|t| libm::sincos(TAU * t));
                let around = [u.1, u.0, v.1, v.0].map(|t| frequency / TAU * t);
                self.octaves.in_four_dimensions(around)
            }
            FilmSource::Image(image) => repeated(image, uv),
        }
    }

    fn thickness_nm(&self, uv: [f64; 2]) -> f64 {
        let [low, high] = self.range;
        let share = if high > low { ((self.raw(uv) - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 };
        self.thickness.min_nm + (self.thickness.max_nm - self.thickness.min_nm) * share
    }

    /// d / (2 d_max), slopes, and the factor that normalises them.
    fn record(&self, [u, v]: [f64; 2]) -> [f64; 4] {
        let across = |step: [f64; 2]| {
            let [ahead, behind] = [1.0, -1.0].map(|sign| self.thickness_nm([u + sign * step[0], v + sign * step[1]]));
            (ahead - behind) / (2.0 * SLOPE_STEP * 1e3 * self.map.extent_um)
        };
        let [dx, dy] = [across([SLOPE_STEP, 0.0]), across([0.0, SLOPE_STEP])];
        [self.thickness_nm([u, v]) / (2.0 * self.thickness.max_nm), dx, dy, libm::sqrt(1.0 + dx * dx + dy * dy)]
    }
}

/// Bilinear read of a picture that repeats: its texels beside the border are copied, so that the clamp of the filter meets them.
fn repeated(image: &Image, uv: [f64; 2]) -> f64 {
    let size = [image.width, image.height].map(f64::from);
    let mut corners = Image::zeros(2, 2, 1);
    let at = [0, 1].map(|axis: usize| (uv[axis] - libm::floor(uv[axis])) * size[axis] - 0.5);
    let base = at.map(libm::floor);
    for (j, i) in [(0_u32, 0_u32), (0, 1), (1, 0), (1, 1)] {
        let column = (base[0] + f64::from(i) + size[0]) as u32 % image.width;
        let row = (base[1] + f64::from(j) + size[1]) as u32 % image.height;
        corners.texel_mut(i, j)[0] = image.texel(column, row)[0];
    }
    let within = [0, 1].map(|axis: usize| at[axis] - base[axis] + 0.5);
    bilinear(&corners, within, WeightBits::Exact)[0]
}

/// Impossible contents of a thickness texture: a thickness outside the range of its film, or a normalisation factor that is not
/// `sqrt(1 + dx^2 + dy^2)` of its slopes, if it has slopes. The map itself is unknown here: only the material file names it.
pub(super) fn doubts(table: &Table<'_>, tile: u32, users: &[User], subject: &Subject<'_>) -> Vec<String> {
    let mut doubts = Vec::new();
    let [x0, y0] = table.entry.layout.origin(tile);
    let [width, height] = table.entry.layout.tile_size();
    let name = &table.entry.tiles[tile as usize].name;
    let has_slopes = match table.texels.channels {
        1 => false,
        4 => true,
        channels => return vec![format!("thickness tile {name}: it has {channels} channels, not one or four.")],
    };
    let (mut low, mut high, mut tilted) = (f64::INFINITY, f64::NEG_INFINITY, 0_u64);
    for (x, y) in (y0..y0 + height).flat_map(|y| (x0..x0 + width).map(move |x| (x, y))) {
        let texel = table.texels.texel(x, y);
        let d = f64::from(texel[0]);
        (low, high) = (low.min(d), high.max(d));
        // Written so that NaN is a doubt.
        let agrees = d.is_finite() && (!has_slopes || is_norm([1, 2, 3].map(|c: usize| f64::from(texel[c]))));
        tilted += u64::from(!agrees);
    }
    if tilted > 0 {
        doubts.push(format!(
            "thickness tile {name}: in {tilted} texels the thickness or the normalisation factor of its slopes is wrong."
        ));
    }
    for &(material, layer) in users {
        let Some(film) = subject.stacks[material].layers.get(layer).and_then(|l| l.films.first()) else { continue };
        let to_nm = 2.0 * film.thickness.max_nm;
        let (found_low, found_high) = (low * to_nm, high * to_nm);
        let slack = HALF_FLOAT * film.thickness.max_nm;
        if found_low < film.thickness.min_nm - slack || found_high > film.thickness.max_nm + slack {
            doubts.push(format!(
                "thickness tile {name}: it holds {} to {} nm, the film is {} to {} nm.",
                number(found_low),
                number(found_high),
                number(film.thickness.min_nm),
                number(film.thickness.max_nm)
            ));
        }
    }
    doubts
}

/// Whether a factor is `sqrt(1 + dx^2 + dy^2)`, within the rounding of half floats.
fn is_norm([dx, dy, factor]: [f64; 3]) -> bool {
    let expected = libm::sqrt(1.0 + dx * dx + dy * dy);
    (factor - expected).abs() <= HALF_FLOAT * expected
}
