//! Albedo tiles in blocks of texels: asked for by a material, or taken by a search whose target has them.

use luthier_bake::{BakeError, Baked, Options, Silent, bake_with};
use luthier_lut::{FormatSet, TableKind, TexelFormat};
use luthier_manifest::Budget;
use luthier_material::Material;

use crate::materials::{STORE, atlas, bake_all, bake_anew, conductor, dielectric, material, try_bake};

const BLOCKS: TexelFormat = TexelFormat::Bc6hRgbUfloat;

/// Albedos of every material.
const ASKED: &str = "[bake]\ntables = [\"fgd\"]\n";

const SMALL_BLOCKS: &str = "[bake.fgd]\nsize = [8, 12]\nformat = \"bc6h-rgb-ufloat\"\n";

fn set(settings: &str) -> Vec<Material> {
    vec![
        material("glass", &dielectric("1.5", 0.3), &(ASKED.to_owned() + settings)),
        material("gold", &conductor("\"au\"", 0.2), ASKED),
        material("chromium", &conductor("{ n = 3.2, k = 4.4 }", 0.3), ASKED),
    ]
}

fn with(materials: &[Material], max_abs: f64, formats: FormatSet) -> Result<Baked, BakeError> {
    let budget = Budget { max_abs: Some(max_abs), ..Budget::default() };
    let no_images = |_: &str, _: &luthier_material::PictureRef| Err("no images here".to_owned());
    bake_with(materials, &Options { budget, formats, ..Options::default() }, &no_images, &Silent, &*STORE)
}

#[test]
fn a_material_may_ask_for_blocks() {
    let bake = bake_all(&set(SMALL_BLOCKS));
    let fgd = atlas(&bake, TableKind::Fgd);
    assert_eq!((fgd.format, fgd.layout.size(), fgd.bytes.len()), (BLOCKS, [8, 36], 3 * 8 * 12));
    // The bytes are those of the texels that were measured.
    assert_eq!(BLOCKS.decode(8, 36, &fgd.bytes).unwrap(), fgd.texels);
    assert!(fgd.tiles.iter().all(|tile| tile.error.max_abs_err < 0.06));
    // Each tile has the blocks that it has alone.
    let alone = material("gold", &conductor("\"au\"", 0.2), SMALL_BLOCKS);
    let alone = bake_anew(&[alone]);
    let alone = &atlas(&alone, TableKind::Fgd).texels;
    let tile = fgd.tiles.iter().position(|tile| tile.name == "gold/0").unwrap();
    let [x, y] = fgd.layout.origin(tile as u32);
    assert!((0..12).all(|j| (0..8).all(|i| fgd.texels.texel(x + i, y + j) == alone.texel(i, j))));
}

#[test]
fn sides_are_of_whole_blocks() {
    let error = try_bake(&set("[bake.fgd]\nsize = [8, 10]\nformat = \"bc6h-rgb-ufloat\"\n")).unwrap_err();
    assert_eq!(error.to_string(), "bake.fgd.size 10 with format bc6h-rgb-ufloat: write a multiple of 4");
}

#[test]
fn a_search_takes_blocks_where_the_target_has_them() {
    let materials = set("");
    let all: FormatSet = TexelFormat::ALL.into_iter().collect();
    let [core, known] = [FormatSet::CORE, all].map(|formats| with(&materials, 2e-2, formats).unwrap());
    let [core, known] = [&core, &known].map(|bake| atlas(bake, TableKind::Fgd));
    assert_ne!(core.format, BLOCKS);
    assert_eq!(known.format, BLOCKS);
    assert!(known.bytes.len() < core.bytes.len());
    assert!(known.tiles.iter().all(|tile| tile.error.max_abs_err <= 2e-2));
    // Nothing that the target lacks.
    let only: FormatSet = [TexelFormat::Rgba16Float].into_iter().collect();
    let bake = with(&materials, 2e-2, only).unwrap();
    for kind in [TableKind::Fresnel, TableKind::Fgd] {
        assert_eq!(atlas(&bake, kind).format, TexelFormat::Rgba16Float, "{kind:?}");
    }
}
