//! Light from below the first interface, as seen from a direction.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::Rgb;

use super::half_vector::{outside, refracted, slope};
use super::{Frame, Lobe, Row, Shape};

/// Least cosine of a normal against that of the surface.
const UP_MIN: f64 = 1e-3;

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
}

impl Below {
    /// The light that a row has for `wo` (unit, above the surface).
    pub fn new(frame: Frame, row: Row, wo: DVec3) -> Self {
        let sin = libm::hypot(wo.x, wo.y);
        let (turn, at, shapes) = match frame.axes {
            None => {
                let turn = if sin > 0.0 { [wo.x / sin, wo.y / sin] } else { [1.0, 0.0] };
                (turn, DVec3::new(sin, 0.0, wo.z), row.lobes.iter().map(|lobe| lobe.in_plane(sin)).collect())
            }
            Some(axes) => {
                let at = axes.inside(wo);
                let sign = axes.sign(at.x, at.y);
                let lobes = row.lobes.iter().map(|lobe| Lobe { shear: sign * lobe.shear, ..*lobe });
                (axes.turn, at, lobes.map(|lobe| lobe.in_axes([at.x, at.y])).collect())
            }
        };
        let eye = refracted(at, frame.index);
        let of_base = row.base.filter(|_| frame.base.is_some_and(|base| base.is_lambertian));
        let wide = of_base.map_or(frame.wide, |base| frame.wide.of_base(base.falloff));
        let frame = Frame { wide, ..frame };
        Self { frame, row, turn, eye, shapes, tilt: [0.0; 2] }
    }

    /// The light after the layers below a slab of relative index `index` are turned to a normal (unit, in the frame of the view). Lobes shift by the
    /// slope of the normal, as half vectors in that slab do. Energies and the wide remainder stay.
    ///
    /// Facets of slope s below a normal of slope t have the slope s + t, up to terms of second order. If lobes are in half vectors of another
    /// medium, the slope is scaled by the ratio of the cosines inside, each times its index: the middle of a lobe in the mirror direction shifts by
    /// as much. Against walks over a tilted metal under a smooth coat of index 1.5, tilts of 5 and 10 degrees add .004 to .05 to the lobe error,
    /// and a tilt of 20 degrees adds .09 to .46 (`tilt_tests.rs`).
    #[must_use]
    pub fn tilted(mut self, normal: DVec3, index: f64) -> Self {
        let [cos, sin] = self.turn;
        let sin_theta_sq = self.frame.index * self.frame.index * (1.0 - self.eye.z * self.eye.z);
        let ratio = (index * index - sin_theta_sq).max(0.0).sqrt() / (self.frame.index * self.eye.z);
        let up = normal.z.max(UP_MIN);
        let [x, y] = [normal.x, normal.y].map(|across| across * ratio / up);
        self.tilt = [cos * x + sin * y, cos * y - sin * x];
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
        for (rgb, value) in lobes.chain([(self.row.wide, wide.value(wi.z) * wi.z / (PI * wide.integral()))]) {
            (0..3).for_each(|c| sum[c] += rgb[c] * value);
        }
        sum
    }

    /// Densities in solid angle of the lobes, one after the other, with which [`Self::sample`] draws.
    pub(super) fn densities(&self, wi: DVec3) -> impl Iterator<Item = f64> {
        let (at, factor) = self.slope(wi);
        self.shapes.iter().map(move |shape| shape.density(at) * factor)
    }

    /// A direction of a lobe for two numbers that are uniform in 0..1; `None` below the horizon.
    pub(super) fn sample(&self, lobe: usize, u: [f64; 2]) -> Option<DVec3> {
        let [x, y] = self.shapes.get(lobe)?.sample(u);
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
