//! Twins of shaders over fluorescent bases.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::luthier_model::{Reflectance, ShadingModel};
use luthier_layers::models::parts::Parts;
use luthier_layers::models::shade::Under;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_layers::twins::terms::Exact;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};

const NM: [f64; 3] = [645.0, 525.0, 445.0];
const ROWS: [Rgb; 3] = [[0.6, 0.3, 0.4], [0.02, 0.5, 0.1], [0.0, 0.03, 0.2]];
const MODELS: [ShadingModel; 2] = [ShadingModel::Elek, ShadingModel::WeidlichWilkie];

fn base(albedo: Rgb) -> Layer {
    Layer { films: Vec::new(), surface: Surface::smooth(), base: Base::Diffuse(Diffuse { albedo, sigma: 0.0 }) }
}

fn coat(absorption_per_um: Rgb) -> Layer {
    let base =
        Base::Dielectric { ior: Ior::constant(1.5, 0.0).unwrap(), slab: Slab { thickness_um: 1.0, absorption_per_um } };
    Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, 0.3), base }
}

fn stack(layers: Vec<Layer>) -> Stack {
    Stack { exterior: Ior::vacuum(), layers }
}

fn directions() -> [(DVec3, DVec3); 3] {
    let unit = |x, y, z| DVec3::new(x, y, z).normalize();
    [
        (unit(0.3, 0.1, 0.7), unit(-0.2, 0.2, 0.9)),
        (unit(0.9, 0.0, 0.1), unit(-0.8, 0.3, 0.2)),
        (DVec3::Z, unit(0.5, 0.0, 0.6)),
    ]
}

fn near(found: Rgb, expected: Rgb) -> bool {
    found.iter().zip(expected).all(|(f, e)| (f - e).abs() < 1e-12 * e.abs().max(1e-3))
}

/// Oracle: the stack with an albedo.
#[test]
fn a_matrix_without_other_channels_is_an_albedo() {
    let albedo = [0.7, 0.4, 0.1];
    let rows = [[0.7, 0.0, 0.0], [0.0, 0.4, 0.0], [0.0, 0.0, 0.1]];
    for model in MODELS {
        for layers in [vec![base(albedo)], vec![coat([0.1, 0.5, 0.9]), coat([0.3; 3]), base(albedo)]] {
            let stack = stack(layers);
            let color = Color::ThreeWavelengths(NM);
            let plain = Shaded::new(model, &stack, NM, color, &Place::NONE).unwrap();
            let mut place = Place { reradiation: Some(rows), ..Place::NONE };
            let glowing = Shaded::new(model, &stack, NM, color, &place).unwrap();
            place.base_color = Some([0.2; 3]);
            let painted = Shaded::new(model, &stack, NM, color, &place).unwrap();
            let grey = Place { base_color: place.base_color, ..Place::NONE };
            let grey = Shaded::new(model, &stack, NM, color, &grey).unwrap();
            for (wi, wo) in directions() {
                assert!(near(glowing.eval(wi, wo), plain.eval(wi, wo)), "{model} {wi} {wo}");
                assert_eq!(painted.eval(wi, wo), grey.eval(wi, wo));
                let lit = plain.eval(wi, wo);
                assert!(near(glowing.eval_lit([0.3, 2.0, 0.0], wi, wo), [0.3 * lit[0], 2.0 * lit[1], 0.0]));
            }
        }
    }
}

/// White light is the light of `eval`, with the reflectance that a material chooses.
#[test]
fn a_chosen_reflectance_is_that_under_light_of_a_colour() {
    let stack = stack(vec![coat([0.0; 3]), base([0.5; 3])]);
    let place = Place { reradiation: Some(ROWS), ..Place::NONE };
    let parts = Parts { reflectance: Reflectance::Approximate, ..Parts::PLAIN };
    for model in MODELS {
        let chosen = Shaded::with(model, &stack, NM, Color::ThreeWavelengths(NM), &place, parts).unwrap();
        let exact = Shaded::new(model, &stack, NM, Color::ThreeWavelengths(NM), &place).unwrap();
        for (wi, wo) in directions() {
            assert!(near(chosen.eval_lit([1.0; 3], wi, wo), chosen.eval(wi, wo)), "{model} {wi} {wo}");
        }
        let (wi, wo) = directions()[1];
        assert!(!near(chosen.eval(wi, wo), exact.eval(wi, wo)), "{model}: the choice has an effect");
    }
}

/// Oracle: by hand, at one interface of index 1.5: Fresnel's formula for the transmission in, what V-cavities give back on the way out, and
/// absorption along either way in the channel that goes it.
#[test]
fn blue_light_goes_in_and_red_comes_out() {
    let depths = [0.2, 0.5, 1.1];
    let stack = stack(vec![coat(depths), base([0.0; 3])]);
    for model in MODELS {
        let color = Color::ThreeWavelengths(NM);
        let twin = Twin::new(model, &stack, NM, color).reradiating(Some(ROWS));
        let terms = Exact::new(&stack, color);
        for (wi, wo) in directions() {
            let wh = (wi + wo).normalize();
            let cos = wh.dot(wi);
            let cos_t = (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
            let (s, p) = ((cos - 1.5 * cos_t) / (cos + 1.5 * cos_t), (1.5 * cos - cos_t) / (1.5 * cos + cos_t));
            let passed = 1.0 - 0.5 * (s * s + p * p);
            let cavity = 1f64.min(2.0 * wh.z * wi.z / cos).min(2.0 * wh.z * wo.z / cos);
            let inside = |w: DVec3| (1.0 - (1.0 - w.z * w.z) / 2.25).sqrt();
            let down = passed * (-depths[2] / inside(wi)).exp();
            let up = (1.0 - cavity + passed * cavity) * (-depths[0] / inside(wo)).exp();
            let expected = wi.z / PI * up * ROWS[0][2] * down;
            let found = twin.eval_lit(&terms, &Under::NONE, [0.0, 0.0, 1.0], wi, wo);
            assert!((found[0] / expected - 1.0).abs() < 1e-12, "{model} {wi} {wo}: {found:?} {expected}");
        }
    }
}

/// Other models have no use for a matrix, and light is a factor.
#[test]
fn other_models_keep_the_albedo() {
    let stack = stack(vec![coat([0.0; 3]), base([0.5; 3])]);
    let color = Color::ThreeWavelengths(NM);
    let terms = Exact::new(&stack, color);
    let (wi, wo) = directions()[0];
    for model in [ShadingModel::Belcour, ShadingModel::GranierHeidrich, ShadingModel::Phong] {
        let plain = Twin::new(model, &stack, NM, color);
        let glowing = Twin::new(model, &stack, NM, color).reradiating(Some(ROWS));
        let expected = plain.eval(&terms, wi, wo);
        assert_eq!(glowing.eval(&terms, wi, wo), expected);
        assert_eq!(glowing.eval_lit(&terms, &Under::NONE, [2.0; 3], wi, wo), expected.map(|v| 2.0 * v));
    }
}
