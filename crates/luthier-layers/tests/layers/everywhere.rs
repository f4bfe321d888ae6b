//! Laws of Elek's model for every stack and pair of directions.

use glam::DVec3;
use luthier_layers::layers::Layers;
use luthier_layers::models::elek::Elek;
use luthier_layers::twins::terms::Exact;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};
use proptest::prelude::*;

use crate::directions::from_cosine;

const WAVELENGTHS: Color = Color::ThreeWavelengths([645.0, 525.0, 445.0]);

fn surface() -> impl Strategy<Value = Surface> {
    let alpha = prop_oneof![Just(0.0), Just(1e-3), (1e-3..=1.0), Just(1.0)];
    (prop_oneof![Just(Distribution::Ggx), Just(Distribution::Beckmann)], alpha)
        .prop_map(|(distribution, alpha)| Surface::isotropic(distribution, alpha))
}

fn ior(n: f64, k: f64) -> Ior {
    Ior::constant(n, k).unwrap()
}

fn films() -> impl Strategy<Value = Vec<Film>> {
    let film = (1.01..2.6, 0.0..2000.0)
        .prop_map(|(n, nm)| Film { ior: ior(n, 0.0), thickness: FilmThickness { min_nm: nm, max_nm: nm } });
    prop::collection::vec(film, 0..=1)
}

fn coat() -> impl Strategy<Value = Layer> {
    (films(), surface(), 1.0..2.5, 0.0..100.0, [0.0..0.1, 0.0..0.1, 0.0..0.1f64]).prop_map(
        |(films, surface, n, thickness_um, absorption_per_um)| Layer {
            films,
            surface,
            base: Base::Dielectric { ior: ior(n, 0.0), slab: Slab { thickness_um, absorption_per_um } },
        },
    )
}

fn base() -> impl Strategy<Value = Layer> {
    let conductor = (surface(), 0.05..5.0, 0.0..8.0).prop_map(|(surface, n, k)| Layer {
        films: Vec::new(),
        surface,
        base: Base::Conductor { ior: ior(n, k) },
    });
    let diffuse = (0.0..=1.0, 0.0..1.5).prop_map(|(albedo, sigma)| Layer {
        films: Vec::new(),
        surface: Surface::smooth(),
        base: Base::Diffuse(Diffuse { albedo: [albedo, 1.0, 0.0], sigma }),
    });
    prop_oneof![conductor, diffuse, coat()]
}

fn stack() -> impl Strategy<Value = Stack> {
    (prop::collection::vec(coat(), 0..=2), base(), 1.0..1.5).prop_map(|(mut layers, base, n)| {
        layers.push(base);
        Stack { exterior: ior(n, 0.0), layers }
    })
}

/// Upward directions, grazing ones as likely as others.
fn upward() -> impl Strategy<Value = DVec3> {
    let cos = prop_oneof![(0.0..=1.0), (-7.0..=0.0f64).prop_map(|e| 10f64.powf(e)), Just(1e-7), Just(1.0)];
    let phi = prop_oneof![Just(0.0), Just(std::f64::consts::PI), 0.0..6.3];
    (cos, phi).prop_map(|(cos, phi)| from_cosine(cos, phi))
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(10_000))]

    #[test]
    fn it_is_finite_and_not_negative(stack in stack(), wi in upward(), wo in upward()) {
        let terms = Exact::new(&stack, WAVELENGTHS);
        let layers = Layers::isotropic_rgb(&stack).layers;
        for wo in [wo, wi, DVec3::new(-wi.x, -wi.y, wi.z), -wi, DVec3::new(wo.x, wo.y, 0.0), -wo] {
            for f in Elek::default().eval_with(&layers, &terms, wi, wo) {
                prop_assert!(f.is_finite() && f >= 0.0, "{f} from {wi} to {wo}");
                prop_assert!(wo.z > 0.0 || f == 0.0);
            }
        }
    }

    /// f, without the cosine, is the same both ways.
    #[test]
    fn one_interface_is_reciprocal(layer in coat(), wi in upward(), wo in upward()) {
        prop_assume!(wi.z > 0.0 && wo.z > 0.0);
        let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer] };
        let terms = Exact::new(&stack, WAVELENGTHS);
        let layers = Layers::isotropic_rgb(&stack).layers;
        let there = Elek::default().eval_with(&layers, &terms, wi, wo).map(|f| f / wi.z);
        let back = Elek::default().eval_with(&layers, &terms, wo, wi).map(|f| f / wo.z);
        for (a, b) in there.into_iter().zip(back) {
            prop_assert!((a - b).abs() <= 1e-9 * a.abs() + 1e-200, "{a} {b}");
        }
    }
}

/// Opposite horizontal directions have no half vector.
#[test]
fn directions_that_cancel_give_nothing() {
    let layer = Layer {
        films: Vec::new(),
        surface: Surface::isotropic(Distribution::Ggx, 0.5),
        base: Base::Conductor { ior: ior(0.2, 3.0) },
    };
    let stack = Stack { exterior: Ior::vacuum(), layers: vec![layer] };
    let terms = Exact::new(&stack, WAVELENGTHS);
    let tiny = DVec3::new(1.0, 0.0, f64::MIN_POSITIVE);
    for (wi, wo) in [(DVec3::X, -DVec3::X), (tiny, -DVec3::X), (tiny, DVec3::new(-1.0, 0.0, f64::MIN_POSITIVE))] {
        for f in Elek::default().eval_with(&Layers::isotropic_rgb(&stack).layers, &terms, wi, wo) {
            assert!(f >= 0.0 && f.is_finite(), "{f}");
        }
    }
}
