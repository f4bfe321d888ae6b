//! The f64 side of a comparison: the twin of a material's shader, and its exact terms.

use luthier_layers::layers::{Layer, Layers};
use luthier_layers::models::lobes::{Cover, Family, SlopeAxis, Varying};
use luthier_layers::models::parts::Parts;
use luthier_layers::models::shade::ShaderTerms;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::shaded::Side;
use luthier_layers::twins::terms::Exact;
use luthier_manifest::{ColorMode, FamilyRecord, MaterialEntry, PatinaRecord, SlopesRecord, VaryingFactor};
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;
use rayon::prelude::*;

use crate::measure::directions::{Pair, wide};
use crate::measure::subject::color;
use crate::measure::table_terms::recorded_veil;

/// The f64 twin of one material's shader, and its exact terms.
pub(crate) struct References {
    pub(crate) layers: Vec<Layer>,
    pub(crate) twin: Twin,
    pub(crate) spectral: Exact,
    pub(crate) three: Exact,
    /// Exact terms of the form without tables, if they differ from `three`.
    pub(crate) level: Option<Exact>,
    color: ColorMode,
}

impl References {
    pub(crate) fn new(stack: &Stack, material: &MaterialEntry) -> Self {
        let three_nm = Color::ThreeWavelengths(material.wavelengths_nm);
        let color = color(material);
        let model = material.model;
        let varying = varying_of(material);
        let twin_of = |stack: &Stack| Twin::with(model, stack, material.wavelengths_nm, color, parts(material));
        let twin = twin_of(stack).reradiating(material.layers.last().and_then(|layer| layer.reradiation));
        let [spectral, three] = [Color::Spectral, three_nm].map(|color| Exact::varying(stack, color, varying));
        let level = model.is_statistical().then(|| Exact::level(stack, three_nm, recorded_veil(material)));
        let coat = material.constants.coat.as_ref().filter(|_| shows_cover(material));
        let (twin, spectral, three) = match coat {
            Some(coat) => {
                let bare = bare_stack(material, stack);
                let twin = twin.covering(coat.weight, twin_of(&bare));
                let of_side = material.side().and_then(|side| varying_of(&side));
                (twin, spectral.over_bare(&bare, of_side), three.over_bare(&bare, of_side))
            }
            None => (twin, spectral, three),
        };
        Self { layers: Layers::isotropic_rgb(stack).layers, twin, spectral, three, level, color: material.color }
    }

    /// The exact terms of the form without tables.
    pub(crate) fn full(&self) -> &Exact {
        self.level.as_ref().unwrap_or(&self.three)
    }

    /// The exact terms that the tables approximate.
    pub(crate) fn baked(&self) -> &Exact {
        match self.color {
            ColorMode::Spectral => &self.spectral,
            ColorMode::ThreeWavelengths => &self.three,
        }
    }
}

/// Layers that the weight of a coat or a film leaves bare, if these have lobes of their own.
pub(crate) fn side_of(material: &MaterialEntry) -> Option<Side> {
    let side = material.constants.coat.as_ref()?.side?;
    Some(if side.without_film { Side::Film } else { Side::Coat })
}

/// The stack of a material where a patina or a weight leaves it bare.
pub(crate) fn bare_stack(material: &MaterialEntry, stack: &Stack) -> Stack {
    side_of(material).unwrap_or(Side::Coat).bare(stack)
}

/// The parts of a model that a material chooses.
pub(crate) fn parts(material: &MaterialEntry) -> Parts {
    let (masking, reflectance) = material.parts();
    let diffuse_term = material.constants.diffuse_term;
    let parts = Parts { masking, reflectance, path: material.path_parts(), diffuse_term, ..Parts::PLAIN };
    material.constants.beams.map_or(parts, |beams| {
        let weights = [beams.specular_weight, beams.diffuse_weight];
        parts.with_beams(beams.inner_alpha_ratio, weights, beams.inner_normal, beams.lobe_height)
    })
}

/// Whether the model of a material shows where its first layer, a coat, is not: rows of lobes may be over something else.
pub(crate) fn shows_cover(material: &MaterialEntry) -> bool {
    let varying = material.constants.lobes.and_then(|lobes| lobes.varying);
    material.model.is_path()
        || material.side().is_some()
        || material.model.is_fitted() && varying.is_some_and(|varying| varying.factor.is_cover())
}

/// The varying factor of a material that its rows of lobes span.
fn varying_of(material: &MaterialEntry) -> Option<Varying> {
    let record = material.constants.lobes?.varying?;
    match record.factor {
        VaryingFactor::AlphaFactor => Some(Varying::Alpha),
        VaryingFactor::SlabFactor => Some(Varying::Slab),
        VaryingFactor::FilmFactor => record.factors.map(Varying::Film),
        VaryingFactor::Patina => {
            let PatinaRecord { diffuse_albedo, base_alpha, tarnish, .. } = *material.constants.patina.as_ref()?;
            Some(Varying::Patina(Cover { diffuse_albedo, base_alpha, tarnish }))
        }
        VaryingFactor::WeightFactor => Some(Varying::Patina(Cover::PLAIN)),
        VaryingFactor::Family => record.family.map(|family| Varying::Family(family_of(family))),
    }
}

/// The axes of a family by its record.
pub(crate) fn family_of(record: FamilyRecord) -> Family {
    let FamilyRecord { coat, base, interface, is_metallic, is_tinted, has_lengths, has_tail, sent_back } = record;
    let axis = |SlopesRecord { least, most, nodes }| SlopeAxis { least, most, nodes: nodes as usize };
    let coat = coat.map_or(SlopeAxis { least: 0.0, most: 0.0, nodes: 1 }, axis);
    let (base, interface) = (axis(base), interface as usize);
    Family { coat, base, interface, is_metallic, is_tinted, has_lengths, has_tail, sent_back }
}

/// The model in f64 at exactly the f32 directions that the device gets.
pub(crate) fn evaluate(twin: &Twin, terms: &(impl ShaderTerms + Sync), pairs: &[Pair]) -> Vec<Rgb> {
    pairs.par_iter().map(|&(wi, wo)| twin.eval(terms, wide(wi), wide(wo))).collect()
}
