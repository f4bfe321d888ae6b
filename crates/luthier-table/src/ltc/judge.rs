//! Errors of tables of linearly transformed cosines.

use glam::DVec3;
use luthier_lut::{WeightBits, bilinear};
use luthier_optics::quadrature::gauss_legendre;
use rayon::prelude::*;

use super::target::{COS_MIN, Rules, Target};
use super::{Lobe, LtcTable, LtcTexels};
use crate::Layout;

/// Fraction bits of the sampler's weights.
pub(super) const WEIGHTS: WeightBits = WeightBits::Fixed(8);

/// An error and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PlacedError {
    /// The error.
    pub error: f64,
    /// Cosine of the viewer's direction.
    pub cos_theta_o: f64,
    /// Slope parameter.
    pub alpha: f64,
}

/// Errors of many places.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LtcError {
    /// The median.
    pub median: f64,
    /// The 95th percentile.
    pub p95: f64,
    /// The largest.
    pub max: PlacedError,
}

/// Errors of the light of rectangles.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct IrradianceError {
    /// Absolute errors for lights of radiance 1, over the albedo.
    pub absolute: LtcError,
    /// Relative errors of lights that reflect more than a hundredth of the albedo.
    pub relative: LtcError,
}

impl LtcError {
    pub(super) fn of(mut errors: Vec<PlacedError>) -> Self {
        errors.sort_by(|a, b| a.error.total_cmp(&b.error));
        let [median, p95, max] = [0.5, 0.95, 1.0].map(|part| errors[((errors.len() - 1) as f64 * part) as usize]);
        Self { median: median.error, p95: p95.error, max }
    }
}

impl LtcTable {
    /// Differences of energy at the texels themselves, from the given cosine and alpha on.
    ///
    /// The difference is half the integral of |lobe times albedo - BRDF times cosine| over the albedo. No light errs by
    /// more, and some light errs by as much. 0 is perfect, 1 is a lobe beside the reflection; an albedo read too large
    /// adds to that. A separate quadrature computes it within 1e-3. At least one texel must be in the range.
    pub fn error_at_texels(&self, texels: &LtcTexels, min_cos: f64, min_alpha: f64) -> LtcError {
        self.error_at(texels, min_cos, min_alpha, [0.0; 2])
    }

    /// Differences of energy half-way between texels, as [`Self::error_at_texels`], for bilinear reads with weights of
    /// 8 bits.
    pub fn error_between_texels(&self, texels: &LtcTexels, min_cos: f64, min_alpha: f64) -> LtcError {
        self.error_at(texels, min_cos, min_alpha, [0.5; 2])
    }

    fn error_at(&self, texels: &LtcTexels, min_cos: f64, min_alpha: f64, offset: [f64; 2]) -> LtcError {
        let rules = Rules::judging();
        let [columns, rows] = [0, 1].map(|k: usize| self.size[k] - u32::from(offset[k] > 0.0));
        let errors: Vec<PlacedError> = (0..columns * rows)
            .into_par_iter()
            .filter_map(|index| {
                let texel = [index % columns, index / columns];
                let [theta, alpha] = place(&self.layout, self.size, texel, offset);
                let cos = libm::cos(theta).max(0.0);
                if cos < min_cos || alpha < min_alpha {
                    return None;
                }
                let read = self.read(texels, theta, alpha);
                let error = difference(read, &Target::new(&rules, self.surface(), alpha, cos));
                Some(PlacedError { error, cos_theta_o: cos, alpha })
            })
            .collect();
        LtcError::of(errors)
    }

    /// The lobe and the albedo of a shader's read.
    fn read(&self, texels: &LtcTexels, theta: f64, alpha: f64) -> (Lobe, f64) {
        let position = self.layout.position(self.size, [theta, alpha]);
        let lobe = Lobe::of_texel(bilinear(&texels.matrices, position, WEIGHTS));
        (lobe, bilinear(&texels.norms, position, WEIGHTS)[0])
    }

    /// Errors of the light of four rectangles: the closed form of the lobe as read from the table, against quadrature
    /// of the BRDF over their area.
    ///
    /// The rectangles are a wide one overhead, a near one beside the normal, a strip, and one that the surface cuts.
    /// They are lit at 6 roughnesses from 0.2 to 1 and 7 cosines from 0.1 to 1, between texels too.
    pub fn irradiance_error(&self, texels: &LtcTexels) -> IrradianceError {
        let rectangles = [
            [DVec3::new(-2.0, -1.0, 1.0), DVec3::new(3.0, 0.0, 0.0), DVec3::new(0.0, 2.0, 0.0)],
            [DVec3::new(-1.2, -0.3, 0.7), DVec3::new(0.6, 0.0, 0.2), DVec3::new(0.0, 0.7, 0.0)],
            [DVec3::new(-1.0, -2.0, 0.4), DVec3::new(0.0, 4.0, 0.0), DVec3::new(0.05, 0.0, 0.1)],
            [DVec3::new(-1.5, -0.8, -0.4), DVec3::new(0.0, 1.6, 0.3), DVec3::new(0.2, 0.0, 1.4)],
        ];
        let mut places = Vec::new();
        for rectangle in rectangles {
            for roughness in [0.2, 0.31, 0.45, 0.6, 0.8, 1.0] {
                for cos in [0.1, 0.2, 0.35, 0.5, 0.7, 0.9, 1.0] {
                    places.push((rectangle, roughness * roughness, cos));
                }
            }
        }
        let rule = gauss_legendre(6);
        let errors: Vec<(PlacedError, f64)> = places
            .into_par_iter()
            .map(|([corner, u, v], alpha, cos)| {
                let wo = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos.max(COS_MIN));
                let surface = self.surface();
                let exact = over_rectangle(&rule, [corner, u, v], |w| surface.brdf_cos(alpha, wo, w));
                let (lobe, albedo) = self.read(texels, libm::acos(cos), alpha);
                let found = albedo * lobe.over_polygon(&[corner, corner + u, corner + u + v, corner + v]);
                (PlacedError { error: (found - exact).abs() / albedo, cos_theta_o: cos, alpha }, exact / albedo)
            })
            .collect();
        let lit = errors.iter().filter(|(_, part)| *part > 0.01);
        IrradianceError {
            absolute: LtcError::of(errors.iter().map(|(placed, _)| *placed).collect()),
            relative: LtcError::of(lit.map(|(at, part)| PlacedError { error: at.error / part, ..*at }).collect()),
        }
    }
}

/// Theta and alpha at a texel, or half-way to the next across and down.
pub(super) fn place(layout: &Layout, size: [u32; 2], texel: [u32; 2], offset: [f64; 2]) -> [f64; 2] {
    if offset == [0.0; 2] {
        return layout.at_texel(size, texel);
    }
    let [from, to] = [texel, texel.map(|i| i + 1)].map(|texel| {
        let [theta, alpha] = layout.at_texel(size, texel);
        [layout.angle.coordinate(theta), layout.slope.map_or(0.0, |slope| slope.coordinate(alpha))]
    });
    layout.canonical([0, 1].map(|k: usize| 0.5 * (from[k] + to[k])))
}

/// Half the L1 distance of a lobe times its albedo from a reflection, over the albedo of the reflection.
pub(super) fn difference((lobe, albedo): (Lobe, f64), target: &Target) -> f64 {
    let amplitude = albedo / target.albedo_dir;
    0.5 * (1.0 + amplitude) - target.shared(lobe, amplitude)
}

/// The integral of a function of the direction over the directions of a rectangle.
fn over_rectangle(rule: &[(f64, f64)], [corner, u, v]: [DVec3; 3], f: impl Fn(DVec3) -> f64) -> f64 {
    const PATCHES: u32 = 32;
    let normal = u.cross(v);
    let mut sum = 0.0;
    for (i, j) in (0..PATCHES * PATCHES).map(|k| (k / PATCHES, k % PATCHES)) {
        for (x, weight_x) in rule {
            for (y, weight_y) in rule {
                let [s, t] = [(i, x), (j, y)].map(|(patch, x)| (f64::from(patch) + x) / f64::from(PATCHES));
                let p = corner + u * s + v * t;
                let r_sq = p.length_squared();
                let w = p / libm::sqrt(r_sq);
                sum += weight_x * weight_y * f(w) * normal.dot(w).abs() / r_sq;
            }
        }
    }
    sum / f64::from(PATCHES * PATCHES)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use luthier_lut::Image;
    use luthier_optics::stack::Distribution;

    use super::*;
    use crate::Stored;

    fn constant(size: [u32; 2], lobe: Lobe, albedo: f32) -> LtcTexels {
        let image = |texel: [f32; 4]| Image {
            width: size[0],
            height: size[1],
            channels: 4,
            data: (0..size[0] * size[1]).flat_map(|_| texel).collect(),
        };
        LtcTexels { matrices: image(lobe.texel().map(|entry| entry as f32)), norms: image([albedo, 0.0, 0.0, 0.0]) }
    }

    /// Half the L1 distance by midpoints over all directions, those below the surface too.
    #[test]
    fn differences_agree_with_midpoints_over_the_sphere() {
        let lobe = Lobe { m11: 0.75, m31: -0.25, m13: 0.5, m33: 0.5 };
        let (alpha, cos) = (0.25, 0.75);
        let surface = LtcTable::of_engines(Distribution::Ggx).surface();
        let target = Target::new(&Rules::judging(), surface, alpha, cos);
        let wo = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos);
        for albedo in [0.5, 0.9, 1.2] {
            let found = difference((lobe, albedo), &target);
            let [mut distance, mut energy] = [0.0; 2];
            let (rings, azimuths) = (2000, 1000);
            for i in 0..rings {
                let z = 2.0 * (f64::from(i) + 0.5) / f64::from(rings) - 1.0;
                let r = libm::sqrt(1.0 - z * z);
                for j in 0..azimuths {
                    let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                    let w = DVec3::new(r * libm::cos(phi), r * libm::sin(phi), z);
                    let exact = surface.brdf_cos(alpha, wo, w);
                    distance += (albedo * lobe.pdf_solid_angle(w) - exact).abs();
                    energy += exact;
                }
            }
            let expected = 0.5 * distance / energy;
            assert!((found - expected).abs() < 1e-3, "{albedo}: {found:?} {expected}");
        }
    }

    /// A small table errs little, and the clamped cosine in its place much.
    #[test]
    fn fitted_tables_err_little_and_wrong_ones_much() {
        let table = LtcTable { size: [17, 17], stored: Stored::Half, ..LtcTable::of_engines(Distribution::Ggx) };
        let texels = table.bake();
        let error = table.error_at_texels(&texels, 0.1, 0.01);
        assert!(error.median < 0.03 && error.max.error < 0.2, "{error:?}");
        let light = table.irradiance_error(&texels);
        assert!(light.absolute.median < 0.01 && light.absolute.max.error < 0.08, "{light:?}");
        let centres =
            LtcTable { layout: Layout::parse("theta,alpha", crate::Nodes::CENTRES).unwrap(), ..table.clone() };
        let error = centres.error_at_texels(&centres.bake(), 0.1, 0.01);
        assert!(error.median < 0.03 && error.max.error < 0.2, "{error:?}");
        let wrong = constant(table.size, Lobe::COSINE, 1.0);
        assert!(table.error_at_texels(&wrong, 0.1, 0.01).median > 0.3);
        assert!(table.irradiance_error(&wrong).absolute.median > 0.05);
    }

    #[test]
    fn a_difference_bounds_what_lights_err() {
        let table = LtcTable { size: [17, 17], stored: Stored::Float, ..LtcTable::of_engines(Distribution::Beckmann) };
        let texels = table.bake();
        let light = table.irradiance_error(&texels).absolute.max.error;
        let bound = table.error_at_texels(&texels, 0.05, 0.02).max.error;
        assert!(light < bound, "{light} {bound}");
    }
}
