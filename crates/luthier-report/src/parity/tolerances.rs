//! How far a shader may be from its twin, model by model, and what is known to be further.

use luthier_manifest::ShadingModel;
use serde::{Deserialize, Serialize};

use crate::Form;
use crate::exceptions::Factor;

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
    /// Why it is what it is.
    pub reason: &'static str,
}

const LOBE_TABLE: Tolerance = Tolerance {
    name: "LOBE_TABLE",
    limit: 2.5e-3,
    reason: "A Fresnel row is within 5e-4, and what lies below is seen through its complement twice. Where a material asks for a table \
             of the distribution, that is interpolated between slope parameters; at the foot of a lobe a value that is a few \
             thousandths off is still bright over the floor.",
};

const PHASE_TABLE: Tolerance = Tolerance {
    name: "PHASE_TABLE",
    limit: 1.5e-3,
    reason: "Between the 256 nodes of a phase row a cosine is a straight line, and its texels are half floats of up to 2.",
};

const ENERGY_TABLE: Tolerance = Tolerance {
    name: "ENERGY_TABLE",
    limit: 2.5e-3,
    reason: "A lobe is a closed form times its energy, a product of reads of the albedo and escape tables; these have 64 nodes along each axis, \
             and what is off by 1e-3 in one is off by that in the lobe.",
};

const NO_TABLE: Tolerance = Tolerance { name: "NO_TABLE", limit: 0.0, reason: "Nothing is read from a table." };

const LOBE_READ: Tolerance = Tolerance {
    name: "LOBE_READ",
    limit: 2e-4,
    reason: "As `LAYERS_IN_F32`; but a texel of a distribution table, where a material asks for one, is a sixteenth root: a rounding \
             error of the coordinate or of the filter comes out sixteen times as large.",
};

const LAYERS_IN_F32: Tolerance = Tolerance {
    name: "LAYERS_IN_F32",
    limit: 5e-5,
    reason: "Some tens of roundings of 6e-8 for every layer, in an exponential whose argument may be ten or more before the value is below \
             the floor.",
};

const BEAMS_IN_F32: Tolerance = Tolerance {
    name: "BEAMS_IN_F32",
    limit: 2e-5,
    reason: "As one layer; the exponents of the lobes reach 2e6, but what they are applied to is formed without cancellation.",
};

const STATISTICS_IN_F32: Tolerance = Tolerance {
    name: "STATISTICS_IN_F32",
    limit: 2e-5,
    reason: "Some tens of roundings of 6e-8 for every layer, and two powers on the way from a slope parameter to a variance and back; no \
             exponential, and the tables hold what they mean.",
};

const PHONG_IN_F32: Tolerance = Tolerance {
    name: "PHONG_IN_F32",
    limit: 1e-5,
    reason: "One exponential of a product whose factors have an error of 1e-7 each: the error is that times the exponent's \
             argument, which the value outweighs beyond 1.",
};

/// The tolerance of a shader.
pub fn tolerance(model: ShadingModel, form: Form, share: Share) -> Tolerance {
    match (share, model) {
        (Share::Table, ShadingModel::Phong) => NO_TABLE,
        (Share::Table, _) if form == Form::Full => NO_TABLE,
        (Share::Table, ShadingModel::GranierHeidrich) => PHASE_TABLE,
        (Share::Table, ShadingModel::Belcour | ShadingModel::Yamaguchi) => ENERGY_TABLE,
        (Share::Table, _) => LOBE_TABLE,
        (Share::Arithmetic, ShadingModel::Phong) => PHONG_IN_F32,
        (Share::Arithmetic, ShadingModel::GranierHeidrich) => BEAMS_IN_F32,
        (Share::Arithmetic, ShadingModel::Belcour | ShadingModel::Yamaguchi) => STATISTICS_IN_F32,
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
    /// How far it goes.
    pub limit: f64,
    /// Where it comes from.
    pub reason: &'static str,
}

/// All known reasons.
pub const KNOWN: [Known; 5] = [
    Known {
        name: "FRESNEL_UNDER_A_COAT",
        models: &[ShadingModel::Elek, ShadingModel::WeidlichWilkie],
        share: Share::Table,
        factor: Factor::Fresnel,
        limit: 2e-2,
        reason: "What lies below an interface is seen through (1 - F)² of it, and beyond 88° 1 - F is small: 0.05 at cos θ 0.008. A half float is up \
                 to 2.4e-4 off there, and straight lines between 128 nodes are as much. Measured on brass-foil, car-paint and gold-metallic-paint: nodes \
                 over the square root of the cosine leave 4.5e-3 to 7.2e-3 in half floats and 1.1e-3 in 32 bits. Of soap-film see FILM_AT_GRAZING.",
    },
    Known {
        name: "DISTRIBUTION_FAR_OUT",
        models: &[ShadingModel::Elek, ShadingModel::WeidlichWilkie],
        share: Share::Table,
        factor: Factor::Distribution,
        limit: 1e-2,
        reason: "Half vectors beyond 55° on surfaces of alpha 0.45 and more: the angle axis has its nodes near the normal, and division \
                 by both cosines makes what is small there bright.",
    },
    Known {
        name: "FILM_AT_GRAZING",
        models: &[ShadingModel::Microfacet],
        share: Share::Table,
        factor: Factor::Fresnel,
        limit: 2e-2,
        reason: "A free film at grazing angles is a resonator: at cos θ 0.0023 its fringes are narrower than the 5 nm steps of spectral integrals, so that red \
                 ripples by 0.06 every 3 nm of thickness, in the reference too; at cos θ 0.02 it does not. The tile's nodes are 2.4 nm apart. What is \
                 compared are two samplings of one ripple.",
    },
    Known {
        name: "ESCAPE_OF_NARROW_LOBES",
        models: &[ShadingModel::Belcour, ShadingModel::Yamaguchi],
        share: Share::Table,
        factor: Factor::Escape,
        limit: 1e-2,
        reason: "Of lobes of alpha 0.001 to 0.01 close to the critical angle (83° to 86° outside) a share turns back that depends on alpha strongly, and \
                 the table's axis, the square root of alpha, has five nodes there, up to a factor of 2.2 apart. Measured for n = 1.5: interpolation \
                 over alpha alone is up to 1.4e-2 off, over the cosine alone 6.8e-3; from alpha 0.01 up 2.0e-3 and 6.8e-4.",
    },
    Known {
        name: "ALBEDO_AT_GRAZING",
        models: &[ShadingModel::Belcour, ShadingModel::Yamaguchi],
        share: Share::Table,
        factor: Factor::Fgd,
        limit: 1e-2,
        reason: "Surfaces of alpha 0.001 beyond 89.9°, outside the domain of the tile's stated error (alpha from 0.01, to 89.5°): it holds up to 6.6e-3 too much. Quadrature \
                 without any table agrees with the reference: for Beckmann, n = 1.5, alpha 0.001 and cos θ 0.0011 0.99075, the reference of \
                 acrylic-lacquer 0.99073, its tile 0.99681. Of soap-film it is the ripple of FILM_AT_GRAZING.",
    },
];

/// The known reason for a share of the error of a model that a factor is at fault for.
pub(super) fn known(model: ShadingModel, share: Share, factor: Factor) -> Option<&'static Known> {
    KNOWN.iter().find(|k| k.models.contains(&model) && k.share == share && k.factor == factor)
}
