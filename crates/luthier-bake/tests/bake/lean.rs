//! Tables are baked because a shader reads them, or because a material asks for them.

use luthier_lut::{TableKind, TexelFormat};
use luthier_manifest::LayerRecord;

use crate::materials::{SMALL, atlas, bake_all, conductor, dielectric, material};

const FILM: &str = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\n[layer.thickness_nm]\nmin = 100\nmax = 500\nextent_um = 1000\n\
                    map = { noise = { seed = 3, frequency = 4, octaves = 3 } }\n";

/// The kinds of the atlases of a bake of one material under a model.
fn kinds(layers: &str, model: &str, more: &str) -> Vec<TableKind> {
    let settings = format!("[bake]\nmodel = \"{model}\"\n{more}");
    bake_all(&[material("one", layers, &settings)]).atlases.iter().map(|a| a.kind).collect()
}

#[test]
fn models_bake_what_their_shaders_read() {
    use TableKind::{Film, Fresnel, Phase, Thickness};
    let coated = dielectric("1.5", 0.1) + &conductor("{ n = 0.2, k = 3.5 }", 0.3);
    let filmed = FILM.to_owned() + &dielectric("1.8", 0.2);
    assert_eq!(kinds(&coated, "lobes", ""), [Fresnel, TableKind::Lobes]);
    for (model, of_coat, of_film) in [
        ("elek", vec![Fresnel], vec![Thickness, Film]),
        ("weidlich-wilkie", vec![Fresnel], vec![Thickness, Film]),
        ("microfacet", vec![Fresnel], vec![Thickness, Film]),
        ("granier-heidrich", vec![], vec![Phase, Thickness]),
        ("phong", vec![], vec![]),
    ] {
        assert_eq!(kinds(&coated, model, ""), of_coat, "{model}");
        assert_eq!(kinds(&filmed, model, ""), of_film, "{model}");
    }
    // Albedos cost seconds: small ones, which the model reads whether or not its file speaks of them.
    let small = "[bake.fgd]\nsize = [4, 4]\n";
    for model in ["belcour", "yamaguchi"] {
        let metal = "ior = { n = 0.2, k = 3.5 }\nalpha = 0.3\n";
        let coated = dielectric("1.5", 0.1) + &format!("[[layer]]\ntype = \"conductor\"\n{metal}");
        assert_eq!(kinds(&coated, model, small), [TableKind::Fgd, TableKind::Escape], "{model}");
        assert_eq!(kinds(&filmed, model, small), [TableKind::Fgd], "{model}");
    }
}

#[test]
fn every_kind_can_be_asked_for() {
    let all = "tables = [\"fresnel\", \"distribution\", \"fgd\", \"phase\", \"thickness\", \"film\", \"escape\", \"lobes\"]\n";
    let layers = FILM.to_owned() + &dielectric("1.8", 0.2) + &conductor("{ n = 0.2, k = 3.5 }", 0.3);
    for model in ["elek", "granier-heidrich", "phong"] {
        assert_eq!(kinds(&layers, model, &(all.to_owned() + SMALL)), TableKind::ALL, "{model}");
    }
}

/// The one of two materials that asks for D reads it; for the other it is computed.
#[test]
fn d_is_a_table_for_those_who_ask() {
    let ask = "[bake]\ndistribution = { size = [16, 8] }\n";
    let bake = bake_all(&[
        material("asks", &conductor("{ n = 0.2, k = 3.5 }", 0.3), ask),
        material("does-not", &conductor("{ n = 0.2, k = 3.5 }", 0.4), ""),
    ]);
    let tiles = |read: fn(&LayerRecord) -> Option<u32>| [0, 1].map(|i: usize| read(&bake.materials[i].records[0]));
    assert_eq!(tiles(|record| record.tiles[TableKind::Distribution]), [Some(0), None]);
    assert_eq!(tiles(|record| record.tiles[TableKind::Fresnel]), [Some(0), Some(0)]);
    assert_eq!(atlas(&bake, TableKind::Distribution).layout.size(), [16, 8]);
}

/// Slopes are for Granier and Heidrich's model; others read the thickness alone, in a quarter of the bytes.
#[test]
fn thickness_has_the_channels_that_are_read() {
    let layers = FILM.to_owned() + &dielectric("1.8", 0.2);
    let baked = |settings: &str| bake_all(&[material("film", &layers, settings)]);
    let (narrow, wide) = (baked(""), baked("[bake]\ntables = [\"thickness\"]\n"));
    let [narrow, wide] = [&narrow, &wide].map(|bake| atlas(bake, TableKind::Thickness));
    assert_eq!((narrow.format, wide.format), (TexelFormat::R16Float, TexelFormat::Rgba16Float));
    assert_eq!(4 * narrow.bytes.len(), wide.bytes.len());
    let [width, height] = wide.layout.size();
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        assert_eq!(narrow.texels.texel(x, y)[0], wide.texels.texel(x, y)[0], "{x} {y}");
    }
    assert!(narrow.tiles[0].error.max_abs_err <= wide.tiles[0].error.max_abs_err);
}
