//! The factor on slopes that a page has for its large picture: which looks follow it, and places for their shaders.

use luthier_manifest::{FileEntry, LayerKind, MapEntry, MapSlot, MaterialEntry, VaryingFactor};
use luthier_material::ALPHA_MIN;
use serde::Serialize;

/// Doublings of the slopes at most.
const OCTAVES: f64 = 2.0;

/// The range of factors on the slopes of all interfaces that a look follows.
#[derive(Debug, PartialEq, Serialize)]
#[serde(rename_all = "snake_case")]
pub(crate) enum PageSlopes {
    /// Binary logarithm of the greatest factor that it follows.
    Octaves(f64),
    /// The reason why it follows none, as a sentence.
    Fixed(&'static str),
}

impl PageSlopes {
    pub(crate) fn of(entry: &MaterialEntry) -> Self {
        let mut interfaces = entry.records().filter(|layer| layer.kind != LayerKind::Diffuse).peekable();
        if interfaces.peek().is_none() {
            return Self::Fixed("The material has no interface whose slopes could change.");
        }
        if interfaces.all(|layer| layer.alpha.max(layer.alpha_xy[0]).max(layer.alpha_xy[1]) <= ALPHA_MIN) {
            return Self::Fixed("All interfaces of the material are smooth, and a factor leaves them so.");
        }
        if !entry.model.is_fitted() {
            return Self::Octaves(OCTAVES);
        }
        let varying = entry.constants.lobes.and_then(|lobes| lobes.varying);
        match varying.map(|varying| varying.factor) {
            // Rows over the factor end at 1.
            Some(VaryingFactor::AlphaFactor) => Self::Octaves(0.0),
            _ => Self::Fixed("The model lobes is fitted for one roughness. Under Shown, other models follow."),
        }
    }
}

/// Gives the shader of materials places whose `alpha_factor` is the factor. To the shader, the page is a roughness map of one texel.
pub(crate) fn with_places(materials: &mut [MaterialEntry]) {
    if let Some(first) = materials.first_mut() {
        first.maps.push(MapEntry {
            slot: MapSlot::Roughness,
            layer: None,
            source: String::new(),
            file: FileEntry::default(),
            width: 1,
            height: 1,
            factor: None,
            srgb: false,
            transform: None,
        });
    }
}

#[cfg(test)]
mod tests {
    use luthier_manifest::{LayerRecord, LobesRecord, MaterialConstants, ShadingModel, VaryingRecord};

    use super::*;

    fn entry(model: ShadingModel, kind: LayerKind, alpha: f64) -> MaterialEntry {
        let layer = LayerRecord { kind, alpha, alpha_xy: [alpha; 2], ..LayerRecord::default() };
        MaterialEntry { model, layers: vec![layer], ..MaterialEntry::default() }
    }

    #[test]
    fn what_follows_a_factor_on_slopes() {
        let of = |model, kind, alpha| PageSlopes::of(&entry(model, kind, alpha));
        assert_eq!(of(ShadingModel::Elek, LayerKind::Conductor, 0.2), PageSlopes::Octaves(2.0));
        for fixed in [
            of(ShadingModel::Elek, LayerKind::Conductor, ALPHA_MIN),
            of(ShadingModel::Elek, LayerKind::Diffuse, 0.2),
            of(ShadingModel::Lobes, LayerKind::Dielectric, 0.2),
        ] {
            assert!(matches!(fixed, PageSlopes::Fixed(text) if text.ends_with('.')), "{fixed:?}");
        }
    }

    #[test]
    fn lobes_over_a_factor_follow_it_down() {
        let over = |factor| {
            let varying = Some(VaryingRecord { factor, tiles: 8, least_spread: 0.1, factors: None, family: None });
            let lobes = LobesRecord {
                index: 1.5,
                falloff: [0.0; 2],
                integral: 1.0,
                critical_cot_sq: 0.0,
                critical_width: 0.0,
                critical_plain_share: 0.0,
                lobes: 2,
                inverse_tails: [1.0; 2],
                rise: None,
                short: None,
                reflectance: None,
                varying,
                axes: None,
                painted: None,
                error: None,
            };
            let constants = MaterialConstants { lobes: Some(lobes), ..MaterialConstants::default() };
            PageSlopes::of(&MaterialEntry { constants, ..entry(ShadingModel::Lobes, LayerKind::Dielectric, 0.2) })
        };
        assert_eq!(over(VaryingFactor::AlphaFactor), PageSlopes::Octaves(0.0));
        assert!(matches!(over(VaryingFactor::SlabFactor), PageSlopes::Fixed(_)));
    }
}
