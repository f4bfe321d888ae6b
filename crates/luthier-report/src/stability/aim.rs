//! Directions of the light and of the eye on a case.

use glam::DVec3;
use luthier_layers::layers::Layer;
use serde::{Deserialize, Serialize};

use crate::measure::directions::{Pair, direction, down, halton, log_uniform, mirrored, rounded};
use crate::parity::ParitySet;

/// Smallest cosine of a stressed direction.
pub(super) const COS_MIN: f64 = 1e-7;

/// Pairs of directions of a case.
const PAIRS: u32 = 96;

/// Set of directions of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Aim {
    /// Uniform directions, and directions near the mirror direction of every lobe.
    Ordinary,
    /// One or both cosines from 1e-7 to 0.1, at any azimuths.
    Grazing,
    /// Mirror directions with cosines from 1e-7 to 1.
    Mirror,
    /// `wo = -wi`, with one or both directions below the horizon; and grazing directions of opposite azimuths.
    Opposite,
    /// `wo = wi`.
    Retro,
}

impl Aim {
    /// The name in identifiers.
    pub fn name(self) -> &'static str {
        match self {
            Self::Ordinary => "ordinary",
            Self::Grazing => "grazing",
            Self::Mirror => "mirror",
            Self::Opposite => "opposite",
            Self::Retro => "retro",
        }
    }

    /// Description of the aim, for a reader.
    pub fn title(self) -> &'static str {
        match self {
            Self::Ordinary => "uniform directions and highlights",
            Self::Grazing => "both cosines, or one of them, from 1e-7 to 0.1",
            Self::Mirror => "mirror directions, cosines from 1e-7 to 1",
            Self::Opposite => {
                "wo = -wi and other directions below the horizon, and grazing directions of opposite azimuths"
            }
            Self::Retro => "wo = wi",
        }
    }

    /// The pairs for layers, rounded to f32.
    pub(super) fn pairs(self, layers: &[Layer]) -> Vec<Pair> {
        if self == Self::Ordinary {
            let sets = [ParitySet::Uniform, ParitySet::NearSpecular];
            return sets.into_iter().flat_map(|set| set.pairs(PAIRS / 2, layers)).collect();
        }
        (0..PAIRS).map(|n| self.pair(n)).collect()
    }

    fn pair(self, n: u32) -> Pair {
        let [a, b, c, d] = halton(n);
        let near = |w: DVec3| rounded(w, COS_MIN);
        let grazing = |u, v| direction(log_uniform(COS_MIN, u), v);
        match self {
            Self::Ordinary | Self::Retro => {
                let w = near(direction(if n.is_multiple_of(2) { 1.0 - a } else { log_uniform(COS_MIN, a) }, b));
                (w, w)
            }
            Self::Grazing => match n % 3 {
                0 => (near(grazing(a, b)), near(grazing(c, d))),
                1 => (near(grazing(a, b)), near(direction(1.0 - c, d))),
                _ => (near(direction(1.0 - a, b)), near(grazing(c, d))),
            },
            Self::Mirror => {
                let cos = libm::exp(a * libm::log(COS_MIN));
                let wi = direction(cos, b);
                // Half of the pairs are exact mirror directions, half are off by a slope of up to 1e-3.
                (near(wi), near(mirrored(wi, if n.is_multiple_of(2) { 0.0 } else { 1e-3 * c }, d)))
            }
            Self::Opposite => {
                let up = near(direction(1.0 - a, b));
                match n % 4 {
                    0 => (near(grazing(a, b)), near(grazing(c, b + 0.5))),
                    1 => (up, down(up)),
                    2 => (down(up), up),
                    _ => (down(up), down(near(direction(1.0 - c, d)))),
                }
            }
        }
    }

    /// Angles of the eye at which albedos are compared, degrees.
    pub(super) fn thetas_deg(self) -> &'static [f64] {
        match self {
            Self::Ordinary => &[30.0, 70.0],
            Self::Grazing | Self::Mirror => &[89.0],
            Self::Opposite | Self::Retro => &[],
        }
    }
}
