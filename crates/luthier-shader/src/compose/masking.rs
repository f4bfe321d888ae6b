//! The maskings that materials of the model `microfacet` choose beside the default.

use std::collections::BTreeSet;
use std::fmt::Write as _;

use luthier_manifest::{Masking, ModelPart};

use crate::MaterialSet;
use crate::compose::feature::Feature;
use crate::compose::features::Features;
use crate::compose::stacks::is_diffuse;

/// The word for a masking.
pub(crate) fn word(masking: Masking) -> Feature {
    match masking {
        Masking::Smith => Feature::MaskSmith,
        Masking::SmithSeparable => Feature::MaskSmithSeparable,
        Masking::SchlickSmith => Feature::MaskSchlickSmith,
        Masking::VCavity => Feature::MaskVCavity,
        Masking::Kelemen => Feature::MaskKelemen,
        Masking::Implicit => Feature::MaskImplicit,
    }
}

/// The maskings of the lobes of a set.
pub(crate) fn used(set: &MaterialSet<'_>) -> BTreeSet<Masking> {
    let materials = set.materials.iter().filter(|material| material.model.takes(ModelPart::Masking));
    let first = materials.filter_map(|material| material.layers.first());
    first.filter(|layer| !is_diffuse(layer)).map(|layer| layer.masking).collect()
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

/// `luthier_masking` and its functions; nothing if all lobes of a set have the default.
pub(crate) fn module(set: &MaterialSet<'_>, features: &Features) -> String {
    let used = used(set);
    let Some(last) = used.last().filter(|_| features.has(Feature::Masked)) else { return String::new() };
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

#[cfg(test)]
mod tests {
    use luthier_manifest::{LayerKind, LayerRecord, Manifest, MaterialEntry, Reflectance, ReflectanceCurve};

    use crate::{Form, MaterialSet, Target, emit};

    use luthier_manifest::ShadingModel;

    use super::*;

    fn text(layers: &[LayerRecord]) -> String {
        let material = |(number, layer): (usize, &LayerRecord)| MaterialEntry {
            name: format!("m{number}"),
            model: ShadingModel::Microfacet,
            layers: vec![layer.clone()],
            ..MaterialEntry::default()
        };
        let materials = layers.iter().enumerate().map(material).collect();
        emit(&MaterialSet::from_manifest(&Manifest::new("test", materials, Vec::new())), Form::Full, Target::Wgsl)
            .unwrap()
    }

    fn metal(masking: Masking) -> LayerRecord {
        let kind = LayerKind::Conductor;
        LayerRecord {
            kind,
            alpha: 0.3,
            alpha_xy: [0.3; 2],
            ior_n: [0.2; 3],
            ior_k: [3.0; 3],
            masking,
            ..LayerRecord::default()
        }
    }

    #[test]
    fn a_set_has_the_maskings_that_it_uses() {
        let plain = text(&[metal(Masking::Smith)]);
        assert!(!["luthier_masking", "masking:", "& 3u"].iter().any(|word| plain.contains(word)), "{plain}");
        for masking in Masking::ALL {
            let alone = text(&[metal(masking)]);
            assert!(alone.contains(if masking == Masking::Smith { "luthier_lambda" } else { expression(masking) }));
            assert!(!alone.contains("layer.masking"), "{alone}");
        }
        let all = text(&Masking::ALL.map(metal));
        assert!(Masking::ALL.iter().all(|masking| all.contains(expression(*masking))), "{all}");
        assert_eq!(all.matches("if layer.masking == ").count(), Masking::ALL.len() - 1);
    }

    #[test]
    fn a_set_has_the_reflectances_that_it_uses() {
        let fitted = |reflectance| LayerRecord {
            reflectance,
            curve: Some(ReflectanceCurve { f0: [0.5; 3], weight: [0.1; 3], exponent: [6.0; 3] }),
            ..metal(Masking::Smith)
        };
        let [approximate, lazanyi] = [Reflectance::Approximate, Reflectance::Lazanyi].map(fitted);
        let alone = text(std::slice::from_ref(&approximate));
        let words = ["luthier_normal_index", "pow(", "layer.reflectance", "ior_n"];
        assert!(!words.iter().any(|word| alone.contains(word)), "{alone}");
        let both = text(&[approximate, lazanyi.clone()]);
        assert!(both.contains("pow(") && !both.contains("layer.reflectance"), "{both}");
        let mixed = text(&[lazanyi, metal(Masking::Smith)]);
        assert!(mixed.contains("luthier_fresnel_fitted(") && mixed.contains("if layer.reflectance > 1u"), "{mixed}");
    }
}
