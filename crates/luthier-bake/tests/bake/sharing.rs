//! Bytes, shared tiles, and sets that cannot be baked.

use luthier_bake::{BakeError, Baked};
use luthier_lut::TableKind;

use crate::materials::{ASKED, SMALL, atlas, bake_anew, conductor, dielectric, material, try_bake};

const FILM: &str = "
[[layer]]
type = \"thin-film\"
ior = 1.4
[layer.thickness_nm]
min = 100
max = 500
extent_um = 1000
map = { noise = { seed = 3, frequency = 4, octaves = 3 } }
";

/// Everything that a bake decides, bit by bit.
fn bits(bake: &Baked) -> Vec<u32> {
    let images = bake.atlases.iter().flat_map(|a| a.truth.data.iter().chain(&a.texels.data));
    let errors = bake.atlases.iter().flat_map(|a| &a.tiles).flat_map(|t| {
        let e = &t.error;
        [e.max_abs_err, e.rms_err, e.p99_abs_err, e.worst.expected, e.worst.sampled]
    });
    images.map(|v| v.to_bits()).chain(errors.flat_map(|e| [(e.to_bits() >> 32) as u32, e.to_bits() as u32])).collect()
}

#[test]
fn threads_do_not_matter() {
    let every_kind = "[bake]\ntables = [\"fresnel\", \"distribution\", \"fgd\", \"phase\", \"thickness\"]\n";
    let set = [
        material("coated", &(dielectric("1.5", 0.1) + &conductor("\"au\"", 0.3)), SMALL),
        material("filmed", &(FILM.to_owned() + &dielectric("1.5", 0.2)), every_kind),
        material("other", &(conductor("{ n = 3.2, k = 3.3 }", 0.3) + "distribution = \"beckmann\"\n"), ASKED),
    ];
    let with = |threads| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| bake_anew(&set))
    };
    let (one, two) = (with(1), with(2));
    assert_eq!(one, two);
    assert_eq!(bits(&one), bits(&two));
    let kinds = [
        TableKind::Fresnel,
        TableKind::Distribution,
        TableKind::Fgd,
        TableKind::Phase,
        TableKind::Thickness,
        TableKind::Film,
    ];
    assert_eq!(one.atlases.iter().map(|a| a.kind).collect::<Vec<_>>(), kinds);
}

#[test]
fn equal_interfaces_share_their_tiles() {
    let set = [
        material("one", &dielectric("1.5", 0.1), SMALL),
        material("two", &dielectric("1.5", 0.7), ASKED),
        material("three", &dielectric("1.6", 0.1), ASKED),
        material("four", &(dielectric("1.5", 0.1) + "distribution = \"beckmann\"\n"), ASKED),
    ];
    let baked = bake_anew(&set);
    let [one, two, three, four] = [0, 1, 2, 3].map(|i: usize| &baked.materials[i].records[0]);
    assert_eq!(
        (one.tiles[TableKind::Fresnel], one.tiles[TableKind::Distribution], one.tiles[TableKind::Fgd]),
        (Some(0), Some(0), Some(0))
    );
    assert_eq!(
        (two.tiles[TableKind::Fresnel], two.tiles[TableKind::Distribution], two.tiles[TableKind::Fgd]),
        (Some(0), Some(0), Some(0))
    );
    assert_eq!(
        (three.tiles[TableKind::Fresnel], three.tiles[TableKind::Distribution], three.tiles[TableKind::Fgd]),
        (Some(1), Some(0), Some(1))
    );
    // Fresnel's formulas know no roughness.
    assert_eq!(
        (four.tiles[TableKind::Fresnel], four.tiles[TableKind::Distribution], four.tiles[TableKind::Fgd]),
        (Some(0), Some(1), Some(2))
    );
    let counts = baked.atlases.iter().map(|a| (a.kind, a.tiles.len())).collect::<Vec<_>>();
    assert_eq!(counts, [(TableKind::Fresnel, 2), (TableKind::Distribution, 2), (TableKind::Fgd, 3)]);
}

/// A tile is the same in company and alone: its key says so, and its texels.
#[test]
fn a_tile_does_not_depend_on_its_neighbours() {
    let gold = || material("gold", &conductor("\"au\"", 0.3), SMALL);
    let alone = bake_anew(&[gold()]);
    let set = bake_anew(&[material("one", &dielectric("1.5", 0.1), ASKED), gold()]);
    for kind in [TableKind::Fresnel, TableKind::Distribution, TableKind::Fgd] {
        let (a, b) = (atlas(&alone, kind), atlas(&set, kind));
        let tile = b.tiles.len() as u32 - 1;
        assert_eq!(a.tiles[0].input_hash, b.tiles[tile as usize].input_hash);
        let [ox, oy] = b.layout.origin(tile);
        for y in 0..a.texels.height {
            for x in 0..a.texels.width {
                assert_eq!(a.texels.texel(x, y), b.texels.texel(ox + x, oy + y), "{kind:?} {x} {y}");
            }
        }
    }
}

#[test]
fn sets_that_cannot_be_baked() {
    let plain = |name: &str, settings: &str| material(name, &dielectric("1.5", 0.1), settings);
    assert!(matches!(try_bake(&[]), Err(BakeError::Empty)));

    let twins = try_bake(&[plain("twin", SMALL), plain("other", ""), plain("twin", "")]);
    assert!(matches!(twins, Err(BakeError::DuplicateName { name, .. }) if name == "twin"));

    let sizes = try_bake(&[plain("a", "[bake.fresnel]\nsize = 64\n"), plain("b", ""), plain("c", SMALL)]);
    match sizes {
        Err(BakeError::Conflict { material, setting, first, first_value, second, second_value }) => {
            assert_eq!((material, setting), (2, "bake.fresnel.size"));
            assert_eq!((first.as_str(), second.as_str()), ("a.toml:9", "c.toml:10"));
            assert_eq!((first_value.as_str(), second_value.as_str()), ("64", "24"));
        }
        other => panic!("{other:?}"),
    }

    // A texture of 8,192 x 8,192 holds four of them; a fifth is one too many, which no job has to find out.
    let large = "[bake]\nmodel = \"belcour\"\n[bake.fgd]\nsize = [4096, 4096]\n";
    let set: Vec<_> =
        (0..5).map(|i| material(&format!("m{i}"), &dielectric(&format!("1.{}", i + 3), 0.1), large)).collect();
    match try_bake(&set) {
        Err(BakeError::TooManyTiles { kind, tiles, tile, most, hint }) => {
            assert_eq!((kind, tiles, tile, most), (TableKind::Fgd, 5, [4096; 2], 4));
            assert!(hint.contains("[bake.fgd]") && hint.contains("several folders"), "{hint}");
        }
        other => panic!("{other:?}"),
    }

    let image = FILM.replace("noise = { seed = 3, frequency = 4, octaves = 3 }", "image = \"missing.png\"");
    match try_bake(&[material("map", &(image + &dielectric("1.5", 0.2)), SMALL)]) {
        Err(BakeError::Map { material, path, reason }) => {
            assert_eq!(
                (material.as_str(), path.as_str(), reason.as_str()),
                ("map.toml", "missing.png", "no images here")
            );
        }
        other => panic!("{other:?}"),
    }
}
