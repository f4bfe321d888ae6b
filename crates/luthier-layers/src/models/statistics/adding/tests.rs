//! Tests of adding: closed forms, transfer matrices of power, published widths, and bounds.

use glam::DVec3;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use proptest::prelude::*;

use super::*;
use crate::models::statistics::fixtures::{NotTotal, fresnel};
use crate::models::statistics::spread::{Covariance, alpha};
use crate::monochrome::{Monochrome, MonochromeBelow};

fn glass(ior: f64, optical_depth: f64) -> MonochromeBelow {
    MonochromeBelow::dielectric(ior, optical_depth)
}

/// Interfaces of (alpha, what is below), from the top.
fn stack(layers: &[(f64, MonochromeBelow)]) -> Monochrome {
    let surfaced = |&(alpha, below)| (Surface::isotropic(Distribution::Ggx, alpha), below);
    Monochrome::bare(&layers.iter().map(surfaced).collect::<Vec<_>>())
}

fn metal() -> MonochromeBelow {
    MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.5) }
}

const COS_45: f64 = std::f64::consts::FRAC_1_SQRT_2;

#[test]
fn smooth_coat_on_a_mirror_is_the_closed_form() {
    // Oracle: F + (1-F)^2 a / (1 - F a), n = 1.5 at 45 degrees, to ten digits; without absorption 1.
    for (optical_depth, expected) in [(0.0, 1.0), (0.1, 0.7992518131), (1.0, 0.1441269347)] {
        let stack = stack(&[(0.0, glass(1.5, optical_depth)), (0.0, metal())]);
        let mirror = |layer: usize, cos: f64, _: f64| if layer == 0 { stack.layers[0].reflectance(cos) } else { 1.0 };
        let got = add::<f64, 1>(&Layers::from(&stack), &mirror, COS_45);
        assert!((got.reflected()[0] - expected).abs() < 1e-10, "{optical_depth}: {}", got.reflected()[0]);
        assert!(got.lobes.iter().all(|l| l.spread == 0.0));
    }
}

#[test]
fn the_lossless_limit_of_the_series_is_one() {
    // q = 0: interface and base reflect everything. Nothing is 0/0, and nothing is lost.
    let stack = stack(&[(0.3, glass(1.5, 0.0)), (0.2, metal())]);
    for outer in [1.0, 1.0 - 1e-16, 1.0 - 1e-12, 1.0 - 1e-6] {
        let nearly = |layer: usize, _: f64, _: f64| if layer == 0 { outer } else { 1.0 };
        let got = add::<f64, 1>(&Layers::from(&stack), &nearly, 0.8);
        assert!((got.reflected()[0] - 1.0).abs() < 1e-9, "{outer}: {}", got.reflected()[0]);
        assert!(got.lobes.iter().all(|l| l.energy[0].is_finite() && l.spread.is_finite()));
    }
}

/// Reflected power of incoherent plane layers, by transfer matrices of (downward, upward) power: another formulation than
/// adding. Unpolarised at every interface, as the model has it.
fn transfer_matrices(stack: &Monochrome, cos: f64) -> f64 {
    let mut total = [[1.0, 0.0], [0.0, 1.0]];
    let product = |a: [[f64; 2]; 2], b: [[f64; 2]; 2]| {
        let entry = |i: usize, j: usize| a[i][0] * b[0][j] + a[i][1] * b[1][j];
        [[entry(0, 0), entry(0, 1)], [entry(1, 0), entry(1, 1)]]
    };
    let sin = (1.0 - cos * cos).sqrt();
    for layer in &stack.layers {
        let cos_here = (1.0 - (sin / layer.above) * (sin / layer.above)).sqrt();
        let r = layer.reflectance(cos_here);
        let t = 1.0 - r;
        let MonochromeBelow::Dielectric { ior, optical_depth, .. } = layer.below else {
            // Opaque: upward power is r times downward power.
            return (total[1][0] + total[1][1] * r) / (total[0][0] + total[0][1] * r);
        };
        let a = libm::exp(-optical_depth / (1.0 - (sin / ior) * (sin / ior)).sqrt());
        total = product(total, [[1.0 / t, -r / t], [r / t, (t * t - r * r) / t]]);
        total = product(total, [[1.0 / a, 0.0], [0.0, a]]);
    }
    total[1][0] / total[0][0]
}

#[test]
fn smooth_stacks_agree_with_transfer_matrices() {
    let dielectrics = [(0.0, glass(1.33, 0.2)), (0.0, glass(1.7, 0.05)), (0.0, glass(1.45, 0.0))];
    let on_metal = [(0.0, glass(1.33, 0.2)), (0.0, glass(1.7, 0.05)), (0.0, glass(1.45, 0.4)), (0.0, metal())];
    for layers in [&dielectrics[..], &on_metal[..]] {
        let stack = stack(layers);
        for cos in [1.0, 0.8, 0.5, 0.2, 0.05] {
            let got = add::<f64, 1>(&Layers::from(&stack), &fresnel(&stack), cos).reflected()[0];
            let expected = transfer_matrices(&stack, cos);
            assert!((got - expected).abs() < 1e-12, "{cos}: {got} against {expected}");
        }
    }
}

#[test]
fn base_under_a_rough_coat_has_the_published_width() {
    // Oracle: Belcour's formulas in another program, first pass (no energy between the layers), n = 1.5 at the normal. Sampled light
    // paths have a median-equivalent alpha of .171, .254 and .118: what the model errs by.
    for (coat, base, expected) in [(0.4, 0.05, 0.214), (0.2, 0.2, 0.311), (0.3, 0.01, 0.139)] {
        let stack = stack(&[(coat, glass(1.5, 0.0)), (base, metal())]);
        let first_pass = |layer: usize, _: f64, _: f64| if layer == 0 { 0.0 } else { 1.0 };
        let lobe = add::<f64, 1>(&Layers::from(&stack), &NotTotal(first_pass), 1.0).lobes[1];
        assert!((alpha(lobe.spread) - expected).abs() < 6e-4, "{coat} {base}: {}", alpha(lobe.spread));
    }
}

/// Tangent of the angle between the normal and the half vector of light that enters a smooth coat, meets a facet of a small
/// slope below it and leaves, over that slope: Snell's law in vectors.
fn slope_gain(n: f64, cos: f64) -> f64 {
    let refract = |w: DVec3, n: f64| {
        let (x, y) = (w.x / n, w.y / n);
        DVec3::new(x, y, (1.0 - x * x - y * y).sqrt())
    };
    let slope = 1e-5;
    let wi = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
    let inside = refract(wi, n);
    let facet = DVec3::new(0.0, slope, 1.0).normalize();
    let reflected = 2.0 * inside.dot(facet) * facet - inside;
    let wh = refract(reflected, 1.0 / n) + wi;
    wh.y / wh.z / slope
}

#[test]
fn jacobian_is_the_slope_gain_of_refraction() {
    for (degrees, expected) in [(0.0, 1.500), (45.0, 1.871), (70.0, 3.418)] {
        let cos = libm::cos(f64::to_radians(degrees));
        let gain = slope_gain(1.5, cos);
        assert!((gain - expected).abs() < 5e-4, "{degrees}: {gain}");
        // The model scales the variance by it, and h grows like alpha^1.1: slopes widen by its power 1/1.1 and the lobe is narrower than
        // light's by 4% to 11%.
        let stack = stack(&[(0.0, glass(1.5, 0.0)), (1e-4, metal())]);
        let lobe = add::<f64, 1>(&Layers::from(&stack), &|layer: usize, _: f64, _: f64| layer as f64, cos).lobes[1];
        let widened = alpha(lobe.spread) / 1e-4;
        assert!((widened - libm::pow(gain, 1.0 / 1.1)).abs() < 1e-3, "{degrees}: {widened}");
        assert!(widened < gain && widened > 0.89 * gain);
    }
}

#[test]
fn total_reflection_keeps_light_below_a_smooth_coat() {
    // A rough base under a smooth coat: what lies beyond the critical angle returns, so a lossless base still reflects everything,
    // and an absorbing slab takes more than without total reflection.
    let lossless = |layer: usize, _: f64, _: f64| if layer == 0 { 0.04 } else { 1.0 };
    let clear = stack(&[(0.0, glass(1.5, 0.0)), (0.6, metal())]);
    let kept = add::<f64, 1>(&Layers::from(&clear), &lossless, 0.9);
    assert!((kept.reflected()[0] - 1.0).abs() < 1e-12);
    let [narrow, wide] = [1e-3, 0.6].map(|base| {
        let stack = stack(&[(0.0, glass(1.5, 0.3)), (base, metal())]);
        add::<f64, 1>(&Layers::from(&stack), &lossless, 0.9).reflected()[0]
    });
    assert!(wide < narrow - 0.02, "{wide} {narrow}");
}

#[test]
fn light_beyond_the_critical_angle_goes_no_further() {
    let stack = stack(&[(0.0, glass(1.5, 0.0)), (0.0, glass(1.0, 0.0)), (0.0, glass(0.5, 0.0)), (0.0, metal())]);
    let got = add::<f64, 1>(&Layers::from(&stack), &fresnel(&stack), 0.5);
    assert_eq!((got.lobes.len(), got.transmitted, got.cos_theta), (3, [0.0], 0.0));
    assert!((got.reflected()[0] - 1.0).abs() < 1e-12);
}

proptest! {
    #[test]
    fn energies_and_spreads_stay_in_bounds(
        layers in prop::collection::vec((0.0..=1.0f64, 0.0..=1.0f64, 0.6..3.0f64, 0.0..2.0f64), 1..7),
        reflectances in prop::collection::vec(prop_oneof![0.0..=1.0f64, Just(0.0), Just(1.0)], 7),
        cos in prop_oneof![0.0..=1.0f64, Just(0.0), Just(1.0), Just(1e-9)],
    ) {
        let layers: Vec<_> = layers
            .iter()
            .map(|&(alpha_x, alpha_y, ior, optical_depth)| {
                let surface = Surface { distribution: Distribution::Ggx, alpha_x, alpha_y, rotation: ior };
                (surface, glass(ior, optical_depth))
            })
            .collect();
        let stack = Monochrome::bare(&layers);
        let energy = |layer: usize, _: f64, _: f64| reflectances[layer];
        let scalar = add::<f64, 1>(&Layers::from(&stack), &energy, cos);
        let total = scalar.reflected()[0] + scalar.transmitted[0];
        prop_assert!((0.0..=1.0 + 1e-9).contains(&total), "{total}");
        prop_assert!((0.0..=1.0 + 1e-9).contains(&scalar.from_below[0]));
        for lobe in &scalar.lobes {
            prop_assert!(lobe.energy[0] >= 0.0 && lobe.spread >= 0.0 && lobe.spread.is_finite());
        }
        for lobe in add::<Covariance, 1>(&Layers::from(&stack), &energy, cos).lobes {
            let p = lobe.spread.principal();
            prop_assert!(lobe.energy[0] >= 0.0 && p.second >= 0.0 && p.first.is_finite());
        }
    }
}
