//! Tests of values that rare paths carry: a stated standard error is true.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

use super::fixtures::rough_coat_on_metal;
use super::random::Stream;
use super::rough::{Rough, Sided};
use super::walk::one_ended;
use super::{Interface, InterfaceMode, LayeredMc, Side};
use crate::model::Estimate;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use crate::references::random_walk::RandomWalk;

/// An error is false where the truth is farther off than this many of it.
const SIGMAS: f64 = 5.0;

/// Relative difference that rounding makes to a value from either end: D and Lambda of Beckmann's surface far out.
const ROUNDING: f64 = 1e-9;

/// Samples of a value: the number that models are registered with.
const SAMPLES: u64 = 4096;

fn towards(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(theta_deg.to_radians());
    let (sin_phi, cos_phi) = libm::sincos(phi_deg.to_radians());
    DVec3::new(sin * cos_phi, sin * sin_phi, cos)
}

fn interface(above: f64, below: Complex64, surface: Surface) -> MonochromeLayer {
    let below = if below.im > 0.0 {
        MonochromeBelow::Conductor { ior: below }
    } else {
        MonochromeBelow::dielectric(below.re, 0.0)
    };
    MonochromeLayer { surface, above, films: Vec::new(), below, f0: None }
}

fn above(direction: DVec3) -> Sided {
    Sided { side: Side::Above, direction }
}

/// Walks from one end that are counted as they come.
fn plain(rough: &Rough, wi: DVec3, wo: DVec3, samples: u64, seed: u64) -> Estimate {
    Estimate::of(samples, |i| one_ended(rough, &mut Stream::new(seed, i), above(wo), above(wi)))
}

/// Number of errors of a sweep, of those that are believed, and of those of them that are false.
#[derive(Default)]
struct Count {
    all: u32,
    settled: u32,
    wrong: u32,
}

impl Count {
    /// `std_err` is what would be printed.
    fn add(&mut self, mean: f64, std_err: f64, truth: Estimate, what: &str) {
        self.all += 1;
        if std_err.is_infinite() {
            eprintln!("{what}: {mean:.4e} not settled, truth {:.4e} +- {:.1e}", truth.mean, truth.std_err);
            return;
        }
        self.settled += 1;
        let off = (mean - truth.mean).abs();
        if off > SIGMAS * libm::hypot(std_err, truth.std_err) + ROUNDING * truth.mean {
            self.wrong += 1;
            eprintln!("{what}: {mean:.4e} +- {std_err:.1e}, truth {:.4e} +- {:.1e}", truth.mean, truth.std_err);
        }
    }

    fn shares(&self) -> [f64; 2] {
        [f64::from(self.settled) / f64::from(self.all), f64::from(self.wrong) / f64::from(self.settled)]
    }
}

/// Light of 85 degrees seen from the normal, inside glass. Oracle: no value of any direction, but whole paths, counted where they leave:
/// those of an eye at 85 degrees in the cone of 4 degrees around the normal, by reciprocity.
#[test]
fn grazing_light_that_goes_from_facet_to_facet() {
    let (wi, wo) = (towards(85.0, 0.0), DVec3::Z);
    let surface = Surface::isotropic(Distribution::Ggx, 0.05);
    let glass = Monochrome { exterior: 1.5, layers: vec![interface(1.5, Complex64::ONE, surface)] };
    let cos_cone = libm::cos(4f64.to_radians());
    let paths = LayeredMc { mode: InterfaceMode::SmithWalk, samples: 6_000_000, seed: 8 };
    let hits = paths.paths(&glass, wi).flatten().filter(|(direction, _)| direction.z > cos_cone).count() as f64;
    // The mean over the cone of f; what curvature adds to it is below a per cent.
    let solid_angle = 2.0 * PI * (1.0 - cos_cone);
    let counted = hits / 6e6 / solid_angle * wi.z;
    let counted = Estimate::known(counted, counted * libm::hypot(1.0 / hits.sqrt(), 0.01));
    let walk = RandomWalk { samples: SAMPLES, seed: 3 };
    let layered = LayeredMc { mode: InterfaceMode::SmithWalk, samples: SAMPLES, seed: 3 };
    let one = walk.density(&glass.layers[0], (Side::Above, wo), (Side::Above, wi));
    for found in [one, layered.estimate(&glass, wi, wo)] {
        eprintln!(
            "{:.4e} +- {:.1e}, counted {:.4e} +- {:.1e}",
            found.mean, found.std_err, counted.mean, counted.std_err
        );
        assert!(
            (found.mean - counted.mean).abs() < 4.0 * libm::hypot(found.std_err, counted.std_err),
            "{found:?} {counted:?}"
        );
        assert!(found.std_err < 0.04 * found.mean && counted.std_err < 0.05 * counted.mean, "{found:?}");
    }
}

/// Oracle: twenty-five times the walks from the end that grazes more, which need no luck, without the weights and the forced meetings of
/// the kernel.
#[test]
fn errors_of_one_interface_are_true() {
    let (mut now, mut naive) = (Count::default(), Count::default());
    let indices = [(1.5, Complex64::ONE), (1.0, Complex64::new(1.5, 0.0)), (1.0, Complex64::new(0.2, 3.5))];
    let angles = [(85.0, 0.0, 0.0), (85.0, 85.0, 150.0), (60.0, 5.0, 90.0), (30.0, 70.0, 180.0), (89.0, 45.0, 20.0)];
    for (index_above, below) in indices {
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for alpha in [0.02, 0.05, 0.15, 0.4] {
                let layer = interface(index_above, below, Surface::isotropic(distribution, alpha));
                let Some(rough) = Interface::new(&layer, InterfaceMode::SmithWalk).rough().cloned() else { panic!() };
                for (theta_i, theta_o, phi) in angles {
                    let (wi, wo) = (towards(theta_i, 0.0), towards(theta_o, phi));
                    let what = format!("{index_above} {below} {distribution:?} {alpha} {theta_i} {theta_o} {phi}");
                    // f cos_theta_i from the end of wi: reciprocity. Where both ends graze, one that needs no luck is not there.
                    let truth = if (wi.z - wo.z).abs() < 0.1 {
                        RandomWalk { samples: 25 * SAMPLES, seed: 99 }.density(
                            &layer,
                            (Side::Above, wo),
                            (Side::Above, wi),
                        )
                    } else if wi.z < wo.z {
                        Estimate::sum([(wi.z / wo.z, plain(&rough, wo, wi, 25 * SAMPLES, 99))])
                    } else {
                        plain(&rough, wi, wo, 25 * SAMPLES, 99)
                    };
                    if !truth.is_settled() {
                        continue;
                    }
                    for seed in 0..4 {
                        let walks = RandomWalk { samples: SAMPLES, seed };
                        let found = walks.density(&layer, (Side::Above, wo), (Side::Above, wi));
                        now.add(found.mean, found.std_err, truth, &what);
                        let old = plain(&rough, wi, wo, SAMPLES, seed);
                        naive.add(old.mean, old.variance().sqrt(), truth, "as it was");
                    }
                }
            }
        }
    }
    let ([settled, wrong], [_, was_wrong]) = (now.shares(), naive.shares());
    eprintln!("{} values: {settled:.3} settled, {wrong:.4} of them wrong; naively {was_wrong:.4}", now.all);
    assert!(wrong <= 0.01 && settled > 0.65 && now.all >= 300, "{settled} {wrong}");
    assert!(was_wrong > 0.02, "{was_wrong}: the sweep is no test");
}

/// Oracle: light and eye exchanged, with thirty-two times the samples.
#[test]
fn errors_of_stacks_are_true() {
    let mut count = Count::default();
    for (coat, base) in [(0.05, 0.05), (0.3, 0.02), (0.02, 0.4)] {
        let stack = rough_coat_on_metal(coat, base);
        for (theta_i, theta_o, phi) in [(85.0, 0.0, 0.0), (60.0, 50.0, 170.0), (30.0, 70.0, 20.0)] {
            let (wi, wo) = (towards(theta_i, 0.0), towards(theta_o, phi));
            let mc = |samples, seed| LayeredMc { mode: InterfaceMode::SmithWalk, samples, seed };
            let truth = Estimate::sum([(wi.z / wo.z, mc(32 * SAMPLES, 77).estimate(&stack, wo, wi))]);
            if !truth.is_settled() {
                eprintln!("no truth: {coat} {base} {theta_i} {theta_o}");
                continue;
            }
            for seed in 0..12 {
                let found = mc(SAMPLES, seed).estimate(&stack, wi, wo);
                count.add(found.mean, found.std_err, truth, &format!("{coat} {base} {theta_i} {theta_o} {phi}"));
            }
        }
    }
    let [settled, wrong] = count.shares();
    eprintln!("{} values: {settled:.3} settled, {wrong:.4} of them wrong", count.all);
    assert!(wrong <= 0.01 && count.all >= 72, "{settled} {wrong}");
}
