//! The maskings that materials of the model `microfacet` choose beside the default.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use luthier_manifest::{LayerKind, Masking, ShadingModel};

use crate::MaterialSet;
use crate::compose::features::Features;

/// The word for a masking that a set uses.
pub(crate) fn word(masking: Masking) -> &'static str {
    match masking {
        Masking::Smith => "mask_smith",
        Masking::SmithSeparable => "mask_smith_separable",
        Masking::SchlickSmith => "mask_schlick_smith",
        Masking::VCavity => "mask_v_cavity",
        Masking::Kelemen => "mask_kelemen",
        Masking::Implicit => "mask_implicit",
    }
}

/// The maskings of the lobes of a set.
pub(crate) fn used(set: &MaterialSet<'_>) -> BTreeSet<Masking> {
    let materials = set.materials.iter().filter(|material| material.model == ShadingModel::Microfacet);
    let first = materials.filter_map(|material| material.layers.first());
    first.filter(|layer| layer.kind != LayerKind::Diffuse).map(|layer| layer.masking).collect()
}

/// G of two directions. `bisector` is their sum, whose squared length is four times the squared cosine of theta_d; half its height over that
/// cosine is the cosine of theta_h.
fn expression(masking: Masking) -> &'static str {
    match masking {
        Masking::Smith => "1.0 / (1.0 + luthier_lambda(layer, wi) + luthier_lambda(layer, wo))",
        Masking::SmithSeparable => "1.0 / ((1.0 + luthier_lambda(layer, wi)) * (1.0 + luthier_lambda(layer, wo)))",
        Masking::SchlickSmith => "luthier_schlick_masking(layer, wi.z) * luthier_schlick_masking(layer, wo.z)",
        Masking::VCavity => "min(4.0 * bisector.z * min(wi.z, wo.z) / length_sq, 1.0)",
        Masking::Kelemen => "min(4.0 * wi.z * wo.z / length_sq, 1.0)",
        Masking::Implicit => "wi.z * wo.z",
    }
}

/// `luthier_masking`, and what it calls; nothing where all lobes of a set have the default.
pub(crate) fn module(set: &MaterialSet<'_>, features: &Features) -> String {
    let used = used(set);
    let Some(last) = used.last().filter(|_| features.has("masked")) else { return String::new() };
    let mut out = include_str!("../wgsl/interface/schlick_masking.wgsl").to_owned();
    out.push_str(
        "\n/// Masking and shadowing of a layer, as its material has it: the part of the facets that both directions see.\n\
         fn luthier_masking(layer: LuthierLayer, wi: vec3<f32>, wo: vec3<f32>, bisector: vec3<f32>, length_sq: f32) -> f32 {\n",
    );
    for masking in used.iter().filter(|masking| *masking != last) {
        let (number, title, value) = (masking.number(), masking.title(), expression(*masking));
        let _ = write!(out, "    // {title}.\n    if layer.masking == {number}u {{\n        return {value};\n    }}\n");
    }
    let _ = write!(out, "    // {}.\n    return {};\n}}\n", last.title(), expression(*last));
    out
}
