use luthier_lut::{Image, TableKind};
use luthier_manifest::ShadingModel;
use luthier_report::{Compared, Form, Report, ReportError, Settings, Subject, Weights, judge};

use crate::fixture::Bake;

fn settings() -> Settings<'static> {
    Settings { pairs_per_set: 600, ..Settings::default() }
}

fn all(report: &Report, compared: Compared) -> Vec<f64> {
    report.materials.iter().map(|m| m.comparison(compared).unwrap().max_error()).collect()
}

#[test]
fn a_planted_error_of_one_percent_is_found() {
    let bake = Bake::new();
    let mut device =
        bake.device(
            |form, material, pair, value| {
                if (form, material, pair) == (Form::Baked, 1, 77) { value.map(|v| v * 1.01) } else { value }
            },
        );
    device.baked_reads_tables = false;
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    // The device has no other error than the rounding of its results to f32.
    let errors = all(&report, Compared::BakedDevice);
    assert!((errors[1] - 0.01).abs() < 2e-7, "{errors:?}");
    assert!([0, 2, 3].iter().all(|&m| errors[m] < 1e-7), "{errors:?}");
    assert!(all(&report, Compared::FullDevice).iter().all(|e| *e < 1e-7));
    assert_eq!(report.max_error(), errors[1]);
    let worst = report.worst().unwrap();
    assert_eq!((worst.material, worst.compared), ("lacquered-copper", Compared::BakedDevice));
}

#[test]
fn an_error_in_the_dark_is_held_against_the_floor() {
    let bake = Bake::new();
    let mut device = bake.device(|form, material, pair, value| {
        // Lambertian red is far from black, but nothing is there at grazing angles: add one ten-thousandth.
        if (form, material, pair) == (Form::Full, 0, 0) { value.map(|v| v + 1e-4) } else { value }
    });
    device.baked_reads_tables = false;
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    // Pair 0 of the grazing set has cosines of 3e-4: reference far below the floor of 0.1/pi.
    let comparison = report.materials[0].comparison(Compared::FullDevice).unwrap();
    let grazing = &comparison.sets[1].1;
    let expected = 1e-4 / (0.1 / std::f64::consts::PI);
    assert!((grazing.relative.max - expected).abs() < 1e-6, "{} {expected}", grazing.relative.max);
    assert!((grazing.max_abs_err - 1e-4).abs() < 1e-9);
}

#[test]
fn values_that_are_not_finite_are_counted_and_fail_any_budget() {
    let bake = Bake::new();
    let device = bake.device(|form, material, pair, value| match (form, material, pair) {
        (Form::Full, 2, 5) => [f32::NAN, f32::INFINITY, value[2]],
        _ => value,
    });
    let settings = Settings { budget: Some(1e6), ..settings() };
    let report = judge(&bake.subject(), Some(&device), &settings).unwrap();
    let sets = &report.materials[2].comparison(Compared::FullDevice).unwrap().sets;
    assert!(sets.iter().all(|(_, s)| s.not_finite == 2));
    assert_eq!(report.max_error(), f64::INFINITY);
    assert_eq!(report.is_within_budget(), Some(false));
    // The same pair in the four sets of the section on stability, and in the quadrature of the first albedo.
    let found = report.findings.iter().filter(|finding| finding.contains("not finite")).count();
    assert_eq!(found, sets.len() + 4 + 1, "{:?}", report.findings);
    let stability = report.materials[2].stability.as_ref().unwrap();
    assert_eq!(stability.not_finite(), 4 * 2 + 1);
}

#[test]
fn the_split_adds_up() {
    let bake = Bake::new();
    // A device that reads the tables without error of its own: what is left is the tables' doing.
    let device = bake.device(|_, _, _, value| value);
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    assert_eq!(report.device_weights, Some(Weights::Exact));
    let (total, tables) = (all(&report, Compared::BakedDevice), all(&report, Compared::TablesExact));
    for (total, tables) in total.iter().zip(&tables) {
        assert!((total - tables).abs() < 1e-7, "{total} {tables}");
    }
    assert!(all(&report, Compared::Arithmetic).iter().all(|e| *e < 1e-7));
    assert!(tables[1] > 1e-5, "tables of half floats cannot be this good: {tables:?}");

    // And with an error of its own, the total is at most the sum.
    let device = bake.device(|_, _, pair, value| value.map(|v| v * if pair % 2 == 0 { 1.002 } else { 0.999 }));
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    for material in &report.materials {
        let sets = |compared| &material.comparison(compared).unwrap().sets;
        let parts = sets(Compared::Arithmetic).iter().zip(sets(Compared::TablesExact));
        for ((_, total), ((_, arithmetic), (_, tables))) in sets(Compared::BakedDevice).iter().zip(parts) {
            assert!(total.max_abs_err <= arithmetic.max_abs_err + tables.max_abs_err + 1e-12);
            assert!(arithmetic.relative.max < 0.002 + 1e-6, "{}", arithmetic.relative.max);
        }
        let arithmetic = material.comparison(Compared::Arithmetic).unwrap().max_error();
        assert!((arithmetic - 0.002).abs() < 1e-6, "{arithmetic}");
    }
}

#[test]
fn a_diffuse_base_has_no_table_and_no_table_error() {
    let bake = Bake::new();
    let report = judge(&bake.subject(), None, &settings()).unwrap();
    assert_eq!(all(&report, Compared::TablesEightBit)[3], 0.0);
    assert_eq!(all(&report, Compared::ThreeWavelengths)[3], 0.0);
    assert!(all(&report, Compared::ThreeWavelengths)[2] > 0.01, "copper is not three wavelengths");
    assert!(report.materials[3].comparison(Compared::BakedDevice).is_none());
    assert_eq!(report.max_error(), all(&report, Compared::TablesEightBit).into_iter().fold(0.0, f64::max));
}

#[test]
fn a_spoilt_texel_is_found_and_held_against_the_baker() {
    let mut bake = Bake::new();
    bake.manifest.tables[0].tiles[2].error.max_abs_err = 1e-3;
    assert_eq!(bake.textures[0].0, TableKind::Fresnel);
    // Tile 2, node 64, green: a quarter too much, while the baker claims a thousandth.
    bake.textures[0].1.texel_mut(64, 2)[1] += 0.25;
    let report = judge(&bake.subject(), None, &settings()).unwrap();
    let tile = &report.tables[0].tiles[2];
    let judge = tile.judge.as_ref().unwrap();
    // The nearest scan point is within 1/8 of a cell of the node, where interpolation leaves at least 7/8 of it.
    assert!((0.25 * 7.0 / 8.0 - 1e-3..0.25 + 1e-3).contains(&judge.max_abs_err), "{}", judge.max_abs_err);
    assert!((judge.worst.at[0] - 64.0 / 127.0).abs() < 1.0 / (8.0 * 127.0));
    assert_eq!(judge.worst.channel, 1);
    assert!(report.findings.iter().any(|f| f.starts_with("fresnel tile lacquered-copper/1: measured here 0.2")));
    let other = report.tables[0].tiles[0].judge.as_ref().unwrap();
    assert!(other.max_abs_err < 1e-3, "{}", other.max_abs_err);
}

#[test]
fn the_report_is_the_same_every_time_and_survives_json() {
    let bake = Bake::new();
    let device = bake.device(|_, _, _, value| value);
    let settings = Settings { pairs_per_set: 50, budget: Some(1e-3), ..Settings::default() };
    let report = judge(&bake.subject(), Some(&device), &settings).unwrap();
    assert_eq!(report, judge(&bake.subject(), Some(&device), &settings).unwrap());
    assert_eq!(Report::from_json(&report.to_json().unwrap()).unwrap(), report);
}

#[test]
fn what_does_not_fit_together_is_refused() {
    let bake = Bake::new();
    let refused = |change: &dyn Fn(&mut Bake)| {
        let mut bake = Bake::new();
        change(&mut bake);
        judge(&bake.subject(), None, &settings()).unwrap_err()
    };
    assert!(matches!(
        refused(&|b| {
            b.stacks.pop();
        }),
        ReportError::MaterialCount { manifest: 4, stacks: 3 }
    ));
    assert!(matches!(refused(&|b| b.stacks.swap(0, 1)), ReportError::Layers { layer: 1, .. }));
    assert!(matches!(refused(&|b| b.textures.clear()), ReportError::MissingTexture(TableKind::Fresnel)));
    assert!(matches!(refused(&|b| b.textures[1].1 = Image::zeros(4, 4, 1)), ReportError::TextureSize { .. }));
    assert!(matches!(refused(&|b| b.manifest.tables[0].layout.columns = 0), ReportError::Layout { .. }));
    assert!(matches!(refused(&|b| b.manifest.tables[0].layout.x.size = u32::MAX), ReportError::TextureSize { .. }));
    assert!(matches!(
        refused(&|b| b.manifest.materials[0].layers[0].tiles[TableKind::Fresnel] = Some(99)),
        ReportError::MissingTile { layer: 0, kind: TableKind::Fresnel, .. }
    ));
    assert!(matches!(
        refused(&|b| b.manifest.materials[0].model = ShadingModel::Belcour),
        ReportError::MissingTile { layer: 0, kind: TableKind::Fgd, .. }
    ));
    let none = Settings { pairs_per_set: 0, ..Settings::default() };
    assert!(matches!(judge(&bake.subject(), None, &none).unwrap_err(), ReportError::NoPairs));
    let nothing = Subject { textures: Vec::new(), ..bake.subject() };
    assert!(judge(&nothing, None, &settings()).is_err());
}
