//! Interfaces of a material for which the shader of its model reads a table. Baker, emitter and judge go by this one function.

use luthier_lut::TableKind;
use luthier_model::{Reach, ReadWhen, Reflectance, ShadingModel};

use crate::record::{LayerKind, LayerRecord};

/// Whether the `baked` shader of a model reads a kind of table for a layer of a stack, by the layer's number. If the kind is optional, a layer
/// may have no tile, and the shader computes the function.
pub fn reads(model: ShadingModel, kind: TableKind, layers: &[LayerRecord], number: usize) -> bool {
    let facts = model.facts();
    let is_interface = layers.get(number).is_some_and(|layer| layer.kind != LayerKind::Diffuse);
    let is_reached = number == 0 || facts.reach == Reach::All;
    let mut read = facts.tables.iter().filter(|table| table.kind == kind);
    is_interface && read.any(|table| (is_reached || is_beyond(table.when)) && is_met(table.when, layers, number))
}

/// Whether a condition is of interfaces that a model does not reach by itself: rows of lobes take the film of the lowest.
fn is_beyond(when: ReadWhen) -> bool {
    matches!(when, ReadWhen::OverF0 | ReadWhen::VaryingOverF0)
}

/// Whether the condition of a table holds for an interface, by its number.
fn is_met(when: ReadWhen, layers: &[LayerRecord], number: usize) -> bool {
    let layer = &layers[number];
    let is_tabled = layer.reflectance == Reflectance::Table;
    let has_film = layer.film_ior_n[0] > 0.0;
    let has_film_tile = layer.varies() || layer.has_film_over_f0();
    match when {
        ReadWhen::Always => true,
        ReadWhen::Tabled => is_tabled,
        ReadWhen::Steady => is_tabled && !has_film_tile,
        ReadWhen::Varying => is_tabled && layer.varies() && !layer.has_film_over_f0(),
        ReadWhen::FirstVarying => layer.varies() && number == 0,
        ReadWhen::Filmed => has_film,
        ReadWhen::OverF0 => layer.has_film_over_f0(),
        ReadWhen::VaryingOverF0 => layer.has_film_over_f0() && layer.varies() && number > 0,
        ReadWhen::BareConductor => !has_film && layer.kind == LayerKind::Conductor,
        ReadWhen::DenserCoat => {
            let is_below = layers.get(number + 1).is_some_and(|below| below.kind != LayerKind::Diffuse);
            is_tabled && layer.kind == LayerKind::Dielectric && layer.eta > 1.0 && is_below
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn layer(kind: LayerKind, eta: f64) -> LayerRecord {
        LayerRecord { kind, eta, ..LayerRecord::default() }
    }

    /// A coat under a film that varies.
    fn varying() -> LayerRecord {
        let film = LayerRecord { film_ior_n: [1.4; 3], film_thickness_nm: 300.0, ..layer(LayerKind::Dielectric, 1.5) };
        LayerRecord { film_thickness_max_nm: 400.0, ..film }
    }

    /// A coat and a metal whose reflectances have no tables.
    #[test]
    fn reflectances_that_are_computed_have_no_rows() {
        for reflectance in [Reflectance::Exact, Reflectance::Approximate, Reflectance::Lazanyi] {
            let computed = |record: LayerRecord| LayerRecord { reflectance, ..record };
            let layers = [computed(layer(LayerKind::Dielectric, 1.5)), computed(layer(LayerKind::Conductor, 1.0))];
            for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie] {
                assert_eq!([0, 1].map(|number| read_by(model, &layers, number)), ["distribution"; 2]);
            }
            for model in [ShadingModel::Belcour, ShadingModel::Yamaguchi] {
                assert_eq!([0, 1].map(|number| read_by(model, &layers, number)), [""; 2]);
            }
        }
        let film = LayerRecord { reflectance: Reflectance::Exact, ..varying() };
        assert_eq!(read_by(ShadingModel::Microfacet, &[film], 0), "distribution thickness");
    }

    /// A base under a film that varies over the F0 of a place.
    fn over_f0() -> LayerRecord {
        LayerRecord { f0: Some([0.5; 3]), ..varying() }
    }

    fn read_by(model: ShadingModel, layers: &[LayerRecord], number: usize) -> String {
        let kinds = TableKind::ALL.into_iter().filter(|&kind| reads(model, kind, layers, number));
        kinds.map(TableKind::name).collect::<Vec<_>>().join(" ")
    }

    /// Tables by model, stack and layer, filled in by hand from the modules of the shaders.
    #[test]
    fn models_read_what_their_shaders_call() {
        use ShadingModel::{Belcour, Elek, GranierHeidrich, Lobes, Microfacet, Phong, WeidlichWilkie, Yamaguchi};
        let (coat, down) = (|| layer(LayerKind::Dielectric, 1.5), || layer(LayerKind::Dielectric, 0.8));
        let (metal, diffuse) = (|| layer(LayerKind::Conductor, 1.0), || layer(LayerKind::Diffuse, 1.0));
        let chains: &[ShadingModel] = &[Elek, WeidlichWilkie];
        let statistical: &[ShadingModel] = &[Belcour, Yamaguchi];
        for (models, layers, expected) in [
            (chains, vec![coat(), metal()], ["fresnel distribution", "fresnel distribution"]),
            (chains, vec![varying(), diffuse()], ["distribution thickness film", ""]),
            (chains, vec![coat(), varying()], ["fresnel distribution", "distribution film"]),
            (&[Microfacet], vec![coat(), metal()], ["fresnel distribution", ""]),
            (&[Phong], vec![coat(), metal()], ["", ""]),
            (&[Lobes], vec![coat(), metal()], ["fresnel distribution lobes", ""]),
            (&[Lobes], vec![varying(), diffuse()], ["distribution thickness film lobes", ""]),
            (&[Lobes], vec![diffuse()], ["", ""]),
            (&[Lobes], vec![over_f0(), diffuse()], ["distribution phase thickness lobes", ""]),
            (&[Lobes], vec![coat(), over_f0()], ["fresnel distribution lobes", "phase thickness"]),
            (statistical, vec![coat(), metal()], ["fgd escape", "fgd"]),
            (statistical, vec![down(), metal()], ["fgd", "fgd"]),
            (statistical, vec![layer(LayerKind::Dielectric, 1.0), metal()], ["fgd", "fgd"]),
            (statistical, vec![varying(), diffuse()], ["fgd", ""]),
            (statistical, vec![metal()], ["fgd", ""]),
            (&[GranierHeidrich], vec![coat(), metal()], ["", ""]),
            (&[GranierHeidrich], vec![metal()], ["fresnel", ""]),
            (&[GranierHeidrich], vec![varying(), diffuse()], ["phase thickness", ""]),
            (&[GranierHeidrich], vec![coat(), varying()], ["", ""]),
        ] {
            for &model in models {
                let found = [0, 1].map(|number| read_by(model, &layers, number));
                assert_eq!(found, expected, "{model} {layers:?}");
            }
        }
        for model in ShadingModel::ALL {
            assert_eq!(model.is_statistical(), statistical.contains(&model));
            assert_eq!(
                model.reads_some(TableKind::Distribution),
                [Elek, WeidlichWilkie, Microfacet, Lobes].contains(&model)
            );
        }
    }
}
