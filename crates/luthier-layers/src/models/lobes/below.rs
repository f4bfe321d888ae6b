//! Light from below the first interface, as seen from a direction.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::Rgb;

use super::draws::LobeDraw;
use super::half_vector::{outside, refracted, slope};
use super::leaving::{LEAVING_MIN, Leaving};
use super::{Frame, Lobe, Row, Shape, Wide};

/// Least cosine of a normal against that of the surface.
pub(super) const UP_MIN: f64 = 1e-3;

/// Tilts of one over this many widths of a lobe and more go by the share of the lobe in its row, and not by an estimate of that share.
const ESTIMATED_BELOW: f64 = 4.0;

/// Least squared cosine inside, times the squared index, in [`Lean::met`].
const INSIDE_SQ_MIN: f64 = 1e-6;

/// Lobes and wide remainder at a view. A renderer computes them once for all lights.
#[derive(Debug, Clone, PartialEq)]
pub struct Below {
    frame: Frame,
    row: Row,
    /// Cosine and sine of the azimuth of the frame of the shapes: the plane of the eye, or axes.
    turn: [f64; 2],
    /// The eye in that frame, inside.
    eye: DVec3,
    shapes: Vec<Shape>,
    /// Slope by which the lobes are turned, along the plane of the eye and across it.
    tilt: [f64; 2],
    /// The lean of a diffuse base.
    lean: Option<Lean>,
}

/// The lean of a diffuse base against the first interface.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Lean {
    /// Energy of the light that meets the base from one direction.
    light: Rgb,
    /// Coordinates of its normal along the surface.
    across: [f64; 2],
    /// Relative index of the slab.
    index: f64,
}

impl Below {
    /// The light that a row has for `wo` (unit, above the surface).
    pub fn new(frame: Frame, row: Row, wo: DVec3) -> Self {
        let sin = libm::hypot(wo.x, wo.y);
        let mut row = row;
        row.lobes.iter_mut().for_each(|lobe| *lobe = frame.shaping.shaped(*lobe, sin));
        let (turn, at, shapes): ([f64; 2], DVec3, Vec<Shape>) = match frame.axes {
            None => {
                let turn = if sin > 0.0 { [wo.x / sin, wo.y / sin] } else { [1.0, 0.0] };
                let plain = row.lobes.iter().map(|lobe| lobe.in_plane(sin));
                let shapes = match frame.stretch {
                    None => plain.collect(),
                    Some(stretch) => {
                        plain.zip(stretch).map(|(shape, squares)| shape.stretched(squares, turn)).collect()
                    }
                };
                (turn, DVec3::new(sin, 0.0, wo.z), shapes)
            }
            Some(axes) => {
                let at = axes.inside(wo);
                let sign = axes.sign(at.x, at.y);
                let lobes = row.lobes.iter().map(|lobe| Lobe { shear: sign * lobe.shear, ..*lobe });
                (axes.turn, at, lobes.map(|lobe| lobe.in_axes([at.x, at.y])).collect())
            }
        };
        let eye = refracted(at, frame.index);
        let row = if frame.stretch.is_some() { shared(row, &shapes, Leaving::new(eye, frame.index), sin) } else { row };
        let of_base = row.base.filter(|_| frame.base.is_some_and(|base| base.is_lambertian));
        let wide = of_base.map_or(frame.wide, |base| frame.wide.of_base(base.falloff));
        let frame = Frame { wide, ..frame };
        Self { frame, row, turn, eye, shapes, tilt: [0.0; 2], lean: None }
    }

    /// The light after the layers below a slab of relative index `index` are turned to a normal (unit, in the frame of the view). Lobes shift by the
    /// slope of the normal, as half vectors in that slab do. The wide remainder stays.
    ///
    /// Facets of slope s below a normal of slope t have the slope s + t, up to terms of second order. If lobes are in half vectors of another
    /// medium, the slope is scaled by the ratio of the cosines inside, each times its index: the middle of a lobe in the mirror direction shifts by
    /// as much.
    ///
    /// Light that turns towards the normal leaves where it was totally reflected. A lobe does not get brighter by that: its energy is at most that of the
    /// row, so that a place returns no more light than falls in. A lobe that turns beyond the horizon loses what is there.
    ///
    /// Against walks over a tilted metal under a smooth coat of index 1.5 (`tests/tilt.rs`), tilts of 5 degrees add up to .013 to the lobe error, tilts of 10
    /// degrees up to .07, and tilts of 20 degrees up to .1 towards the eye and .6 away from it: terms of second order count there. In a white furnace a place
    /// returns at most 1.002 of the light up to 10 degrees, and 1.009 at 20 degrees.
    #[must_use]
    pub fn tilted(mut self, normal: DVec3, index: f64) -> Self {
        let [cos, sin] = self.turn;
        let sin_theta_sq = self.frame.index * self.frame.index * (1.0 - self.eye.z * self.eye.z);
        let ratio = (index * index - sin_theta_sq).max(0.0).sqrt() / (self.frame.index * self.eye.z);
        let up = normal.z.max(UP_MIN);
        let [x, y] = [normal.x, normal.y].map(|across| across * ratio / up);
        self.tilt = [cos * x + sin * y, cos * y - sin * x];
        let leaving = Leaving::new(self.eye, self.frame.index);
        for i in 0..self.shapes.len() {
            let shape = &self.shapes[i];
            let [level, leaned] = [[0.0; 2], self.tilt].map(|tilt| leaving.share(shape, tilt));
            let [x, y] = shape.scaled([0, 1].map(|axis: usize| shape.middle[axis] + self.tilt[axis]));
            // The estimate without a tilt becomes the share of the row, so that tilts begin with no step and estimates that are too low do not count.
            let soon = (1.0 - ESTIMATED_BELOW * libm::hypot(x, y)).max(0.0);
            let lobe = &mut self.row.lobes[i];
            let share = lobe.share.clamp(LEAVING_MIN, 1.0);
            let gain = ((share + soon * (level - share)) / leaned).clamp(share, 1.0);
            let left = (leaned / level).min(1.0);
            (0..3).for_each(|c| self.row.albedo_dir[c] += lobe.strength[c] * lobe.share * (left - 1.0));
            lobe.strength = lobe.strength.map(|strength| strength * gain);
            lobe.share *= left / gain;
        }
        self
    }

    /// The light after the diffuse base below a slab of relative index `index` is turned to a normal (unit, in the frame of the view), in the colour of the
    /// base, or that of the simulation.
    ///
    /// Light that comes through the layers meets the base by its cosine to the normal, over that to the level base. Light that they send back to the base
    /// is no longer of one direction: this share of the base's light stays. Neglected are parts of the base that shade and light each other, the slabs of
    /// further layers, whose index counts as that of the first, and what the tilt changes of the shares.
    #[must_use]
    pub fn leaning(mut self, normal: DVec3, index: f64, albedo: Option<Rgb>) -> Self {
        let Some((base, simulated)) = self.row.base.zip(self.frame.base) else { return self };
        let light =
            base.met.unwrap_or_else(|| base.of_one_direction(simulated.albedo, albedo.unwrap_or(simulated.albedo)));
        for (c, light) in light.into_iter().enumerate() {
            self.row.wide[c] -= light * (1.0 - normal.z);
            self.row.albedo_dir[c] -= light * (1.0 - normal.z);
        }
        self.lean = Some(Lean { light, across: [normal.x, normal.y], index });
        self
    }

    /// The light of a pixel whose normals have slopes of a variance along either axis. Squared widths of lobes grow by twice that variance, times
    /// the square of `cos / (n cos_inside)`: half vectors inside shift by this share of the slope of a normal. Energies stay.
    #[must_use]
    pub fn widened(mut self, wo: DVec3, slope_variance: f64) -> Self {
        let leaning = wo.z / (self.frame.index * self.eye.z);
        let more = 2.0 * slope_variance.max(0.0) * leaning * leaning;
        for shape in &mut self.shapes {
            shape.width = shape.width.map(|width| (width * width + more).sqrt());
        }
        self
    }

    /// The light over a diffuse base of another albedo, RGB; unchanged if the stack has no such base.
    #[must_use]
    pub fn over_base(mut self, albedo: Rgb) -> Self {
        let Some((base, simulated)) = self.row.base.zip(self.frame.base) else { return self };
        for (c, more) in base.more(simulated.albedo, albedo).into_iter().enumerate() {
            let more = more.max(-self.row.wide[c]);
            self.row.wide[c] += more;
            self.row.albedo_dir[c] += more;
        }
        self
    }

    /// The row of the view.
    pub fn row(&self) -> &Row {
        &self.row
    }

    /// `f cos_theta_i` by channel, without the first facet; `wi` is above the horizon.
    pub fn eval(&self, wi: DVec3) -> Rgb {
        let (at, factor) = self.slope(wi);
        let shapes = self.shapes.iter().zip(&self.row.lobes);
        let lobes = shapes.map(|(shape, lobe)| (lobe.strength, shape.density(at) * factor));
        let wide = &self.frame.wide;
        let mut sum = [0.0; 3];
        let remainder = self.lean.map_or(self.row.wide, |lean| lean.met(self.row.wide, wi));
        for (rgb, value) in lobes.chain([(remainder, wide.value(wi.z) * wi.z / (PI * wide.integral()))]) {
            (0..3).for_each(|c| sum[c] += rgb[c] * value);
        }
        sum
    }

    /// The shape of the remainder.
    pub(super) fn wide(&self) -> &Wide {
        &self.frame.wide
    }

    /// The draws of the lobes, one after the other.
    pub(super) fn draws(&self) -> Vec<LobeDraw> {
        let leaving = Leaving::new(self.eye, self.frame.index);
        self.shapes.iter().map(|shape| LobeDraw::new(*shape, &leaving, self.tilt)).collect()
    }

    /// Densities in solid angle with which [`Self::sample`] draws.
    pub(super) fn densities<'a>(&self, draws: &'a [LobeDraw], wi: DVec3) -> impl Iterator<Item = f64> + 'a {
        let (at, factor) = self.slope(wi);
        draws.iter().map(move |draw| draw.density(at) * factor)
    }

    /// A direction of a lobe for two numbers that are uniform in 0..1; `None` below the horizon.
    pub(super) fn sample(&self, draw: &LobeDraw, u: [f64; 2]) -> Option<DVec3> {
        let [x, y] = draw.sample(u);
        let slope = [x + self.tilt[0], y + self.tilt[1]];
        let DVec3 { x, y, z } = outside(slope, self.eye, self.frame.index)?;
        let [cos, sin] = self.turn;
        Some(DVec3::new(cos * x - sin * y, sin * x + cos * y, z))
    }

    /// The slope inside of the half vector with light against the tilt, in the frame of the shapes, and the factor to solid angles.
    fn slope(&self, wi: DVec3) -> ([f64; 2], f64) {
        let [cos, sin] = self.turn;
        let turned = DVec3::new(cos * wi.x + sin * wi.y, cos * wi.y - sin * wi.x, wi.z);
        let ([x, y], factor) = slope(turned, refracted(turned, self.frame.index), self.eye, self.frame.index);
        ([x - self.tilt[0], y - self.tilt[1]], factor)
    }
}

/// A row whose lobes have other shapes in the plane of the eye than its own, with as much energy: shares above the horizon change as their estimates do.
fn shared(mut row: Row, shapes: &[Shape], leaving: Leaving, sin: f64) -> Row {
    for (lobe, shape) in row.lobes.iter_mut().zip(shapes) {
        let [own, other] = [&lobe.in_plane(sin), shape].map(|shape| leaving.share(shape, [0.0; 2]));
        let share = (lobe.share * other / own).min(1.0);
        let gain = lobe.share.max(LEAVING_MIN) / share.max(LEAVING_MIN);
        lobe.strength = lobe.strength.map(|strength| strength * gain);
        lobe.share = share;
    }
    row
}

impl Lean {
    /// The energy of the remainder as light from `wi` meets the base.
    fn met(&self, wide: Rgb, wi: DVec3) -> Rgb {
        let inside_sq = self.index * self.index - (wi.x * wi.x + wi.y * wi.y);
        let along = (self.across[0] * wi.x + self.across[1] * wi.y) / inside_sq.max(INSIDE_SQ_MIN).sqrt();
        [0, 1, 2].map(|c: usize| (wide[c] + self.light[c] * along).max(0.0))
    }
}
