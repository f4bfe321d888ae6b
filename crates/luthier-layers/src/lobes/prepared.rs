//! The model at a view: values, samples, densities.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::Rgb;

use super::half_vector::{outside, refracted, slope};
use super::{Lobes, Row, Shape};
use crate::facets::Masking;

/// The model as seen from a direction: what a renderer computes once for all lights.
#[derive(Debug, Clone)]
pub struct Prepared<'a> {
    lobes: &'a Lobes,
    wo: DVec3,
    /// Cosine and sine of the azimuth of the eye.
    azimuth: [f64; 2],
    /// The eye in its own plane, inside.
    eye: DVec3,
    shapes: Vec<Shape>,
    row: Row,
    /// Probabilities of the first facet, of each lobe, and of the wide remainder.
    chances: Vec<f64>,
}

/// A direction of light, drawn.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sample {
    /// Direction.
    pub wi: DVec3,
    /// `f cos_theta_i` over the density, by channel.
    pub weight: Rgb,
    /// Density in solid angle.
    pub pdf_solid_angle: f64,
    /// The part that it was drawn for: 0 for the first facet, k for lobe k - 1, and last the wide remainder.
    pub part: usize,
}

/// Shares above the horizon are no less than this, where energies are divided by them.
const SHARE_MIN: f64 = 1e-3;

impl<'a> Prepared<'a> {
    pub(super) fn new(lobes: &'a Lobes, wo: DVec3) -> Option<Self> {
        if wo.z <= 0.0 {
            return None;
        }
        let sin = libm::hypot(wo.x, wo.y);
        let azimuth = if sin > 0.0 { [wo.x / sin, wo.y / sin] } else { [1.0, 0.0] };
        let place = lobes.axis.place(wo.z);
        let first = (place as usize).min(lobes.rows.len() - 2);
        let row = lobes.rows[first].between(&lobes.rows[first + 1], place - first as f64);
        let shape = |(lobe, tail): (&super::Lobe, &f64)| Shape {
            shift: lobe.shift * sin,
            width: lobe.sharpness.map(|sharpness| 1.0 / sharpness),
            tail: *tail,
        };
        let shapes = row.lobes.iter().zip(&lobes.tails).map(shape).collect();
        let mean = |rgb: Rgb| (rgb.iter().sum::<f64>() / 3.0).max(0.0);
        let mut chances = vec![mean(row.first_facet)];
        chances.extend(row.lobes.iter().map(|lobe| mean(lobe.energy)));
        chances.push(mean(row.wide));
        let total: f64 = chances.iter().sum();
        if total > 0.0 {
            chances.iter_mut().for_each(|chance| *chance /= total);
        } else if let Some(wide) = chances.last_mut() {
            *wide = 1.0;
        }
        let eye = refracted(DVec3::new(sin, 0.0, wo.z), lobes.index);
        Some(Self { lobes, wo, azimuth, eye, shapes, row, chances })
    }

    /// The row of the view.
    pub fn row(&self) -> &Row {
        &self.row
    }

    /// Directional albedo by channel.
    pub fn albedo_dir(&self) -> Rgb {
        [0, 1, 2].map(|c: usize| {
            let lobes: f64 = self.row.lobes.iter().map(|lobe| lobe.energy[c]).sum();
            self.row.first_facet[c] + lobes + self.row.wide[c]
        })
    }

    /// `f cos_theta_i` by channel; 0 below the horizon.
    pub fn eval(&self, wi: DVec3) -> Rgb {
        if wi.z <= 0.0 {
            return [0.0; 3];
        }
        let mut sum = self.first_facet(wi);
        let mut add = |rgb: Rgb, value: f64| (0..3).for_each(|c| sum[c] += rgb[c] * value);
        let (at, factor) = self.slope(wi);
        for (shape, lobe) in self.shapes.iter().zip(&self.row.lobes) {
            add(lobe.energy, shape.density(at) * factor / lobe.share.max(SHARE_MIN));
        }
        add(self.row.wide, self.wide_density(wi));
        sum
    }

    /// Density in solid angle with which [`Self::sample`] draws a direction. Its integral is 1 less what is drawn below the horizon.
    pub fn pdf_solid_angle(&self, wi: DVec3) -> f64 {
        if wi.z <= 0.0 {
            return 0.0;
        }
        let (at, factor) = self.slope(wi);
        let first = self.lobes.first.as_ref().map_or(0.0, |first| first.facets.pdf_solid_angle(wi, self.wo));
        let lobes = self.shapes.iter().map(|shape| shape.density(at) * factor);
        let densities = std::iter::once(first).chain(lobes).chain([wi.z / PI]);
        self.chances.iter().zip(densities).filter(|(chance, _)| **chance > 0.0).map(|(c, d)| c * d).sum()
    }

    /// A direction for three numbers that are uniform in 0..1; `None` for one below the horizon.
    pub fn sample(&self, [choice, u, v]: [f64; 3]) -> Option<Sample> {
        let mut rest = choice;
        let mut part = self.chances.len() - 1;
        for (i, chance) in self.chances.iter().enumerate() {
            if rest < *chance {
                part = i;
                break;
            }
            rest -= chance;
        }
        let wi = if part == 0 {
            let wh = self.lobes.first.as_ref()?.facets.sample(self.wo, [u, v]);
            2.0 * wh.dot(self.wo) * wh - self.wo
        } else if let Some(shape) = self.shapes.get(part - 1) {
            let DVec3 { x, y, z } = outside(shape.sample([u, v]), self.eye, self.lobes.index)?;
            let [cos, sin] = self.azimuth;
            DVec3::new(cos * x - sin * y, sin * x + cos * y, z)
        } else {
            let (sin, cos) = libm::sincos(2.0 * PI * v);
            DVec3::new(u.sqrt() * cos, u.sqrt() * sin, (1.0 - u).sqrt())
        };
        let pdf_solid_angle = self.pdf_solid_angle(wi);
        (pdf_solid_angle > 0.0).then(|| {
            let value = self.eval(wi);
            Sample { wi, weight: value.map(|value| value / pdf_solid_angle), pdf_solid_angle, part }
        })
    }

    /// One facet of the first interface.
    fn first_facet(&self, wi: DVec3) -> Rgb {
        let value = self.lobes.first.as_ref().and_then(|first| {
            let lobe = first.facets.lobe(Masking::Smith, wi, self.wo)?;
            Some(first.reflectance.rgb(lobe.cos_theta_d).map(|reflectance| reflectance * lobe.value))
        });
        value.unwrap_or([0.0; 3])
    }

    /// The slope inside of the half vector with light, in the plane of the eye, and the factor to solid angles.
    fn slope(&self, wi: DVec3) -> ([f64; 2], f64) {
        let [cos, sin] = self.azimuth;
        let turned = DVec3::new(cos * wi.x + sin * wi.y, cos * wi.y - sin * wi.x, wi.z);
        slope(turned, refracted(turned, self.lobes.index), self.eye, self.lobes.index)
    }

    fn wide_density(&self, wi: DVec3) -> f64 {
        self.lobes.wide.value(wi.z) * wi.z / (PI * self.lobes.wide.integral())
    }
}
