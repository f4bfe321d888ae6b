//! The material buffer that shaders read.

use luthier_lut::TableKind;

use crate::constants::MaterialConstants;
use crate::material::MaterialEntry;
use crate::record::{LAYER_WORDS, LayerRecord, whole};

/// `vec4` words of a material's header in the material buffer: as many as a layer has, so that both are blocks of one size.
pub const MATERIAL_WORDS: usize = LAYER_WORDS;

/// The material buffer: [`MATERIAL_WORDS`] header words per material, then [`LAYER_WORDS`] words per layer, in order; after the
/// layers of a material with patina, or with a coat that has a weight, the layer of [`MaterialConstants::bare`].
///
/// Where such a coat has a [`MaterialEntry::side`], the header of the side follows this layer, and then its layers. Headers and layers have as many
/// words, so that functions for a material by its number take the side by the number of the block that its header is. In place of the model's number this
/// header has the weight of the coat.
///
/// Whole numbers n that shaders count with, here and the kind of a layer, are 2^23 + n: the low 23 bits of such an f32 are n, and no
/// conversion is needed.
///
/// | header word | x, y, z, w |
/// |---|---|
/// | 0 | index of its first layer's first word, number of layers, number of the model, number of its tile of lobes or 0 |
/// | 1-10 | see [`MaterialConstants::words`] |
pub fn material_buffer(materials: &[MaterialEntry]) -> Vec<[f32; 4]> {
    let mut words = Vec::new();
    let mut first = materials.len() * MATERIAL_WORDS;
    for material in materials {
        let lobes = material.layers.first().and_then(|layer| layer.tiles[TableKind::Lobes]).unwrap_or(0);
        let model = material.model.number() as usize;
        words.push([whole(first), whole(material.layers.len()), whole(model), lobes as f32]);
        extend_with_constants(&mut words, &material.constants);
        first += material.blocks() * LAYER_WORDS;
    }
    for material in materials {
        words.extend(material.records().flat_map(LayerRecord::words));
        if let (Some(side), Some(coat)) = (material.side(), &material.constants.coat) {
            let (first, lobes) = (words.len() + MATERIAL_WORDS, coat.bare.tiles[TableKind::Lobes].unwrap_or(0));
            words.push([whole(first), whole(side.layers.len()), coat.weight as f32, lobes as f32]);
            extend_with_constants(&mut words, &side.constants);
            words.extend(side.layers.iter().flat_map(LayerRecord::words));
        }
    }
    words
}

/// The rest of a header behind its first word: the constants, and zeros up to the size of a block.
fn extend_with_constants(words: &mut Vec<[f32; 4]>, constants: &MaterialConstants) {
    words.extend(constants.words());
    words.extend([[0.0; 4]; UNUSED]);
}

/// Words of a header that hold nothing, where a layer has more; a header that has more than a layer does not compile.
const UNUSED: usize = MATERIAL_WORDS - 1 - MaterialConstants::WORDS;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{CoatRecord, LayerKind, LobesRecord, PatinaRecord, ShadingModel, SideRecord};

    fn layer(kind: LayerKind) -> LayerRecord {
        LayerRecord { kind, alpha: 2.0, eta: 4.0, ior_n: [10.0, 11.0, 12.0], ..LayerRecord::default() }
    }

    #[test]
    fn headers_point_at_the_layers() {
        let [top, middle, base] = [LayerKind::Dielectric, LayerKind::Conductor, LayerKind::Diffuse].map(layer);
        let material = |model, layers| MaterialEntry { model, layers, ..MaterialEntry::default() };
        let materials = [
            material(ShadingModel::Elek, vec![top, base]),
            material(ShadingModel::Phong, Vec::new()),
            material(ShadingModel::Microfacet, vec![middle]),
        ];
        let buffer = material_buffer(&materials);
        let headers: Vec<[f32; 4]> = buffer[..3 * MATERIAL_WORDS].iter().step_by(MATERIAL_WORDS).copied().collect();
        let whole = |word: f32| word.to_bits() & 0x7f_ffff;
        let numbers: Vec<[u32; 3]> = headers.iter().map(|[x, y, z, _]| [x, y, z].map(|word| whole(*word))).collect();
        assert_eq!(numbers, [[33, 2, 0], [55, 0, 5], [55, 1, 6]]);
        assert_eq!(buffer.len(), 3 * MATERIAL_WORDS + 3 * LAYER_WORDS);
        for (header, material) in numbers.iter().zip(&materials) {
            let first = header[0] as usize;
            let words: Vec<[f32; 4]> = material.layers.iter().flat_map(LayerRecord::words).collect();
            assert_eq!(buffer[first..first + words.len()], words);
        }
        assert!(material_buffer(&[]).is_empty());
    }

    #[test]
    fn the_bare_layer_of_a_patina_follows_the_others() {
        let [top, base, bare] = [LayerKind::Dielectric, LayerKind::Conductor, LayerKind::Diffuse].map(layer);
        let patina = PatinaRecord {
            extent: 0.5,
            transition: 0.5,
            diffuse_albedo: [0.0; 3],
            base_alpha: None,
            tarnish: [1.0; 3],
            bare: bare.clone(),
        };
        let constants = MaterialConstants { patina: Some(patina), ..MaterialConstants::default() };
        let grown = MaterialEntry { layers: vec![top.clone(), base], constants, ..MaterialEntry::default() };
        let plain = MaterialEntry { layers: vec![top.clone()], ..MaterialEntry::default() };
        let buffer = material_buffer(&[grown, plain]);
        let first = 2 * MATERIAL_WORDS;
        assert_eq!(buffer[0][..2], [first, 2].map(whole));
        assert_eq!(buffer[first + 2 * LAYER_WORDS..][..LAYER_WORDS], bare.words());
        assert_eq!(buffer[MATERIAL_WORDS][0], whole(first + 3 * LAYER_WORDS));
        assert_eq!(buffer[first + 3 * LAYER_WORDS..], top.words());
    }
    #[test]
    fn the_side_of_a_coat_is_a_material_behind_its_layers() {
        let [top, middle, base] = [LayerKind::Dielectric, LayerKind::Dielectric, LayerKind::Diffuse].map(layer);
        let mut bare = layer(LayerKind::Conductor);
        bare.tiles[TableKind::Lobes] = Some(7);
        let lobes = LobesRecord {
            index: 1.25,
            falloff: [0.5, 0.75],
            integral: 1.0,
            critical_cot_sq: 0.0,
            critical_width: 0.0,
            critical_plain_share: 0.0,
            lobes: 1,
            inverse_tails: [2.0, 0.0],
            rise: None,
            short: None,
            reflectance: None,
            varying: None,
            axes: None,
            painted: None,
            error: None,
        };
        let side = Some(SideRecord { lobes: Some(lobes), without_film: false });
        let coat = Some(CoatRecord { weight: 0.25, bare: bare.clone(), side });
        let constants = MaterialConstants { lobes: Some(lobes), coat, ..MaterialConstants::default() };
        let model = ShadingModel::Lobes;
        let layers = vec![top.clone(), middle, base.clone()];
        let coated = MaterialEntry { model, layers, constants, ..MaterialEntry::default() };
        let plain = MaterialEntry { layers: vec![top.clone()], ..MaterialEntry::default() };
        let buffer = material_buffer(&[coated.clone(), plain]);
        // Two headers, three layers, the bare one, the header of the side, its two layers, and the layer of the other material.
        let blocks: Vec<&[[f32; 4]]> = buffer.chunks(LAYER_WORDS).collect();
        assert_eq!((blocks.len(), coated.blocks()), (10, 7));
        assert_eq!([blocks[5], blocks[7], blocks[8]], [&bare.words()[..], &bare.words(), &base.words()]);
        assert_eq!(blocks[6][0], [whole(7 * LAYER_WORDS), whole(2), 0.25, 7.0]);
        let alone = MaterialConstants { lobes: Some(lobes), ..MaterialConstants::default() };
        assert_eq!(blocks[6][1..], alone.words());
        assert_eq!(blocks[1][0][0], whole(9 * LAYER_WORDS));
        assert_eq!(blocks[9], top.words());
        // Without a film the side has all layers.
        let mut filmed = coated;
        let side = filmed.constants.coat.as_mut().and_then(|coat| coat.side.as_mut()).unwrap();
        side.without_film = true;
        assert_eq!((filmed.side().unwrap().layers[1..].len(), filmed.blocks()), (2, 8));
    }
}
