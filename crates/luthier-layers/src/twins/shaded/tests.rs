//! Twins at places against stacks that are written otherwise.

use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Diffuse, FilmThickness, Layer, Slab};

use super::*;
use crate::effects::flakes::Flakes;
use crate::effects::patina::Patina;
use crate::model::Model;
use crate::models::lobes::FitSettings;
use crate::monochrome::Monochrome;
use crate::registry;

const WAVELENGTHS_NM: [f64; 3] = [645.0, 525.0, 445.0];

/// Copper under a dispersive coat.
fn copper() -> Stack {
    let layer =
        |alpha, base| Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Beckmann, alpha), base };
    let samples = [(400.0, 1.7), (700.0, 1.5)].map(|(wavelength_nm, n)| IorSample { wavelength_nm, n, k: 0.0 });
    let slab = Slab { thickness_um: 1.0, absorption_per_um: [0.1, 0.3, 0.2] };
    let coat = Base::Dielectric { ior: Ior::sampled(samples.to_vec()).unwrap(), slab };
    let metal = Base::Conductor { ior: Ior::constant(1.04, 2.59).unwrap() };
    Stack { exterior: Ior::vacuum(), layers: vec![layer(0.3, coat), layer(0.2, metal)] }
}

fn directions() -> (DVec3, DVec3) {
    (DVec3::new(0.3, 0.1, 0.7).normalize(), DVec3::new(-0.2, 0.2, 0.9).normalize())
}

fn shaded(place: &Place, nm: f64) -> Rgb {
    let (wi, wo) = directions();
    let still = at_wavelength(&copper(), nm);
    Shaded::new(ShadingModel::Elek, &still, [nm; 3], Color::ThreeWavelengths([nm; 3]), place).unwrap().eval(wi, wo)
}

/// Oracle: the effects of Elek's model at one wavelength, which are written for a stack at one wavelength.
#[test]
fn effects_are_those_of_the_models_at_one_wavelength() {
    let (wi, wo) = directions();
    let patina = Patina { extent: 0.6, transition: 0.5, diffuse_albedo: 0.3, base_alpha: Some(0.4), tarnish: 0.6 };
    for map in [0.0, 0.4, 0.7, 1.0] {
        let growth =
            Growth { amount: patina.amount(map), diffuse_albedo: [0.3; 3], base_alpha: Some(0.4), tarnish: [0.6; 3] };
        let found = shaded(&Place { patina: Some(growth), ..Place::NONE }, 525.0);
        for (c, found) in found.into_iter().enumerate() {
            let expected = patina.eval(&Monochrome::new(&copper(), 525.0, c), map, wi, wo);
            assert!((found / expected - 1.0).abs() < 1e-12, "{map}: {found} {expected}");
        }
    }
    let flakes = Flakes { seed: 5, count: 64, tiling: 10.0, spread: 0.2, scale: 1.0, fade_start: 1.0 };
    let uv = glam::DVec2::new(0.0123, 0.0456);
    let under = Under { flake_normal: flakes.normal(uv, 0.5), ..Under::NONE };
    let found = shaded(&Place { under, ..Place::NONE }, 600.0);
    let plain = shaded(&Place::NONE, 600.0);
    for c in 0..3 {
        let expected = flakes.eval(&Monochrome::new(&copper(), 600.0, c), uv, 0.5, wi, wo);
        assert!((found[c] / expected - 1.0).abs() < 1e-12, "{} {expected}", found[c]);
        assert!((found[c] / plain[c] - 1.0).abs() > 1e-3);
    }
}

/// Where none has grown, oracles are the stack of the other layers by itself, and the closed form of a base; and light is linear in the amount.
#[test]
fn lobes_under_patina_are_those_of_both_ends() {
    let (wi, wo) = directions();
    let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
    let growth = Growth { amount: 0.0, diffuse_albedo: [0.3; 3], base_alpha: Some(0.4), tarnish: [0.6; 3] };
    let at = |stack: &Stack, patina: Option<Growth>| {
        Shaded::new(ShadingModel::Lobes, stack, WAVELENGTHS_NM, color, &Place { patina, ..Place::NONE })
            .unwrap()
            .eval(wi, wo)
    };
    let mut painted = copper();
    painted.layers[1].base = Base::Diffuse(Diffuse { albedo: [0.8, 0.5, 0.2], sigma: 0.0 });
    for stack in [copper(), painted] {
        let [none, half, whole] = [0.0, 0.4, 1.0].map(|amount| at(&stack, Some(Growth { amount, ..growth })));
        let bare = at(&lobes::bare(&stack), None);
        let all = at(&stack, None);
        for c in 0..3 {
            assert!((none[c] / bare[c] - 1.0).abs() < 0.02, "{none:?} {bare:?}");
            assert!((half[c] - 0.6 * none[c] - 0.4 * whole[c]).abs() < 1e-12, "{half:?}");
            // Scattering and tarnish change what is seen, and a whole patina covers the base.
            assert!((whole[c] / all[c] - 1.0).abs() > 0.02, "{whole:?} {all:?}");
        }
    }
    // Rows of an anisotropic stack are over the azimuth.
    let mut brushed = copper();
    brushed.layers[1].surface.alpha_y = 0.4;
    assert_eq!(at(&brushed, Some(growth)), at(&brushed, None));
}

/// Light of lobes by few paths, at a place.
fn lobes_at(stack: &Stack, place: &Place) -> Rgb {
    let (wi, wo) = directions();
    let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
    let few = FitSettings { rows: 8, paths: 2000, seed: 3 };
    let fit = |stack: &Stack, color: &Color, varying: Option<Varying>| Varied::with(stack, color, varying, few);
    Shaded::fitted_by(&fit, ShadingModel::Lobes, stack, WAVELENGTHS_NM, color, place).unwrap().eval(wi, wo)
}

/// Oracle: the stack and the one without its first layer, evaluated apart at the places that textures make of them.
#[test]
fn a_coat_over_a_side_is_the_mean_of_two_stacks() {
    let plastic = |f0: f64| Base::Dielectric {
        ior: Ior::engine(&Ior::constant(1.5, 0.0).unwrap(), DIELECTRIC_INDEX).with_f0([f0; 3]),
        slab: Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] },
    };
    let mut engine = copper();
    engine.layers[1].base = plastic(0.04);
    let mut paint = copper();
    paint.layers[1].base = Base::Diffuse(Diffuse { albedo: [0.8, 0.5, 0.2], sigma: 0.3 });
    engine.layers.push(paint.layers[1].clone());
    let leaning = |x: f64, y: f64| DVec3::new(x, y, 0.9).normalize();
    let own = |factor: f64| LayerSample {
        alpha_factors: [factor; 2],
        normal: leaning(0.1 - 0.2 * factor, 0.1),
        ..LayerSample::NONE
    };
    let normal = leaning(-0.05, 0.1);
    let sample = TextureSample { normal, alpha_factor: 0.8, slab_factor: 0.3, ..TextureSample::NONE };
    let mix =
        Mix { metal: [0.9, 0.6, 0.3], tint: [1.0; 3], dielectric: [0.04; 3], matt: [0.5, 0.4, 0.2], metallic: 0.3 };
    let flakes = Under { flake_normal: DVec3::new(0.2, 0.1, 0.9).normalize(), ..Under::NONE };
    let plain = Place { sample, layers: vec![own(0.5), own(0.7)], ..Place::NONE };
    for (stack, place) in [
        (copper(), Place { under: flakes, ..plain.clone() }),
        (engine, Place { metal: Some(mix), ..plain.clone() }),
        (paint.clone(), Place { base_color: Some([0.2, 0.6, 0.9]), layers: Vec::new(), ..plain.clone() }),
        // Bumps of the coat alone leave the base level.
        (paint, Place { layers: vec![LayerSample { normal: leaning(0.2, 0.1), ..LayerSample::NONE }], ..plain }),
    ] {
        let whole = lobes_at(&stack, &place);
        let sample = TextureSample { slab_factor: 1.0, ..place.sample };
        let layers = place.layers.iter().skip(1).copied().collect();
        let below = lobes_at(&lobes::bare(&stack), &Place { sample, layers, under: Under::NONE, ..place.clone() });
        for weight in [0.0, 0.35, 1.0] {
            let patina = Some(Growth::of_coat(weight));
            let found = lobes_at(&stack, &Place { patina, side: Some(Side::Coat), ..place.clone() });
            for c in 0..3 {
                let expected = weight * whole[c] + (1.0 - weight) * below[c];
                assert!((found[c] - expected).abs() < 1e-12, "{weight}: {found:?} {whole:?} {below:?}");
                assert!((whole[c] - below[c]).abs() > 1e-3);
            }
        }
    }
}

/// A film that varies on a coat over copper, and on copper.
fn filmed() -> [Stack; 2] {
    let thickness = FilmThickness { min_nm: 200.0, max_nm: 400.0 };
    let film = Film { ior: Ior::constant(1.9, 0.0).unwrap(), thickness };
    let mut coated = copper();
    coated.layers[0].films = vec![film.clone()];
    let mut metal = Stack { exterior: Ior::vacuum(), layers: vec![copper().layers[1].clone()] };
    metal.layers[0].films = vec![film];
    [coated, metal]
}

/// Oracle: the stack with its film and the one without it, evaluated apart. One film on one interface, and one that varies above other layers.
#[test]
fn a_film_with_a_weight_is_the_mean_of_two_stacks() {
    let [coated, metal] = filmed();
    let sample = TextureSample { alpha_factor: 0.8, slab_factor: 0.3, film_factor: 1.2, ..TextureSample::NONE };
    let place = Place { sample, ..Place::NONE };
    for stack in [coated, metal] {
        let mut bare = stack.clone();
        bare.layers[0].films.clear();
        let [whole, without] = [&stack, &bare].map(|stack| lobes_at(stack, &place));
        for weight in [0.0, 0.35, 1.0] {
            let patina = Some(Growth::of_coat(weight));
            let found = lobes_at(&stack, &Place { patina, side: Some(Side::Film), ..place.clone() });
            for c in 0..3 {
                let expected = weight * whole[c] + (1.0 - weight) * without[c];
                assert!((found[c] - expected).abs() < 1e-12, "{weight}: {found:?} {whole:?} {without:?}");
                assert!((whole[c] - without[c]).abs() > 1e-3);
            }
        }
    }
}

/// Oracle: the stack with its film and the one without it, at places with flakes and own normals, in models of paths.
#[test]
fn a_film_with_a_weight_is_the_mean_of_two_stacks_in_paths() {
    let (wi, wo) = directions();
    let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
    let [coated, metal] = filmed();
    let leaning = |x: f64, y: f64| DVec3::new(x, y, 0.9).normalize();
    let own = |normal: DVec3| LayerSample { normal, ..LayerSample::NONE };
    let sample = TextureSample { alpha_factor: 1.5, slab_factor: 0.3, film_factor: 1.2, ..TextureSample::NONE };
    let under = Under { flake_normal: leaning(0.1, -0.1), ..Under::NONE };
    let layers = vec![own(leaning(-0.05, 0.1)), own(leaning(0.1, 0.1))];
    for (model, stack) in [
        (ShadingModel::Elek, &coated),
        (ShadingModel::WeidlichWilkie, &coated),
        (ShadingModel::Elek, &metal),
        (ShadingModel::WeidlichWilkie, &metal),
    ] {
        let place = Place { sample, under, layers: layers.clone(), ..Place::NONE };
        let at = |stack: &Stack, place: &Place| {
            Shaded::new(model, stack, WAVELENGTHS_NM, color, place).unwrap().eval(wi, wo)
        };
        let [whole, without] = [stack.clone(), stack.without_first_films()].map(|stack| at(&stack, &place));
        assert_ne!(whole, without);
        for weight in [0.0, 0.35, 1.0] {
            let patina = Some(Growth::of_coat(weight));
            let found = at(stack, &Place { patina, side: Some(Side::Film), ..place.clone() });
            for c in 0..3 {
                let expected = weight * whole[c] + (1.0 - weight) * without[c];
                assert!((found[c] - expected).abs() < 1e-12, "{model:?} {weight}: {found:?} {whole:?} {without:?}");
            }
        }
    }
}

/// Oracle: the stack of a file with these numbers.
#[test]
fn tinted_slabs_are_those_of_another_stack() {
    let (wi, wo) = directions();
    let color = Color::ThreeWavelengths(WAVELENGTHS_NM);
    let factors = [0.3, 2.0, 0.7];
    let own = LayerSample { absorption_factors: factors, ..LayerSample::NONE };
    let place = Place { layers: vec![own], ..Place::NONE };
    let mut tinted = copper();
    if let Base::Dielectric { slab, .. } = &mut tinted.layers[0].base {
        (0..3).for_each(|c| slab.absorption_per_um[c] *= factors[c]);
    }
    for model in [ShadingModel::Elek, ShadingModel::WeidlichWilkie, ShadingModel::Belcour, ShadingModel::Yamaguchi] {
        let of = |stack: &Stack, place: &Place| {
            Shaded::new(model, stack, WAVELENGTHS_NM, color, place).unwrap().eval(wi, wo)
        };
        let [found, expected, plain] = [of(&copper(), &place), of(&tinted, &Place::NONE), of(&copper(), &Place::NONE)];
        assert!((0..3).all(|c| (found[c] / expected[c] - 1.0).abs() < 1e-12), "{model}: {found:?} {expected:?}");
        assert!((0..3).all(|c| (found[c] / plain[c] - 1.0).abs() > 1e-3), "{model}: {plain:?}");
    }
    assert_eq!(lobes_at(&copper(), &place), lobes_at(&tinted, &Place::NONE));
}

/// Oracle: the model of that wavelength with its textures.
#[test]
fn places_are_those_of_the_textured_models() {
    let (wi, wo) = directions();
    let sample = TextureSample {
        normal: DVec3::new(0.1, -0.05, 0.9).normalize(),
        alpha_factor: 1.3,
        slab_factor: 2.0,
        slope_variance: 0.02,
        ..TextureSample::NONE
    };
    for name in
        [ShadingModel::Elek, ShadingModel::WeidlichWilkie, ShadingModel::GranierHeidrich, ShadingModel::Microfacet]
    {
        let model = registry::model(name.name()).unwrap();
        let (nm, still) = (480.0, at_wavelength(&copper(), 480.0));
        for sample in [TextureSample::NONE, sample] {
            let color = Color::ThreeWavelengths([nm; 3]);
            let place = Place { sample, ..Place::NONE };
            let found = Shaded::new(name, &still, [nm; 3], color, &place).unwrap().eval(wi, wo);
            for (c, found) in found.into_iter().enumerate() {
                let expected = sample.eval(model.as_ref() as &dyn Model, &Monochrome::new(&copper(), nm, c), wi, wo);
                assert!((found / expected - 1.0).abs() < 1e-12, "{name}: {found} {expected}");
            }
        }
    }
}
