//! Normals of single interfaces, against whole surfaces that are tilted, and against Snell's law as vectors.

use std::f64::consts::FRAC_1_PI;

use glam::{DVec2, DVec3};
use luthier_layers::effects::layer_sample::LayerSample;
use luthier_layers::effects::textured::TextureSample;
use luthier_layers::luthier_model::ShadingModel;
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};

const NM: [f64; 3] = [645.0, 525.0, 445.0];
const MODELS: [ShadingModel; 2] = [ShadingModel::Elek, ShadingModel::WeidlichWilkie];

fn layer(alpha: f64, base: Base) -> Layer {
    Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, alpha), base }
}

fn coat(ior: f64, alpha: f64, absorption: f64) -> Layer {
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [absorption; 3] };
    layer(alpha, Base::Dielectric { ior: Ior::constant(ior, 0.0).unwrap(), slab })
}

fn metal(alpha: f64) -> Layer {
    layer(alpha, Base::Conductor { ior: Ior::constant(0.2, 3.4).unwrap() })
}

fn white() -> Layer {
    layer(0.0, Base::Diffuse(Diffuse { albedo: [0.8; 3], sigma: 0.0 }))
}

fn stack(layers: &[Layer]) -> Stack {
    Stack { exterior: Ior::vacuum(), layers: layers.to_vec() }
}

fn bumps(normals: &[DVec3]) -> Place {
    let layers = normals.iter().map(|&normal| LayerSample { normal, ..LayerSample::NONE }).collect();
    Place { layers, ..Place::NONE }
}

fn shaded(model: ShadingModel, stack: &Stack, place: &Place) -> Shaded {
    Shaded::new(model, stack, NM, Color::ThreeWavelengths(NM), place).unwrap()
}

fn unit(x: f64, y: f64, z: f64) -> DVec3 {
    DVec3::new(x, y, z).normalize()
}

fn directions() -> [(DVec3, DVec3); 4] {
    [
        (unit(0.3, 0.1, 0.7), unit(-0.2, 0.2, 0.9)),
        (unit(0.6, 0.0, 0.4), unit(-0.5, 0.3, 0.4)),
        (DVec3::Z, unit(0.5, 0.0, 0.6)),
        (unit(0.1, -0.4, 0.8), unit(0.0, 0.5, 0.8)),
    ]
}

/// Oracle: the normal map of a whole surface. Slabs are clear, because their thickness does not follow the bumps.
#[test]
fn layers_that_are_all_tilted_alike_are_a_tilted_surface() {
    let normal = unit(0.2, -0.15, 1.0);
    let whole = Place { sample: TextureSample { normal, ..TextureSample::NONE }, ..Place::NONE };
    for model in MODELS {
        for layers in [vec![metal(0.2)], vec![white()], vec![coat(1.5, 0.2, 0.0), coat(1.3, 0.3, 0.0), white()]] {
            let stack = stack(&layers);
            let (own, all) =
                (shaded(model, &stack, &bumps(&vec![normal; layers.len()])), shaded(model, &stack, &whole));
            for (wi, wo) in directions() {
                let (found, expected) = (own.eval(wi, wo), all.eval(wi, wo));
                assert!(expected[0] > 1e-6);
                for c in 0..3 {
                    assert!((found[c] / expected[c] - 1.0).abs() < 1e-12, "{model}: {found:?} {expected:?}");
                }
            }
        }
    }
}

/// Oracle: by hand. Below a coat of index 1 a base is lit by the cosine to its own normal, and a slab absorbs along paths against the
/// surface's.
#[test]
fn a_tilted_base_is_lit_by_its_own_cosine() {
    let normal = unit(-0.3, 0.2, 1.0);
    for model in MODELS {
        let value = shaded(model, &stack(&[coat(1.0, 0.2, 0.4), white()]), &bumps(&[DVec3::Z, normal]));
        for (wi, wo) in directions() {
            let absorbed = libm::exp(-0.4 * (1.0 / wi.z + 1.0 / wo.z));
            let expected = 0.8 * FRAC_1_PI * normal.dot(wi).max(0.0) * absorbed;
            let found = value.eval(wi, wo)[1];
            assert!((found - expected).abs() < 1e-12, "{model}: {found} {expected}");
        }
    }
}

/// A direction to the light or the eye, across a boundary of the relative index `eta` and a normal, both pointing up (Snell's law).
fn across(w: DVec3, normal: DVec3, eta: f64) -> DVec3 {
    let cos = w.dot(normal);
    let tangential = (w - cos * normal) / eta;
    tangential + libm::sqrt(1.0 - tangential.length_squared()) * normal
}

/// Oracle: Snell's law and a mirror as vectors, without local frames. The highlight of a flat mirror below a tilted varnish is where the
/// varnish bends it to; that of a tilted mirror below a flat varnish likewise.
#[test]
fn highlights_are_where_snell_sends_them() {
    let tilt = unit(0.12, 0.08, 1.0);
    let layers = stack(&[coat(1.5, 0.3, 0.0), metal(0.01)]);
    let clear = stack(&[coat(1.5, 0.3, 0.0)]);
    for (top, base) in [(tilt, DVec3::Z), (DVec3::Z, tilt)] {
        let place = bumps(&[top, base]);
        let value = shaded(ShadingModel::WeidlichWilkie, &layers, &place);
        let varnish = shaded(ShadingModel::WeidlichWilkie, &clear, &place);
        let wo = unit(-0.3, 0.2, 0.9);
        let down = across(wo, top, 1.5);
        let mirrored = 2.0 * base.dot(down) * base - down;
        let wi = across(mirrored, top, 1.0 / 1.5);
        let from_below = |wi: DVec3| value.eval(wi, wo)[1] - varnish.eval(wi, wo)[1];
        let peak = from_below(wi);
        assert!(peak > 10.0, "{peak}");
        for step in [0.05, 0.1] {
            for (x, y) in [(1.0, 0.0), (-1.0, 0.0), (0.0, 1.0), (0.0, -1.0)] {
                let beside = from_below((wi + step * DVec3::new(x, y, 0.0)).normalize());
                assert!(beside < 0.6 * peak, "{beside} {peak}");
            }
        }
        let level = from_below(DVec3::new(-wo.x, -wo.y, wo.z));
        assert!(level < 0.05 * peak, "{level} {peak}");
    }
}

/// Oracle: the stack of the file with these numbers.
#[test]
fn factors_and_tangents_are_those_of_another_stack() {
    let brushed = |layer: Layer, alpha_x: f64, alpha_y: f64, rotation: f64| Layer {
        surface: Surface { distribution: Distribution::Ggx, alpha_x, alpha_y, rotation },
        ..layer
    };
    let slab = |thickness_um: f64| Slab { thickness_um, absorption_per_um: [0.3; 3] };
    let inner =
        |thickness_um| layer(0.3, Base::Dielectric { ior: Ior::constant(1.3, 0.0).unwrap(), slab: slab(thickness_um) });
    let given = stack(&[brushed(coat(1.5, 0.1, 0.1), 0.4, 0.2, 0.3), inner(1.0), brushed(metal(0.1), 0.1, 0.5, -0.2)]);
    let turn = |angle: f64| DVec2::new(libm::cos(angle), libm::sin(angle));
    let own = [
        LayerSample { alpha_factors: [0.5, 0.8], tangent: turn(0.4), ..LayerSample::NONE },
        LayerSample { alpha_factors: [0.7; 2], slab_factor: 0.25, ..LayerSample::NONE },
        LayerSample { tangent: turn(-0.9), ..LayerSample::NONE },
    ];
    let other = stack(&[
        brushed(coat(1.5, 0.1, 0.1), 0.2, 0.16, 0.7),
        Layer { surface: Surface::isotropic(Distribution::Ggx, 0.21), ..inner(0.25) },
        brushed(metal(0.1), 0.1, 0.5, -1.1),
    ]);
    for model in [
        ShadingModel::WeidlichWilkie,
        ShadingModel::Yamaguchi,
        ShadingModel::Elek,
        ShadingModel::Belcour,
        ShadingModel::Microfacet,
        ShadingModel::GranierHeidrich,
    ] {
        let found = shaded(model, &given, &Place { layers: own.to_vec(), ..Place::NONE });
        let (expected, without) = (shaded(model, &other, &Place::NONE), shaded(model, &given, &Place::NONE));
        for (wi, wo) in directions() {
            let [found, expected, without] = [&found, &expected, &without].map(|one| one.eval(wi, wo)[1]);
            assert!((found / expected - 1.0).abs() < 1e-9, "{model}: {found} {expected}");
            assert!((without / expected - 1.0).abs() > 1e-3, "{model}: {without} {expected}");
        }
    }
}
