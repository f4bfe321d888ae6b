//! Directions of the parity run.

use glam::DVec3;
use luthier_layers::layers::{Below, Layer};
use serde::{Deserialize, Serialize};

use crate::measure::directions::{
    DirectionSet, GRAZING_COS_MIN, LOBE_REACH, Pair, direction, down, halton, log_uniform, mirrored, rounded, spreads,
};

luthier_lut::named! {
    /// Set of directions at which a shader is compared with its twin.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum ParitySet("parity set") {
        /// Both directions uniform over the hemisphere.
        Uniform = "uniform",
        /// Near the mirror direction.
        NearSpecular = "near-specular",
        /// Grazing to 89.9 degrees.
        Grazing = "grazing",
        /// Near the mirror direction of smoother surfaces, alpha down to 0.001.
        Smooth = "smooth",
        /// Along one line, and below the horizon.
        Opposite = "opposite",
    }
}

/// Cosine of 89.9 degrees.
const COS_89_9: f64 = 1.745_328_365_898_309e-3;

/// Largest slope parameters of the polished variants of a material, for the smooth set. One factor scales all slope parameters of a variant, and none
/// goes below 0.001.
pub const POLISHED_ALPHAS: [f64; 4] = [0.001, 0.003, 0.01, 0.03];

impl ParitySet {
    /// Description of the set, for a reader.
    pub fn description(self) -> &'static str {
        match self {
            Self::Uniform => "Both directions uniform over the hemisphere.",
            Self::NearSpecular => {
                "wi uniform, wo mirrored about half vectors whose slope reaches four alpha of each lobe in turn (widened by refraction \
                 for lobes below the first interface)."
            }
            Self::Grazing => {
                "Grazing cosines are log-uniform from that of 89.9° to 0.1. In a sixth of the pairs both directions are grazing, in a sixth wi \
                 only, in a sixth wo only, at any azimuths. In half of the pairs wi is grazing and wo lies near its mirror direction."
            }
            Self::Smooth => {
                "The pairs of near-specular, on four polished variants of the material. Their slope parameters are scaled by one factor, so that the largest is \
                 0.001, 0.003, 0.01 and 0.03, and none is below 0.001."
            }
            Self::Opposite => {
                "Four kinds of pairs, a quarter each: wo opposite in azimuth, with both cosines log-uniform from 1e-6 to 0.1; wo = wi; wo = -wi; and \
                 both directions below the horizon. The value of the last two is exactly 0."
            }
        }
    }

    /// The first `count` pairs for a material with these layers: points of a Halton sequence, rounded to f32 at the end.
    pub fn pairs(self, count: u32, layers: &[Layer]) -> Vec<Pair> {
        match self {
            Self::Uniform => DirectionSet::Random.pairs(count, layers),
            Self::NearSpecular | Self::Smooth => {
                let spreads = all_spreads(layers);
                (0..count)
                    .map(|n: u32| {
                        let [a, b, c, d] = halton(n / spreads.len() as u32);
                        let wi = direction(1.0 - a, b);
                        let wo = mirrored(wi, LOBE_REACH * c * spreads[n as usize % spreads.len()], d);
                        (rounded(wi, GRAZING_COS_MIN), rounded(wo, GRAZING_COS_MIN))
                    })
                    .collect()
            }
            Self::Grazing => {
                let spreads = all_spreads(layers);
                (0..count).map(|n| grazing(n, &spreads)).collect()
            }
            Self::Opposite => (0..count).map(opposite).collect(),
        }
    }
}

/// Slope spreads of every lobe, for both kinds of models: those in which no layer is smoother than the one above it, and those without that rule.
fn all_spreads(layers: &[Layer]) -> Vec<f64> {
    let mut all = spreads(layers);
    let mut eta_above = 1.0;
    for layer in layers {
        let own = layer.surface.alpha_x * eta_above;
        if matches!(layer.below, Below::Diffuse { .. }) {
            break;
        }
        eta_above *= layer.eta();
        if !all.contains(&own) {
            all.push(own);
        }
    }
    all
}

fn grazing(n: u32, spreads: &[f64]) -> Pair {
    let [a, b, c, d] = halton(n / 6);
    let (wi, wo) = match n % 6 {
        0 => (direction(log_uniform(COS_89_9, a), b), direction(log_uniform(COS_89_9, c), d)),
        1 => (direction(log_uniform(COS_89_9, a), b), direction(1.0 - c, d)),
        2 => (direction(1.0 - a, b), direction(log_uniform(COS_89_9, c), d)),
        _ => {
            let [a, b, c, d] = halton(n / 2);
            let wi = direction(log_uniform(COS_89_9, a), b);
            (wi, mirrored(wi, LOBE_REACH * c * spreads[(n / 6) as usize % spreads.len()], d))
        }
    };
    (rounded(wi, COS_89_9), rounded(wo, COS_89_9))
}

fn opposite(n: u32) -> Pair {
    let [a, b, c, d] = halton(n / 4);
    let up = rounded(direction(1.0 - a, b), GRAZING_COS_MIN);
    match n % 4 {
        0 => {
            let wi = direction(log_uniform(GRAZING_COS_MIN, a), b);
            let wo: DVec3 = direction(log_uniform(GRAZING_COS_MIN, c), b + 0.5 + 1e-2 * (d - 0.5));
            (rounded(wi, GRAZING_COS_MIN), rounded(wo, GRAZING_COS_MIN))
        }
        1 => (up, up),
        2 => (up, down(up)),
        _ => (down(up), down(rounded(direction(1.0 - c, d), GRAZING_COS_MIN))),
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::stack::{Distribution, Surface};

    use super::*;

    fn layers() -> Vec<Layer> {
        let layer =
            |distribution, alpha, below| Layer { surface: Surface::isotropic(distribution, alpha), above: 1.0, below };
        let coat = Below::Dielectric { ior: 1.5, optical_depth: [0.0; 3] };
        vec![layer(Distribution::Ggx, 0.2, coat), layer(Distribution::Beckmann, 0.05, Below::Conductor)]
    }

    #[test]
    fn sets_are_where_they_say() {
        for set in ParitySet::ALL {
            let pairs = set.pairs(6000, &layers());
            assert_eq!(pairs.len(), 6000);
            for (wi, wo) in &pairs {
                for w in [wi, wo] {
                    let length_sq: f64 = w.iter().map(|&c| f64::from(c) * f64::from(c)).sum();
                    assert!((length_sq - 1.0).abs() < 4e-6, "{set:?} {w:?}: {length_sq}");
                }
            }
            let lowest = pairs.iter().map(|(wi, wo)| wi[2].min(wo[2])).fold(1.0, f32::min);
            match set {
                ParitySet::Grazing => assert!((1.745e-3..1.75e-3).contains(&lowest), "{lowest}"),
                ParitySet::Opposite => {
                    let below = pairs.iter().filter(|(wi, wo)| wi[2].min(wo[2]) < 0.0).count();
                    assert_eq!(below, 3000);
                }
                _ => assert!(lowest > 0.0, "{set:?}"),
            }
        }
    }

    #[test]
    fn a_smooth_layer_below_a_rough_one_has_its_own_highlights() {
        assert_eq!(all_spreads(&layers()), [0.2, 0.2 * 1.5, 0.05 * 1.5]);
    }
}
