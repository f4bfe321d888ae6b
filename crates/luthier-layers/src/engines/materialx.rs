//! Nodes of MaterialX's physically based library that graphs of surfaces use.
//!
//! Source: AcademySoftwareFoundation/MaterialX 1.39, `libraries/pbrlib/genglsl`: `lib/mx_microfacet_specular.glsl`, `mx_dielectric_bsdf.glsl`,
//! `mx_generalized_schlick_bsdf.glsl`, `lib/mx_microfacet_diffuse.glsl`. Directional albedos are by the library's own fit, method 0, the default. `layer` is response of the top plus throughput of the top
//! times response of the base; throughput is 1 less the directional albedo at the eye, so that the result is not reciprocal.
//!
//! A choice here: below a film, whose reflectance the caller gives, the throughput is that of the film's reflectance at the eye.

use std::f64::consts::{FRAC_1_PI, PI};

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::dielectric_albedo::{JointMasking, fresnel_dielectric};

use super::facets::{Facets, cos_theta_d};

/// A part of a surface: `f cos_theta_i`, and the share of light that it leaves to what lies below.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Part {
    /// `f cos_theta_i`, RGB.
    pub response: Rgb,
    /// Share of the light below that passes, RGB.
    pub throughput: Rgb,
}

impl Part {
    /// This part over another.
    pub fn over(&self, base: Rgb) -> Rgb {
        [0, 1, 2].map(|c: usize| self.response[c] + self.throughput[c] * base[c])
    }
}

/// `mx_ggx_dir_albedo_analytic`: factors of F0 and of F90.
pub fn dir_albedo(cos_theta: f64, alpha: f64) -> [f64; 2] {
    let (x, y) = (cos_theta, alpha);
    let terms = [1.0, x, y, x * y, x * x, y * y, x * x * y, x * y * y, x * x * y * y];
    let [a, b, c, d] = FIT.map(|row: [f64; 9]| row.iter().zip(&terms).map(|(factor, term)| factor * term).sum::<f64>());
    [a / c, b / d]
}

const FIT: [[f64; 9]; 4] = [
    [0.10031, -0.63301, 9.74995, -2.02075, 29.38247, -8.24713, -26.51510, 19.98406, -5.41717],
    [0.93450, -2.32352, 2.22823, -3.74584, 1.42450, -0.76829, 1.43366, 0.29060, 0.62933],
    [1.0, -1.76427, 8.26501, 11.54840, 28.99991, -7.50867, -36.16186, 15.85408, 33.41550],
    [1.0, 0.22797, 15.93688, -55.82466, 13.07919, 41.25882, 54.86775, 300.10923, -284.73288],
];

/// `mx_ggx_energy_compensation`.
fn compensation(cos_theta: f64, alpha: f64, fresnel: f64) -> f64 {
    let [a, b] = dir_albedo(cos_theta, alpha);
    1.0 + fresnel * (1.0 - a - b) / (a + b)
}

/// `dielectric_bsdf` that reflects alone: an index over that above, with a tint and a weight.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Dielectric {
    /// Index over that above.
    pub index: f64,
    /// Slopes.
    pub facets: Facets,
    /// Factor on what it reflects, RGB.
    pub tint: Rgb,
    /// Share of the surface.
    pub weight: f64,
}

impl Dielectric {
    /// A clear interface that covers all.
    pub fn clear(index: f64, facets: Facets) -> Self {
        Self { index, facets, tint: [1.0; 3], weight: 1.0 }
    }

    /// The part for unit directions above the surface. A `film` reflects at a cosine in place of the interface.
    pub fn part(&self, wi: DVec3, wo: DVec3, film: Option<&dyn Fn(f64) -> Rgb>) -> Part {
        let Self { index, facets, tint, weight } = *self;
        let alpha = facets.mean();
        let cos = cos_theta_d(wi, wo);
        let fresnel = film.map_or_else(|| [fresnel_dielectric(index, cos); 3], |film| film(cos));
        let more = fresnel.map(|fresnel| compensation(wo.z, alpha, fresnel));
        let lobe = facets.lobe(JointMasking::Correlated, wi, wo) * wi.z;
        let f0 = (index - 1.0) * (index - 1.0) / ((index + 1.0) * (index + 1.0));
        let [a, b] = dir_albedo(wo.z, alpha);
        let taken = film.map_or([f0 * a + b; 3], |film| film(wo.z).map(|f| f * (a + b)));
        Part {
            response: [0, 1, 2].map(|c: usize| lobe * fresnel[c] * more[c] * tint[c] * weight),
            throughput: [0, 1, 2].map(|c: usize| 1.0 - weight * taken[c] * more[c]),
        }
    }
}

/// Response of a metal by its reflectance at the half vector, `generalized_schlick_bsdf` or `conductor_bsdf`.
pub fn metal(facets: &Facets, wi: DVec3, wo: DVec3, fresnel: Rgb) -> Rgb {
    let lobe = facets.lobe(JointMasking::Correlated, wi, wo) * wi.z;
    let alpha = facets.mean();
    fresnel.map(|fresnel| lobe * fresnel * compensation(wo.z, alpha, fresnel))
}

/// `oren_nayar_diffuse_bsdf` with `energy_compensation`: Fujii's model and the light that it loses (Portsmouth, Kutz and Hill 2025), `f cos_theta_i`.
pub fn rough_diffuse(color: Rgb, roughness: f64, wi: DVec3, wo: DVec3) -> Rgb {
    if roughness == 0.0 {
        return color.map(|c| c * FRAC_1_PI * wi.z);
    }
    let s = wi.dot(wo) - wi.z * wo.z;
    let s_over_t = if s > 0.0 { s / wi.z.max(wo.z) } else { s };
    let factor = 1.0 / (1.0 + FUJII * roughness);
    let albedo = |mu: f64| {
        let x = 1.0 - mu;
        let g = x * (0.057_108_528_9 + x * (0.491_881_867 + x * (-0.332_181_442 + x * 0.071_442_995_3)));
        factor * (1.0 + roughness * g)
    };
    let average = factor * (1.0 + (2.0 / 3.0 - 28.0 / (15.0 * PI)) * roughness);
    let lost = (1.0 - albedo(wi.z)) * (1.0 - albedo(wo.z)) / (1.0 - average).max(1e-7);
    color.map(|c| {
        let again = c * c * average / (1.0 - c * (1.0 - average));
        FRAC_1_PI * wi.z * (c * factor * (1.0 + roughness * s_over_t) + again * lost)
    })
}

/// `1/2 - 2/(3 pi)`.
const FUJII: f64 = 0.5 - 2.0 / (3.0 * PI);

#[cfg(test)]
mod tests {
    use luthier_optics::dielectric_albedo::reflected_dir;
    use luthier_optics::stack::Distribution;

    use super::*;
    use crate::directional_albedo::over_hemisphere;

    /// Oracle: quadrature. The library says that its fit is one of Monte Carlo data; it is within .02 of them.
    #[test]
    fn the_fit_is_one_of_albedos() {
        for (cos, alpha) in [(1.0, 0.1), (0.5, 0.1), (0.5, 0.4), (0.2, 0.3), (0.8, 0.9)] {
            let [a, b] = dir_albedo(cos, alpha);
            let exact = reflected_dir(Distribution::Ggx, JointMasking::Correlated, alpha, cos, |_| 1.0);
            assert!((a + b - exact).abs() < 0.03, "{cos} {alpha}: {} {exact}", a + b);
        }
    }

    /// A white rough base returns all light, at every angle and roughness.
    #[test]
    fn white_diffuse_bases_lose_nothing() {
        for roughness in [0.0, 0.3, 1.0] {
            for cos in [1.0, 0.5, 0.2_f64] {
                let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let [found, ..] = over_hemisphere(DVec3::Z, |wi| rough_diffuse([1.0; 3], roughness, wi, wo)).0;
                assert!((found - 1.0).abs() < 2e-3, "{roughness} {cos}: {found}");
            }
        }
    }
}
