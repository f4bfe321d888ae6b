//! Phase rows and thickness textures.

use std::f64::consts::PI;

use luthier_lut::{Image, TableKind, WeightBits};

use luthier_bake::{Silent, bake};

use crate::materials::{SMALL, atlas, bake_all, dielectric, material};

const MIN_NM: f64 = 150.0;
const MAX_NM: f64 = 600.0;
const EXTENT_UM: f64 = 2000.0;

fn film(map: &str) -> String {
    format!(
        "[[layer]]\ntype = \"thin-film\"\nior = 1.4\n[layer.thickness_nm]\nmin = {MIN_NM}\nmax = {MAX_NM}\n\
         extent_um = {EXTENT_UM}\nmap = {{ {map} }}\n{}",
        dielectric("1.5", 0.0)
    )
}

const NOISE: &str = "noise = { seed = 5, frequency = 3, octaves = 4 }";

#[test]
fn phase_rows_are_two_cosines() {
    let settings = "[bake]\nwavelengths_nm = [640, 530, 450]\n[bake.phase]\nsize = 64\nformat = \"rgba32float\"\n\
                    [bake.fgd]\nsize = [4, 4]\n[bake.thickness]\nsize = 8\n";
    let baked = bake_all(&[material("film", &film(NOISE), settings)]);
    let table = atlas(&baked, TableKind::Phase);
    for i in 0..64 {
        let s = f64::from(i) / 63.0;
        for (c, nm) in [640.0, 530.0, 450.0].into_iter().enumerate() {
            let expected = 2.0 * (4.0 * PI * MAX_NM * 1.4 / nm * s).cos();
            let found = f64::from(table.truth.texel(i, 0)[c]);
            assert!((found - expected).abs() < 2e-7, "{s} {nm}: {found} {expected}");
        }
    }
}

/// Nodes are moved to halve the error between them, which makes theirs as large: the largest is stated all the same.
#[test]
fn phase_rows_err_no_more_than_is_stated_at_nodes_and_between() {
    let water = "[[layer]]\ntype = \"thin-film\"\nior = \"water\"\n[layer.thickness_nm]\nmin = 100\nmax = 600\nextent_um = 50000\n\
                 map = { noise = { seed = 3, frequency = 2, octaves = 5 } }\n";
    let layers = water.to_owned() + &dielectric("1.0", 0.0);
    let small = "[bake.fgd]\nsize = [4, 4]\n[bake.thickness]\nsize = 8\n";
    let soap = material("soap", &layers, &(small.to_owned() + "[bake.phase]\nsize = 256\n"));
    let waves = [645.0, 525.0, 445.0].map(|nm| 2.0 * 600.0 * soap.stack.layers[0].films[0].ior.at(nm).re / nm);
    let baked = bake_all(&[soap]);
    let table = atlas(&baked, TableKind::Phase);
    let stated = table.tiles[0].error.max_abs_err;
    let error = |s: f64| {
        let read = table.sample(0, [s, 0.0], WeightBits::Fixed(8));
        let exact = waves.map(|waves: f64| 2.0 * (2.0 * PI * waves * s).cos());
        (0..3).map(|c| (read[c] - exact[c]).abs()).fold(0.0, f64::max)
    };
    let nodes = (0..256).map(|i| error(f64::from(i) / 255.0)).fold(0.0, f64::max);
    let between = (0..=255 * 64).map(|i| error(f64::from(i) / (255.0 * 64.0))).fold(0.0, f64::max);
    eprintln!("phase: nodes {nodes:.3e}, between {between:.3e}, stated {stated:.3e}");
    // Points between those of the bake's own scan may be a little worse.
    assert!(nodes <= stated * (1.0 + 1e-9) && between <= 1.02 * stated, "{nodes} {between} {stated}");
}

#[test]
fn thickness_textures_repeat_without_a_seam() {
    let settings = SMALL.replace("size = 16\n", "size = 128\n") + "format = \"rgba32float\"\n";
    let baked = bake_all(&[material("film", &film(NOISE), &settings)]);
    let table = atlas(&baked, TableKind::Thickness);
    let at = |u: f64, v: f64| table.sample(0, [u, v], WeightBits::Exact);
    // The greatest step between points 1/1024 apart, inside and across the edges.
    let (mut inside, mut across) = (0f64, 0f64);
    for i in 0..512 {
        let t = f64::from(i) / 512.0;
        for (a, b) in
            [(at(1.0, t), at(0.0, t)), (at(t, 1.0), at(t, 0.0)), (at(-0.25, t), at(0.75, t)), (at(t, 2.6), at(t, 0.6))]
        {
            for (a, b) in a.into_iter().zip(b) {
                assert!((a - b).abs() < 1e-9, "{t}: {a} {b}");
            }
        }
        let h = 1.0 / 2048.0;
        across = across.max((at(1.0 - h, t)[0] - at(h, t)[0]).abs()).max((at(t, 1.0 - h)[0] - at(t, h)[0]).abs());
        for x in [0.2, 0.5, 0.7] {
            inside =
                inside.max((at(x - h, t)[0] - at(x + h, t)[0]).abs()).max((at(t, x - h)[0] - at(t, x + h)[0]).abs());
        }
    }
    assert!(across < 2.0 * inside && across > 0.0, "{across} {inside}");
}

#[test]
fn thickness_textures_hold_what_they_say() {
    let settings = SMALL.replace("size = 16\n", "size = 128\n") + "format = \"rgba32float\"\n";
    let baked = bake_all(&[material("film", &film(NOISE), &settings)]);
    let table = atlas(&baked, TableKind::Thickness);
    let (mut low, mut high) = (f64::INFINITY, 0f64);
    let thickness = |u: f64, v: f64| table.sample(0, [u, v], WeightBits::Exact)[0] * 2.0 * MAX_NM;
    for j in 0..128 {
        for i in 0..128 {
            let (u, v) = (f64::from(i) / 128.0, f64::from(j) / 128.0);
            let [_, slope_x, slope_y, normalisation] = table.sample(0, [u, v], WeightBits::Exact);
            let nm = thickness(u, v);
            (low, high) = (low.min(nm), high.max(nm));
            // Across a texel on either side the relief is close to a parabola.
            let h = 1.0 / 128.0;
            let difference = (thickness(u + h, v) - thickness(u - h, v)) / (2.0 * h * EXTENT_UM * 1e3);
            assert!((difference - slope_x).abs() < 2e-4, "{difference} {slope_x}");
            let difference = (thickness(u, v + h) - thickness(u, v - h)) / (2.0 * h * EXTENT_UM * 1e3);
            assert!((difference - slope_y).abs() < 2e-4, "{difference} {slope_y}");
            assert!((normalisation - (1.0 + slope_x * slope_x + slope_y * slope_y).sqrt()).abs() < 1e-6);
        }
    }
    assert!((low - MIN_NM).abs() < 1e-3 && (high - MAX_NM).abs() < 1e-3, "{low} {high}");
}

/// An image of four texels: thin, thick, thick, thin. Half way between two texels the film is half way.
#[test]
fn images_become_thickness() {
    let image = Image { width: 2, height: 2, channels: 1, data: vec![0.0, 1.0, 1.0, 0.0] };
    let set = [material("film", &film("image = \"map.png\""), &(SMALL.to_owned() + "format = \"rgba32float\"\n"))];
    let baked =
        bake(&set, &|_, map| if map.path == "map.png" { Ok(image.clone()) } else { Err(map.path.clone()) }, &Silent);
    let baked = baked.unwrap();
    let table = atlas(&baked, TableKind::Thickness);
    let middle = 0.5 * (MIN_NM + MAX_NM);
    for (uv, nm) in [
        ([0.25, 0.25], MIN_NM),
        ([0.75, 0.25], MAX_NM),
        ([0.25, 0.75], MAX_NM),
        ([0.75, 0.75], MIN_NM),
        ([0.5, 0.25], middle),
        ([0.0, 0.75], middle),
        ([0.5, 0.5], middle),
    ] {
        let found = table.sample(0, uv, WeightBits::Exact)[0] * 2.0 * MAX_NM;
        assert!((found - nm).abs() < 1e-3, "{uv:?}: {found} {nm}");
    }
}

/// A record has the first of films on films, and so has all that shaders compute; tables are made of all. `Feature::InnerFilms` says so.
#[test]
fn records_have_one_film_and_tables_have_all() {
    let film = |ior: f64, nm: f64| format!("[[layer]]\ntype = \"thin-film\"\nior = {ior}\nthickness_nm = {nm}\n");
    let coat = dielectric("1.5", 0.3);
    let one = material("one", &(film(1.9, 140.0) + &coat), SMALL);
    let two = material("two", &(film(1.9, 140.0) + &film(1.4, 90.0) + &coat), SMALL);
    let outline = luthier_bake::outline(&[one, two], &|_, _| Err("no images here".to_owned())).unwrap();
    let [one, two] = [0, 1].map(|i| outline.materials[i].records[0].clone());
    assert_ne!(one.tiles[TableKind::Fresnel], two.tiles[TableKind::Fresnel]);
    assert_ne!(one.tiles[TableKind::Fgd], two.tiles[TableKind::Fgd]);
    let tiles = |record: &luthier_manifest::LayerRecord| luthier_manifest::LayerRecord {
        tiles: record.tiles.with([(TableKind::Fresnel, None), (TableKind::Fgd, None), (TableKind::Phase, None)]),
        ..record.clone()
    };
    assert_eq!(tiles(&one), tiles(&two));
}
