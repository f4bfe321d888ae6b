//! Tolerances of the error of a shader against its twin, by model, and known reasons of larger errors.

use luthier_manifest::{Form, ShadingModel};
use luthier_model::{Family, Tolerance};
use serde::{Deserialize, Serialize};

use crate::measure::causes::Factor;
use crate::measure::table_terms::Weights;

luthier_lut::named! {
    /// A share of the error of a shader.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum Share("share") {
        /// The error of reading tables.
        Table = "table",
        /// The error of f32 arithmetic.
        Arithmetic = "arithmetic",
    }
}

/// The tolerance of a share of the error of a shader. `weights` are those with which the device filters tables; `None` for a form without tables.
///
/// ```
/// use luthier_report::{Form, Share, Weights, tolerance};
///
/// // A hardware filter has weights of 8 bits, which widens the arithmetic error of shaders with tables.
/// let model = luthier_manifest::ShadingModel::Elek;
/// let limit = |weights| tolerance(model, Form::Baked, Share::Arithmetic, Some(weights)).limit;
/// assert!(limit(Weights::EightBit) > limit(Weights::Exact));
/// ```
pub fn tolerance(model: ShadingModel, form: Form, share: Share, weights: Option<Weights>) -> Tolerance {
    let of = &model.facts().tolerances;
    match (share, form) {
        (Share::Table, Form::Full) => Tolerance::NO_TABLE,
        (Share::Table, Form::Baked) => of.table,
        (Share::Arithmetic, _) if weights == Some(Weights::EightBit) => of.filtered,
        (Share::Arithmetic, Form::Baked) => of.baked,
        (Share::Arithmetic, Form::Full) => of.full,
    }
}

/// A known reason for an error beyond its tolerance. It applies up to a limit, and only if its factor was measured to cause the largest error.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Its name.
    pub name: &'static str,
    /// The models, by family.
    pub families: &'static [Family],
    /// The share.
    pub share: Share,
    /// Factor that must be the cause.
    pub factor: Factor,
    /// Largest error that it explains.
    pub limit: f64,
    /// The reason of the error.
    pub reason: &'static str,
}

/// All known reasons.
pub const KNOWN: [Known; 6] = [
    Known {
        name: "FRESNEL_UNDER_A_COAT",
        families: &[Family::Path],
        share: Share::Table,
        factor: Factor::Fresnel,
        limit: 2e-2,
        reason: "An interface transmits (1 - F)² of the light of lower layers, and beyond 88° 1 - F is small: 0.05 at cos θ = 0.008. A half float is up \
                 to 2.4e-4 off there, and so is linear interpolation between 128 nodes. This was measured on brass-foil, car-paint and \
                 gold-metallic-paint: with nodes over the square root of the cosine, errors of 4.5e-3 to 7.2e-3 remain in half floats, and 1.1e-3 in 32 bits. \
                 The reason for soap-film is FILM_AT_GRAZING.",
    },
    Known {
        name: "DISTRIBUTION_FAR_OUT",
        families: &[Family::Path],
        share: Share::Table,
        factor: Factor::Distribution,
        limit: 1e-2,
        reason: "The half vectors are more than 55° from the normal, on surfaces of alpha 0.45 and more. The angle axis has most of its nodes near the normal, \
                 and division by both cosines makes the small values far from it bright.",
    },
    Known {
        name: "FILM_AT_GRAZING",
        families: &[Family::Facets, Family::Lobes],
        share: Share::Table,
        factor: Factor::Fresnel,
        limit: 2e-2,
        reason: "A free film at grazing angles is a resonator. At cos θ = 0.0023 its fringes are narrower than the 5 nm steps of spectral integrals, so that \
                 red ripples by 0.06 every 3 nm of thickness, in the reference too; at cos θ = 0.02 there is no ripple. The nodes of the tile are 2.4 nm \
                 apart. So the page compares two samplings of one ripple.",
    },
    Known {
        name: "FAINT_LOBES_IN_HALF_FLOATS",
        families: &[Family::Lobes],
        share: Share::Table,
        factor: Factor::Lobes,
        limit: 0.1,
        reason: "A half float below 6.1e-5 is in steps of 6e-8. Of house-paint with alpha 0.001 the row at cos θ 0.168 has a lobe of strength 2e-6 with \
                 sharpnesses of 213 and 188: it is as bright as the floor in its middle, and a step is 3% of it. Strengths of ceramic-glaze fall from 0.057 to 2e-6 \
                 between its first two rows.",
    },
    Known {
        name: "ESCAPE_OF_NARROW_LOBES",
        families: &[Family::Statistics],
        share: Share::Table,
        factor: Factor::Escape,
        limit: 1e-2,
        reason: "Part of a lobe of alpha 0.001 to 0.01 close to the critical angle (83° to 86° outside) is totally reflected, and that part depends strongly \
                 on alpha. The axis of the table is the square root of alpha; it has five nodes in this range, up to a factor of 2.2 apart. For n = 1.5, \
                 interpolation over alpha alone was measured to be up to 1.4e-2 off, and over the cosine alone 6.8e-3; from alpha 0.01 upwards they \
                 are 2.0e-3 and 6.8e-4 off.",
    },
    Known {
        name: "ALBEDO_AT_GRAZING",
        families: &[Family::Statistics],
        share: Share::Table,
        factor: Factor::Fgd,
        limit: 1e-2,
        reason: "Surfaces of alpha 0.001 beyond 89.9° are outside the range of the tile's stated error (alpha from 0.01, angles to 89.5°). The tile is up to \
                 6.6e-3 too large there. Quadrature without any table agrees with the reference: for Beckmann, n = 1.5, alpha 0.001 and cos θ = 0.0011 it \
                 gives 0.99075, where the reference of acrylic-lacquer has 0.99073 and its tile 0.99681. The reason for soap-film is the ripple of \
                 FILM_AT_GRAZING.",
    },
];

/// The known reason for an error of a model in a share, caused by a factor.
pub(super) fn known(model: ShadingModel, share: Share, factor: Factor) -> Option<&'static Known> {
    KNOWN.iter().find(|k| k.families.contains(&model.facts().family) && k.share == share && k.factor == factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A filter in hardware widens the tolerance of arithmetic in forms with tables, and no other.
    #[test]
    fn hardware_filters_widen_arithmetic_alone() {
        for model in ShadingModel::ALL {
            let of = |share, weights| tolerance(model, Form::Baked, share, weights).limit;
            let [exact, hardware] = [Weights::Exact, Weights::EightBit].map(|w| of(Share::Arithmetic, Some(w)));
            if model == ShadingModel::Phong {
                assert!(exact == hardware, "{model}");
            } else {
                assert!(hardware > 5.0 * exact && hardware <= 2e-2, "{model}: {exact}, {hardware}");
            }
            assert!(of(Share::Table, Some(Weights::Exact)) == of(Share::Table, Some(Weights::EightBit)), "{model}");
        }
    }
}
