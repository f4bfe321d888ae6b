//! Rows over the view.

mod curve;
mod one_width;
mod shaping;
mod short;

use luthier_optics::Rgb;

use super::LOBES;
use super::shape::{Shape, TAIL_MIN};
use crate::least_squares::solve;

pub use curve::Curve;
pub use one_width::OneWidth;
pub use shaping::Shaping;
pub use short::Short;

/// Cosine at which the row of the horizon is traced, at 89.9 degrees.
const FLATTEST: f64 = 0.001_745;

/// A critical angle of the view, beyond which a medium that is optically thinner than the exterior lets nothing through.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Critical {
    /// Squared cotangent k of the angle; 0 if the stack has no such angle.
    pub cot_sq: f64,
    /// Half the width w over which rough interfaces blur the kink, in squared cosines.
    pub width: f64,
    /// Share of the view's own cosine in the cosine of the axis; the rest is the cosine inside.
    pub plain_share: f64,
}

/// Share of the view's own cosine, before [`Critical::new`] moves a node to the kink.
const PLAIN_SHARE: f64 = 0.25;

/// The view's own part of the axis: `(1 + b) c / (b + c)` of its cosine c. At the horizon, where reflectances are steepest, it is five times as steep
/// as c.
fn plain(cos_theta: f64) -> f64 {
    cos_theta * ((1.0 + PLAIN_BEND) / (cos_theta + PLAIN_BEND))
}

/// The b of [`plain`].
const PLAIN_BEND: f64 = 0.25;

impl Critical {
    /// The critical angle of a medium of relative index below 1, and none otherwise. The share is chosen so that a node lies at the kink.
    pub fn new(index: f64, width: f64, rows: usize) -> Self {
        if index >= 1.0 {
            return Self::default();
        }
        let cot_sq = (1.0 - index) * (1.0 + index) / (index * index);
        let critical = Self { cot_sq, width, plain_share: PLAIN_SHARE };
        let axis = ViewAxis::new(rows, critical);
        let outside = ((1.0 - index) * (1.0 + index)).sqrt();
        let (inside, last) = (axis.inside(outside), (axis.size - 1) as f64);
        let u = libm::round(axis.place(outside)).max(1.0) / last;
        let share = (u / (2.0 - u) - inside) / (plain(outside) - inside);
        // A kink next to an end of the axis gets no node: the share would be far from the usual one.
        if share > 0.5 * PLAIN_SHARE && share < 2.0 * PLAIN_SHARE {
            Self { plain_share: share, ..critical }
        } else {
            critical
        }
    }
}

/// The axis of rows over the view: nodes at equal distances in `2c / (1 + c)`, up to the normal.
///
/// Usually c is the cosine of the view. If a medium reflects flat light totally, all light from below has a kink at the critical angle. Then c
/// is a mean of two cosines: the cosine inside ([`Self::inside`]) is steep at the kink, and `5 cos / (1 + 4 cos)` of the view tells flatter views
/// apart.
///
/// ```
/// use luthier_layers::models::lobes::{Critical, ViewAxis};
///
/// let axis = ViewAxis::new(4, Critical::default());
/// // 2c / (1 + c) of c = 1/2 is two thirds of the way along three steps.
/// assert!((axis.place(0.5) - 2.0).abs() < 1e-12);
/// assert!((axis.cos_theta(2.0) - 0.5).abs() < 1e-12);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct ViewAxis {
    size: usize,
    critical: Critical,
    /// The rounded root at the horizon, and its range from there to the normal.
    roots: [f64; 2],
}

impl ViewAxis {
    /// An axis of `size` nodes, at least two.
    pub fn new(size: usize, critical: Critical) -> Self {
        let [horizon, normal] = [-critical.cot_sq, 1.0].map(|x| root(x, critical.width));
        Self { size: size.max(2), critical, roots: [horizon, normal - horizon] }
    }

    /// Number of nodes.
    pub fn size(self) -> usize {
        self.size
    }

    /// The axis of every `step`-th node, with the first and the last.
    pub(super) fn thinned(self, step: usize) -> Self {
        Self::new((self.size - 1) / step + 1, self.critical)
    }

    /// The axis with `parts` steps in place of one.
    pub(super) fn refined(self, parts: usize) -> Self {
        Self::new((self.size - 1) * parts + 1, self.critical)
    }

    /// The critical angle.
    pub fn critical(self) -> Critical {
        self.critical
    }

    /// The cosine inside, from 0 at the horizon to 1 at the normal. The squared cosine of the refracted direction is in proportion to
    /// `x = cos^2 - k sin^2`; its root is rounded off to `sqrt((x + sqrt(x^2 + 4 w^2)) / 2)`, because rough interfaces blur the kink. Without a
    /// critical angle the result is the cosine itself.
    pub fn inside(self, cos_theta: f64) -> f64 {
        let sin_sq = (1.0 - cos_theta) * (1.0 + cos_theta);
        let [horizon, range] = self.roots;
        let x = cos_theta * cos_theta - self.critical.cot_sq * sin_sq;
        ((root(x, self.critical.width) - horizon) / range).clamp(0.0, 1.0)
    }

    /// The cosine c of a view.
    pub fn cosine(self, cos_theta: f64) -> f64 {
        if self.critical.cot_sq > 0.0 {
            let inside = self.inside(cos_theta);
            inside + self.critical.plain_share * (plain(cos_theta) - inside)
        } else {
            cos_theta.clamp(0.0, 1.0)
        }
    }

    /// Fractional number of the node of a view.
    pub fn place(self, cos_theta: f64) -> f64 {
        self.place_at(self.cosine(cos_theta))
    }

    /// Fractional number of the node of a cosine c.
    pub fn place_at(self, c: f64) -> f64 {
        2.0 * c / (1.0 + c) * (self.size - 1) as f64
    }

    /// The cosine of the view at a fractional number of a node, at least that of 89.9 degrees.
    pub fn cos_theta(self, place: f64) -> f64 {
        let u = place / (self.size - 1) as f64;
        let c = (u / (2.0 - u)).clamp(0.0, 1.0);
        if self.critical.cot_sq == 0.0 || c == 1.0 {
            return c.max(FLATTEST);
        }
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..BISECTIONS {
            let middle = 0.5 * (low + high);
            *if self.cosine(middle) < c { &mut low } else { &mut high } = middle;
        }
        f64::max(0.5 * (low + high), FLATTEST)
    }

    /// Rows at the nodes, given rows at more views: lines between the nodes are nearest to the given rows by least squares. `cosines` are those of
    /// the views. On a curve, such lines err half as much as chords do, and as much at the nodes as between them.
    pub(super) fn nearest(self, rows: &[Row], cosines: &[f64]) -> Vec<Row> {
        let mut matrix = vec![vec![0.0; self.size]; self.size];
        for ends in cosines.iter().map(|cos_theta| self.ends(*cos_theta)) {
            ends.iter().for_each(|(i, x)| ends.iter().for_each(|(j, y)| matrix[*i][*j] += x * y));
        }
        let (given, has_base): (Vec<Vec<[f64; 4]>>, _) =
            (rows.iter().map(Row::to_parts).collect(), rows[0].base.is_some());
        let mut parts = vec![given[0].clone(); self.size];
        for (part, c) in (0..given[0].len()).flat_map(|part| [0, 1, 2, 3].map(|c: usize| (part, c))) {
            let mut right = vec![0.0; self.size];
            for (row, cos_theta) in given.iter().zip(cosines) {
                self.ends(*cos_theta).iter().for_each(|(i, x)| right[*i] += x * row[part][c]);
            }
            parts.iter_mut().zip(solve(matrix.clone(), right)).for_each(|(parts, x)| parts[part][c] = x);
        }
        parts.iter().map(|parts| Row::within(rows[0].lobes.len(), parts, has_base)).collect()
    }

    /// The nodes on both sides of a view, each with its weight in the line between them.
    fn ends(self, cos_theta: f64) -> [(usize, f64); 2] {
        let place = self.place(cos_theta);
        let first = (place as usize).min(self.size - 2);
        [(first, 1.0 - (place - first as f64)), (first + 1, place - first as f64)]
    }
}

/// Halvings of the interval in which [`ViewAxis::cos_theta`] looks for a view: down to the digits of a double.
const BISECTIONS: u32 = 50;

/// The root of x, rounded off over a width: `sqrt((x + sqrt(x^2 + 4 w^2)) / 2)`.
fn root(x: f64, width: f64) -> f64 {
    let far = (x * x + 4.0 * width * width).sqrt();
    // For negative x the sum would cancel.
    let sum = if x < 0.0 { 4.0 * width * width / (far - x) } else { x + far };
    (0.5 * sum).sqrt()
}

/// Energies and shapes at a view.
#[derive(Debug, Clone, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Row {
    /// Directional albedo.
    pub albedo_dir: Rgb,
    /// The lobes.
    pub lobes: Vec<Lobe>,
    /// Energy of the wide remainder.
    pub wide: Rgb,
    /// The light of a diffuse base below interfaces, which the remainder includes; `None` for a stack without one.
    pub base: Option<BaseLight>,
}

/// The light of a diffuse base at a view. [`Self::more`] recolours the base without a new fit.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct BaseLight {
    /// Energy in the wide remainder.
    pub energy: Rgb,
    /// Share of the light from the base that the layers send back to it.
    pub internal: Rgb,
    /// Coefficients of the shape of a Lambertian base's light, which the remainder takes; 0 above another base.
    pub falloff: [f64; 2],
    /// Lengths of light in the first slab, over its thickness, in rows of a family with such: of one visit to the base interface; of the light of the diffuse base,
    /// or of more visits without one; and of what is sent back to it.
    pub lengths: [f64; 3],
    /// Energy of the light that meets the base from one direction, in a row of a family in colours; its other numbers know no colour.
    #[cfg_attr(feature = "serde", serde(skip))]
    pub met: Option<Rgb>,
}

impl BaseLight {
    /// Energy that a base of another albedo sends beyond the energy of the simulated one. The light of an albedo R is in proportion to `R / (1 - r R)`,
    /// with r the share that the layers send back.
    pub fn more(&self, simulated: Rgb, albedo: Rgb) -> Rgb {
        [0, 1, 2].map(|c: usize| {
            let [own, other] = [simulated[c], albedo[c]].map(|r| r / (1.0 - self.internal[c] * r).max(1e-3));
            // A base that was simulated black leaves no light to scale.
            if own > 0.0 { self.energy[c] * (other / own - 1.0) } else { 0.0 }
        })
    }

    /// [`Self::more`] and [`Self::of_one_direction`] where the first slab lets a share of the light of the base through, and a share of what is sent back to it.
    pub(super) fn dimmed(&self, simulated: Rgb, albedo: Rgb, [passed, around]: [Rgb; 2]) -> [Rgb; 2] {
        let mut light = [[0.0; 3]; 2];
        for c in [0, 1, 2].into_iter().filter(|&c| simulated[c] > 0.0) {
            let own = simulated[c] / (1.0 - self.internal[c] * simulated[c]).max(1e-3);
            let left = (1.0 - self.internal[c] * around[c] * albedo[c]).max(1e-3);
            let direct = self.energy[c] * albedo[c] * passed[c] / own;
            light[0][c] = direct / left - self.energy[c];
            light[1][c] = direct;
        }
        light
    }

    /// Energy that a base of another albedo has of light that comes through the layers, without what these send back to it.
    pub(super) fn of_one_direction(&self, simulated: Rgb, albedo: Rgb) -> Rgb {
        let more = self.more(simulated, albedo);
        [0, 1, 2].map(|c: usize| (self.energy[c] + more[c]) * (1.0 - self.internal[c] * albedo[c]).max(0.0))
    }
}

/// A lobe at a view.
#[derive(Debug, Clone, Copy, PartialEq)]
#[cfg_attr(feature = "serde", derive(serde::Serialize, serde::Deserialize))]
pub struct Lobe {
    /// Energy divided by [`Self::share`].
    pub strength: Rgb,
    /// Share of the shape above the horizon.
    pub share: f64,
    /// Shift of the middle over the sine of the view.
    pub shift: f64,
    /// Reciprocal widths in the plane of the eye and across it. In axes: the diagonal of a symmetric matrix S.
    pub sharpness: [f64; 2],
    /// The entry of S off the diagonal; 0 in the plane of the eye.
    pub shear: f64,
    /// Tail of the shape.
    pub tail: f64,
}

impl Lobe {
    /// The shape in the plane of an eye, by the sine of its angle.
    pub(super) fn in_plane(&self, sin: f64) -> Shape {
        let width = self.sharpness.map(|sharpness| 1.0 / sharpness);
        Shape { middle: [self.shift * sin, 0.0], width, turn: [1.0, 0.0], tail: self.tail }
    }

    /// The shape in axes in which the eye has coordinates along the surface.
    ///
    /// The middle is `shift det(S) S^-2 eye`, so that S times the middle is `shift adj(S) eye`.
    pub(super) fn in_axes(&self, eye: [f64; 2]) -> Shape {
        let [x, y] = self.sharpness;
        let (mean, half) = (0.5 * (x + y), 0.5 * (x - y));
        // Rounding may leave no ellipse: the lesser sharpness would not be positive.
        let radius = libm::hypot(half, self.shear).min(mean * (1.0 - SHARPNESS_MIN));
        let (sin, cos) = libm::sincos(0.5 * libm::atan2(self.shear, half));
        let sharpness = [mean + radius, mean - radius];
        let [along, across] = [cos * eye[0] + sin * eye[1], cos * eye[1] - sin * eye[0]];
        let ratio = sharpness[1] / sharpness[0];
        let [along, across] = [self.shift * ratio * along, self.shift / ratio * across];
        Shape {
            middle: [cos * along - sin * across, sin * along + cos * across],
            width: sharpness.map(|sharpness| 1.0 / sharpness),
            turn: [cos, sin],
            tail: self.tail,
        }
    }
}

/// Least sharpness along one axis, over that along the other.
const SHARPNESS_MIN: f64 = 1e-4;

impl Row {
    /// The row with the energies of each channel from a row of its own; shapes stay.
    #[must_use]
    pub fn with_channels(mut self, own: [&Self; 3]) -> Self {
        for (c, own) in own.into_iter().enumerate() {
            (self.albedo_dir[c], self.wide[c]) = (own.albedo_dir[c], own.wide[c]);
            self.lobes.iter_mut().zip(&own.lobes).for_each(|(lobe, own)| lobe.strength[c] = own.strength[c]);
            if let (Some(base), Some(own)) = (&mut self.base, own.base) {
                (base.energy[c], base.internal[c]) = (own.energy[c], own.internal[c]);
            }
        }
        self
    }

    /// Number of parts of the light of a diffuse base.
    pub const BASE_PARTS: usize = 2;

    /// Number of parts of a row with `lobes` lobes, without the parts of a diffuse base.
    pub const fn parts(lobes: usize) -> usize {
        2 + 2 * lobes
    }

    /// The row as parts of four numbers, as tables have it.
    ///
    /// | part | x, y, z, w |
    /// |---|---|
    /// | -2, with a diffuse base only | share of the base's light that the layers send back to it RGB, b of the remainder |
    /// | -1, with a diffuse base only | energy of the base's light in the remainder RGB, a of the remainder |
    /// | 0 | wide remainder RGB, shear of the first lobe |
    /// | 1 | strength of the first lobe RGB, shift |
    /// | 2, with one lobe | its sharpness along the plane of the eye, and across it; 1 over the tail; share |
    /// | 2, with two lobes | strength of the second lobe RGB, shift |
    /// | 3, with two lobes | sharpness of the first lobe, then of the second |
    /// | 4, with two lobes | 1 over the tail and share of the first lobe, then of the second |
    /// | last of so many lobes | directional albedo RGB, shear of the second lobe |
    /// | 6, with three lobes | strength of the third lobe RGB, shift |
    /// | 7, with three lobes | its sharpness along the plane of the eye, and across it; 1 over the tail; share |
    ///
    /// So a row of three lobes begins with that of two. A third lobe has no shear: stacks with axes have two lobes.
    ///
    /// Tails hold at all views of a tile. A shader that has those of the material as numbers ([`Self::inverse_tails`]) does not read part 4.
    ///
    /// Sharpness x and y and shear k are multiplied by the root of the tail. With z, 1 over the tail, the shape is then
    /// `(x y - k^2) z / pi (1 + q)^-(1 + z)`: a shader has no tail to multiply.
    pub fn to_parts(&self) -> Vec<[f64; 4]> {
        let [shear_first, shear_second] = [0, 1]
            .map(|lobe: usize| self.lobes.get(lobe).map_or(0.0, |lobe| lobe.shear * lobe.tail.max(TAIL_MIN).sqrt()));
        let mut parts = Vec::new();
        if let Some(BaseLight { energy, internal, falloff: [a, b], .. }) = self.base {
            parts.extend([part(internal, b), part(energy, a)]);
        }
        parts.push(part(self.wide, shear_first));
        let (paired, further) = self.lobes.split_at(self.lobes.len().min(LOBES));
        let light = |lobe: &Lobe| part(lobe.strength, lobe.shift);
        let shape = |lobe: &Lobe| {
            let tail = lobe.tail.max(TAIL_MIN);
            let [x, y] = lobe.sharpness.map(|sharpness| sharpness * tail.sqrt());
            [x, y, 1.0 / tail, lobe.share]
        };
        parts.extend(paired.iter().map(light));
        match *paired.iter().map(shape).collect::<Vec<_>>() {
            [[a, b, first_tail, first_share], [c, d, second_tail, second_share]] => {
                parts.extend([[a, b, c, d], [first_tail, first_share, second_tail, second_share]]);
            }
            ref alone => parts.extend(alone),
        }
        parts.push(part(self.albedo_dir, shear_second));
        parts.extend(further.iter().flat_map(|lobe| [light(lobe), shape(lobe)]));
        parts
    }

    /// 1 over the tail of each of two lobes, as [`Self::to_parts`] has it; 0 for a lobe that the row lacks.
    pub fn inverse_tails(&self) -> [f64; 2] {
        [0, 1].map(|lobe: usize| self.lobes.get(lobe).map_or(0.0, |lobe| 1.0 / lobe.tail.max(TAIL_MIN)))
    }

    /// The row as parts where it has [`OneWidth`]: sharpness and share of its one lobe are beside colours, so that the light of a view takes two parts.
    pub fn to_parts_of_one_width(&self) -> Vec<[f64; 4]> {
        let base =
            self.base.map(|BaseLight { energy, internal, falloff: [a, b], .. }| [part(internal, b), part(energy, a)]);
        let Lobe { strength, share, shift, sharpness: [x, _], .. } = self.lobes.first().copied().unwrap_or(DARK);
        let own = [part(self.wide, x), part(strength, shift), part(self.albedo_dir, share)];
        base.into_iter().flatten().chain(own).collect()
    }

    /// The row as parts where it has [`Short`]: the energy of its one lobe with the shift, and the albedo with the share.
    pub fn to_parts_of_short(&self) -> Vec<[f64; 4]> {
        let Lobe { strength, share, shift, .. } = self.lobes.first().copied().unwrap_or(DARK);
        vec![part(strength, shift), part(self.albedo_dir, share)]
    }

    /// The row of [`Self::to_parts_of_short`]; the widths are as in no row.
    pub fn of_short_parts(parts: &[[f64; 4]]) -> Self {
        let [light, albedo] = [0, 1].map(|part: usize| parts.get(part).copied().unwrap_or_default());
        let lobe = Lobe {
            strength: rgb(Some(&light)),
            share: albedo[3],
            shift: light[3],
            sharpness: [1.0; 2],
            shear: 0.0,
            tail: 1.0,
        };
        Self { albedo_dir: rgb(Some(&albedo)), lobes: vec![lobe], wide: [0.0; 3], base: None }
    }

    /// The row of parts with at most two lobes. With `has_base`, the first two parts belong to a diffuse base. Three parts are those of [`OneWidth`].
    pub fn of_parts(parts: &[[f64; 4]], has_base: bool) -> Self {
        Self::within(LOBES, parts, has_base)
    }

    /// [`Self::of_parts`] with at most so many lobes. Parts beyond theirs are of other rows beside it.
    pub fn within(most: usize, parts: &[[f64; 4]], has_base: bool) -> Self {
        let (of_base, parts) = parts.split_at(if has_base { Self::BASE_PARTS.min(parts.len()) } else { 0 });
        let parts = &parts[..parts.len().min(Self::parts(most))];
        let (parts, further) = parts.split_at(parts.len().min(Self::parts(LOBES)));
        let falloff = [1, 0].map(|part: usize| of_base.get(part).map_or(0.0, |part| part[3]));
        let base = BaseLight {
            energy: rgb(of_base.get(1)),
            internal: rgb(of_base.first()),
            falloff,
            lengths: [0.0; 3],
            met: None,
        };
        let inner = parts.get(1..parts.len().saturating_sub(1)).unwrap_or_default();
        let shears = [parts.first(), parts.last()].map(|part| part.map_or(0.0, |part| part[3]));
        let (strengths, shapes) = inner.split_at(inner.len().div_ceil(2));
        let shapes = match *shapes {
            [[a, b, c, d], [first_tail, first_share, second_tail, second_share]] => {
                vec![[a, b, first_tail, first_share], [c, d, second_tail, second_share]]
            }
            _ => shapes.to_vec(),
        };
        let mut shaped: Vec<([f64; 4], [f64; 4])> = match *inner {
            [strength] => vec![(strength, [shears[0], shears[0], 1.0, shears[1]])],
            _ => strengths.iter().copied().zip(shapes).collect(),
        };
        shaped.extend(further.chunks_exact(2).map(|own| (own[0], own[1])));
        let shears = if inner.len() == 1 { [0.0; 2] } else { shears };
        let lobes = shaped.into_iter().zip(shears.into_iter().chain(std::iter::repeat(0.0))).map(
            |((strength, [x, y, inverse_tail, share]), shear)| {
                let inverse_tail = inverse_tail.max(1.0);
                Lobe {
                    strength: rgb(Some(&strength)),
                    share,
                    shift: strength[3],
                    sharpness: [x, y].map(|x| x * inverse_tail.sqrt()),
                    shear: shear * inverse_tail.sqrt(),
                    tail: 1.0 / inverse_tail,
                }
            },
        );
        Self {
            albedo_dir: rgb(parts.last()),
            lobes: lobes.collect(),
            wide: rgb(parts.first()),
            base: has_base.then_some(base),
        }
    }

    /// The row with `lobes` lobes in all: those beyond its own have no light.
    #[must_use]
    pub fn filled(mut self, lobes: usize) -> Self {
        self.lobes.resize(lobes.max(self.lobes.len()), DARK);
        self
    }

    /// The row with all slopes scaled by a factor: lobes are wider by it, and shifted farther.
    #[must_use]
    pub fn spread(mut self, factor: f64) -> Self {
        for lobe in &mut self.lobes {
            lobe.shift *= factor;
            lobe.sharpness = lobe.sharpness.map(|sharpness| sharpness / factor);
            lobe.shear /= factor;
        }
        self
    }

    /// Energies of all light, of the wide remainder, of a diffuse base (part of the remainder), and of each lobe.
    pub fn energies(&self) -> Vec<Rgb> {
        let of_base = self.base.map_or([0.0; 3], |base| base.energy);
        let lobes = self.lobes.iter().map(|lobe| lobe.strength.map(|strength| strength * lobe.share));
        [self.albedo_dir, self.wide, of_base].into_iter().chain(lobes).collect()
    }

    /// Energy of one facet of the first interface: the albedo without lobes and remainder.
    pub fn first_facet(&self) -> Rgb {
        let energies = self.energies();
        [0, 1, 2].map(|c: usize| {
            let below: f64 = energies[1..2].iter().chain(&energies[3..]).map(|energy| energy[c]).sum();
            (self.albedo_dir[c] - below).max(0.0)
        })
    }

    /// The row with energies from 0 up, shares within 0..=1, and an albedo of at most 1. Noise and least squares may break all three. If the albedo
    /// exceeds 1, the light from below is scaled down.
    pub(super) fn bounded(mut self) -> Self {
        self.lobes.iter_mut().for_each(|lobe| lobe.share = lobe.share.clamp(0.0, 1.0));
        let strengths = self.lobes.iter_mut().map(|lobe| &mut lobe.strength);
        let of_base = self.base.iter_mut().map(|base| &mut base.energy);
        for energy in strengths.chain(of_base).chain([&mut self.wide, &mut self.albedo_dir]) {
            *energy = energy.map(|x| x.max(0.0));
        }
        let first = self.first_facet();
        for (c, facet) in first.into_iter().enumerate() {
            let below = self.albedo_dir[c] - facet;
            if self.albedo_dir[c] > 1.0 {
                let left = if below > 0.0 { (1.0 - facet).max(0.0) / below } else { 0.0 };
                self.wide[c] *= left;
                self.base.iter_mut().for_each(|base| base.energy[c] *= left);
                self.lobes.iter_mut().for_each(|lobe| lobe.strength[c] *= left);
                self.albedo_dir[c] = 1.0;
            }
        }
        self
    }

    /// The row between two others.
    #[must_use]
    pub fn between(&self, other: &Self, t: f64) -> Self {
        let met = self.base.and_then(|base| base.met).zip(other.base.and_then(|base| base.met));
        let lengths = self.base.zip(other.base).map(|(own, other)| [own.lengths, other.lengths]);
        let (own, other) = (self.to_parts(), other.to_parts());
        let parts = own.iter().zip(&other).map(|(a, b)| [0, 1, 2, 3].map(|i: usize| a[i] + t * (b[i] - a[i])));
        let mut between = Self::within(self.lobes.len(), &parts.collect::<Vec<_>>(), self.base.is_some());
        if let (Some(base), Some([a, b])) = (&mut between.base, lengths) {
            base.lengths = [0, 1, 2].map(|i: usize| a[i] + t * (b[i] - a[i]));
        }
        if let (Some(base), Some((a, b))) = (&mut between.base, met) {
            base.met = Some([0, 1, 2].map(|c: usize| a[c] + t * (b[c] - a[c])));
        }
        between
    }
}

/// A lobe without light.
const DARK: Lobe = Lobe { strength: [0.0; 3], share: 1.0, shift: 0.0, sharpness: [1.0; 2], shear: 0.0, tail: 0.0 };

/// A part of a row.
fn part([r, g, b]: Rgb, w: f64) -> [f64; 4] {
    [r, g, b, w]
}

/// The colour of a part; black for a missing part.
fn rgb(part: Option<&[f64; 4]>) -> Rgb {
    part.map_or([0.0; 3], |&[r, g, b, _]| [r, g, b])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::lobes::{Frame, Lobes, Wide};

    #[test]
    fn places_and_views_are_inverse() {
        let axis = ViewAxis::new(20, Critical::default());
        // From index 1.5 to 1: the critical angle has a sine of two thirds.
        let (cot_sq, critical_cos) = (1.25, f64::sqrt(5.0 / 9.0));
        let critical = |width| ViewAxis::new(20, Critical { cot_sq, width, plain_share: 0.25 });
        for place in [0.3, 7.5, 19.0] {
            for axis in [axis, critical(0.01), critical(0.5)] {
                assert!((axis.place(axis.cos_theta(place)) - place).abs() < 1e-6, "{axis:?} {place}");
            }
        }
        // Where x is 0, the rounded root is that of the width.
        let soft = critical(0.01);
        let [horizon, normal] = [root(-cot_sq, 0.01), root(1.0, 0.01)];
        assert!((soft.inside(critical_cos) - (0.1 - horizon) / (normal - horizon)).abs() < 1e-12);
        let plain = 5.0 * critical_cos / (1.0 + 4.0 * critical_cos);
        assert!((soft.cosine(critical_cos) - (0.75 * soft.inside(critical_cos) + 0.25 * plain)).abs() < 1e-12);
        assert_eq!([soft.cosine(0.0), soft.cosine(1.0)], [0.0, 1.0]);
        // With a node at the kink.
        let kinked = ViewAxis::new(20, Critical::new(2.0 / 3.0, 0.01, 20));
        let place = kinked.place(critical_cos);
        assert!((place - libm::round(place)).abs() < 1e-9, "{place}");
        assert_eq!(Critical::new(1.2, 0.1, 20), Critical::default());
        // A sharp kink: the cosine of the refracted direction.
        assert!(
            critical(0.0).inside(critical_cos - 1e-9) == 0.0
                && (critical(0.0).inside(0.9) - f64::sqrt(0.81 - 1.25 * 0.19)).abs() < 1e-12
        );
        assert_eq!(axis.place(0.0), 0.0);
        assert!((axis.cos_theta(19.0) - 1.0).abs() < 1e-15);
        assert!((libm::acos(axis.cos_theta(0.0)).to_degrees() - 89.9).abs() < 1e-3);
        // 2/3 of 1/2 over 3/2: two thirds of the way.
        assert!((ViewAxis::new(4, Critical::default()).place(0.5) - 2.0).abs() < 1e-15);
    }

    /// Oracle: rows on a line, which are found again; and a parabola, whose chords are off by an eighth of its second difference.
    #[test]
    fn nearest_rows_err_half_as_much_as_those_on_a_curve() {
        let axis = ViewAxis::new(10, Critical::default());
        let seen = ViewAxis::new(19, Critical::default());
        let cosines: Vec<f64> = (0..19).map(|row| seen.cos_theta(f64::from(row))).collect();
        let row = |albedo: f64| Row { albedo_dir: [albedo; 3], lobes: vec![], wide: [0.0; 3], base: None };
        let nearest = |of: &dyn Fn(f64) -> f64| {
            let rows: Vec<Row> = cosines.iter().map(|cos_theta| row(of(axis.place(*cos_theta)))).collect();
            axis.nearest(&rows, &cosines)
        };
        for (i, row) in nearest(&|place| 1.0 + 2.0 * place).iter().enumerate() {
            assert!((row.albedo_dir[0] - (1.0 + 2.0 * i as f64)).abs() < 1e-9, "{i} {row:?}");
        }
        let curved = nearest(&|place| place * place);
        // Not at the ends, where there is one side alone.
        for i in 3..7 {
            let [here, next] = [i, i + 1].map(|i: usize| curved[i].albedo_dir[0] - (i * i) as f64);
            let between = 0.5 * (here + next) + 0.25;
            assert!((here + 0.125).abs() < 0.02 && (between - 0.125).abs() < 0.02, "{i}: {here} {between}");
        }
    }

    #[test]
    fn parts_are_the_row() {
        let lobe = |k: f64| Lobe {
            strength: [1.0, 2.0, 3.0].map(|x| x + k),
            share: 0.5 + k,
            shift: 0.25,
            sharpness: [8.0, 9.0],
            shear: 1.0 + k,
            tail: 0.25,
        };
        for lobes in [vec![], vec![lobe(0.0)], vec![lobe(0.0), lobe(0.25)]] {
            let base = BaseLight {
                energy: [0.7, 0.8, 0.9],
                internal: [0.4, 0.5, 0.6],
                falloff: [0.2, 0.1],
                lengths: [0.0; 3],
                met: None,
            };
            for base in [None, Some(base)] {
                let row = Row { albedo_dir: [4.0, 5.0, 6.0], lobes: lobes.clone(), wide: [0.1, 0.2, 0.3], base };
                let (parts, of_base) = (row.to_parts(), base.map_or(0, |_| Row::BASE_PARTS));
                let count = Row::parts(row.lobes.len()) + of_base;
                assert_eq!((parts.len(), &Row::of_parts(&parts, base.is_some())), (count, &row));
                // Beside families and rows of three lobes those of two have parts that are not theirs.
                if row.lobes.len() == LOBES {
                    let beside = [parts, vec![[7.0; 4]; 2]].concat();
                    assert_eq!(Row::of_parts(&beside, base.is_some()), row);
                }
            }
        }
    }

    /// Rows of three lobes begin with those of two.
    #[test]
    fn rows_of_three_lobes_mix() {
        let lobe = |k: f64| Lobe {
            strength: [k, 2.0, 3.0],
            share: 0.5,
            shift: 0.25 * k,
            sharpness: [8.0, 9.0 + k],
            shear: 0.0,
            tail: 0.25,
        };
        let row = |k: f64| Row {
            albedo_dir: [k; 3],
            lobes: [k, k + 1.0, k + 2.0].map(lobe).to_vec(),
            wide: [0.1; 3],
            base: None,
        };
        assert_eq!(row(0.0).to_parts().len(), Row::parts(3));
        assert_eq!(row(0.0).between(&row(4.0), 0.5), row(2.0));
    }

    #[test]
    fn no_row_returns_more_than_falls_in() {
        let lobe =
            Lobe { strength: [0.5, 0.5, 0.0], share: 0.8, shift: 0.0, sharpness: [1.0; 2], shear: 0.0, tail: 0.0 };
        let row =
            Row { albedo_dir: [1.25, 0.75, 1.5], lobes: vec![lobe], wide: [0.1, 0.1, -0.2], base: None }.bounded();
        // Of .5 from below .25 are too much; the third channel has nothing there.
        assert_eq!((row.albedo_dir, row.lobes[0].strength), ([1.0, 0.75, 1.0], [0.25, 0.5, 0.0]));
        assert!((row.wide[0] - 0.05).abs() < 1e-15 && (row.first_facet()[0] - 0.75).abs() < 1e-12);
    }

    /// Oracle: the matrix itself, for the squared distance and the determinant.
    #[test]
    fn lobes_in_axes_are_those_of_their_matrix() {
        let lobe = Lobe { strength: [1.0; 3], share: 1.0, shift: 0.3, sharpness: [7.0, 3.0], shear: -2.0, tail: 0.5 };
        let eye = [0.5, 0.2];
        let shape = lobe.in_axes(eye);
        let adjugate = [3.0 * eye[0] + 2.0 * eye[1], 7.0 * eye[1] + 2.0 * eye[0]];
        for [x, y] in [[0.0, 0.0], [0.3, -0.1], [-0.2, 0.5]] {
            let scaled = [7.0 * x - 2.0 * y - 0.3 * adjugate[0], -2.0 * x + 3.0 * y - 0.3 * adjugate[1]];
            let q = scaled[0] * scaled[0] + scaled[1] * scaled[1];
            let expected = (7.0 * 3.0 - 4.0) / std::f64::consts::PI * libm::pow(1.0 + 0.5 * q, -3.0);
            assert!((shape.density([x, y]) / expected - 1.0).abs() < 1e-9, "{x} {y}");
        }
        // Rounding has left no ellipse.
        let none = Lobe { shear: 5.0, ..lobe }.in_axes(eye);
        assert!(none.width.iter().all(|width| width.is_finite() && *width > 0.0));
    }

    /// By hand: 4 - (1 * .5) - .1 and so on.
    #[test]
    fn the_first_facet_has_the_rest() {
        let lobe =
            Lobe { strength: [1.0, 2.0, 3.0], share: 0.5, shift: 0.0, sharpness: [1.0; 2], shear: 0.0, tail: 0.0 };
        let row = Row { albedo_dir: [4.0, 2.0, 1.0], lobes: vec![lobe], wide: [0.1; 3], base: None };
        let expected = [3.4, 0.9, 0.0];
        assert!(row.first_facet().iter().zip(expected).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    /// Oracles: rows whose widths follow the squared sine keep them, any row its energies, and parts are those of the row.
    #[test]
    fn one_width_keeps_energies() {
        let axis = ViewAxis::new(7, Critical::default());
        let row = |place: usize| {
            let cos = axis.cos_theta(place as f64);
            let (x, sin_sq) = (6.0 + cos, (1.0 - cos) * (1.0 + cos));
            let lobe = Lobe {
                strength: [0.5, 0.4, 0.3],
                share: 0.7,
                shift: 0.1,
                sharpness: [x, x * (1.0 - 0.5 * sin_sq)],
                shear: 0.0,
                tail: 0.25,
            };
            Row { albedo_dir: [0.9; 3], lobes: vec![lobe], wide: [0.1; 3], base: None }
        };
        let frame = Frame::new(1.5, Wide::new([0.2, 0.1], axis));
        let given = Lobes { first: None, frame, axis, rows: (0..7).map(row).collect() };
        let narrowed = given.clone().of_one_width().unwrap();
        let Shaping::OneWidth(one_width) = narrowed.frame.shaping else { panic!("{:?}", narrowed.frame.shaping) };
        assert!((one_width.rise + 0.5).abs() < 1e-9 && one_width.inverse_tail == 4.0, "{one_width:?}");
        for (place, (given, narrowed)) in given.rows.iter().zip(&narrowed.rows).enumerate() {
            let cos = axis.cos_theta(place as f64);
            let shaped = one_width.shaped(narrowed.lobes[0], ((1.0 - cos) * (1.0 + cos)).sqrt());
            for (found, expected) in shaped.sharpness.iter().zip(given.lobes[0].sharpness) {
                assert!((found - expected).abs() < 1e-9, "{found} {expected}");
            }
            for (found, expected) in narrowed.energies().iter().flatten().zip(given.energies().iter().flatten()) {
                assert!((found - expected).abs() < 1e-12, "{found} {expected}");
            }
            assert_eq!(&Row::of_parts(&narrowed.to_parts_of_one_width(), false), narrowed);
        }
        let two = Row { lobes: vec![given.rows[0].lobes[0]; 2], ..given.rows[0].clone() };
        assert_eq!(OneWidth::of(&[two], &[0.0]), None);
    }
}
