//! What holds for every model, stack and pair of directions.

use glam::DVec3;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use luthier_layers::registry::models;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use proptest::prelude::*;

/// Models of this part; others are tested beside their own oracles.
const NAMES: [&str; 10] = [
    "phong",
    "microfacet",
    "microfacet-v-cavity",
    "elek",
    "patina",
    "weidlich-wilkie",
    "weidlich-wilkie-directions",
    "weidlich-wilkie-facet",
    "weidlich-wilkie-corrected",
    "granier-heidrich",
];

fn surface() -> impl Strategy<Value = Surface> {
    let alpha = || prop_oneof![Just(0.0), Just(1e-4), 1e-4..=1.0, Just(1.0)];
    let distribution = prop_oneof![Just(Distribution::Ggx), Just(Distribution::Beckmann)];
    (distribution, alpha(), alpha(), 0.0..6.3).prop_map(|(distribution, alpha_x, alpha_y, rotation)| Surface {
        distribution,
        alpha_x,
        alpha_y,
        rotation,
    })
}

fn layer(below: impl Strategy<Value = MonochromeBelow>) -> impl Strategy<Value = MonochromeLayer> {
    let film = (1.0..2.6, 0.0..0.5, 0.0..3.0f64);
    (surface(), prop::collection::vec(film, 0..=1), below).prop_map(|(surface, films, below)| MonochromeLayer {
        surface,
        above: 1.0,
        films: films.into_iter().map(|(n, k, waves)| FilmLayer { ior: Complex64::new(n, k), waves }).collect(),
        below,
    })
}

fn transparent() -> impl Strategy<Value = MonochromeBelow> {
    let depth = prop_oneof![Just(0.0), 0.0..5.0, Just(1e4)];
    (prop_oneof![1.0..2.6, Just(1.5)], depth).prop_map(|(ior, optical_depth)| MonochromeBelow::Dielectric {
        ior,
        complex_ior: Complex64::new(ior, 0.0),
        optical_depth,
    })
}

fn base() -> impl Strategy<Value = MonochromeBelow> {
    let metal = (0.0..5.0, 0.0..8.0f64).prop_map(|(n, k)| MonochromeBelow::Conductor { ior: Complex64::new(n, k) });
    let diffuse = (0.0..=1.0, 0.0..1.5).prop_map(|(albedo, sigma)| MonochromeBelow::Diffuse { albedo, sigma });
    prop_oneof![metal, diffuse, transparent()]
}

fn stack() -> impl Strategy<Value = Monochrome> {
    (prop::collection::vec(layer(transparent()), 0..=2), layer(base())).prop_map(|(mut layers, last)| {
        layers.push(last);
        let mut above = 1.0;
        for layer in &mut layers {
            layer.above = above;
            if let MonochromeBelow::Dielectric { ior, .. } = layer.below {
                above = ior;
            }
        }
        Monochrome { exterior: 1.0, layers }
    })
}

/// Upward directions, grazing ones as likely as others.
fn upward() -> impl Strategy<Value = DVec3> {
    let cos = prop_oneof![(0.0..=1.0), (-7.0..=0.0f64).prop_map(|e| 10f64.powf(e)), Just(1e-7), Just(1.0)];
    let phi = prop_oneof![Just(0.0), Just(std::f64::consts::PI), 0.0..6.3];
    (cos, phi).prop_map(|(cos, phi): (f64, f64)| {
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
    })
}

#[test]
fn all_are_registered_once() {
    let registered: Vec<_> = models().iter().map(|m| m.info().name).collect();
    for name in NAMES.into_iter().chain(["flakes"]) {
        assert_eq!(registered.iter().filter(|n| **n == name).count(), 1, "{name}");
    }
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(2000))]

    #[test]
    fn they_are_finite_and_not_negative(stack in stack(), wi in upward(), wo in upward()) {
        for model in models().iter().filter(|m| NAMES.contains(&m.info().name)) {
            let name = model.info().name;
            for wo in [wo, wi, DVec3::new(-wi.x, -wi.y, wi.z), -wi, DVec3::new(wo.x, wo.y, 0.0), -wo] {
                let f = model.eval(&stack, wi, wo);
                prop_assert!(f.is_finite() && f >= 0.0, "{name}: {f} from {wi} to {wo}");
                prop_assert!((wo.z > 0.0 && wi.z > 0.0) || f == 0.0, "{name}: {f} below the horizon");
            }
        }
    }
}
