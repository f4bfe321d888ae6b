//! Directional albedo of the cloth lobe (sheen): the Charlie distribution of Estevez and Kulla under the masking terms in use.
//!
//! The lobe is D V without Fresnel; V = G / (4 cos_theta_i cos_theta_o). It is single-scattering and gains energy where alpha is low and light
//! grazes: albedos exceed 1 there.

mod row;

use std::f64::consts::PI;
use std::sync::OnceLock;

use crate::albedo::COS_THETA_MIN;
use crate::quadrature::GradedRules;

pub use row::ClothRow;

/// Lowest alpha of a cloth lobe; lower ones are evaluated as this one.
pub const CLOTH_ALPHA_MIN: f64 = 1e-6;

/// A visibility term V of cloth.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ClothVisibility {
    /// `1 / (4 (cos_i + cos_o - cos_i cos_o))`: Neubelt and Pettineo 2013, after Ashikhmin. Filament, Godot, Babylon.js, the glTF IBL
    /// sampler and MaterialX.
    Neubelt,
    /// Smith's with the Lambda that Estevez and Kulla 2017 fitted (section 3): Unity's fabric, and the glTF extension
    /// KHR_materials_sheen without the clamp of V to 1 in its sample code.
    EstevezKulla,
    /// As [`Self::EstevezKulla`], with the softened terminator of the paper's section 4: Lambda of the light to the power `1 + 2 (1 - cos)^8`.
    EstevezKullaSoftened,
}

impl ClothVisibility {
    /// All terms, in the order of [`cloth_albedos`].
    pub const ALL: [Self; 3] = [Self::Neubelt, Self::EstevezKulla, Self::EstevezKullaSoftened];

    /// Its name on command lines and in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Neubelt => "neubelt",
            Self::EstevezKulla => "estevez-kulla",
            Self::EstevezKullaSoftened => "estevez-kulla-softened",
        }
    }

    /// V for the cosines of the view and of the light.
    pub fn value(self, alpha: f64, cos_view: f64, cos_light: f64) -> f64 {
        self.of_lambda(cos_view, charlie_lambda(alpha, cos_view), cos_light, alpha)
    }

    fn of_lambda(self, cos_view: f64, lambda_view: f64, cos_light: f64, alpha: f64) -> f64 {
        let lambda_light = match self {
            Self::Neubelt => return 0.25 / (cos_view + cos_light - cos_view * cos_light),
            Self::EstevezKulla => charlie_lambda(alpha, cos_light),
            Self::EstevezKullaSoftened => {
                let from_horizon = (1.0 - cos_light) * (1.0 - cos_light);
                let to_fourth = from_horizon * from_horizon;
                libm::pow(charlie_lambda(alpha, cos_light), 1.0 + 2.0 * to_fourth * to_fourth)
            }
        };
        0.25 / (cos_view * cos_light * (1.0 + lambda_view + lambda_light))
    }
}

/// The Charlie distribution `(2 + 1/alpha) sin^(1/alpha) / (2 pi)` (Estevez and Kulla 2017, eq. 2). `alpha` > 0.
pub fn charlie(alpha: f64, sin_theta_h_sq: f64) -> f64 {
    (2.0 + 1.0 / alpha) / (2.0 * PI) * libm::pow(sin_theta_h_sq, 0.5 / alpha)
}

/// Lambda of the Charlie distribution, as Estevez and Kulla fitted it for 0 <= `alpha` <= 1 (2017, section 3, table 1).
pub fn charlie_lambda(alpha: f64, cos_theta: f64) -> f64 {
    let at_0 = (1.0 - alpha) * (1.0 - alpha);
    let [a, b, c, d, e] = FIT.map(|[rough_0, rough_1]| rough_1 + at_0 * (rough_0 - rough_1));
    let fit = |x: f64| a / (1.0 + b * libm::pow(x, c)) + d * x + e;
    libm::exp(if cos_theta < FIT_JOINT { fit(cos_theta) } else { 2.0 * fit(FIT_JOINT) - fit(1.0 - cos_theta) })
}

/// Coefficients a to e of the fit of ln Lambda, at alpha = 0 and alpha = 1.
const FIT: [[f64; 2]; 5] =
    [[25.3245, 21.5473], [3.32435, 3.82987], [0.16801, 0.19823], [-1.27393, -1.97760], [-4.85967, -4.32054]];

/// The albedo of white cloth towards a direction.
///
/// `alpha` in 0..=1 (from [`CLOTH_ALPHA_MIN`]), `cos_theta` in 0..=1 (from [`COS_THETA_MIN`]). Quadrature over some 1500 directions: within 1e-6 of
/// the albedo, or absolutely where it is below 1, for cosines from 0.001; within 1e-5 with the softened terminator. `alpha` is the argument of D: the
/// square of the artist's roughness in engines, that roughness itself in MaterialX.
pub fn cloth_albedo(visibility: ClothVisibility, alpha: f64, cos_theta: f64) -> f64 {
    let [albedo] = albedos_of(rules(), [visibility], alpha, cos_theta);
    albedo
}

/// The values of [`cloth_albedo`] under all of [`ClothVisibility::ALL`], in one pass.
pub fn cloth_albedos(alpha: f64, cos_theta: f64) -> [f64; 3] {
    albedos_of(rules(), ClothVisibility::ALL, alpha, cos_theta)
}

/// Quadrature over directions of light.
struct Rules {
    /// Over the cosine, from the horizon.
    horizon: GradedRules,
    /// Over the cosine, from the cosine of the view.
    mirror: GradedRules,
    /// Over the tangent of half the azimuth from the view, and from its opposite.
    azimuth: [GradedRules; 2],
}

impl Rules {
    fn new(horizon: [f64; 2], mirror: [f64; 2], azimuth: [[f64; 2]; 2]) -> Self {
        let [front, back] = azimuth;
        let [horizon, mirror, front, back] =
            [horizon, mirror, front, back].map(|[first, per_fold]| GradedRules::new(first, per_fold));
        // The square t^2 of the tangent in place of the tangent; weights are of the azimuth.
        let azimuth = [front, back].map(|rules| rules.map(|t, weight| (t * t, 2.0 * weight / (1.0 + t * t)), &[]));
        Self { horizon, mirror, azimuth }
    }
}

fn rules() -> &'static Rules {
    static RULES: OnceLock<Rules> = OnceLock::new();
    RULES.get_or_init(|| Rules::new([8.0, 4.0], [4.0, 2.0], [[4.0, 2.0], [7.0, 2.5]]))
}

/// Length of a panel over the scale of the weak kink that integrals over the azimuth have at the view's cosine.
const MIRROR_REACH: f64 = 1e3;
/// Cosine at which the fit of ln Lambda has a kink in its curvature.
const FIT_JOINT: f64 = 0.5;
/// Scale on which the fit of ln Lambda changes at the horizon, over the scale of the other factors there.
const FIT_SCALE: f64 = 1e-2;
/// Power of the sine above which the kink at the view's cosine is too weak to matter.
const SMOOTH_POWER: f64 = 3.0;

fn albedos_of<const N: usize>(rules: &Rules, terms: [ClothVisibility; N], alpha: f64, cos_theta: f64) -> [f64; N] {
    let alpha = alpha.max(CLOTH_ALPHA_MIN);
    let cos_v = cos_theta.clamp(COS_THETA_MIN, 1.0);
    let scale = libm::exp(ln_largest(alpha, cos_v));
    if scale < NEGLIGIBLE {
        return [0.0; N];
    }
    over_largest(rules, terms, alpha, cos_v).map(|over| scale * over)
}

/// Albedos are 0 if the largest D is below this: they are at most pi/2 times it.
const NEGLIGIBLE: f64 = 1e-12;

/// The logarithm of the largest D over all directions of light: at the horizon below the view.
fn ln_largest(alpha: f64, cos_v: f64) -> f64 {
    libm::log((2.0 + 1.0 / alpha) / (2.0 * PI)) + 0.5 / alpha * ln_largest_sine_sq(cos_v)
}

/// The logarithm of the half vector's squared sine at the largest D. The half vector's cosine is the sine of half the view's elevation.
fn ln_largest_sine_sq(cos_v: f64) -> f64 {
    libm::log1p(-0.5 * cos_v * cos_v / (1.0 + libm::sqrt((1.0 - cos_v) * (1.0 + cos_v))))
}

/// Albedos over the largest D, for cosines and alphas within their limits.
fn over_largest<const N: usize>(rules: &Rules, terms: [ClothVisibility; N], alpha: f64, cos_v: f64) -> [f64; N] {
    let ring = Ring {
        cos_v,
        sin_v_sq: (1.0 - cos_v) * (1.0 + cos_v),
        power: 0.5 / alpha,
        ln_reference: ln_largest_sine_sq(cos_v),
    };
    let lambda_v = charlie_lambda(alpha, cos_v);
    // At the horizon: the scale of the visibility, and that on which sin^(1/alpha) falls with the cosine of the half vector.
    let from_horizon = cos_v.min(libm::sqrt(alpha)).min(alpha / cos_v);
    let mirror_reach = if ring.power > SMOOTH_POWER { 10.0 } else { MIRROR_REACH };
    let is_fitted = terms.iter().any(|&term| term != ClothVisibility::Neubelt);
    let at_horizon = if is_fitted { FIT_SCALE * from_horizon } else { from_horizon };
    let (below, above) = (0.5 * cos_v, (2.0 * cos_v).min(0.5 * (1.0 + cos_v)));
    let panels = [
        (0.0, below, at_horizon, &rules.horizon),
        (cos_v, below, below / mirror_reach, &rules.mirror),
        (cos_v, above, (above - cos_v) / mirror_reach, &rules.mirror),
        (above, 1.0, from_horizon.max(cos_v), &rules.horizon),
    ];
    let mut sums = [0.0; N];
    for (start, end, scale, graded) in panels {
        let parts = if is_fitted && (start - FIT_JOINT) * (end - FIT_JOINT) < 0.0 {
            &[(start, FIT_JOINT, scale), (FIT_JOINT, end, scale + (FIT_JOINT - start).abs())][..]
        } else {
            &[(start, end, scale)][..]
        };
        for &(start, end, scale) in parts {
            let length: f64 = end - start;
            let reach = length / scale;
            for &(part, weight) in graded.for_reach_squared(reach * reach) {
                let cos_l = start + length * part;
                let around = weight * length.abs() * cos_l * ring.around(rules, cos_l);
                for (sum, term) in sums.iter_mut().zip(terms) {
                    *sum += around * term.of_lambda(cos_v, lambda_v, cos_l, alpha);
                }
            }
        }
    }
    sums
}

/// Directions of light of one polar angle.
struct Ring {
    cos_v: f64,
    sin_v_sq: f64,
    /// D goes with the squared sine of the half vector's angle to this power.
    power: f64,
    /// The logarithm of the largest squared sine of all rings.
    ln_reference: f64,
}

impl Ring {
    /// The integral over the azimuth of the squared sine to `power`, over its largest value on all rings.
    fn around(&self, rules: &Rules, cos_l: f64) -> f64 {
        let sin_l_sq = (1.0 - cos_l) * (1.0 + cos_l);
        let sines = libm::sqrt(self.sin_v_sq) + libm::sqrt(sin_l_sq);
        let cosines_sq = (self.cos_v + cos_l) * (self.cos_v + cos_l);
        // (sin_v + sin_l)^2 and (sin_v - sin_l)^2: the squared sine times the squared length of v + l, towards the view and away from it.
        let near = sines * sines;
        let far = (self.cos_v - cos_l) * (self.cos_v - cos_l) * cosines_sq / near.max(f64::MIN_POSITIVE);
        if near == 0.0 {
            return 0.0;
        }
        // The logarithm of the squared sine, from the cosine where the sine is near 1 and has lost its digits.
        let ln_of = |near_part: f64, far_part: f64| {
            let sin_part = near * near_part + far * far_part;
            let length_sq = sin_part + cosines_sq * (near_part + far_part);
            let cos_sq = cosines_sq * (near_part + far_part) / length_sq;
            if cos_sq < 0.5 { libm::log1p(-cos_sq) } else { libm::log(sin_part / length_sq) }
        };
        let largest = ln_of(1.0, 0.0);
        if self.power * (largest - self.ln_reference) < SMALLEST_LN {
            return 0.0;
        }
        let value =
            |near_part: f64, far_part: f64| libm::exp(self.power * (ln_of(near_part, far_part) - self.ln_reference));
        // t is the tangent of half the azimuth. The logarithm falls on a scale of t and rises on a scale of 1/t; below are the inverse squares
        // of these scales.
        let fall = self.power * cosines_sq * (near - far) / (near * (near + cosines_sq));
        let rise_of_length = (near + cosines_sq) / (far + cosines_sq);
        let rise_of_sine = if self.power > SMOOTH_POWER { 1.0 } else { near / (far + 1e-6 * near) };
        let [front, back] = &rules.azimuth;
        let mut sum = 0.0;
        for &(t_sq, weight) in front.for_reach_squared(fall) {
            sum += weight * value(1.0, t_sq);
        }
        for &(w_sq, weight) in back.for_reach_squared(rise_of_length.max(rise_of_sine)) {
            sum += weight * value(w_sq, 1.0);
        }
        // Both sides of the plane of incidence.
        2.0 * sum
    }
}

/// Logarithm below which a ring is left out: e^-50 is below rounding.
const SMALLEST_LN: f64 = -50.0;

#[cfg(test)]
mod tests {
    use super::*;

    const ALPHAS: [f64; 11] = [1e-6, 1e-5, 1e-4, 0.001, 0.0025, 0.01, 0.05, 0.2, 0.5, 0.8, 1.0];
    const COSINES: [f64; 12] = [0.001, 0.003, 0.01, 0.02, 0.05, 0.1, 0.3, 0.5, 0.7, 0.9, 0.99, 1.0];

    #[test]
    fn converges_as_documented() {
        let fine = Rules::new([16.0, 9.0], [16.0, 9.0], [[16.0, 9.0], [16.0, 9.0]]);
        let mut worst = [0.0f64; 3];
        for alpha in ALPHAS {
            for cos in COSINES {
                let found = cloth_albedos(alpha, cos);
                let expected = albedos_of(&fine, ClothVisibility::ALL, alpha, cos);
                for (worst, (a, b)) in worst.iter_mut().zip(found.into_iter().zip(expected)) {
                    *worst = worst.max((a - b).abs() / b.max(1.0));
                }
                // The coarser way of one term alone.
                let alone = cloth_albedo(ClothVisibility::Neubelt, alpha, cos);
                worst[0] = worst[0].max((alone - expected[0]).abs() / expected[0].max(1.0));
            }
        }
        let [neubelt, fitted, softened] = worst;
        assert!(neubelt < 1e-6 && fitted < 1e-6 && softened < 1e-5, "{worst:?}");
    }

    /// Towards the normal the half vector's squared sine is (1 - cos)/2 and Neubelt's V is 1/4: the albedo is 2^-p / (2 (p + 2)), p = 1/(2 alpha).
    #[test]
    fn towards_the_normal_it_has_a_closed_form() {
        for alpha in [0.02, 0.1, 0.25, 0.5, 1.0] {
            let p = 0.5 / alpha;
            let expected = libm::pow(2.0, -p) / (2.0 * (p + 2.0));
            let found = cloth_albedo(ClothVisibility::Neubelt, alpha, 1.0);
            assert!((found - expected).abs() < 1e-8, "{alpha}: {found} {expected}");
        }
    }

    /// The integral over directions by midpoints, with D and V as the papers print them.
    #[test]
    fn agrees_with_midpoints_over_directions() {
        let (rings, azimuths) = (1200, 400);
        for (alpha, cos_v) in [(1.0, 0.3), (0.5, 0.8), (0.25, 0.15), (0.05, 0.4), (0.02, 0.1)] {
            let sin_v = libm::sqrt(1.0 - cos_v * cos_v);
            let mut expected = [0.0; 3];
            for i in 0..rings {
                let cos_l = (f64::from(i) + 0.5) / f64::from(rings);
                let sin_l = libm::sqrt(1.0 - cos_l * cos_l);
                let mut d = 0.0;
                for j in 0..azimuths {
                    let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                    let h = glam::DVec3::new(sin_v + sin_l * libm::cos(phi), sin_l * libm::sin(phi), cos_v + cos_l)
                        .normalize();
                    let sin_h = libm::sqrt(h.x * h.x + h.y * h.y);
                    d += (2.0 + 1.0 / alpha) * libm::pow(sin_h, 1.0 / alpha) / (2.0 * PI) / f64::from(azimuths);
                }
                let (lv, ll) = (charlie_lambda(alpha, cos_v), charlie_lambda(alpha, cos_l));
                let soft = libm::pow(ll, 1.0 + 2.0 * libm::pow(1.0 - cos_l, 8.0));
                let v = [
                    1.0 / (4.0 * (cos_v + cos_l - cos_v * cos_l)),
                    1.0 / (4.0 * cos_v * cos_l * (1.0 + lv + ll)),
                    1.0 / (4.0 * cos_v * cos_l * (1.0 + lv + soft)),
                ];
                for (sum, v) in expected.iter_mut().zip(v) {
                    *sum += d * v * cos_l * 2.0 * PI / f64::from(rings);
                }
            }
            for (found, expected) in cloth_albedos(alpha, cos_v).into_iter().zip(expected) {
                assert!((found - expected).abs() < 2e-5, "{alpha} {cos_v}: {found} {expected}");
            }
        }
    }

    /// MaterialX 1.39 publishes a rational fit of sampled albedos under Neubelt's V (`mx_imageworks_sheen_dir_albedo_analytic`).
    #[test]
    fn follows_the_fit_of_materialx() {
        let fit = |x: f64, r: f64| {
            let above =
                13.673 - 68.78018 * x + 799.08825 * r - 905.00061 * x * r + 60.28956 * x * x + 1086.96473 * r * r;
            let below =
                1.0 + 61.57746 * x + 442.78211 * r + 2597.49308 * x * r + 121.81241 * x * x + 3045.55075 * r * r;
            above / below
        };
        for alpha in [0.2, 0.35, 0.5, 0.75, 1.0] {
            for cos in [0.1, 0.25, 0.4, 0.6, 0.8, 1.0] {
                let found = cloth_albedo(ClothVisibility::Neubelt, alpha, cos);
                let off = (found - fit(cos, alpha)).abs();
                assert!(off < 0.05, "{alpha} {cos}: {off:e}");
            }
        }
    }

    #[test]
    fn the_fit_of_lambda_joins_smoothly_and_ends_are_numbers() {
        for alpha in [0.0, 0.3, 1.0] {
            let [below, above] = [0.5 - 1e-9, 0.5].map(|cos| charlie_lambda(alpha, cos));
            assert!((below / above - 1.0).abs() < 1e-6);
        }
        for (alpha, cos) in [(0.0, 0.0), (0.0, 1.0), (1.0, 0.0), (1e-6, 1e-5)] {
            assert!(
                cloth_albedos(alpha, cos).iter().all(|albedo| albedo.is_finite() && *albedo >= 0.0),
                "{alpha} {cos}"
            );
        }
    }
}
