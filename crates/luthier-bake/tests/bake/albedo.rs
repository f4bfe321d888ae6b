//! FGD-infinity as a GPU samples it.

use luthier_lut::{Atlas, TableKind, WeightBits};
use luthier_optics::color::luminance;

use crate::brute_force::{Facets, Heights, Slopes, Surface};
use crate::materials::{ASKED, atlas, bake_all, conductor, dielectric, material};

/// The error that the table may have (the project's goal), next to the noise of the oracle.
const TOLERANCE: f64 = 1e-3;

/// Tables other than the one that is looked at.
const OTHERS: &str = "[bake]\ntables = [\"fgd\"]\n[bake.fresnel]\nsize = 4\n[bake.distribution]\nsize = [4, 4]\n";

/// (cos_theta, alpha), none of them a node.
const POINTS: [[f64; 2]; 12] = [
    [0.97, 0.05],
    [0.61, 0.07],
    [0.11, 0.09],
    [0.04, 0.23],
    [0.83, 0.27],
    [0.33, 0.31],
    [0.99, 0.52],
    [0.17, 0.55],
    [0.52, 0.64],
    [0.77, 0.91],
    [0.29, 0.97],
    [0.021, 0.83],
];

fn sample(table: &Atlas, point: [f64; 2]) -> [f64; 4] {
    table.sample(0, point, WeightBits::Fixed(8))
}

/// Brute-force walks of `facets` against the table, at all points and on average.
fn check(table: &Atlas, slopes: Slopes, facets: Facets, walks: u32) {
    let (mut sum, mut variance) = (0.0, 0.0);
    for (i, point) in POINTS.into_iter().enumerate() {
        let surface = Surface { slopes, heights: Heights::Uniform, alpha: point[1], facets };
        let shares = surface.shares(point[0], walks, 1000 + i as u64);
        let [r, _, _, never_crossed] = sample(table, point);
        let all = shares.never_crossed + shares.crossed;
        for (found, share) in [(r, all), (never_crossed, shares.never_crossed)] {
            let limit = TOLERANCE + 4.0 * shares.sigma(share);
            assert!((found - share).abs() < limit, "{point:?}: {found} against {share}, sigma {}", shares.sigma(share));
        }
        sum += r - all;
        variance += shares.sigma(all).powi(2);
    }
    let count = POINTS.len() as f64;
    assert!(sum.abs() / count < 0.3 * TOLERANCE + 4.0 * variance.sqrt() / count, "mean error {}", sum / count);
}

#[test]
fn a_conductor_as_brute_force_has_it() {
    let baked = bake_all(&[material("metal", &conductor("{ n = 3.2, k = 3.3 }", 0.1), OTHERS)]);
    check(atlas(&baked, TableKind::Fgd), Slopes::Ellipsoid, Facets::Conductor { n: 3.2, k: 3.3 }, 1 << 20);
}

#[test]
fn a_dielectric_as_brute_force_has_it() {
    let layer = dielectric("1.5", 0.1) + "distribution = \"beckmann\"\n";
    let baked = bake_all(&[material("glass", &layer, OTHERS)]);
    check(atlas(&baked, TableKind::Fgd), Slopes::Gaussian, Facets::Dielectric { n: 1.5 }, 1 << 19);
}

/// The errors stated of a tile bound those that brute force finds, seen from the denser side too, where much of the light crosses and comes
/// back: at nodes of the roughest row, which no neighbours support, and between. Root mean square and percentile count what the function is
/// off.
#[test]
fn what_is_stated_bounds_what_brute_force_finds() {
    let layers = "exterior = 1.5\n".to_owned() + &dielectric("1.0", 0.1);
    let baked = bake_all(&[material("down", &layers, OTHERS)]);
    let table = atlas(&baked, TableKind::Fgd);
    let stated = &table.tiles[0].error;
    assert!(stated.slack > 0.0);
    let node = |k: u32| table.layout.x.node(k);
    let nodes = [[1.0, 1.0], [node(60), 1.0], [node(50), 1.0], [node(30), 1.0], [1.0, 0.7], [node(4), 1.0]];
    let off = |(i, point): (usize, [f64; 2])| {
        let facets = Facets::Dielectric { n: 1.0 / 1.5 };
        let surface = Surface { slopes: Slopes::Ellipsoid, heights: Heights::Uniform, alpha: point[1], facets };
        let shares = surface.shares(point[0], 1 << 18, 2000 + i as u64);
        let all = shares.never_crossed + shares.crossed;
        (sample(table, point)[0] - all, shares.sigma(all))
    };
    let found: Vec<(f64, f64)> = nodes.into_iter().chain(POINTS).enumerate().map(off).collect();
    for ((error, sigma), point) in found.iter().zip(nodes.into_iter().chain(POINTS)) {
        eprintln!("{point:?}: {error:.2e} +- {sigma:.1e}");
        assert!(error.abs() <= stated.max_abs_err + 4.0 * sigma, "{point:?}: {error} +- {sigma}, {stated:?}");
    }
    eprintln!("{stated:?}");
    // Away from the corner where all is worst, less the noise of the oracle.
    let others = &found[nodes.len()..];
    let squares: f64 = others.iter().map(|(error, sigma)| error * error - sigma * sigma).sum();
    let rms = (squares.max(0.0) / others.len() as f64).sqrt();
    assert!(rms <= 1.5 * stated.rms_err, "{rms} {}", stated.rms_err);
    let largest = others.iter().map(|(error, sigma)| error.abs() - 4.0 * sigma).fold(0.0, f64::max);
    assert!(largest <= stated.p99_abs_err, "{largest} {}", stated.p99_abs_err);
}

/// The largest error of every tile is the difference at its worst point, and what the function may be off itself.
#[test]
fn the_largest_error_is_the_worst_difference_and_slack() {
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\n[layer.thickness_nm]\nmin = 100\nmax = 300\nextent_um = 500\n\
                map = { noise = { seed = 5, frequency = 3, octaves = 2 } }\n";
    let baked = bake_all(&[
        material("film", &(film.to_owned() + &dielectric("1.5", 0.1)), crate::materials::SMALL),
        material("metal", &conductor("\"cu\"", 0.1), ASKED),
    ]);
    let mut slack = 0;
    for tile in baked.atlases.iter().flat_map(|atlas| &atlas.tiles) {
        let error = &tile.error;
        let difference = (error.worst.expected - error.worst.sampled).abs();
        assert_eq!(error.max_abs_err, difference + error.slack, "{}", tile.name);
        assert!(error.rms_err <= error.max_abs_err && error.p99_abs_err <= error.max_abs_err, "{}", tile.name);
        slack += u32::from(error.slack > 0.0);
    }
    assert_eq!(slack, 2, "albedo tiles");
}

/// Index 0.01 + 1000 i reflects all but 4e-5.
#[test]
fn a_perfect_reflector_loses_nothing() {
    let settings = OTHERS.to_owned() + "[bake.fgd]\nsize = [16, 16]\nformat = \"rgba32float\"\n";
    let baked = bake_all(&[material("mirror", &conductor("{ n = 0.01, k = 1000 }", 0.1), &settings)]);
    let table = atlas(&baked, TableKind::Fgd);
    for i in 0..=30 {
        for j in 0..=30 {
            let point = [f64::from(i) / 30.0, f64::from(j) / 30.0];
            for channel in sample(table, point) {
                assert!((channel - 1.0).abs() < 1e-4, "{point:?}: {channel}");
            }
        }
    }
}

#[test]
fn what_never_crossed_is_part_of_all() {
    let settings = OTHERS.to_owned() + "[bake.fgd]\nsize = [16, 16]\nformat = \"rgba32float\"\n";
    let baked = bake_all(&[
        material("glass", &dielectric("\"sf11\"", 0.1), &settings),
        material("metal", &conductor("\"cu\"", 0.1), ASKED),
    ]);
    let table = atlas(&baked, TableKind::Fgd);
    let mut crossed = 0f64;
    for texel in 0..16 * 16 {
        let [glass, metal] = [0, 1].map(|tile| {
            let [x, y] = table.layout.origin(tile);
            let t = table.truth.texel(x + texel % 16, y + texel / 16);
            (luminance([t[0], t[1], t[2]].map(f64::from)), f64::from(t[3]))
        });
        assert!(glass.1 <= glass.0 + 1e-6 && glass.0 <= 1.0);
        crossed = crossed.max(glass.0 - glass.1);
        assert!((metal.0 - metal.1).abs() < 1e-6, "nothing crosses into a metal");
    }
    assert!(crossed > 0.005, "{crossed}");
}

/// The smooth end of the table is Fresnel's reflectance in all its colour. Oracle: colours at normal incidence to four digits, from
/// another program (see the optics' tests of metals); half floats are 5e-4 apart above 1.
#[test]
fn smooth_metals_keep_their_colour() {
    let settings = OTHERS.to_owned() + "[bake.fgd]\nsize = [16, 16]\n";
    for (name, expected) in
        [("au", [1.0376, 0.7284, 0.3646]), ("cu", [0.9317, 0.6227, 0.5223]), ("ag", [0.9894, 0.9840, 0.9778])]
    {
        let baked = bake_all(&[material("metal", &conductor(&format!("\"{name}\""), 0.1), &settings)]);
        let found = sample(atlas(&baked, TableKind::Fgd), [1.0, 0.0]);
        for (a, b) in found.into_iter().zip(expected) {
            assert!((a - b).abs() < 6e-4, "{name}: {found:?} {expected:?}");
        }
    }
}
