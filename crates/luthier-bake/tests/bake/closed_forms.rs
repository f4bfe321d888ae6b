//! Fresnel rows and slope distributions: the errors that tiles state, measured again against closed forms.

use std::f64::consts::{FRAC_PI_2, PI};

use luthier_lut::{Atlas, TableKind, WeightBits};

use crate::brute_force;
use crate::materials::{ASKED, atlas, bake_all, conductor, dielectric, material};

/// Largest error over a grid of `u` much denser than the baker's.
fn rescan(atlas: &Atlas, tile: u32, steps: [u32; 2], expected: impl Fn([f64; 2]) -> f64) -> f64 {
    let layout = &atlas.layout;
    let mut worst = 0f64;
    for j in 0..steps[1] {
        for i in 0..steps[0] {
            let u = [(i, steps[0]), (j, steps[1])].map(|(i, n)| (f64::from(i) + 0.5) / f64::from(n));
            let values = [layout.x.decode(u[0]), layout.y.as_ref().map_or(0.0, |y| y.decode(u[1]))];
            let found = atlas.sample(tile, values, WeightBits::Fixed(8))[0];
            worst = worst.max((found - expected(values)).abs());
        }
    }
    worst
}

/// Asserts that a denser scan finds little more than the error stated, and most of it.
fn assert_confirmed(what: &str, stated: f64, found: f64) {
    assert!(found <= 1.02 * stated && found >= 0.7 * stated, "{what}: {found} found, {stated} stated");
}

#[test]
fn errors_of_fresnel_rows_are_as_stated() {
    for settings in ["", "format = \"rgba8unorm\"", "mapping = \"sqrt-cosine\"", "mapping = \"theta\"\nsize = 64"] {
        let rows =
            format!("[bake.fresnel]\n{settings}\n[bake.fgd]\nsize = [4, 4]\n[bake.distribution]\nsize = [4, 4]\n");
        let baked = bake_all(&[
            material("glass", &dielectric("1.5", 0.1), &rows),
            material("metal", &conductor("{ n = 3.2, k = 3.3 }", 0.1), ""),
        ]);
        let fresnel = atlas(&baked, TableKind::Fresnel);
        let theta = settings.contains("theta");
        let cos = |value: f64| if theta { value.cos() } else { value };
        let glass = rescan(fresnel, 0, [20_000, 1], |v| brute_force::dielectric(1.5, cos(v[0])));
        assert_confirmed(settings, fresnel.tiles[0].error.max_abs_err, glass);
        let metal = rescan(fresnel, 1, [20_000, 1], |v| brute_force::conductor(3.2, 3.3, cos(v[0])));
        assert_confirmed(settings, fresnel.tiles[1].error.max_abs_err, metal);
        assert!(glass < 6e-3 && metal < 6e-3);
    }
}

/// `pi alpha^2 D` in angles: exp(-tan^2/m^2)/cos^4, and m^4 / (cos^4 (m^2 + tan^2)^2).
fn scaled(beckmann: bool, theta: f64, m: f64) -> f64 {
    if theta >= FRAC_PI_2 {
        return if beckmann { 0.0 } else { m.powi(4) };
    }
    let (tan_sq, cos_4) = (theta.tan().powi(2), theta.cos().powi(4));
    if beckmann { (-tan_sq / (m * m)).exp() / cos_4 } else { m.powi(4) / (cos_4 * (m * m + tan_sq).powi(2)) }
}

#[test]
fn errors_of_slope_distributions_are_as_stated() {
    for settings in ["", "format = \"r32float\"", "mapping = \"linear\"\nalpha_mapping = \"linear\"", "exponent = 4"] {
        let tables = format!("[bake.distribution]\nsize = [96, 64]\n{settings}\n[bake.fgd]\nsize = [4, 4]\n");
        let baked = bake_all(&[
            material("ggx", &dielectric("1.5", 0.1), &tables),
            material("beckmann", &(dielectric("1.5", 0.1) + "distribution = \"beckmann\"\n"), ASKED),
        ]);
        let table = atlas(&baked, TableKind::Distribution);
        for (tile, entry) in table.tiles.iter().enumerate() {
            let beckmann = entry.name == "beckmann";
            let found = rescan(table, tile as u32, [96 * 10, 64 * 10], |[theta, m]| scaled(beckmann, theta, m));
            assert_confirmed(&format!("{} {settings}", entry.name), entry.error.max_abs_err, found);
        }
    }
}

/// Slope distributions are numbers for every m in (0, 1] and every angle, not negative and at most the peak; D/D(0) is 1 at the normal.
#[test]
fn slope_distributions_are_numbers_everywhere() {
    for settings in ["", "alpha_mapping = \"linear\"", "format = \"r16float\"", "mapping = \"cos-power\""] {
        let tables = format!("[bake.distribution]\nsize = [64, 64]\n{settings}\n[bake.fgd]\nsize = [4, 4]\n");
        let baked = bake_all(&[
            material("ggx", &dielectric("1.5", 0.1), &tables),
            material("beckmann", &(dielectric("1.5", 0.1) + "distribution = \"beckmann\"\n"), ASKED),
        ]);
        let table = atlas(&baked, TableKind::Distribution);
        let normal = if settings.contains("cos-power") { 1.0 } else { 0.0 };
        assert!(table.texels.data.iter().all(|v| v.is_finite()));
        for tile in 0..2 {
            for m in [1e-300, 1e-9, 1e-4, 1e-3, 0.0021, 0.02, 0.3, 1.0] {
                let peak = table.sample(tile, [normal, m], WeightBits::Fixed(8))[0];
                assert!((peak - 1.0).abs() < 1e-3, "{settings} {m}: {peak}");
                for i in 0..=400 {
                    let x = table.layout.x.max * f64::from(i) / 400.0;
                    let d = table.sample(tile, [x, m], WeightBits::Fixed(8))[0] / (PI * m * m).max(f64::MIN_POSITIVE);
                    assert!((0.0..=f64::MAX).contains(&d), "{settings} {m} {x}: {d}");
                }
            }
        }
    }
}
