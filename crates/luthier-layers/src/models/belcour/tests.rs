//! Tests of Belcour's model: energy, reciprocity, tables in place of energies, and the mean number of bounces.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::quadrature::gauss_legendre;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use proptest::prelude::*;

use super::*;
use crate::layers::Layers;
use crate::model::Model;
use crate::models::statistics::adding::add;
use crate::models::statistics::diffuse_base::DiffuseBase;
use crate::models::statistics::evaluate::{Prepared, evaluate};
use crate::models::statistics::fixtures::{NotTotal, direction, fresnel, tabulated};
use crate::models::statistics::spread::{alpha, variance};
use crate::monochrome::{Monochrome, MonochromeBelow};

fn coated(coat: f64, base: f64, below: MonochromeBelow) -> Monochrome {
    let surface = |alpha| Surface::isotropic(Distribution::Ggx, alpha);
    Monochrome::bare(&[(surface(coat), MonochromeBelow::dielectric(1.5, 0.1)), (surface(base), below)])
}

fn gold() -> MonochromeBelow {
    MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.5) }
}

fn chalk() -> MonochromeBelow {
    MonochromeBelow::Diffuse { albedo: 0.9, sigma: 0.0 }
}

/// Directional albedo for the eye at `wo`, in polar angles about the mirror direction's half vectors.
fn albedo(stack: &Monochrome, follow: Follow, cos_o: f64) -> f64 {
    let prepared = Prepared::new(stack);
    let wo = direction(cos_o, 0.0);
    let (thetas, phis) = (gauss_legendre(96), 96);
    let mut sum = 0.0;
    for (x, weight) in thetas {
        // Normals, graded towards the surface's.
        let theta = 0.5 * PI * x * x * x;
        for k in 0..phis {
            let phi = 2.0 * PI * (f64::from(k) + 0.5) / f64::from(phis);
            let wh = direction(libm::cos(theta), phi);
            let cos_d = wh.dot(wo);
            let wi = 2.0 * cos_d * wh - wo;
            if cos_d > 0.0 && wi.z > 0.0 {
                let value = prepared.eval::<f64>(follow, wi, wo);
                let measure = 4.0 * cos_d * libm::sin(theta) * 1.5 * PI * x * x * 2.0 * PI / f64::from(phis);
                sum += value * measure * weight;
            }
        }
    }
    sum
}

#[test]
fn albedo_is_at_most_one_and_near_the_energy_for_narrow_lobes() {
    for follow in [Follow::Eye, Follow::HalfVector] {
        for (coat, base, below) in [(0.05, 0.1, gold()), (0.4, 0.3, gold()), (0.9, 0.9, gold()), (0.3, 0.0, chalk())] {
            let stack = coated(coat, base, below);
            for cos in [0.2, 0.6, 1.0] {
                let got = albedo(&stack, follow, cos);
                assert!(got > 0.1 && got < 1.0, "{follow:?} {coat} {base} {cos}: {got}");
            }
        }
    }
    let stack = coated(0.02, 0.03, gold());
    let prepared = Prepared::new(&stack);
    let [energy] = add::<f64, 1>(prepared.layers(), prepared.energy(), 0.8).reflected();
    let got = albedo(&stack, Follow::Eye, 0.8);
    assert!((got - energy).abs() < 0.01 * energy, "{got} against {energy}");
}

#[test]
fn half_vectors_make_it_reciprocal_and_the_eye_does_not() {
    let (wi, wo) = (direction(0.3, 0.4), direction(0.9, 2.8));
    for below in [gold(), chalk()] {
        let prepared = Prepared::new(&coated(0.3, 0.2, below));
        let brdfs = |follow| [prepared.eval::<f64>(follow, wi, wo) / wi.z, prepared.eval::<f64>(follow, wo, wi) / wo.z];
        let [a, b] = brdfs(Follow::HalfVector);
        assert!((a - b).abs() < 1e-12 * a, "{a} {b}");
        let [a, b] = brdfs(Follow::Eye);
        assert!((a - b).abs() > 1e-3 * a, "{a} {b}");
    }
}

#[test]
fn a_table_can_stand_in_for_the_energies() {
    let stack = coated(0.2, 0.2, gold());
    let prepared = Prepared::new(&stack);
    let (wi, wo) = (direction(0.7, 0.3), direction(0.6, 3.0));
    let exact = prepared.eval::<f64>(Follow::Eye, wi, wo);
    let table = tabulated(prepared.energy());
    let [got] = evaluate::<f64, 1>(prepared.layers(), &table, None, Follow::Eye, wi, wo);
    assert!((got - exact).abs() < 2e-3 * exact, "{got} against {exact}");
}

/// The bounces of each wavelength differ little from their mean, the one m for all channels that the paper's code takes. Slopes of the
/// base's lobe against that for the mean of m, by the two-layer formula; gold at 690, 550 and 450 nm below a coat of n = 1.5, both of alpha
/// 0.2.
#[test]
fn bounces_by_wavelength_differ_little_from_their_mean() {
    for (cos_i, expected) in
        [(1.0, [0.0121, 0.0037, -0.0160]), (0.5, [0.0174, 0.0051, -0.0233]), (0.2, [0.0256, 0.0058, -0.0384])]
    {
        let n = 1.5;
        let cos_t = f64::sqrt(1.0 - (1.0 - cos_i * cos_i) / (n * n));
        let j = n * cos_t / cos_i;
        let stacks = [(0.16, 3.8), (0.42, 2.5), (1.56, 1.9)]
            .map(|(re, im)| coated(0.2, 0.2, MonochromeBelow::Conductor { ior: Complex64::new(re, im) }));
        let bounces = stacks.each_ref().map(|stack| {
            let echo = stack.layers[0].reflectance(cos_i) * stack.layers[1].reflectance(cos_t);
            echo / (1.0 - echo)
        });
        // Absorption lowers m; the formula is that without it.
        let clear = stacks.map(|mut stack| {
            stack.layers[0].below = MonochromeBelow::dielectric(n, 0.0);
            stack
        });
        let m = bounces.iter().sum::<f64>() / 3.0;
        let t12 = variance(0.1 * (1.0 - 1.0 / j).abs());
        let t21 = variance(0.1 * (1.0 - j).abs());
        let mean = alpha(t21 + j * (t12 + variance(0.2) * (1.0 + 2.0 * m)));
        for (stack, expected) in clear.iter().zip(expected) {
            let lobes = add::<f64, 1>(&Layers::from(stack), &NotTotal(fresnel(stack)), cos_i).lobes;
            let found = alpha(lobes[1].spread) / mean - 1.0;
            assert!((found - expected).abs() < 1e-4, "{cos_i}: {found} against {expected}");
        }
    }
}

#[test]
fn reads_as_a_model_and_remembers() {
    let stack = coated(0.2, 0.3, gold());
    let model = Belcour::new(Follow::Eye);
    let (wi, wo) = (direction(0.7, 0.3), direction(0.6, 3.0));
    let first = model.eval(&stack, wi, wo);
    assert_eq!(first, model.eval(&stack, wi, wo));
    assert_eq!(first, Prepared::new(&stack).eval::<f64>(Follow::Eye, wi, wo));
    assert!(first > 0.0);
    assert_eq!(model.eval(&stack, -wi, wo), 0.0);
    assert_eq!(model.eval(&stack, wi, DVec3::X), 0.0);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(48))]
    #[test]
    fn finite_and_not_negative_everywhere(
        alphas in prop::array::uniform2(prop_oneof![0.0..=1.0f64, Just(0.0), Just(1.0)]),
        cosines in prop::array::uniform2(prop_oneof![0.0..=1.0f64, Just(1.0), Just(1e-8), Just(1e-300)]),
        phi in prop_oneof![0.0..7.0f64, Just(PI), Just(0.0)],
        ior in 0.5..2.5f64,
        film in any::<bool>(),
        diffuse in any::<bool>(),
    ) {
        let mut stack = coated(alphas[0], alphas[1], if diffuse { chalk() } else { gold() });
        stack.layers[0].below = MonochromeBelow::dielectric(ior, 0.5);
        stack = Monochrome::joined(1.0, stack.layers);
        if film {
            stack.layers[0].films.push(FilmLayer { ior: Complex64::new(1.8, 0.0), waves: 0.4 });
        }
        // Fresnel in place of FGD-infinity: the walks have tests of their own.
        let energy = fresnel(&stack);
        let base = DiffuseBase::new(&Layers::from(&stack), &energy);
        let (wi, wo) = (direction(cosines[0], 0.0), direction(cosines[1], phi));
        for follow in [Follow::Eye, Follow::HalfVector] {
            let [value] = evaluate::<f64, 1>(&Layers::from(&stack), &energy, base.as_ref(), follow, wi, wo);
            prop_assert!(value.is_finite() && value >= 0.0, "{value}");
        }
    }
}
