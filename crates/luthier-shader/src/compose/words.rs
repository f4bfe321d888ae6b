//! Words of the material buffer, by their names in modules.

use luthier_manifest::{LAYER_WORDS, MATERIAL_WORDS};

use crate::identifiers::is_of_word;

/// Header words of a material, as `MaterialConstants::words` lays them out behind the first.
const MATERIAL: [&str; 11] = [
    "layers",
    "phong_diffuse",
    "phong_specular",
    "veil",
    "flakes_grid",
    "flakes_shape",
    "patina",
    "patina_diffuse_albedo",
    "patina_tarnish",
    "glitter_cells",
    "glitter_tilt",
];

/// Words of a layer, as `LayerRecord::words` lays them out.
const LAYER: [&str; 11] = [
    "slopes",
    "tiles",
    "slab",
    "base",
    "ior_n",
    "ior_k",
    "film_ior_n",
    "film_ior_k",
    "film_thickness_waves",
    "tangent",
    "numbers",
];

/// The expression for a word of a layer in `luthier_layer`, which has variables for two of them.
pub(crate) fn layer(word: usize) -> String {
    match LAYER.get(word) {
        Some(&name @ ("tiles" | "slab")) => name.to_owned(),
        _ => format!("luthier_materials[first + {word}u]"),
    }
}

/// The text with the number of each word in place of `$word_NAME`, and counts in place of `$words_material` and `$words_layer`.
///
/// # Panics
/// On an unknown name.
pub(crate) fn numbered(text: &str) -> String {
    let mut parts = text.split("$word_");
    let mut out = parts.next().unwrap_or_default().to_owned();
    for part in parts {
        let end = part.find(|c| !is_of_word(c)).unwrap_or(part.len());
        let (name, rest) = part.split_at(end);
        let number = [&MATERIAL[..], &LAYER].iter().find_map(|words| words.iter().position(|word| *word == name));
        let number = number.unwrap_or_else(|| panic!("no word of the material buffer is `{name}`"));
        out.push_str(&format!("{number}u{rest}"));
    }
    let counts = [("$words_material", MATERIAL_WORDS), ("$words_layer", LAYER_WORDS)];
    counts.iter().fold(out, |out, (place, count)| out.replace(place, &format!("{count}u")))
}

#[cfg(test)]
mod tests {
    use luthier_manifest::{
        Distribution, FlakesRecord, GlitterRecord, LayerKind, LayerRecord, MaterialConstants, PatinaRecord,
    };

    use luthier_lut::TableKind;

    use super::*;

    /// Numbers of the words that differ from those of a record of zeros.
    fn changed<const N: usize>(words: [[f32; 4]; N], without: [[f32; 4]; N]) -> Vec<usize> {
        (0..N).filter(|&i| words[i] != without[i]).collect()
    }

    #[test]
    fn material_words_have_the_numbers_of_the_buffer() {
        let none = MaterialConstants::default();
        let flakes = FlakesRecord { seed: 1, count: 1, tiling: 1.0, spread: 1.0, scale: 1.0, fade_start: 1.0 };
        let bare = LayerRecord::default();
        let (diffuse_albedo, tarnish) = ([1.0; 3], [1.0; 3]);
        let patina = PatinaRecord { extent: 1.0, transition: 1.0, diffuse_albedo, base_alpha: None, tarnish, bare };
        let glitter = GlitterRecord { seed: 1, frequency: 1.0, filled: 1.0, tilt: 1.0 };
        for (names, constants) in [
            (&["phong_diffuse"][..], MaterialConstants { phong_diffuse: [1.0; 3], ..none.clone() }),
            (&["phong_specular"], MaterialConstants { phong_specular: [1.0; 3], ..none.clone() }),
            (&["veil"], MaterialConstants { internal_reflectance: [1.0; 3], upward_loss: 1.0, ..none.clone() }),
            (&["flakes_grid", "flakes_shape"], MaterialConstants { flakes: Some(flakes), ..none.clone() }),
            (
                &["patina", "patina_diffuse_albedo", "patina_tarnish"],
                MaterialConstants { patina: Some(patina), ..none.clone() },
            ),
            (&["glitter_cells", "glitter_tilt"], MaterialConstants { glitter: Some(glitter), ..none.clone() }),
        ] {
            let numbers = changed(constants.words(), none.words()).into_iter().map(|i| format!("{}u", 1 + i));
            let named = names.iter().map(|name| numbered(&format!("$word_{name}")));
            assert_eq!(named.collect::<Vec<_>>(), numbers.collect::<Vec<_>>());
        }
        assert_eq!(numbered("$word_flakes_grid"), format!("{}u", MaterialConstants::FLAKES_WORD));
    }

    #[test]
    fn layer_words_have_the_numbers_of_the_buffer() {
        let none = LayerRecord::default();
        for (name, record) in [
            (
                "tiles",
                LayerRecord {
                    tiles: none.tiles.with([(TableKind::Fresnel, Some(1)), (TableKind::Phase, Some(1))]),
                    ..none.clone()
                },
            ),
            (
                "slab",
                LayerRecord {
                    optical_depth: [1.0; 3],
                    tiles: none.tiles.with([(TableKind::Thickness, Some(1))]),
                    ..none.clone()
                },
            ),
            ("base", LayerRecord { albedo: [1.0; 3], distribution: Distribution::Ggx, ..none.clone() }),
            ("ior_n", LayerRecord { ior_n: [1.0; 3], film_thickness_nm: 1.0, ..none.clone() }),
            ("ior_k", LayerRecord { ior_k: [1.0; 3], film_thickness_max_nm: 1.0, ..none.clone() }),
            (
                "film_ior_n",
                LayerRecord {
                    film_ior_n: [1.0; 3],
                    tiles: none.tiles.with([(TableKind::Film, Some(1))]),
                    ..none.clone()
                },
            ),
            ("film_ior_k", LayerRecord { film_ior_k: [1.0; 3], critical_cot_sq: 1.0, ..none.clone() }),
            (
                "film_thickness_waves",
                LayerRecord {
                    film_thickness_waves: [1.0; 3],
                    tiles: none.tiles.with([(TableKind::Escape, Some(1))]),
                    ..none.clone()
                },
            ),
            ("tangent", LayerRecord { alpha_xy: [1.0; 2], rotation: 1.0, ..none.clone() }),
            ("numbers", LayerRecord { kind: LayerKind::Diffuse, sigma: 1.0, ..none.clone() }),
        ] {
            let numbers: Vec<_> = changed(record.words(), none.words()).iter().map(|i| format!("{i}u")).collect();
            assert_eq!(numbers, [numbered(&format!("$word_{name}"))], "{name}");
        }
        assert_eq!(changed(LayerRecord { alpha: 0.5, ..none.clone() }.words(), none.words()), [0, LAYER_WORDS - 1]);
        assert_eq!(numbered("$word_slopes, $words_layer"), "0u, 11u");
    }
}
