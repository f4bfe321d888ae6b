//! Light from below the first interface, as seen from a direction.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::Rgb;

use super::half_vector::{outside, refracted, slope};
use super::{Frame, Row, Shape};

/// Lobes and wide remainder at a view: what a renderer computes once for all lights.
#[derive(Debug, Clone, PartialEq)]
pub struct Below {
    frame: Frame,
    row: Row,
    /// Cosine and sine of the azimuth of the eye.
    azimuth: [f64; 2],
    /// The eye in its own plane, inside.
    eye: DVec3,
    shapes: Vec<Shape>,
}

impl Below {
    /// The light that a row has for `wo` (unit, above the surface).
    pub fn new(frame: Frame, row: Row, wo: DVec3) -> Self {
        let sin = libm::hypot(wo.x, wo.y);
        let azimuth = if sin > 0.0 { [wo.x / sin, wo.y / sin] } else { [1.0, 0.0] };
        let shapes = row.lobes.iter().map(|lobe| Shape {
            shift: lobe.shift * sin,
            width: lobe.sharpness.map(|sharpness| 1.0 / sharpness),
            tail: lobe.tail,
        });
        let shapes = shapes.collect();
        let eye = refracted(DVec3::new(sin, 0.0, wo.z), frame.index);
        Self { frame, row, azimuth, eye, shapes }
    }

    /// The row of the view.
    pub fn row(&self) -> &Row {
        &self.row
    }

    /// `f cos_theta_i` by channel, without the first facet; `wi` is above the horizon.
    pub fn eval(&self, wi: DVec3) -> Rgb {
        let mut sum = [0.0; 3];
        let mut add = |rgb: Rgb, value: f64| (0..3).for_each(|c| sum[c] += rgb[c] * value);
        let (at, factor) = self.slope(wi);
        for (shape, lobe) in self.shapes.iter().zip(&self.row.lobes) {
            add(lobe.strength, shape.density(at) * factor);
        }
        let wide = &self.frame.wide;
        add(self.row.wide, wide.value(wi.z) * wi.z / (PI * wide.integral()));
        sum
    }

    /// Densities in solid angle of the lobes, one after the other, with which [`Self::sample`] draws.
    pub(super) fn densities(&self, wi: DVec3) -> impl Iterator<Item = f64> {
        let (at, factor) = self.slope(wi);
        self.shapes.iter().map(move |shape| shape.density(at) * factor)
    }

    /// A direction of a lobe for two numbers that are uniform in 0..1; `None` below the horizon.
    pub(super) fn sample(&self, lobe: usize, u: [f64; 2]) -> Option<DVec3> {
        let DVec3 { x, y, z } = outside(self.shapes.get(lobe)?.sample(u), self.eye, self.frame.index)?;
        let [cos, sin] = self.azimuth;
        Some(DVec3::new(cos * x - sin * y, sin * x + cos * y, z))
    }

    /// The slope inside of the half vector with light, in the plane of the eye, and the factor to solid angles.
    fn slope(&self, wi: DVec3) -> ([f64; 2], f64) {
        let [cos, sin] = self.azimuth;
        let turned = DVec3::new(cos * wi.x + sin * wi.y, cos * wi.y - sin * wi.x, wi.z);
        slope(turned, refracted(turned, self.frame.index), self.eye, self.frame.index)
    }
}
