//! Distributions of facet normals by name: the surface's own, and those that need a slope parameter translated.

use glam::DVec3;
use luthier_model::Masking;
use luthier_optics::masking::smith_g1_of;
use luthier_optics::ndf::{Abc, BlinnPhong, Ndf, Sgd};
use luthier_optics::stack::{Distribution, Surface};

use crate::formulas::facets::{ALPHA_MIN, Facets, Lobe, masked_lobe};
use crate::memo::Memo;

/// Distribution of facet normals.
///
/// The last three are isotropic and have parameters of their own, which follow from alpha, the geometric mean of the surface's
/// slope parameters. Their Smith masking is computed by quadrature ([`smith_g1_of`]).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Normals {
    /// The surface's own.
    Surface,
    /// Beckmann or GGX, whatever the surface says.
    Slopes(Distribution),
    /// Blinn-Phong of exponent `2/alpha^2 - 2` (Walter et al. 2007): Beckmann's peak.
    BlinnPhong,
    /// ABC of `b = 2/alpha^2`, `c = 2`: the peak of GGX and its fall-off around the normal.
    Abc,
    /// SGD of the paper's `alpha` equal to alpha squared, `p = 1`: Beckmann's fall-off far from the normal, a sharper peak.
    Sgd,
}

/// Blinn's exponent for a slope parameter: `2/alpha^2 - 2` (Walter et al. 2007).
pub fn exponent(alpha: f64) -> f64 {
    let alpha = alpha.clamp(ALPHA_MIN, 1.0);
    2.0 / (alpha * alpha) - 2.0
}

/// Least exponent of Blinn-Phong: alpha = 1 has 0.
const EXPONENT_MIN: f64 = 1e-9;

/// Memo of the parts of [`Normals`] that are slow to compute.
#[derive(Debug)]
pub(crate) struct NormalsMemo {
    /// Distributions by alpha.
    distributions: Memo<u64, Option<Isotropic>>,
    /// Smith's Lambda by alpha and cosine.
    lambdas: Memo<[u64; 2], f64>,
}

impl NormalsMemo {
    pub(crate) const fn new() -> Self {
        Self { distributions: Memo::new(), lambdas: Memo::new() }
    }
}

#[derive(Debug, Clone, Copy)]
enum Isotropic {
    BlinnPhong(BlinnPhong),
    Abc(Abc),
    Sgd(Sgd),
}

impl Ndf for Isotropic {
    fn density(&self, cos_theta_h: f64, sin_theta_h_sq: f64) -> f64 {
        match self {
            Self::BlinnPhong(ndf) => ndf.density(cos_theta_h, sin_theta_h_sq),
            Self::Abc(ndf) => ndf.density(cos_theta_h, sin_theta_h_sq),
            Self::Sgd(ndf) => ndf.density(cos_theta_h, sin_theta_h_sq),
        }
    }
}

impl Normals {
    /// The lobe of a surface, see [`Facets::lobe`]. A memo serves one kind of normals only.
    pub(crate) fn lobe(
        self,
        memo: &NormalsMemo,
        surface: &Surface,
        masking: Masking,
        wi: DVec3,
        wo: DVec3,
    ) -> Option<Lobe> {
        let alpha = surface.alpha_isotropic().clamp(ALPHA_MIN, 1.0);
        let ndf = match self {
            Self::Surface => return Facets::new(surface).lobe(masking, wi, wo),
            Self::Slopes(distribution) => {
                return Facets::new(&Surface { distribution, ..*surface }).lobe(masking, wi, wo);
            }
            Self::BlinnPhong | Self::Abc | Self::Sgd => {
                memo.distributions.get(alpha.to_bits(), || self.isotropic(alpha))?
            }
        };
        masked_lobe(
            masking,
            [wi, wo],
            alpha,
            |wh| ndf.density(wh.z, wh.x * wh.x + wh.y * wh.y),
            |w| memo.lambdas.get([alpha, w.z].map(f64::to_bits), || 1.0 / smith_g1_of(&ndf, w.z) - 1.0),
        )
    }

    /// The distribution with its own parameters, translated from alpha; `None` for a distribution of slopes.
    fn isotropic(self, alpha: f64) -> Option<Isotropic> {
        match self {
            Self::Surface | Self::Slopes(_) => None,
            Self::BlinnPhong => BlinnPhong::new(exponent(alpha).max(EXPONENT_MIN)).map(Isotropic::BlinnPhong).ok(),
            Self::Abc => Abc::new(2.0 / (alpha * alpha), 2.0).map(Isotropic::Abc).ok(),
            Self::Sgd => Sgd::new(alpha * alpha, 1.0).map(Isotropic::Sgd).ok(),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// D around the normal, times G = 1 - o(1) there.
    fn peak(normals: Normals, alpha: f64) -> f64 {
        let surface = Surface::isotropic(Distribution::Ggx, alpha);
        let lobe = normals.lobe(&NormalsMemo::new(), &surface, Masking::Smith, DVec3::Z, DVec3::Z).unwrap();
        4.0 * lobe.value / lobe.masking
    }

    /// Oracle: 1/(pi alpha^2) is the peak of Beckmann and of GGX. ABC's projected area is cut at the horizon, which raises its peak
    /// by 1 + O(alpha^2 ln alpha).
    #[test]
    fn peaks_are_as_documented() {
        let alpha = 0.02;
        let expected = 1.0 / (std::f64::consts::PI * alpha * alpha);
        for (normals, tolerance) in [
            (Normals::Slopes(Distribution::Beckmann), 1e-12),
            (Normals::Slopes(Distribution::Ggx), 1e-12),
            (Normals::BlinnPhong, 1e-12),
            (Normals::Abc, 3e-3),
        ] {
            let ratio = peak(normals, alpha) / expected;
            assert!((ratio - 1.0).abs() < tolerance, "{normals:?}: {ratio}");
        }
        assert!(peak(Normals::Sgd, alpha) > 10.0 * expected);
    }

    #[test]
    fn all_are_defined_from_the_least_alpha_to_one() {
        let memo = NormalsMemo::new();
        for normals in [Normals::BlinnPhong, Normals::Abc, Normals::Sgd] {
            for alpha in [0.0, 1e-3, 0.1, 1.0] {
                let surface = Surface::isotropic(Distribution::Ggx, alpha);
                for wi in [DVec3::Z, DVec3::new(0.6, 0.0, 0.8), DVec3::new(1.0, 0.0, 1e-9).normalize()] {
                    let lobe = normals.lobe(&NormalsMemo::new(), &surface, Masking::Smith, wi, DVec3::Z).unwrap();
                    assert!(lobe.value.is_finite() && lobe.value >= 0.0, "{normals:?} {alpha} {wi}: {lobe:?}");
                }
            }
        }
        let surface = Surface::isotropic(Distribution::Ggx, 0.1);
        assert_eq!(Normals::Abc.lobe(&memo, &surface, Masking::Smith, -DVec3::Z, DVec3::Z), None);
    }
}
