//! Materials for each map and for pairs of maps.

use luthier_material::{Material, parse};

const COAT: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nroughness = 0.3\nthickness_um = 100\nabsorption_per_um = [0.0006, 0.004, 0.016]\n";
const VARNISH: &str = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\nthickness_um = 20\nabsorption_per_um = [0.01, 0.02, 0.05]\n";
const FILM: &str = "[[layer]]\ntype = \"thin-film\"\nior = 2.3\n\
    thickness_nm = { min = 60, max = 240, extent_um = 20000, map = { noise = { seed = 3, frequency = 4, octaves = 3 } } }\n";
const WHITE: &str = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.95, 0.95, 0.95]\n";
const WOOD: &str = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0.2]\n";
const METAL: &str = "[[layer]]\ntype = \"conductor\"\nior = { n = [0.2, 0.92, 1.1], k = [3.9, 2.5, 2.4], wavelengths_nm = [645, 525, 445] }\nalpha = 0.25\n";
const BRUSHED: &str = "[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.4 }\nalpha_x = 0.35\nalpha_y = 0.12\n";
const GLTF: &str =
    "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.9, 0.6, 0.4]\nmetallic = 1.0\nroughness = 0.4\n";
const PATINA: &str =
    "[effects.patina]\nextent = 0.45\ntransition = 0.65\nmap = { noise = { seed = 4, frequency = 3, octaves = 5 } }\n";
const SCATTERS: &str = "diffuse_albedo = [0.25, 0.55, 0.42]\nbase_alpha = 0.45\ntarnish = [0.8, 0.45, 0.25]\n";
const FLAKES: &str =
    "[effects.flakes]\ncells = { seed = 5, count = 64, spread_deg = 12 }\ntiling = 40\nscale = 0.8\nfade_start = 2\n";
const GLITTER: &str = "[effects.glitter]\nseed = 9\nfrequency = 60\nfilled = 0.5\ntilt_deg = 20\n";

/// Maps of the layer before, by key, with the pictures of the grammar.
fn maps(keys: &[&str]) -> String {
    let maps = keys.iter().map(|key| match *key {
        "normal" | "bumps" => format!("{key} = \"bumps.png\""),
        "albedo" | "base_color" => format!("{key} = \"paint.png\""),
        "tangent" => format!("{key} = \"circles.png\""),
        _ => format!("{key} = \"thickness.png\""),
    });
    format!("maps = {{ {} }}\n", maps.collect::<Vec<_>>().join(", "))
}

/// A coat with maps on a base with maps.
fn coat(keys: &[&str], base: &[&str], below: &str) -> String {
    let [own, base] = [keys, base].map(|keys| if keys.is_empty() { String::new() } else { maps(keys) });
    [COAT, &own, below, &base].concat()
}

/// Names and texts of the materials.
fn texts() -> Vec<(&'static str, String)> {
    vec![
        ("roughness", coat(&["roughness"], &[], WOOD)),
        ("thickness", coat(&["thickness"], &[], WOOD)),
        ("albedo", coat(&[], &["albedo"], WHITE)),
        ("normal", coat(&["normal"], &[], WOOD)),
        ("roughness-albedo", coat(&["roughness"], &["albedo"], WHITE)),
        ("thickness-albedo", coat(&["thickness"], &["albedo"], WHITE)),
        ("normal-albedo", coat(&["normal"], &["albedo"], WHITE)),
        ("normal-roughness-albedo", coat(&["normal", "roughness"], &["albedo"], WHITE)),
        ("normal-thickness-albedo", coat(&["normal", "thickness"], &["albedo"], WHITE)),
        ("roughness-thickness", coat(&["roughness", "thickness"], &[], WOOD)),
        ("roughness-thickness-albedo", coat(&["roughness", "thickness"], &["albedo"], WHITE)),
        ("metal-roughness", [VARNISH, &maps(&["roughness"]), METAL].concat()),
        ("metal-thickness", [VARNISH, &maps(&["thickness"]), METAL].concat()),
        ("film", [FILM, VARNISH, METAL].concat()),
        ("film-albedo", [FILM, VARNISH, WHITE, &maps(&["albedo"])].concat()),
        ("film-roughness", [FILM, VARNISH, &maps(&["roughness"]), METAL].concat()),
        ("patina", [VARNISH, METAL, PATINA].concat()),
        ("patina-scatters", [VARNISH, METAL, PATINA, SCATTERS].concat()),
        ("flakes", [VARNISH, METAL, FLAKES].concat()),
        ("flakes-roughness", [VARNISH, &maps(&["roughness"]), METAL, FLAKES].concat()),
        ("glitter", [VARNISH, METAL, GLITTER].concat()),
        ("bumps-alpha", [VARNISH, METAL, &maps(&["bumps", "alpha"])].concat()),
        ("inner-thickness", [VARNISH, VARNISH, &maps(&["thickness"]), WOOD].concat()),
        ("tangent", [BRUSHED, &maps(&["tangent", "alpha_x"])].concat()),
        ("coated-tangent", [VARNISH, BRUSHED, &maps(&["tangent", "alpha_x"])].concat()),
        ("base-color-metallic", [GLTF, &maps(&["base_color", "metallic"])].concat()),
        ("base-color-metallic-roughness", [GLTF, &maps(&["base_color", "metallic", "roughness"])].concat()),
        ("coated-base-color-metallic", [VARNISH, GLTF, &maps(&["base_color", "metallic"])].concat()),
    ]
}

/// The materials; their maps lie beside this crate's sources.
pub(super) fn all() -> Vec<Material> {
    let materials = texts().into_iter().map(|(name, body)| {
        let text = format!("schema = 1\nname = \"{name}\"\n{body}");
        let parsed = parse("textured.toml", &text, &|_| Err(std::io::Error::other("no file")));
        let mut material = parsed.unwrap_or_else(|errors| panic!("{}", errors[0].render(&text))).material;
        material.source = crate::maps::source();
        material
    });
    materials.collect()
}

#[cfg(test)]
mod tests {
    use luthier_manifest::ShadingModel::{self, Lobes};

    /// Most of them are of the model that stacks have by default.
    #[test]
    fn every_case_is_a_material_that_varies() {
        let all = super::all();
        assert!(all.iter().all(super::super::varies));
        let lobes = all.iter().filter(|material| material.model() == Lobes).count();
        assert!(lobes > all.len() / 2, "{lobes} of {}", all.len());
        let others: Vec<ShadingModel> = all.iter().map(luthier_material::Material::model).collect();
        assert!(others.contains(&ShadingModel::Belcour), "{others:?}");
    }
}
