//! Which tables the shader of a model reads: the one list that the baker, the emitter and the judge go by.

use luthier_lut::TableKind;

use crate::{LayerKind, LayerRecord, Reflectance, ShadingModel};

impl ShadingModel {
    /// Whether the model follows light through the layers as statistics of lobes.
    pub fn is_statistical(self) -> bool {
        matches!(self, Self::Belcour | Self::Yamaguchi)
    }

    /// Whether its `baked` shader reads D from a table, where there is one.
    pub fn reads_distribution(self) -> bool {
        matches!(self, Self::Elek | Self::WeidlichWilkie | Self::Microfacet | Self::Lobes)
    }

    /// Whether the `baked` shader of the model reads a kind of table for a layer of a stack, by the layer's number. For layers without a
    /// tile it does without the kinds that are optional.
    pub fn reads(self, kind: TableKind, layers: &[LayerRecord], number: usize) -> bool {
        let Some(layer) = layers.get(number).filter(|layer| layer.kind != LayerKind::Diffuse) else { return false };
        let has_film = layer.film_ior_n[0] > 0.0;
        match self {
            Self::Phong => false,
            // They look at the first layer alone.
            Self::Microfacet | Self::GranierHeidrich | Self::Lobes if number > 0 => false,
            Self::Elek | Self::WeidlichWilkie | Self::Microfacet | Self::Lobes => match kind {
                TableKind::Lobes => self == Self::Lobes,
                TableKind::Fresnel | TableKind::Film if layer.reflectance != Reflectance::Table => false,
                TableKind::Fresnel => !layer.varies(),
                TableKind::Film => layer.varies(),
                TableKind::Thickness => layer.varies() && number == 0,
                TableKind::Distribution => true,
                _ => false,
            },
            Self::Belcour | Self::Yamaguchi => match kind {
                TableKind::Fgd => true,
                // Part of the lobes of an interface below is totally reflected where it would leave a denser medium.
                TableKind::Escape => {
                    let is_below = layers.get(number + 1).is_some_and(|below| below.kind != LayerKind::Diffuse);
                    layer.kind == LayerKind::Dielectric && layer.eta > 1.0 && is_below
                }
                _ => false,
            },
            // Transparent interfaces without a film are Schlick's form.
            Self::GranierHeidrich => match kind {
                TableKind::Phase | TableKind::Thickness => has_film,
                TableKind::Fresnel => !has_film && layer.kind == LayerKind::Conductor,
                _ => false,
            },
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
                assert_eq!([0, 1].map(|number| read(model, &layers, number)), ["distribution"; 2]);
            }
        }
        let film = LayerRecord { reflectance: Reflectance::Exact, ..varying() };
        assert_eq!(read(ShadingModel::Microfacet, &[film], 0), "distribution thickness");
    }

    fn read(model: ShadingModel, layers: &[LayerRecord], number: usize) -> String {
        let kinds = TableKind::ALL.into_iter().filter(|&kind| model.reads(kind, layers, number));
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
                let found = [0, 1].map(|number| read(model, &layers, number));
                assert_eq!(found, expected, "{model} {layers:?}");
            }
        }
        for model in ShadingModel::ALL {
            assert_eq!(model.is_statistical(), statistical.contains(&model));
            assert_eq!(model.reads_distribution(), [Elek, WeidlichWilkie, Microfacet, Lobes].contains(&model));
        }
    }
}
