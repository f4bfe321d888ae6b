//! Laws of every model for every stack and pair of directions.

use glam::DVec3;
use luthier_layers::furnace::furnace;
use luthier_layers::model::{Kind, Model};
use luthier_layers::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use luthier_layers::registry::models;
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use proptest::prelude::*;

/// All but those that are tested beside their own oracles: estimates, and the statistical models and lobes, which prepare each stack.
fn tested() -> Vec<Box<dyn Model>> {
    let elsewhere = |name: &str| ["belcour", "yamaguchi", "lobes"].iter().any(|start| name.starts_with(start));
    models().into_iter().filter(|m| m.estimator().is_none() && !elsewhere(m.info().name)).collect()
}

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
        f0: None,
    })
}

fn transparent() -> impl Strategy<Value = MonochromeBelow> {
    let depth = prop_oneof![Just(0.0), 0.0..5.0, Just(1e4)];
    (prop_oneof![1.0..2.6, Just(1.5)], depth).prop_map(|(ior, depth)| MonochromeBelow::dielectric(ior, depth))
}

fn base() -> impl Strategy<Value = MonochromeBelow> {
    let metal = (0.0..5.0, 0.0..8.0f64).prop_map(|(n, k)| MonochromeBelow::Conductor { ior: Complex64::new(n, k) });
    let diffuse = (0.0..=1.0, 0.0..1.5).prop_map(|(albedo, sigma)| MonochromeBelow::Diffuse { albedo, sigma });
    prop_oneof![metal, diffuse, transparent()]
}

fn stack() -> impl Strategy<Value = Monochrome> {
    (prop::collection::vec(layer(transparent()), 0..=2), layer(base())).prop_map(|(mut layers, last)| {
        layers.push(last);
        Monochrome::joined(1.0, layers)
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

proptest! {
    #![proptest_config(ProptestConfig::with_cases(400))]

    #[test]
    fn they_are_finite_and_not_negative(stack in stack(), wi in upward(), wo in upward()) {
        for model in tested() {
            let name = model.info().name;
            for wo in [wo, wi, DVec3::new(-wi.x, -wi.y, wi.z), -wi, DVec3::new(wo.x, wo.y, 0.0), -wo] {
                let f = model.eval(&stack, wi, wo);
                prop_assert!(f.is_finite() && f >= 0.0, "{name}: {f} from {wi} to {wo}");
                prop_assert!((wo.z > 0.0 && wi.z > 0.0) || f == 0.0, "{name}: {f} below the horizon");
            }
        }
    }

    /// f without the cosine, of those that claim it.
    #[test]
    fn reciprocity_holds_where_it_is_claimed(stack in stack(), wi in upward(), wo in upward()) {
        for model in tested().iter().filter(|m| m.info().claims.reciprocal) {
            let (there, back) = (model.eval(&stack, wi, wo) * wo.z, model.eval(&stack, wo, wi) * wi.z);
            let name = model.info().name;
            prop_assert!((there - back).abs() <= 1e-9 * there.max(back) + 1e-200, "{name}: {there} {back} {wi} {wo}");
        }
    }
}

/// Directional albedos of surfaces that claim to keep energy, by themselves in a furnace: GGX and Beckmann, three alphas, four angles.
/// 1e-3 is what the quadrature may be off.
#[test]
fn surfaces_keep_energy_where_they_claim_it() {
    for model in tested() {
        let info = model.info();
        if info.kind != Kind::Surface || !info.claims.conserves_energy {
            continue;
        }
        for (distribution, alpha) in [(Distribution::Ggx, 0.1), (Distribution::Beckmann, 0.5), (Distribution::Ggx, 1.0)]
        {
            let surface = Surface::isotropic(distribution, alpha);
            let base = MonochromeBelow::Diffuse { albedo: 0.5, sigma: 0.3 };
            let mut stack = Monochrome::bare(&[MonochromeBelow::dielectric(1.5, 0.0), base].map(|b| (surface, b)));
            stack.layers[0].films.push(FilmLayer { ior: Complex64::new(1.3, 0.0), waves: 0.3 });
            for cos in [1.0, 0.7, 0.3, 0.1f64] {
                let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                let radiance = furnace(model.as_ref(), &stack, wo);
                let most = 1.0 + 1e-3 + radiance.error;
                assert!(radiance.value > 0.0 && radiance.value < most, "{} {alpha} {cos}: {radiance:?}", info.name);
            }
        }
    }
}
