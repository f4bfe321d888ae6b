//! Tests of the model of Yamaguchi et al.: the paper's two-layer formulas, rotations, and Belcour's model as a limit.

use std::f64::consts::{FRAC_PI_2, PI};

use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use proptest::prelude::*;

use super::*;
use crate::layers::Layers;
use crate::model::Model;
use crate::models::belcour::Belcour;
use crate::models::statistics::adding::add;
use crate::models::statistics::evaluate::{Prepared, evaluate};
use crate::models::statistics::fixtures::{NotTotal, direction, fresnel, tabulated};
use crate::models::statistics::spread::variance;
use crate::monochrome::{Monochrome, MonochromeBelow};

fn surface(alpha_x: f64, alpha_y: f64, rotation: f64) -> Surface {
    Surface { distribution: Distribution::Ggx, alpha_x, alpha_y, rotation }
}

/// A coat of index 1.49 on gold: the materials of the paper's figures.
fn coated(coat: Surface, base: Surface) -> Monochrome {
    let gold = MonochromeBelow::Conductor { ior: Complex64::new(0.143, 3.983) };
    Monochrome::bare(&[(coat, MonochromeBelow::dielectric(1.49, 0.0)), (base, gold)])
}

#[test]
fn two_layers_are_the_formulas_of_the_paper() {
    // Oracle: the two-layer formulas of the supplementary document, written out with 2x2 matrices entry by entry.
    let (coat, base) = (surface(0.1, 0.4, 0.3), surface(0.25, 0.05, -0.7));
    let stack = coated(coat, base);
    let (cos_i, n) = (0.7f64, 1.49f64);
    let cos_t = (1.0 - (1.0 - cos_i * cos_i) / (n * n)).sqrt();
    let sigma = |s: Surface, scale: f64| {
        let (tx, ty) = (libm::cos(s.rotation), libm::sin(s.rotation));
        let (vx, vy) = (variance(scale * s.alpha_x), variance(scale * s.alpha_y));
        [tx * tx * vx + ty * ty * vy, tx * ty * vx - ty * tx * vy, ty * ty * vx + tx * tx * vy]
    };
    let (r12, rb) = (stack.layers[0].reflectance(cos_i), stack.layers[1].reflectance(cos_t));
    let weight = (1.0 - r12) * (1.0 - r12) * rb / (1.0 - r12 * rb);
    let m = r12 * rb / (1.0 - r12 * rb);
    let j12 = n * cos_t / cos_i;
    let t12 = sigma(coat, 0.5 * (1.0 - cos_i / (n * cos_t)).abs());
    let t21 = sigma(coat, 0.5 * (1.0 - n * cos_t / cos_i).abs());
    let (r1, b) = (sigma(coat, 1.0), sigma(base, 1.0));

    let lobes = add::<Covariance, 1>(&Layers::from(&stack), &NotTotal(fresnel(&stack)), cos_i).lobes;
    assert!((lobes[0].energy[0] - r12).abs() < 1e-15 && (lobes[1].energy[0] - weight).abs() < 1e-15);
    for (lobe, expected) in
        [(lobes[0], r1), (lobes[1], [0, 1, 2].map(|k| t21[k] + j12 * (t12[k] + b[k] + m * (b[k] + r1[k]))))]
    {
        let got = [lobe.spread.xx, lobe.spread.xy, lobe.spread.yy];
        for k in 0..3 {
            assert!((got[k] - expected[k]).abs() < 1e-14, "{got:?} against {expected:?}");
        }
    }
}

#[test]
fn isotropic_surfaces_give_belcour() {
    let stack = coated(surface(0.2, 0.2, 0.9), surface(0.3, 0.3, -0.2));
    let energy = fresnel(&stack);
    for (cos_i, cos_o, phi) in [(0.9, 0.8, 3.0), (0.3, 0.6, 1.0), (0.05, 0.1, PI), (1.0, 1.0, 0.0)] {
        let (wi, wo) = (direction(cos_i, 0.0), direction(cos_o, phi));
        for follow in [Follow::Eye, Follow::HalfVector] {
            let [a] = evaluate::<Covariance, 1>(&Layers::from(&stack), &energy, None, follow, wi, wo);
            let [b] = evaluate::<f64, 1>(&Layers::from(&stack), &energy, None, follow, wi, wo);
            assert!((a - b).abs() < 1e-10 * b, "{a} {b}");
        }
    }
}

/// Isotropic stacks give `belcour` as models are registered, energies and total reflection included.
#[test]
fn isotropic_stacks_give_belcour_as_models() {
    let stack = coated(surface(0.2, 0.2, 0.9), surface(0.3, 0.3, -0.2));
    for follow in [Follow::Eye, Follow::HalfVector] {
        let (ours, belcour) = (Yamaguchi::new(follow), Belcour::new(follow));
        for (cos_i, cos_o, phi) in [(0.9, 0.8, 3.0), (0.3, 0.6, 1.0), (0.05, 0.1, PI), (1.0, 1.0, 0.0)] {
            let (wi, wo) = (direction(cos_i, 0.0), direction(cos_o, phi));
            let (a, b) = (ours.eval(&stack, wi, wo), belcour.eval(&stack, wi, wo));
            assert!((a - b).abs() < 1e-10 * b, "{follow:?}: {a} {b}");
        }
    }
}

#[test]
fn a_table_can_stand_in_for_the_energies() {
    let stack = coated(surface(0.1, 0.4, 0.2), surface(0.3, 0.05, 0.5));
    let prepared = Prepared::new(&stack);
    let (wi, wo) = (direction(0.7, 0.3), direction(0.6, 3.0));
    let exact = prepared.eval::<Covariance>(Follow::Eye, wi, wo);
    let table = tabulated(prepared.energy());
    let [got] = evaluate::<Covariance, 1>(&Layers::from(&stack), &table, None, Follow::Eye, wi, wo);
    assert!(exact > 0.0 && (got - exact).abs() < 2e-3 * exact, "{got} against {exact}");
}

#[test]
fn a_quarter_turn_swaps_the_slopes() {
    let stack = coated(surface(0.1, 0.4, 0.2), surface(0.3, 0.05, 0.5));
    let turned = coated(surface(0.4, 0.1, 0.2 + FRAC_PI_2), surface(0.05, 0.3, 0.5 + FRAC_PI_2));
    let (wi, wo) = (direction(0.7, 0.3), direction(0.6, 3.0));
    let [[a], [b]] =
        [&stack, &turned].map(|s| evaluate::<Covariance, 1>(&Layers::from(s), &fresnel(s), None, Follow::Eye, wi, wo));
    assert!((a - b).abs() < 1e-12 * a, "{a} {b}");
}

#[test]
fn turning_everything_changes_nothing() {
    let (wi, wo) = ((0.7, 0.3), (0.6, 3.0));
    let at = |turn: f64| {
        let stack = coated(surface(0.1, 0.4, 0.2 + turn), surface(0.3, 0.05, 0.5 + turn));
        let [wi, wo] = [wi, wo].map(|(cos, phi)| direction(cos, phi + turn));
        evaluate::<Covariance, 1>(&Layers::from(&stack), &fresnel(&stack), None, Follow::Eye, wi, wo)[0]
    };
    for turn in [0.4, 2.0, -1.3] {
        assert!((at(turn) - at(0.0)).abs() < 1e-11 * at(0.0), "{turn}");
    }
}

#[test]
fn crossed_brushings_below_each_other_are_round_and_finite() {
    // Two perpendicular brushings whose covariances add up to equal eigenvalues: any axis will do.
    let base = Covariance::along(variance(0.3), variance(0.1), 0.4);
    let crossed = Covariance::along(variance(0.3), variance(0.1), 0.4 + FRAC_PI_2);
    let sum = base + crossed;
    let p = sum.principal();
    assert!((p.first - p.second).abs() < 1e-14 && p.rotation.is_finite());
}

#[test]
fn reads_as_a_model() {
    let stack = coated(surface(0.1, 0.3, 0.0), surface(0.2, 0.05, 0.8));
    let model = Yamaguchi::new(Follow::HalfVector);
    let (wi, wo) = (direction(0.7, 0.3), direction(0.6, 3.0));
    let (a, b) = (model.eval(&stack, wi, wo) / wi.z, model.eval(&stack, wo, wi) / wo.z);
    assert!(a > 0.0 && (a - b).abs() < 1e-12 * a, "{a} {b}");
    assert_eq!(model.info().name, "yamaguchi-half-vector");
}

proptest! {
    #[test]
    fn finite_and_not_negative_everywhere(
        alphas in prop::array::uniform4(prop_oneof![0.0..=1.0f64, Just(0.0), Just(1.0)]),
        turns in prop::array::uniform2(-4.0..4.0f64),
        cosines in prop::array::uniform2(prop_oneof![0.0..=1.0f64, Just(1.0), Just(1e-8), Just(1e-300)]),
        phi in prop_oneof![0.0..7.0f64, Just(PI), Just(0.0)],
    ) {
        let stack = coated(surface(alphas[0], alphas[1], turns[0]), surface(alphas[2], alphas[3], turns[1]));
        let (wi, wo) = (direction(cosines[0], 0.0), direction(cosines[1], phi));
        for follow in [Follow::Eye, Follow::HalfVector] {
            let [value] = evaluate::<Covariance, 1>(&Layers::from(&stack), &fresnel(&stack), None, follow, wi, wo);
            prop_assert!(value.is_finite() && value >= 0.0, "{value}");
        }
    }
}
