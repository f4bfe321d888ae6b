//! Directions drawn at places of a family.

use glam::DVec3;
use luthier_optics::color::Color;

use super::{NM, coat, layer, stack};
use crate::models::lobes::{Family, FitSettings, Mix, Paint, Slopes, Varied, Varying};
use luthier_optics::ior::Ior;
use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Base, Diffuse, Slab};

const DRAWN: u32 = 60_000;

/// Bins over the cosine and over the azimuth, and points of the midpoint rule along each side of one.
const BINS: [usize; 2] = [10, 16];
const POINTS: usize = 40;

/// Oracle: the density by a midpoint rule, and chi-square (a normal quantile by Wilson and Hilferty 1931). Bases are metal, plastic, mixed, and anisotropic.
#[test]
fn draws_at_places_of_a_family_follow_their_density() {
    let plastic = |n: f64| Base::Dielectric {
        ior: Ior::constant(n, 0.0).unwrap().with_f0([0.04; 3]),
        slab: Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] },
    };
    let diffuse = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
    let whole =
        stack(vec![layer(0.3, coat([0.0; 3])), layer(0.5, plastic(1.5 * DIELECTRIC_INDEX)), layer(0.0, diffuse)]);
    let family = Family::new(&whole, [0.2, 0.4], [0.2, 0.6], true).unwrap();
    let settings = FitSettings { rows: 10, paths: 8000, seed: 5 };
    let color = Color::ThreeWavelengths(NM);
    let varied = Varied::with(&whole, &color, Some(Varying::Family(family)), settings);
    let brushed = Slopes { along: [0.6, 0.2], turn: [0.6, 0.8] };
    for (slopes, shade, metallic) in [
        ([0.25.into(), 0.3.into()], [0.9, 0.6, 0.3], 1.0),
        ([0.4.into(), 0.5.into()], [0.7, 0.4, 0.2], 0.0),
        ([0.3.into(), 0.25.into()], [0.8; 3], 0.5),
        ([0.3.into(), brushed], [0.9, 0.8, 0.7], 1.0),
    ] {
        let level = family.apply(&whole, slopes);
        let lobes = varied
            .painted(
                slopes,
                &Paint::of(&level).mixed(Mix {
                    metal: shade,
                    tint: [1.0; 3],
                    dielectric: [0.04; 3],
                    matt: shade,
                    metallic,
                }),
            )
            .unwrap();
        for theta in [0.1, 0.8, 1.3] {
            let (sin, cos) = libm::sincos(theta);
            let prepared = lobes.prepare(DVec3::new(0.8 * sin, 0.6 * sin, cos)).unwrap();
            let mut expected = vec![0.0; BINS[0] * BINS[1]];
            let sides = BINS.map(|bins| bins * POINTS);
            for (i, j) in (0..sides[0]).flat_map(|i| (0..sides[1]).map(move |j| (i, j))) {
                let z = (i as f64 + 0.5) / sides[0] as f64;
                let (y, x) = libm::sincos(std::f64::consts::TAU * (j as f64 + 0.5) / sides[1] as f64);
                let flat = (1.0 - z * z).sqrt();
                let solid_angle = std::f64::consts::TAU / (sides[0] * sides[1]) as f64;
                expected[i / POINTS * BINS[1] + j / POINTS] +=
                    prepared.pdf_solid_angle(DVec3::new(x * flat, y * flat, z)) * solid_angle * f64::from(DRAWN);
            }
            let mut counts = vec![0.0; expected.len()];
            let (mut greatest, albedo) = (0.0_f64, prepared.albedo_dir().iter().sum::<f64>() / 3.0);
            let mut random = luthier_optics::sampling::split_mix::SplitMix64::new(7);
            for _ in 0..DRAWN {
                let Some(sample) = prepared.sample([random.unit(), random.unit(), random.unit()]) else { continue };
                let turns = (libm::atan2(sample.wi.y, sample.wi.x) / std::f64::consts::TAU).rem_euclid(1.0);
                let bin = [sample.wi.z * BINS[0] as f64, turns * BINS[1] as f64].map(|at| at as usize);
                counts[bin[0].min(BINS[0] - 1) * BINS[1] + bin[1].min(BINS[1] - 1)] += 1.0;
                greatest = greatest.max(sample.weight.iter().sum::<f64>() / 3.0 / albedo);
            }
            let used: Vec<(f64, f64)> =
                counts.iter().copied().zip(expected.iter().copied()).filter(|(_, share)| *share > 10.0).collect();
            let chi_sq: f64 = used.iter().map(|(count, share)| (count - share) * (count - share) / share).sum();
            let spread = 2.0 / (9.0 * used.len() as f64);
            let misfit = (libm::cbrt(chi_sq / used.len() as f64) - (1.0 - spread)) / spread.sqrt();
            assert!(misfit < 4.5, "{slopes:?} {metallic} {theta}: chi-square {chi_sq} of {} bins", used.len());
            assert!(greatest < 1.65, "{slopes:?} {metallic} {theta}: {greatest}");
        }
    }
}
