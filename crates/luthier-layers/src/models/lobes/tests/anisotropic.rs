//! Tests of lobes of anisotropic stacks.

use std::f64::consts::{FRAC_PI_2, PI};

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Layer, Slab, Stack, Surface};

use super::{direction, integral};
use crate::models::lobes::{Axes, Below, FitSettings, Lobes, Simulation};
use crate::monochrome::Monochrome;
use crate::references::layered_mc::{InterfaceMode, LayeredMc};

const NM: [f64; 3] = [650.0, 550.0, 450.0];

const SETTINGS: FitSettings = FitSettings { rows: 11, paths: 8192, seed: 5 };

/// A coat on a metal, by slope parameters and rotations.
fn coated(coat: [f64; 3], base: [f64; 3]) -> Stack {
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.0; 3] };
    let layer = |[alpha_x, alpha_y, rotation]: [f64; 3], base| Layer {
        films: Vec::new(),
        surface: Surface { distribution: Distribution::Ggx, alpha_x, alpha_y, rotation },
        base,
    };
    let metal = Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() };
    let clear = Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab };
    Stack { exterior: Ior::vacuum(), layers: vec![layer(coat, clear), layer(base, metal)] }
}

fn fitted(stack: &Stack, count: usize) -> Lobes {
    Simulation::new(stack, &Color::ThreeWavelengths(NM), SETTINGS).fit(count)
}

/// A direction turned by an angle about the normal.
fn turned(w: DVec3, angle: f64) -> DVec3 {
    let (sin, cos) = libm::sincos(angle);
    DVec3::new(cos * w.x - sin * w.y, sin * w.x + cos * w.y, w.z)
}

/// Oracle: optics. Between refracted directions, a metal under a smooth coat shows its own two widths, whatever the azimuth.
#[test]
fn a_brushed_metal_under_a_smooth_coat_shows_its_own_widths() {
    let settings = FitSettings { paths: 32_768, ..SETTINGS };
    let stack = coated([0.0; 3], [0.3, 0.1, 0.0]);
    let lobes = Simulation::new(&stack, &Color::ThreeWavelengths(NM), settings).fit(1);
    assert!((lobes.frame.index - 1.5).abs() < 1e-9, "{}", lobes.frame.index);
    assert_eq!(lobes.rows.len(), 11 * Axes::TILES);
    for tile in 0..Axes::TILES {
        // The more of the lobe the critical angle cuts off, the less of it is left to tell its width by.
        for (row, tolerance) in [(10, 0.12), (9, 0.2), (8, 0.25)] {
            let lobe = lobes.tile(tile)[row].lobes[0];
            let widths = lobe.in_axes([0.0; 2]).width;
            assert!((widths[1] / 0.3 - 1.0).abs() < tolerance, "{tile} {row}: {lobe:?}");
            assert!((widths[0] / 0.1 - 1.0).abs() < tolerance, "{tile} {row}: {lobe:?}");
            assert!(lobe.sharpness[1] > 2.0 * lobe.sharpness[0], "{tile} {row}: {lobe:?}");
        }
    }
}

/// Oracle: paths of the reference with other random numbers, and a quadrature of the values.
#[test]
fn energy_is_that_of_the_simulation_at_all_azimuths() {
    for stack in [coated([0.2, 0.2, 0.0], [0.4, 0.15, 0.3]), coated([0.3, 0.1, 0.7], [0.4, 0.15, 0.0])] {
        let lobes = fitted(&stack, 2);
        for (theta_deg, phi) in [(0.0, 0.0), (35.0, 0.5), (35.0, 2.3), (65.0, 1.2), (65.0, 4.0)] {
            let wo = direction(theta_deg, phi);
            let mc = LayeredMc { seed: 77, ..LayeredMc::new(InterfaceMode::SmithWalk) };
            let expected = mc.albedo(&Monochrome::new(&stack, NM[1], 1), wo, 20_000).mean;
            let prepared = lobes.prepare(wo).unwrap();
            let stated = prepared.albedo_dir()[1];
            let values = integral(wo, |wi| prepared.eval(wi)[1]);
            assert!((stated - expected).abs() < 0.01, "{theta_deg} {phi}: {stated} {expected}");
            assert!((values - stated).abs() < 0.02, "{theta_deg} {phi}: {values} {stated}");
        }
    }
}

/// Oracle: the integral of the density by quadrature, in all and in a half.
#[test]
fn samples_have_their_density() {
    let lobes = fitted(&coated([0.3, 0.1, 0.7], [0.4, 0.15, 0.0]), 2);
    for (theta_deg, phi) in [(30.0, 2.0), (70.0, 4.5)] {
        let wo = direction(theta_deg, phi);
        let prepared = lobes.prepare(wo).unwrap();
        // A lattice (Roberts 2018).
        let steps = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
        let (mut drawn, mut right) = (0.0, 0.0);
        let is_right = |wi: DVec3| wi.x > 0.1;
        for i in 0..60_000 {
            let u = steps.map(|step| (0.5 + step * f64::from(i)).rem_euclid(1.0));
            if let Some(sample) = prepared.sample(u) {
                let share = 1.0 / 60_000.0;
                drawn += share;
                right += if is_right(sample.wi) { share } else { 0.0 };
                assert!((sample.wi.length() - 1.0).abs() < 1e-9 && sample.wi.z > 0.0);
            }
        }
        let whole = integral(wo, |wi| prepared.pdf_solid_angle(wi));
        let half = integral(wo, |wi| if is_right(wi) { prepared.pdf_solid_angle(wi) } else { 0.0 });
        assert!((whole - drawn).abs() < 0.01, "{theta_deg}: {whole} {drawn}");
        assert!((half - right).abs() < 0.02, "{theta_deg}: {half} {right}");
    }
}

/// Oracle: a fit to a simulation that was seen from there.
#[test]
fn between_azimuths_lobes_are_those_that_are_fitted_there() {
    let stack = coated([0.1, 0.1, 0.0], [0.4, 0.15, 0.0]);
    let lobes = fitted(&stack, 1);
    // Turned so that what was between two azimuths is at one.
    let [cos, sin] = lobes.frame.axes.unwrap().azimuth(2.5);
    let angle = libm::atan2(sin, cos);
    let mut other = stack.clone();
    other.layers[0].surface = Surface { alpha_y: 0.100_001, rotation: -angle, ..other.layers[0].surface };
    let seen = fitted(&other, 1);
    assert!(!seen.frame.axes.unwrap().is_mirrored && lobes.frame.axes.unwrap().is_mirrored);
    for (theta_deg, phi) in [(20.0, angle), (50.0, angle), (50.0, PI - angle)] {
        let wo = direction(theta_deg, phi);
        let [ours, theirs] = [&lobes, &seen].map(|lobes| lobes.below(wo).unwrap());
        let moved = 0.5 * integral(wo, |wi| (ours.eval(wi)[1] - theirs.eval(wi)[1]).abs());
        assert!(moved < 0.04, "{theta_deg} {phi}: {moved}");
    }
}

/// Oracle: geometry. The turned stack is the stack seen from elsewhere: with other light of the same paths that is near, with the same
/// rows exact.
#[test]
fn turning_the_stack_turns_the_answer() {
    let lobes = fitted(&coated([0.2, 0.2, 0.0], [0.4, 0.15, 0.3]), 1);
    let other = fitted(&coated([0.2, 0.2, 0.0], [0.4, 0.15, 1.0]), 1);
    for (theta_deg, phi) in [(0.0, 0.0), (40.0, 0.9), (70.0, 2.2), (70.0, 5.0)] {
        let (wo, wi) = (direction(theta_deg, phi), direction(35.0, phi + 2.8));
        let [here, there] = [lobes.eval(wi, wo)[1], other.eval(turned(wi, 0.7), turned(wo, 0.7))[1]];
        assert!((here - there).abs() < 0.1 * here, "{theta_deg} {phi}: {here} {there}");
        // A stack that is its own mirror image.
        let across = 2.0 * 0.3;
        let mirror = |w: DVec3| turned(DVec3::new(w.x, -w.y, w.z), across);
        let mirrored = lobes.eval(mirror(wi), mirror(wo))[1];
        assert!((here / mirrored - 1.0).abs() < 1e-9, "{theta_deg} {phi}: {here} {mirrored}");
        // Half a turn changes nothing, a quarter does.
        let half = lobes.eval(turned(wi, PI), turned(wo, PI))[1];
        assert!((here / half - 1.0).abs() < 1e-9, "{theta_deg} {phi}: {here} {half}");
        let quarter = lobes.eval(turned(wi, FRAC_PI_2), turned(wo, FRAC_PI_2))[1];
        assert!(theta_deg == 0.0 || (here / quarter - 1.0).abs() > 0.02, "{theta_deg} {phi}: {here} {quarter}");
    }
}

/// At normal incidence there is no azimuth, and over the seam of a circle nothing jumps.
#[test]
fn rows_meet_along_the_normal_and_over_the_seam() {
    for stack in [coated([0.2, 0.2, 0.0], [0.4, 0.15, 0.3]), coated([0.3, 0.1, 0.7], [0.4, 0.15, 0.0])] {
        let lobes = fitted(&stack, 2);
        let wi = direction(30.0, 1.0);
        let along = Below::new(lobes.frame, lobes.row(DVec3::Z), DVec3::Z).eval(wi)[1];
        for tile in 0..Axes::TILES {
            let here = lobes.tile(tile)[10].clone();
            assert_eq!(here.energies(), lobes.row(DVec3::Z).energies());
            assert!((Below::new(lobes.frame, here, DVec3::Z).eval(wi)[1] / along - 1.0).abs() < 1e-12, "{tile}");
        }
        let start = libm::atan2(lobes.frame.axes.unwrap().turn[1], lobes.frame.axes.unwrap().turn[0]);
        for quarter in [0.0, FRAC_PI_2, PI, 3.0 * FRAC_PI_2] {
            let [before, after] = [-1e-9, 1e-9].map(|step| lobes.eval(wi, direction(60.0, start + quarter + step))[1]);
            assert!((before / after - 1.0).abs() < 1e-6, "{quarter}: {before} {after}");
        }
    }
}
