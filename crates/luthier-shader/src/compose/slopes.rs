//! Distributions of slopes in closed form, for a set with others than those of Beckmann and of GGX.

use std::fmt::Write as _;

use crate::compose::feature::Feature;
use crate::compose::features::Features;

/// Distributions by their features: number in the buffer, and pi alpha^2 D of squares of the half vector.
const FORMS: [(Feature, u32, &str); 5] = [
    (Feature::Beckmann, 0, "luthier_beckmann(falloff, z_sq, across_sq)"),
    (Feature::Ggx, 1, "luthier_ggx(falloff, z_sq, across_sq)"),
    (Feature::Blinn, 2, "luthier_blinn(falloff, z_sq, across_sq)"),
    (Feature::Abc, 3, "luthier_abc(layer.shape, falloff, z_sq, across_sq)"),
    (Feature::Sgd, 4, "luthier_sgd(layer.shape, falloff, z_sq, across_sq)"),
];

/// Statements that return D of a layer; they choose by its distribution if a set has several.
pub(crate) fn returned(features: &Features) -> String {
    let used: Vec<_> = FORMS.iter().filter(|(name, ..)| features.has(*name)).collect();
    let mut out = String::new();
    for (i, (_, number, value)) in used.iter().enumerate().rev() {
        // From the highest number down, each distribution takes one comparison.
        let _ = match i {
            0 => writeln!(out, "    return {value};"),
            _ => writeln!(
                out,
                "    if layer.distribution > {:.1} {{\n        return {value};\n    }}",
                f64::from(*number) - 0.5
            ),
        };
    }
    out
}

#[cfg(test)]
mod tests {
    use luthier_manifest::{Distribution, LayerKind, LayerRecord, Manifest, Masking, MaterialEntry, ShadingModel};
    use luthier_optics::ndf::Shape;

    use crate::{Form, MaterialSet, Target, emit};

    fn text(distributions: &[Distribution]) -> String {
        let metal = |distribution| LayerRecord {
            kind: LayerKind::Conductor,
            distribution,
            alpha: 0.3,
            alpha_xy: [0.3; 2],
            ior_n: [0.2; 3],
            ior_k: [3.0; 3],
            masking: Masking::VCavity,
            ..LayerRecord::default()
        };
        let material = |(i, distribution): (usize, &Distribution)| MaterialEntry {
            name: format!("m{i}"),
            model: ShadingModel::Microfacet,
            layers: vec![metal(*distribution)],
            ..MaterialEntry::default()
        };
        let materials = distributions.iter().enumerate().map(material).collect();
        emit(&MaterialSet::from_manifest(&Manifest::new("test", materials, Vec::new())), Form::Full, Target::Wgsl)
            .unwrap()
    }

    #[test]
    fn a_set_has_the_distributions_that_it_uses() {
        let all = [
            Distribution::Beckmann,
            Distribution::Ggx,
            Distribution::Blinn,
            Distribution::Abc(Shape::abc(100.0, 1.5).unwrap()),
            Distribution::Sgd(Shape::sgd(0.1, 0.8).unwrap()),
        ];
        let calls = |text: &str| all.map(|d| text.matches(&format!("luthier_{}(", d.name())).count());
        for (i, distribution) in all.iter().enumerate() {
            let alone = text(&[*distribution]);
            // The function, and its call.
            assert_eq!(calls(&alone), [0, 1, 2, 3, 4].map(|other| if other == i { 2 } else { 0 }), "{alone}");
            assert!(!alone.contains("layer.distribution"), "{alone}");
        }
        let whole = text(&all);
        assert_eq!((calls(&whole), whole.matches("if layer.distribution > ").count()), ([2; 5], 4), "{whole}");
        let plain = text(&all[..2]);
        assert!(!plain.contains("shape") && !plain.contains("luthier_log2"), "{plain}");
    }
}
