//! Words of other formats (glTF 2.0, OpenPBR, Standard Surface, Disney's model), and the words of material files for them.

use super::table::Table;

const HOST: &str = "the program that draws the surface adds it: a material says how light is reflected";
const EMISSION: &str = "light that a surface gives off is the host's business: add it to what the shader returns";
const COVERAGE: &str = "which places are covered is the host's business: mask or blend what the shader returns";
const TRANSMISSION: &str =
    "light that passes through is the host's business; a last layer of `type = \"dielectric\"` reflects as glass does";
const SUBSURFACE: &str = "light that travels sideways is not simulated: a layer of `type = \"diffuse\"` stands for it";
const SHEEN: &str = "sheen is not a layer yet: leave it out";
const COAT: &str =
    "a coat is a layer of its own: write a `[[layer]]` of `type = \"dielectric\"` above, with its `weight`";
const FILM: &str = "a film is a layer of its own: write a `[[layer]]` of `type = \"thin-film\"` above";
const ANISOTROPY: &str = "write `alpha_x` and `alpha_y`, and `rotation_deg` to turn them";
const GLOSS: &str = "write `roughness`, which is 1 less the gloss";
const MAP: &str = "textures stand in the table `maps` of a layer, such as `maps = { normal = \"n.png\" }`";
const PLASTIC: &str = "write a `[[layer]]` of `type = \"dielectric\"`, and one of `type = \"diffuse\"` below";

/// Beginnings of words without case and underscores, and what to do; the first that fits counts.
const KEYS: [(&str, &str); 27] = [
    ("emissi", EMISSION),
    ("opacity", COVERAGE),
    ("geometryopacity", COVERAGE),
    ("transparency", COVERAGE),
    ("alphamode", COVERAGE),
    ("alphacutoff", COVERAGE),
    ("transmission", TRANSMISSION),
    ("volume", TRANSMISSION),
    ("attenuation", "write `absorption_per_um` and `thickness_um` of the dielectric that absorbs"),
    ("subsurface", SUBSURFACE),
    ("sss", SUBSURFACE),
    ("sheen", SHEEN),
    ("fuzz", SHEEN),
    ("clearcoat", COAT),
    ("coat", COAT),
    ("iridescence", FILM),
    ("thinfilm", FILM),
    ("anisotrop", ANISOTROPY),
    ("specularanisotrop", ANISOTROPY),
    ("gloss", GLOSS),
    ("smoothness", GLOSS),
    ("normalmap", MAP),
    ("normaltexture", MAP),
    ("bumpmap", MAP),
    ("displacement", "heights that move the surface are the host's business; a normal map stands in `maps`"),
    ("occlusion", HOST),
    ("ambientocclusion", HOST),
];

/// Types of layers of other formats.
const TYPES: [(&str, &str); 24] = [
    ("sheen", SHEEN),
    ("fuzz", SHEEN),
    ("cloth", SHEEN),
    ("velvet", SHEEN),
    ("emissi", EMISSION),
    ("transmission", TRANSMISSION),
    ("subsurface", SUBSURFACE),
    ("sss", SUBSURFACE),
    ("clearcoat", "write `type = \"dielectric\"`"),
    ("coat", "write `type = \"dielectric\"`"),
    ("varnish", "write `type = \"dielectric\"`"),
    ("glass", "write `type = \"dielectric\"`"),
    ("metal", "write `type = \"conductor\"`"),
    ("lambert", "write `type = \"diffuse\"`"),
    ("orennayar", "write `type = \"diffuse\"`, with a `sigma`"),
    ("plastic", PLASTIC),
    ("film", "write `type = \"thin-film\"`"),
    ("iridescence", "write `type = \"thin-film\"`"),
    ("pbr", ENGINE),
    ("principled", ENGINE),
    ("disney", ENGINE),
    ("openpbr", ENGINE),
    ("standard", ENGINE),
    ("gltf", ENGINE),
];

const ENGINE: &str =
    "`type = \"metallic-roughness\"` is the usual surface of engines; coats and films are layers above it";

fn of(list: &[(&str, &'static str)], word: &str) -> Option<&'static str> {
    let plain: String = word.chars().filter(|c| c.is_alphanumeric()).flat_map(char::to_lowercase).collect();
    list.iter().find(|(beginning, _)| plain.starts_with(beginning)).map(|(_, advice)| *advice)
}

/// Advice on a key that a table lacks and has other words for.
pub(crate) fn here(table: &Table, name: &str) -> Option<&'static str> {
    match (table.name, name) {
        ("dielectric", "color" | "colour" | "base_color") => Some(
            "a coat takes its colour from `absorption_per_um` and `thickness_um`; a base of colour is a layer below",
        ),
        ("conductor-maps", "base_color" | "metallic" | "albedo") => {
            Some("a picture of the colours of a metal is a map of its `f0`")
        }
        ("dielectric", "f82_tint") => {
            Some("an edge tint is for metals: `conductor` with an `f0`, or `metallic-roughness`")
        }
        ("diffuse-maps", "base_color") => Some("write `albedo`"),
        ("metallic-roughness" | "conductor" | "diffuse", "darkening") => {
            Some("a coat darkens what lies below it: write `darkening = false` in the `[[layer]]` of the coat above")
        }
        ("metallic-roughness", "specular_color" | "edge_color" | "edge_tint" | "specularColor") => {
            Some("the tint of a metal's edge is `f82_tint`; without metal its F0 is `f0`")
        }
        ("metallic-roughness", "ior" | "specular") => {
            Some("its F0 without metal is `f0`, 0.04 if absent: ((n - 1) / (n + 1))^2 for an index of n")
        }
        _ => None,
    }
}

/// Advice on a key that no table has.
pub(crate) fn key(name: &str) -> Option<&'static str> {
    of(&KEYS, name)
}

/// Advice on a `type` that no layer has.
pub(crate) fn kind(text: &str) -> Option<&'static str> {
    of(&TYPES, text)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_are_known_in_any_writing() {
        for word in ["emission", "emissive", "emissiveFactor", "emissive_strength", "Emission_Color"] {
            assert_eq!(of(&KEYS, word), Some(EMISSION), "{word}");
        }
        assert_eq!(of(&KEYS, "clearcoatRoughnessFactor"), Some(COAT));
        assert_eq!(of(&KEYS, "roughness"), None);
        assert_eq!((kind("Sheen"), kind("oren-nayar").is_some(), kind("difuse")), (Some(SHEEN), true, None));
    }
}
