//! Tables are baked because a shader reads them, or because a material asks for them.

use luthier_lut::{TableKind, TexelFormat, WeightBits};
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
    // Transparent media of one index have their reflectance in closed form there.
    assert_eq!(kinds(&coated, "lobes", ""), [TableKind::Lobes]);
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

/// Rows of a bake have the light of diffuse bases apart where one of its materials has such a base; those of others have none. Oracle: the share of diffuse
/// light that a smooth surface of index 1.5 sends back, .596.
#[test]
fn rows_have_the_light_of_bases_where_there_are_some() {
    let coat = dielectric("1.5", 0.001);
    let metal = coat.clone() + &conductor("{ n = 0.2, k = 3.5 }", 0.3);
    let paint = coat + "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.5, 0]\n";
    let lobes = "[bake]\nmodel = \"lobes\"\ncolor = \"three-wavelengths\"\n";
    let parts = |bake: &luthier_bake::Baked| atlas(bake, TableKind::Lobes).layout.y.as_ref().map(|y| (y.min, y.max));
    assert_eq!(parts(&bake_all(&[material("metal", &metal, lobes)])).unwrap().0, 0.0);
    let bake = bake_all(&[material("metal", &metal, lobes), material("paint", &paint, lobes)]);
    let (first, last) = parts(&bake).unwrap();
    assert!(first == -2.0 && last >= 3.0, "{first} {last}");
    let part = |number: usize, cos_theta: f64, part: f64| {
        let tile = bake.materials[number].records[0].tiles[TableKind::Lobes].unwrap();
        atlas(&bake, TableKind::Lobes).sample(tile, [cos_theta, part], WeightBits::Exact)
    };
    for cos_theta in [1.0, 0.6, 0.1] {
        assert_eq!([-2.0, -1.0].map(|of_base| part(0, cos_theta, of_base)), [[0.0; 4]; 2]);
        let [internal, base, wide] = [-2.0, -1.0, 0.0].map(|of_base| part(1, cos_theta, of_base));
        for c in 0..2 {
            assert!((internal[c] - 0.596).abs() < 0.01, "{internal:?}");
            // A smooth coat sends nothing else up.
            assert!((base[c] - wide[c]).abs() < 1e-3 && base[c] > 0.05, "{base:?} {wide:?}");
        }
        assert_eq!([internal[2], base[2]], [0.0; 2]);
    }
    let painted = bake.materials[1].constants.lobes.unwrap().painted.unwrap();
    assert_eq!((painted.albedo, painted.moments), ([0.8, 0.5, 0.0], None));
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
