//! Which tables the shader of a model reads: the one list that the baker, the emitter and the judge go by.

use luthier_lut::TableKind;

use crate::{LayerKind, LayerRecord, ShadingModel};

impl ShadingModel {
    /// Whether the model follows light through the layers as statistics of lobes.
    pub fn is_statistical(self) -> bool {
        matches!(self, Self::Belcour | Self::Yamaguchi)
    }

    /// Whether its `baked` shader reads D from a table, where there is one.
    pub fn reads_distribution(self) -> bool {
        matches!(self, Self::Elek | Self::WeidlichWilkie | Self::Microfacet)
    }

    /// Whether the `baked` shader of the model reads a kind of table for a layer of a stack, by the layer's number. For layers without a
    /// tile it does without the kinds that are optional.
    pub fn reads(self, kind: TableKind, layers: &[LayerRecord], number: usize) -> bool {
        let Some(layer) = layers.get(number).filter(|layer| layer.kind != LayerKind::Diffuse) else { return false };
        let has_film = layer.film_ior_n[0] > 0.0;
        match self {
            Self::Phong => false,
            // They look at the first layer alone.
            Self::Microfacet | Self::GranierHeidrich if number > 0 => false,
            Self::Elek | Self::WeidlichWilkie | Self::Microfacet => match kind {
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
