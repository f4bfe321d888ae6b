//! Film tiles against the spectral reflectance, beside the phase rows of the same films.

use luthier_bake::Baked;
use luthier_lut::{TableKind, WeightBits};
use luthier_manifest::LayerRecord;
use luthier_material::Material;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::FilmThickness;

use crate::materials::{SMALL, atlas, bake_all, dielectric, material};

const MAX_NM: f64 = 1600.0;

/// A film between air and a denser body, as the sign of the phase row needs it; colours are spectral.
fn film(settings: &str) -> (Material, Baked) {
    let layers = format!(
        "[[layer]]\ntype = \"thin-film\"\nior = 1.4\n[layer.thickness_nm]\nmin = 10\nmax = {MAX_NM}\nextent_um = 1000\n\
         map = {{ noise = {{ seed = 5, frequency = 3, octaves = 2 }} }}\n{}",
        dielectric("1.8", 0.1)
    );
    let material = material("film", &layers, settings);
    let bake = bake_all(std::slice::from_ref(&material));
    (material, bake)
}

/// The truth: all wavelengths, all beams.
fn spectral(material: &Material, nm: f64, cos_theta: f64) -> [f64; 3] {
    let mut interface = Interface::of(&material.stack, 0).unwrap();
    interface.films[0].thickness = FilmThickness { min_nm: nm, max_nm: nm };
    interface.sampled(&Color::Spectral).rgb(cos_theta)
}

/// Two beams whose interference is read from the phase row: what Granier and Heidrich's texture can give, with the exact powers
/// of both interfaces.
fn two_beams(bake: &Baked, record: &LayerRecord, nm: f64, cos_theta: f64) -> [f64; 3] {
    let power = |above: f64, below: f64, cos_theta: f64| {
        let cos_t = (1.0 - (above / below).powi(2) * (1.0 - cos_theta * cos_theta)).sqrt();
        let s = (above * cos_theta - below * cos_t) / (above * cos_theta + below * cos_t);
        let p = (below * cos_theta - above * cos_t) / (below * cos_theta + above * cos_t);
        (0.5 * (s * s + p * p), cos_t)
    };
    let (r, cos_t) = power(1.0, 1.4, cos_theta);
    let t = (1.0 - r) * (1.0 - r) * power(1.4, 1.8, cos_t).0;
    let swing = atlas(bake, TableKind::Phase).sample(
        record.tiles[TableKind::Phase].unwrap(),
        [nm / MAX_NM * cos_t, 0.0],
        WeightBits::Fixed(8),
    );
    [0, 1, 2].map(|c| r + t + swing[c] * (r * t).sqrt())
}

#[test]
fn film_tiles_hold_the_spectral_reflectance_off_their_nodes() {
    let settings = SMALL.replace("size = 32\n", "size = 1024\n");
    let (material, bake) = film(&settings);
    let record = &bake.materials[0].records[0];
    let table = atlas(&bake, TableKind::Film);
    let read = |nm: f64, cos_theta: f64| {
        table.sample(record.tiles[TableKind::Film].unwrap(), [cos_theta, nm / MAX_NM], WeightBits::Fixed(8))
    };
    let stated = table.tiles[0].error.max_abs_err;
    eprintln!("| thickness, nm | angle | film table | phase row |\n|---|---|---|---|");
    for (low, high) in [(0.0, 200.0), (200.0, 400.0), (400.0, 800.0), (800.0, 1600.0)] {
        for angle in [0.0f64, 45.0, 70.0] {
            let cos_theta = angle.to_radians().cos();
            let (mut by_table, mut by_phase) = (0.0f64, 0.0f64);
            for i in 0..200 {
                let nm = low + (high - low) * (f64::from(i) + 0.37) / 200.0;
                let truth = spectral(&material, nm, cos_theta);
                let (film, beams) = (read(nm, cos_theta), two_beams(&bake, record, nm, cos_theta));
                for c in 0..3 {
                    by_table = by_table.max((film[c] - truth[c]).abs());
                    by_phase = by_phase.max((beams[c] - truth[c]).abs());
                }
            }
            eprintln!("| {low} to {high} | {angle} | {by_table:.5} | {by_phase:.5} |");
            // The scan of the baker has four points per cell and may miss the very worst.
            assert!(by_table < 1.5 * stated, "{low} {angle}: {by_table}, stated {stated}");
            assert!(by_table < by_phase, "{low} {angle}: {by_table} {by_phase}");
        }
    }
    eprintln!("stated: {stated:.5}");
    assert!(stated < 2e-3, "{stated}");
}

/// Films of one thickness keep their row: only what varies has a tile.
#[test]
fn only_films_that_vary_have_a_tile() {
    let layers = format!("[[layer]]\ntype = \"thin-film\"\nior = 1.4\nthickness_nm = 300\n{}", dielectric("1.8", 0.1));
    let bake = bake_all(&[material("film", &layers, SMALL)]);
    assert_eq!(bake.materials[0].records[0].tiles[TableKind::Film], None);
    assert!(bake.atlases.iter().all(|a| a.kind != TableKind::Film));
}

/// The nominal thickness of a neutral place lies in the tile where the Fresnel row says the same.
#[test]
fn the_nominal_thickness_reads_as_the_fresnel_row() {
    let (_, bake) = film(SMALL);
    let record = &bake.materials[0].records[0];
    let fraction = record.film_thickness_nm / record.film_thickness_max_nm;
    for cos_theta in [0.1, 0.37, 0.8, 1.0] {
        let row = atlas(&bake, TableKind::Fresnel).sample(
            record.tiles[TableKind::Fresnel].unwrap(),
            [cos_theta, 0.0],
            WeightBits::Exact,
        );
        let tile = atlas(&bake, TableKind::Film).sample(
            record.tiles[TableKind::Film].unwrap(),
            [cos_theta, fraction],
            WeightBits::Exact,
        );
        for c in 0..3 {
            // The row of this test has 24 nodes over a curve that bends by 3 near grazing.
            assert!((row[c] - tile[c]).abs() < 6e-3, "{cos_theta}: {row:?} {tile:?}");
        }
    }
}
