//! Sets of direction pairs. A pair depends on its number and on the material's lobes only.

use std::f64::consts::TAU;

use glam::DVec3;
use luthier_layers::layers::{Below, Layer};
use serde::{Deserialize, Serialize};

/// `(wi, wo)`: unit to f32 precision, above the horizon, in the local frame.
pub type Pair = ([f32; 3], [f32; 3]);

luthier_lut::named! {
    /// Set of directions at which a shader is compared with its reference.
    ///
    /// ```
    /// use luthier_report::DirectionSet;
    ///
    /// // A pair depends on its number only: a longer set begins with the shorter one.
    /// let [few, many] = [8, 64].map(|count| DirectionSet::Grazing.pairs(count, &[]));
    /// assert_eq!(few, many[..8]);
    /// assert!(many.iter().all(|(wi, wo)| wi[2].min(wo[2]) <= 0.1));
    /// ```
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum DirectionSet("direction set") {
        /// Both directions uniform over the hemisphere.
        Random = "random",
        /// One direction or both grazing, any azimuths.
        Grazing = "grazing",
        /// Near the mirror direction, as wide as each lobe of the material.
        Highlight = "highlight",
        /// Near the mirror direction, wi grazing.
        Glancing = "glancing",
    }
}

/// Smallest cosine of the grazing set: 89.99994 degrees.
pub(crate) const GRAZING_COS_MIN: f64 = 1e-6;
/// Largest cosine of the grazing sets: 84.3 degrees.
const GRAZING_COS_MAX: f64 = 0.1;
/// Smallest cosine of the glancing set: 89.99 degrees. Two f32 directions that nearly oppose each other fix
/// cos_theta_d only to about `f32::EPSILON / (4 cos_theta)`, 1.7e-4 here: closer to the horizon the question has no
/// answer to the precision that is asked for.
const GLANCING_COS_MIN: f64 = 1.745e-4;
/// Half-vector slopes reach this many alpha: Beckmann has fallen to e^-16, GGX to 1/289 of its peak.
pub(crate) const LOBE_REACH: f64 = 4.0;

impl DirectionSet {
    /// Description of the set, for a reader.
    pub fn description(self) -> &'static str {
        match self {
            Self::Random => "Both directions uniform over the hemisphere.",
            Self::Grazing => {
                "A third of the pairs have both directions grazing, a third wi only, a third wo only; cosines \
                 log-uniform from 1e-6 (89.99994°) to 0.1 (84.3°), azimuths uniform."
            }
            Self::Highlight => {
                "wi uniform over the hemisphere, wo mirrored about half vectors whose slope reaches four alpha of \
                 each lobe in turn (widened by refraction for lobes below the first interface)."
            }
            Self::Glancing => {
                "The pairs of highlight, but with wi grazing: its cosine is log-uniform from 1.745e-4 (89.99°) to 0.1. Closer to the \
                 horizon two f32 directions no longer determine the angle between them."
            }
        }
    }

    /// The first `count` pairs for a material with these layers: points of a four-dimensional Halton sequence (Halton
    /// 1960), the same point once for each kind of grazing or each lobe, rounded to f32 at the end.
    pub fn pairs(self, count: u32, layers: &[Layer]) -> Vec<Pair> {
        let spreads = spreads(layers);
        (0..count).map(|n| self.pair(n, &spreads)).collect()
    }

    fn pair(self, n: u32, spreads: &[f64]) -> Pair {
        const GRAZES: [[bool; 2]; 3] = [[true, true], [true, false], [false, true]];
        let variants = match self {
            Self::Random => 1,
            Self::Grazing => GRAZES.len(),
            Self::Highlight | Self::Glancing => spreads.len(),
        };
        let (point, variant) = (n / variants as u32, n as usize % variants);
        let [a, b, c, d] = halton(point);
        let (wi, wo) = match self {
            Self::Random => (direction(1.0 - a, b), direction(1.0 - c, d)),
            Self::Grazing => {
                let [i_grazes, o_grazes] = GRAZES[variant];
                let [wi, wo] = [(i_grazes, a, b), (o_grazes, c, d)].map(|(grazes, u, turn)| {
                    direction(if grazes { log_uniform(GRAZING_COS_MIN, u) } else { 1.0 - u }, turn)
                });
                (wi, wo)
            }
            Self::Highlight | Self::Glancing => {
                let cos = if self == Self::Highlight { 1.0 - a } else { log_uniform(GLANCING_COS_MIN, a) };
                let wi = direction(cos, b);
                (wi, mirrored(wi, LOBE_REACH * c * spreads[variant], d))
            }
        };
        let smallest = if self == Self::Glancing { GLANCING_COS_MIN } else { GRAZING_COS_MIN };
        (rounded(wi, smallest), rounded(wo, smallest))
    }
}

/// Slope spread of every lobe, seen from outside. Refraction at index `eta` divides the tangential part of a half vector by `eta`, so that a lobe
/// below looks `eta` times as wide. A material without a lobe gets one moderate spread.
pub(crate) fn spreads(layers: &[Layer]) -> Vec<f64> {
    let mut out = Vec::new();
    let (mut eta_above, mut alpha_above) = (1.0, 0.0_f64);
    for layer in layers {
        if matches!(layer.below, Below::Diffuse { .. }) {
            break;
        }
        alpha_above = alpha_above.max(layer.surface.alpha_x);
        out.push(alpha_above * eta_above);
        eta_above *= layer.eta();
    }
    if out.is_empty() {
        out.push(0.25);
    }
    out
}

/// Point `n` of the Halton sequence in bases 2, 3, 5, 7; every coordinate in 0..1, exclusive.
///
/// Additive recurrences are simpler, but the four-dimensional one on the root of x^5 = x + 1 has
/// `1/x + 5/x^3 = 4.0002`: thousands of its points lie on six lines of the two cosines.
pub(crate) fn halton(n: u32) -> [f64; 4] {
    [2, 3, 5, 7].map(|base| {
        let (mut index, mut fraction, mut scale) = (u64::from(n) + 1, 0.0, 1.0);
        while index > 0 {
            scale /= base as f64;
            fraction += scale * (index % base) as f64;
            index /= base;
        }
        fraction
    })
}

/// The mirror direction of `wi` about a half vector of a slope and an azimuth in turns. A direction below the horizon is folded up instead of
/// dropped, so that the number of pairs stays; it becomes one more grazing pair.
pub(crate) fn mirrored(wi: DVec3, slope: f64, turn: f64) -> DVec3 {
    let wh = DVec3::new(slope * libm::cos(TAU * turn), slope * libm::sin(TAU * turn), 1.0).normalize();
    let wo = 2.0 * wi.dot(wh) * wh - wi;
    DVec3::new(wo.x, wo.y, wo.z.abs())
}

pub(crate) fn log_uniform(min: f64, u: f64) -> f64 {
    min * libm::pow(GRAZING_COS_MAX / min, u)
}

pub(crate) fn direction(cos_theta: f64, turn: f64) -> DVec3 {
    let sin_theta = (1.0 - cos_theta * cos_theta).max(0.0).sqrt();
    DVec3::new(sin_theta * libm::cos(TAU * turn), sin_theta * libm::sin(TAU * turn), cos_theta)
}

pub(crate) fn rounded(w: DVec3, smallest_cos: f64) -> [f32; 3] {
    [w.x as f32, w.y as f32, w.z.max(smallest_cos) as f32]
}

/// A direction of a device, in f64.
pub(crate) fn wide(w: [f32; 3]) -> DVec3 {
    DVec3::from(w.map(f64::from))
}

/// The opposite direction.
pub(crate) fn down(w: [f32; 3]) -> [f32; 3] {
    w.map(|x| -x)
}

#[cfg(test)]
mod tests {
    use luthier_layers::layers::ALPHA_MIN;
    use luthier_optics::stack::{Distribution, Surface};

    use super::*;

    fn coat_on_metal(alpha: f64) -> Vec<Layer> {
        let layer =
            |distribution, alpha, below| Layer { surface: Surface::isotropic(distribution, alpha), above: 1.0, below };
        let coat = Below::Dielectric { ior: 1.5, optical_depth: [0.0; 3] };
        vec![layer(Distribution::Ggx, ALPHA_MIN, coat), layer(Distribution::Beckmann, alpha, Below::Conductor)]
    }

    #[test]
    fn directions_are_unit_and_above_the_horizon() {
        for set in DirectionSet::ALL {
            for alpha in [0.001, 0.3, 1.0] {
                for (wi, wo) in set.pairs(5000, &coat_on_metal(alpha)) {
                    for w in [wi, wo] {
                        let length_sq: f64 = w.iter().map(|&c| f64::from(c) * f64::from(c)).sum();
                        assert!((length_sq - 1.0).abs() < 3e-7, "{set:?} {w:?}");
                        assert!(w[2] >= 0.99e-6, "{set:?} {w:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_pair_depends_on_its_number_only() {
        let layers = coat_on_metal(0.2);
        for set in DirectionSet::ALL {
            let many = set.pairs(100, &layers);
            assert_eq!(many[..40], set.pairs(40, &layers)[..]);
        }
    }

    #[test]
    fn random_directions_have_the_moments_of_the_hemisphere() {
        // Uniform solid angle: E[z] = 1/2, E[z^2] = 1/3, E[x] = 0, and wi independent of wo: E[zi zo] = 1/4.
        let pairs = DirectionSet::Random.pairs(4096, &[]);
        let mean = |f: &dyn Fn(&Pair) -> f32| pairs.iter().map(|p| f64::from(f(p))).sum::<f64>() / 4096.0;
        assert!((mean(&|p| p.0[2]) - 0.5).abs() < 2e-3);
        assert!((mean(&|p| p.1[2] * p.1[2]) - 1.0 / 3.0).abs() < 2e-3);
        assert!(mean(&|p| p.1[0]).abs() < 2e-3);
        assert!((mean(&|p| p.0[2] * p.1[2]) - 0.25).abs() < 2e-3);
    }

    #[test]
    fn grazing_reaches_its_ends() {
        let pairs = DirectionSet::Grazing.pairs(4096, &[]);
        let smallest = pairs.iter().map(|p| p.0[2].min(p.1[2])).fold(1.0, f32::min);
        let largest = pairs.iter().map(|p| p.0[2].min(p.1[2])).fold(0.0, f32::max);
        assert!(smallest < 1.1e-6 && largest > 0.08 && largest <= 0.1, "{smallest} {largest}");
    }

    #[test]
    fn highlights_stay_within_the_reach_of_the_widest_lobe() {
        let surface = Surface::isotropic(Distribution::Ggx, 0.02);
        let layers = [Layer { surface, above: 1.0, below: Below::Conductor }];
        for (wi, wo) in DirectionSet::Highlight.pairs(2000, &layers) {
            let wh = DVec3::from(wi.map(f64::from)) + DVec3::from(wo.map(f64::from));
            let slope = libm::hypot(wh.x, wh.y) / wh.z;
            // Folded pairs lie near the horizon and may be wider.
            assert!(slope < 0.0801 || wi[2].min(wo[2]) < 0.17, "{slope}");
        }
    }
}
