//! Single-scattering directional albedo of a rough interface between transparent media, from either side, by quadrature.
//!
//! Albedos that energy-compensation tables hold (Kulla and Conty 2017, "Revisiting Physically Based Shading at Imageworks"; Turquin 2019,
//! "Practical multiple scattering compensation for microfacet models"). Facets reflect and refract by Fresnel's formulas (Walter et al. 2007,
//! "Microfacet Models for Refraction through Rough Surfaces", eq. 20 and 21, integrated over the facets instead of directions). Albedos
//! are of power: the change of radiance with the square of the index is left out.
//!
//! Out of scope: films, absorption, anisotropy, light that meets a second facet.

mod facets;

use std::f64::consts::FRAC_PI_2;

use crate::albedo::{ALPHA_MIN, COS_THETA_MIN};
use crate::masking::{Correlation, smith};
use crate::stack::Distribution;
use facets::{Facets, Feature, Rules, fresnel_feature, visit_nodes};

/// Smith masking and shadowing of reflected and of refracted light alike, from the Lambdas of both directions.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum JointMasking {
    /// 1/(1 + Lambda_i + Lambda_o), for refraction too, as Cycles has it.
    Correlated,
    /// The product of both G1: Walter et al. 2007, eq. 23, and Adobe's OpenPBR.
    Separable,
    /// G1 of the incident direction: shadowing is left out.
    Incident,
}

impl JointMasking {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Correlated, Self::Separable, Self::Incident];

    /// Its name in files and on command lines.
    pub fn name(self) -> &'static str {
        match self {
            Self::Correlated => "correlated",
            Self::Separable => "separable",
            Self::Incident => "incident",
        }
    }

    fn of(self, lambda_i: f64, lambda_o: impl FnOnce() -> f64) -> f64 {
        match self {
            Self::Correlated => smith(Correlation::Height, lambda_i, lambda_o()),
            Self::Separable => smith(Correlation::Separable, lambda_i, lambda_o()),
            Self::Incident => 1.0 / (1.0 + lambda_i),
        }
    }
}

/// Light that leaves an interface after one facet, as parts of the incident light.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct InterfaceAlbedo {
    /// Part reflected.
    pub reflected: f64,
    /// Part transmitted.
    pub transmitted: f64,
}

impl InterfaceAlbedo {
    /// Both parts together; multiple scattering carries the rest of the light.
    pub fn total(self) -> f64 {
        self.reflected + self.transmitted
    }
}

/// Reflectance of a plane interface between transparent media, unpolarised: `eta_ti` is the index behind over that in front. Exact, 1 under total
/// reflection (Walter et al. 2007, eq. 22).
pub fn fresnel_dielectric(eta_ti: f64, cos_theta_i: f64) -> f64 {
    let c = cos_theta_i.clamp(0.0, 1.0);
    let g_sq = (eta_ti - 1.0) * (eta_ti + 1.0) + c * c;
    if g_sq <= 0.0 {
        return 1.0;
    }
    let g = libm::sqrt(g_sq);
    // g - c without cancellation where the media are alike.
    let difference = (eta_ti - 1.0) * (eta_ti + 1.0) / (g + c);
    let s = difference / (g + c);
    let p = (c * (g + c) - 1.0) / (c * difference + 1.0);
    (0.5 * s * s * (1.0 + p * p)).min(1.0)
}

/// The single-scattering directional albedo of a rough interface between transparent media.
///
/// `alpha` in 0..=1 (a plane below [`ALPHA_MIN`]); `eta_ti` > 0 is the index behind over that in front, below 1 for light from the denser side;
/// `cos_theta_i` in 0..=1 (the limit at grazing below [`COS_THETA_MIN`]).
///
/// Within 1e-6 for `eta_ti` in 0.01..=100, and 2e-6 under [`JointMasking::Incident`], which ends abruptly at the horizon: measured against
/// rules of twice the nodes. A tenth to a fifth of a millisecond.
pub fn albedo_dir(
    distribution: Distribution,
    masking: JointMasking,
    alpha: f64,
    eta_ti: f64,
    cos_theta_i: f64,
) -> InterfaceAlbedo {
    with_rules(Rules::usual(), distribution, masking, alpha, eta_ti, cos_theta_i)
}

fn with_rules(
    rules: &Rules,
    distribution: Distribution,
    masking: JointMasking,
    alpha: f64,
    eta_ti: f64,
    cos_theta_i: f64,
) -> InterfaceAlbedo {
    let cos_i = cos_theta_i.clamp(COS_THETA_MIN, 1.0);
    if alpha < ALPHA_MIN {
        let reflected = fresnel_dielectric(eta_ti, cos_i);
        return InterfaceAlbedo { reflected, transmitted: 1.0 - reflected };
    }
    let facets = Facets::new(rules, distribution, masking, alpha, cos_i);
    let reflected = facets.reflected(fresnel_feature(eta_ti), |cos| fresnel_dielectric(eta_ti, cos));
    let transmitted = facets.transmitted(eta_ti, |cos| fresnel_dielectric(eta_ti, cos));
    InterfaceAlbedo { reflected, transmitted }
}

/// The single-scattering directional albedo of facets of any smooth reflectance, a function of the cosine at the facet: 1 for the E of
/// metals, which Turquin's factor `1 + f0 (1 - E)/E` takes.
///
/// Domain and bound of [`albedo_dir`].
pub fn reflected_dir(
    distribution: Distribution,
    masking: JointMasking,
    alpha: f64,
    cos_theta_i: f64,
    reflectance: impl Fn(f64) -> f64,
) -> f64 {
    let cos_i = cos_theta_i.clamp(COS_THETA_MIN, 1.0);
    if alpha < ALPHA_MIN {
        return reflectance(cos_i);
    }
    Facets::new(Rules::usual(), distribution, masking, alpha, cos_i)
        .reflected(Feature { at: FRAC_PI_2, width: 1.0 }, reflectance)
}

/// The hemispherical average of [`albedo_dir`]: the integral of `2 cos_theta_i albedo_dir` over the cosine, by Gauss-Legendre.
///
/// Within 2e-6: measured against rules of twice the nodes, and by reciprocity, which makes the light transmitted from the rarer side
/// `eta_ti^2` times that from the denser.
pub fn albedo_avg(distribution: Distribution, masking: JointMasking, alpha: f64, eta_ti: f64) -> InterfaceAlbedo {
    let (mut reflected, mut transmitted) = (0.0, 0.0);
    average(Rules::usual(), alpha, eta_ti, |weight, cos| {
        let albedo = albedo_dir(distribution, masking, alpha, eta_ti, cos);
        reflected += weight * albedo.reflected;
        transmitted += weight * albedo.transmitted;
    });
    InterfaceAlbedo { reflected, transmitted }
}

/// The hemispherical average of [`reflected_dir`].
pub fn reflected_avg(
    distribution: Distribution,
    masking: JointMasking,
    alpha: f64,
    reflectance: impl Fn(f64) -> f64,
) -> f64 {
    let mut sum = 0.0;
    average(Rules::usual(), alpha, ALIKE, |weight, cos| {
        sum += weight * reflected_dir(distribution, masking, alpha, cos, &reflectance);
    });
    sum
}

/// A relative index whose reflectance has no feature besides grazing.
const ALIKE: f64 = std::f64::consts::SQRT_2;

/// Weights and cosines of the average over the hemisphere.
fn average(rules: &Rules, alpha: f64, eta_ti: f64, mut visit: impl FnMut(f64, f64)) {
    let fresnel = fresnel_feature(eta_ti);
    // Over cosines: masking changes near grazing on the scale of alpha, and what critical angles make is as wide as the facets' slopes.
    let features = [
        Feature { at: 0.0, width: 0.5 * alpha },
        Feature { at: libm::cos(fresnel.at), width: fresnel.width },
        // From here on rings up to the critical angle have facets at right angles to the surface.
        Feature { at: eta_ti.min(1.0), width: 0.1 },
        Feature { at: 1.0, width: 1.0 },
    ];
    visit_nodes(&rules.averages, [0.0, 1.0], features, |cos, weight| visit(2.0 * cos * weight, cos));
}

#[cfg(test)]
mod tests;
