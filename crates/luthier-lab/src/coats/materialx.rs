//! Nodes of MaterialX's physically based library that the graphs of coats use.
//!
//! Source: AcademySoftwareFoundation/MaterialX 1.39, `libraries/pbrlib/genglsl`: `lib/mx_microfacet_specular.glsl`, `mx_dielectric_bsdf.glsl`,
//! `mx_generalized_schlick_bsdf.glsl`. Directional albedos are by the library's own fit, method 0, the default. `layer` is response of the top plus throughput of the top times response of the base;
//! throughput is 1 less the directional albedo at the eye, so that the result is not reciprocal.

use luthier_optics::Rgb;
use luthier_optics::dielectric_albedo::fresnel_dielectric;

use super::surface::{Pair, rgb};

/// A part of a surface: `f cos_theta_i`, and the share of light that it leaves to what lies below.
pub(super) struct Part {
    pub(super) response: Rgb,
    pub(super) throughput: f64,
}

impl Part {
    /// This part over another.
    pub(super) fn over(&self, base: Rgb) -> Rgb {
        rgb(|c| self.response[c] + self.throughput * base[c])
    }
}

/// `mx_ggx_dir_albedo_analytic`: factors of F0 and of F90.
pub(super) fn dir_albedo(cos_theta: f64, alpha: f64) -> [f64; 2] {
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

/// `dielectric_bsdf` that reflects alone.
pub(super) fn dielectric(at: &Pair, index: f64, alpha: f64) -> Part {
    let fresnel = fresnel_dielectric(index, at.d);
    let more = compensation(at.o, alpha, fresnel);
    let f0 = (index - 1.0) * (index - 1.0) / ((index + 1.0) * (index + 1.0));
    let [a, b] = dir_albedo(at.o, alpha);
    Part { response: [at.correlated(alpha) * fresnel * more * at.i; 3], throughput: 1.0 - (f0 * a + b) * more }
}

/// Response of a metal by its reflectance at the half vector, `generalized_schlick_bsdf` or `conductor_bsdf`.
pub(super) fn metal(at: &Pair, alpha: f64, fresnel: Rgb) -> Rgb {
    let lobe = at.correlated(alpha) * at.i;
    fresnel.map(|fresnel| lobe * fresnel * compensation(at.o, alpha, fresnel))
}

#[cfg(test)]
mod tests {
    use luthier_optics::dielectric_albedo::{JointMasking, reflected_dir};
    use luthier_optics::stack::Distribution;

    use super::*;

    /// Oracle: quadrature. The library says that its fit is one of Monte Carlo data; it is within .02 of them.
    #[test]
    fn the_fit_is_one_of_albedos() {
        for (cos, alpha) in [(1.0, 0.1), (0.5, 0.1), (0.5, 0.4), (0.2, 0.3), (0.8, 0.9)] {
            let [a, b] = dir_albedo(cos, alpha);
            let exact = reflected_dir(Distribution::Ggx, JointMasking::Correlated, alpha, cos, |_| 1.0);
            assert!((a + b - exact).abs() < 0.03, "{cos} {alpha}: {} {exact}", a + b);
        }
    }
}
