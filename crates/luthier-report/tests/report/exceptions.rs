use luthier_report::{Cause, Compared, Exception, Factor, Form, Report, Settings, TARGET_MAX_REL_ERR, judge};

use crate::fixture::Bake;

fn settings() -> Settings<'static> {
    Settings { pairs_per_set: 600, ..Settings::default() }
}

fn of<'a>(report: &'a Report, material: &str, compared: Compared) -> &'a Exception {
    report.exceptions.iter().find(|e| e.material == material && e.compared == compared).unwrap()
}

#[test]
fn all_that_miss_the_target_are_listed_and_no_others() {
    let bake = Bake::new();
    let device = bake.device(|form, _, pair, value| match (form, pair) {
        (Form::Full, 7) => value.map(|v| v * 1.1),
        _ => value,
    });
    for device in [None, Some(&device)] {
        let report = judge(&bake.subject(), device.map(|d| d as _), &settings()).unwrap();
        let judged: &[Compared] = match device {
            Some(_) => &[Compared::BakedDevice, Compared::FullDevice],
            None => &[Compared::TablesEightBit],
        };
        let mut listed = 0;
        for material in &report.materials {
            for &compared in judged {
                let max = material.comparison(compared).unwrap().max_error();
                let found = report.exceptions.iter().find(|e| e.material == material.name && e.compared == compared);
                assert_eq!(found.is_some(), max > TARGET_MAX_REL_ERR, "{} {compared:?} {max}", material.name);
                if let Some(exception) = found {
                    assert_eq!(exception.worst.error, max);
                    assert!(exception.samples_above > 0 && exception.samples == 4 * 600 * 3);
                }
                listed += usize::from(found.is_some());
            }
        }
        assert_eq!(report.exceptions.len(), listed);
        assert!(listed > 0);
    }
}

#[test]
fn a_device_without_errors_has_no_exceptions() {
    let bake = Bake::new();
    let mut device = bake.device(|_, _, _, value| value);
    device.baked_reads_tables = false;
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    assert_eq!(report.exceptions, []);
    assert!(
        report
            .to_html(&luthier_report::Exhibits::default())
            .contains("None: no finite sample of the 8 materials × shaders")
    );
}

#[test]
fn a_spoilt_row_is_the_cause() {
    let mut bake = Bake::new();
    // Tile 2 is the copper under the lacquer: a half too much in the middle of the row, more than any other
    // error of these tables.
    (40..120).for_each(|x| bake.textures[0].1.texel_mut(x, 2)[1] += 0.5);
    let report = judge(&bake.subject(), None, &settings()).unwrap();
    let exception = of(&report, "lacquered-copper", Compared::TablesEightBit);
    let Cause::Fresnel { layer: 1, tile, cos_theta_d, expected, sampled } = &exception.parts[0].cause else {
        panic!("{exception:?}");
    };
    assert_eq!(tile, "lacquered-copper/1");
    assert!((39.0 / 127.0..120.0 / 127.0).contains(cos_theta_d));
    assert!((sampled - expected - 0.5).abs() < 2e-3, "{expected} {sampled}");
    assert_eq!(exception.worst.channel, 1);
    assert_eq!(exception.tally[0].0, Factor::Fresnel);
}

#[test]
fn a_spoilt_distribution_is_the_cause() {
    let mut bake = Bake::new();
    // The Beckmann tile, all of it, twice too high.
    for y in 0..512 {
        (0..512).for_each(|x| bake.textures[1].1.texel_mut(x, y)[0] *= 2.0);
    }
    let report = judge(&bake.subject(), None, &settings()).unwrap();
    let exception = of(&report, "copper & <satin>", Compared::TablesEightBit);
    let Cause::Distribution { layer: 0, tile, alpha, expected, sampled, .. } = &exception.parts[0].cause else {
        panic!("{exception:?}");
    };
    assert_eq!((tile.as_str(), *alpha), ("beckmann", 0.15));
    assert!((sampled / expected - 2.0).abs() < 0.05, "{expected} {sampled}");
    // The copper below the lacquer reads the other tile.
    let coat = of(&report, "lacquered-copper", Compared::TablesEightBit);
    assert!(matches!(&coat.parts[0].cause, Cause::Distribution { layer: 0, tile, .. } if tile == "beckmann"));
}

#[test]
fn what_the_device_adds_is_arithmetic() {
    let bake = Bake::new();
    let device =
        bake.device(
            |form, material, pair, value| {
                if (form, material, pair) == (Form::Baked, 0, 77) { value.map(|v| v * 0.9 - 0.01) } else { value }
            },
        );
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    let exception = of(&report, "red-lacquer", Compared::BakedDevice);
    assert_eq!(exception.parts[0].cause, Cause::Arithmetic);
    assert!(exception.parts[0].rel_err < 0.0, "darker than it should be");
    // One pair of each of the four sets, all channels, besides what the tables do.
    assert!(exception.samples_above >= 12);
}

#[test]
fn the_parts_add_up_to_the_error() {
    let mut bake = Bake::new();
    (0..512 * 512).for_each(|i| bake.textures[1].1.texel_mut(i % 512, i / 512)[0] *= 1.003);
    (0..128).for_each(|x| bake.textures[0].1.texel_mut(x, 2)[0] *= 1.002);
    let device = bake.device(|_, _, _, value| value.map(|v| v * 1.004));
    let report = judge(&bake.subject(), Some(&device), &settings()).unwrap();
    assert!(report.exceptions.len() > 3);
    for exception in &report.exceptions {
        let sum: f64 = exception.parts.iter().map(|p| p.rel_err).sum();
        let signed = if exception.worst.found > exception.worst.expected { 1.0 } else { -1.0 } * exception.worst.error;
        // Products of two parts are in the total only.
        let largest = exception.parts[0].rel_err.abs();
        assert!((sum - signed).abs() < 4.0 * largest * largest + 1e-7, "{exception:?}");
    }
}
