//! Tolerances of the error of a shader against its twin, by model, and known reasons of larger errors.

use luthier_manifest::ShadingModel;
use serde::{Deserialize, Serialize};

use crate::judge::exceptions::Factor;
use crate::{Form, Weights};

/// A share of the error of a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Share {
    /// The error of reading tables.
    Table,
    /// The error of f32 arithmetic.
    Arithmetic,
}

impl Share {
    /// Both shares.
    pub const ALL: [Self; 2] = [Self::Table, Self::Arithmetic];

    /// The name in reports.
    pub fn name(self) -> &'static str {
        match self {
            Self::Table => "table",
            Self::Arithmetic => "arithmetic",
        }
    }
}

/// The largest error of one share that a shader is held to.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Tolerance {
    /// Its name.
    pub name: &'static str,
    /// Relative to max(brightest channel of the reference, [`crate::FLOOR`]).
    pub limit: f64,
    /// Reason for the limit.
    pub reason: &'static str,
}

const LOBE_TABLE: Tolerance = Tolerance {
    name: "LOBE_TABLE",
    limit: 2.5e-3,
    reason: "A Fresnel row is within 5e-4 of the reflectance F, and light of lower layers passes the interface twice, with a factor of 1 - F each time. \
             If a material asks for a table of the distribution, that table is interpolated between slope parameters. The values at the foot \
             of a lobe are then a few thousandths off, and still brighter than the floor.",
};

const PHASE_TABLE: Tolerance = Tolerance {
    name: "PHASE_TABLE",
    limit: 1.5e-3,
    reason: "A phase row replaces a cosine by straight lines between 256 nodes, and stores it in half floats of up to 2.",
};

const ENERGY_TABLE: Tolerance = Tolerance {
    name: "ENERGY_TABLE",
    limit: 2.5e-3,
    reason: "A lobe is a closed form times its energy, and the energy is a product of values from the `fgd` and `escape` tables. The tables have 64 nodes \
             along each axis. An error of 1e-3 in one of the factors is an error of 1e-3 in the lobe.",
};

const ROW_TABLE: Tolerance = Tolerance {
    name: "ROW_TABLE",
    limit: 1e-2,
    reason: "A Fresnel row is within 5e-4 of the reflectance F, which is 1% of 0.04. Rows of lobes are half floats, \
             off by up to 2.4e-4 of themselves: at the foot of a Gaussian lobe a change of its width changes the value fifteen times as much.",
};

const NO_TABLE: Tolerance = Tolerance { name: "NO_TABLE", limit: 0.0, reason: "The shader reads no table." };

const LOBE_READ: Tolerance = Tolerance {
    name: "LOBE_READ",
    limit: 2e-4,
    reason: "The reason of `LAYERS_IN_F32` holds. In addition, a distribution table, where a material asks for one, stores sixteenth roots: \
             a rounding error of the coordinate or of the filter grows sixteenfold.",
};

const LOBES_IN_F32: Tolerance = Tolerance {
    name: "LOBES_IN_F32",
    limit: 3.5e-4,
    reason: "A sampler finds its place in a row in f32, to some millionths of the distance between rows. Where a lobe fades to almost nothing between the \
             first two rows, beyond 88°, what is left of it is off by more than a hundred times as much. Elsewhere values are within 2e-4: a Gaussian \
             lobe is a power with an exponent of up to 1025, which multiplies the rounding of its base.",
};

const LAYERS_IN_F32: Tolerance = Tolerance {
    name: "LAYERS_IN_F32",
    limit: 5e-5,
    reason: "Every layer adds some tens of roundings of 6e-8 each. They enter an exponential, whose argument can reach ten or more \
             before its value is below the floor.",
};

const BEAMS_IN_F32: Tolerance = Tolerance {
    name: "BEAMS_IN_F32",
    limit: 2e-5,
    reason: "The rounding errors are those of one layer. The exponents of the lobes reach 2e6, but their bases are computed without cancellation.",
};

const STATISTICS_IN_F32: Tolerance = Tolerance {
    name: "STATISTICS_IN_F32",
    limit: 2e-5,
    reason: "Every layer adds some tens of roundings of 6e-8 each, and two powers convert a slope parameter to a variance and back. No exponential \
             and no root of a stored value makes the errors larger.",
};

const PHONG_IN_F32: Tolerance = Tolerance {
    name: "PHONG_IN_F32",
    limit: 1e-5,
    reason: "The shader evaluates one exponential of a product whose factors have an error of 1e-7 each. The error of the value is that error times \
             the argument, and beyond an argument of 1 the value falls faster than the error grows.",
};

const FILTERED_BY_HARDWARE: Tolerance = Tolerance {
    name: "FILTERED_BY_HARDWARE",
    limit: 4e-3,
    reason: "A filter in hardware has weights of 8 bits, and f32 rounds a coordinate to one side or the other of a step: a part of 256 of the difference of two \
             texels. A GPU was seen to round filtered half floats to half floats again, off by 2.4e-4 of themselves. Values are products of several.",
};

const FILTERED_BELOW_A_COAT: Tolerance = Tolerance {
    name: "FILTERED_BELOW_A_COAT",
    limit: 2e-2,
    reason: "The reason of `FILTERED_BY_HARDWARE` holds. In addition, light of lower layers is multiplied by (1 - F)², which is small beyond 88° while F is near 1: \
             as in `FRESNEL_UNDER_A_COAT`. Tables of the distribution store sixteenth roots, and a Gaussian lobe changes fifteen times as much as its width.",
};

/// The tolerance of a shader, whose device filters tables with some weights; `None` for a form without tables.
pub fn tolerance(model: ShadingModel, form: Form, share: Share, weights: Option<Weights>) -> Tolerance {
    let is_hardware = weights == Some(Weights::EightBit);
    match (share, model) {
        (Share::Table, ShadingModel::Phong) => NO_TABLE,
        (Share::Table, _) if form == Form::Full => NO_TABLE,
        (Share::Table, ShadingModel::GranierHeidrich) => PHASE_TABLE,
        (Share::Table, ShadingModel::Belcour | ShadingModel::Yamaguchi) => ENERGY_TABLE,
        (Share::Table, ShadingModel::Lobes) => ROW_TABLE,
        (Share::Table, _) => LOBE_TABLE,
        (Share::Arithmetic, ShadingModel::Phong) => PHONG_IN_F32,
        (Share::Arithmetic, ShadingModel::Elek | ShadingModel::WeidlichWilkie | ShadingModel::Lobes) if is_hardware => {
            FILTERED_BELOW_A_COAT
        }
        (Share::Arithmetic, _) if is_hardware => FILTERED_BY_HARDWARE,
        (Share::Arithmetic, ShadingModel::GranierHeidrich) => BEAMS_IN_F32,
        (Share::Arithmetic, ShadingModel::Belcour | ShadingModel::Yamaguchi) => STATISTICS_IN_F32,
        (Share::Arithmetic, ShadingModel::Lobes) => LOBES_IN_F32,
        (Share::Arithmetic, _) if form == Form::Baked => LOBE_READ,
        (Share::Arithmetic, _) => LAYERS_IN_F32,
    }
}

/// A larger error whose reason is known: the factor that was measured to be at fault where it is largest, up to a limit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Known {
    /// Its name.
    pub name: &'static str,
    /// The models.
    pub models: &'static [ShadingModel],
    /// The share.
    pub share: Share,
    /// Factor that has to be at fault.
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
        models: &[ShadingModel::Elek, ShadingModel::WeidlichWilkie],
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
        models: &[ShadingModel::Elek, ShadingModel::WeidlichWilkie],
        share: Share::Table,
        factor: Factor::Distribution,
        limit: 1e-2,
        reason: "The half vectors are more than 55° from the normal, on surfaces of alpha 0.45 and more. The angle axis has most of its nodes near the normal, \
                 and division by both cosines makes the small values far from it bright.",
    },
    Known {
        name: "FILM_AT_GRAZING",
        models: &[ShadingModel::Microfacet, ShadingModel::Lobes],
        share: Share::Table,
        factor: Factor::Fresnel,
        limit: 2e-2,
        reason: "A free film at grazing angles is a resonator. At cos θ = 0.0023 its fringes are narrower than the 5 nm steps of spectral integrals, so that \
                 red ripples by 0.06 every 3 nm of thickness, in the reference too; at cos θ = 0.02 there is no ripple. The nodes of the tile are 2.4 nm \
                 apart. So the page compares two samplings of one ripple.",
    },
    Known {
        name: "FAINT_LOBES_IN_HALF_FLOATS",
        models: &[ShadingModel::Lobes],
        share: Share::Table,
        factor: Factor::Lobes,
        limit: 0.1,
        reason: "A half float below 6.1e-5 is in steps of 6e-8. Of house-paint with alpha 0.001 the row at cos θ 0.168 has a lobe of strength 2e-6 with \
                 sharpnesses of 213 and 188: it is as bright as the floor in its middle, and a step is 3% of it. Strengths of ceramic-glaze fall from 0.057 to 2e-6 \
                 between its first two rows.",
    },
    Known {
        name: "ESCAPE_OF_NARROW_LOBES",
        models: &[ShadingModel::Belcour, ShadingModel::Yamaguchi],
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
        models: &[ShadingModel::Belcour, ShadingModel::Yamaguchi],
        share: Share::Table,
        factor: Factor::Fgd,
        limit: 1e-2,
        reason: "Surfaces of alpha 0.001 beyond 89.9° are outside the range of the tile's stated error (alpha from 0.01, angles to 89.5°). The tile is up to \
                 6.6e-3 too large there. Quadrature without any table agrees with the reference: for Beckmann, n = 1.5, alpha 0.001 and cos θ = 0.0011 it \
                 gives 0.99075, where the reference of acrylic-lacquer has 0.99073 and its tile 0.99681. The reason for soap-film is the ripple of \
                 FILM_AT_GRAZING.",
    },
];

/// The known reason for a share of the error of a model that a factor is at fault for.
pub(super) fn known(model: ShadingModel, share: Share, factor: Factor) -> Option<&'static Known> {
    KNOWN.iter().find(|k| k.models.contains(&model) && k.share == share && k.factor == factor)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A filter in hardware widens tolerances of what it is read for: the arithmetic of forms with tables.
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
