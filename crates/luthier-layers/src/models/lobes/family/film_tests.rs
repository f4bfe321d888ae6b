//! Films on the base of a family against the simulation of single places.

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Base, Diffuse, Distribution, Film, FilmThickness, Layer, Slab, Stack, Surface};

use super::tests::traced;
use super::{Family, Mix, Paint};
use crate::models::lobes::{FitSettings, Varied, Varying};

const SETTINGS: FitSettings = FitSettings { rows: 19, paths: 16_000, seed: 5 };

/// A film on a base without metal.
fn filmed(ior: f64, nm: f64) -> Stack {
    let film = Film { ior: Ior::constant(ior, 0.0).unwrap(), thickness: FilmThickness { min_nm: nm, max_nm: nm } };
    let surface = Surface::isotropic(Distribution::Ggx, 0.5);
    let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
    let interface = Base::Dielectric { ior: Ior::engine(&Ior::vacuum(), DIELECTRIC_INDEX).with_f0([0.04; 3]), slab };
    let diffuse = Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 });
    let layers = vec![
        Layer { films: vec![film], surface, base: interface },
        Layer { films: Vec::new(), surface: Surface::smooth(), base: diffuse },
    ];
    Stack { exterior: Ior::vacuum(), layers }
}

/// Oracle: paths of the stack in one colour, which meet the film at every facet. Closed forms in the F0 of a place are as far from them as the approximations
/// of the film say, a hundredth in the median; a white place returns all light, and no place more.
#[test]
fn films_in_closed_form_are_those_of_the_simulation() {
    let color = Color::Spectral;
    let colors = [([0.3, 0.7, 0.95], 1.0), ([0.9, 0.4, 0.1], 0.0), ([1.0; 3], 1.0), ([1.0; 3], 0.0)];
    let mut differences = Vec::new();
    for (ior, nm) in [(1.5, 400.0), (1.8, 250.0)] {
        let stack = filmed(ior, nm);
        for alpha in [0.1, 0.5] {
            let family = Family::new(&stack, [alpha; 2], [alpha; 2], true).unwrap();
            let varied = Varied::with(&stack, &color, Some(Varying::Family(family)), SETTINGS);
            for (base, metallic) in colors {
                let level = family.apply(&stack, [alpha; 2]);
                let paint = Paint::of(&level).mixed(Mix {
                    metal: base,
                    tint: [1.0; 3],
                    dielectric: [0.04; 3],
                    matt: base,
                    metallic,
                });
                let here = if metallic > 0.0 { paint.metal_of(&level) } else { paint.plastic_of(&level) };
                let lobes = varied.painted([alpha; 2], &paint).unwrap();
                for theta in [0.0, 1.0, 1.3] {
                    let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                    let (found, sum) = (lobes.row(wo).albedo_dir, traced(&here, &color, 30_000, wo));
                    let apart = (0..3).map(|c: usize| (found[c] - sum[c]).abs()).fold(0.0, f64::max);
                    let limit = if base == [1.0; 3] { 0.004 } else { 0.035 };
                    assert!(apart < limit, "{ior} {nm} {alpha} {base:?} {metallic} {theta}: {found:?} {sum:?}");
                    assert!(found.iter().all(|albedo| *albedo < 1.002), "{found:?}");
                    differences.push(apart);
                }
            }
        }
    }
    differences.sort_by(f64::total_cmp);
    assert!(differences[differences.len() / 2] < 0.005, "{differences:?}");
}

/// The stack below a coat.
fn coated(alpha: f64, below: Stack) -> Stack {
    let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
    let clear = Ior::constant(1.5, 0.0).unwrap();
    let base = Base::Dielectric { ior: clear.clone(), slab };
    let coat = Layer { films: Vec::new(), surface: Surface::isotropic(Distribution::Ggx, alpha), base };
    let layers = [coat].into_iter().chain(below.layers).map(|mut layer| {
        if let Base::Dielectric { ior, .. } = &mut layer.base
            && let Some(f0) = ior.f0()
        {
            *ior = Ior::engine(&clear, DIELECTRIC_INDEX).with_f0(f0);
        }
        layer
    });
    Stack { exterior: below.exterior, layers: layers.collect() }
}

/// Oracle: paths of the stack in one colour, which meet the film at every facet of the base. Thicknesses are factors on that of the stack, which rows know
/// nothing of. The film of 1.2 reflects some light totally that the coat keeps.
#[test]
fn films_below_a_coat_are_those_of_the_simulation() {
    let color = Color::Spectral;
    let colors = [([0.5; 3], 1.0), ([0.3, 0.7, 0.95], 1.0), ([0.9, 0.4, 0.1], 0.0), ([1.0; 3], 1.0), ([1.0; 3], 0.0)];
    let (mut metals, mut others) = (Vec::new(), Vec::new());
    for (ior, nm) in [(1.2, 870.0), (1.5, 400.0), (1.8, 250.0)] {
        for (coat, alpha) in [(0.001, 0.12), (0.2, 0.4)] {
            let stack = coated(coat, filmed(ior, nm));
            let family = Family::new(&stack, [coat; 2], [alpha; 2], true).unwrap();
            let varied = Varied::with(&stack, &color, Some(Varying::Family(family)), SETTINGS);
            for (number, (base, metallic)) in colors.into_iter().enumerate() {
                let mut level = family.apply(&stack, [coat, alpha]);
                let film_factor = 0.8 + 0.1 * number as f64;
                let thickness = nm * film_factor;
                level.layers[1].films[0].thickness = FilmThickness { min_nm: thickness, max_nm: thickness };
                let paint = Paint { film_factor, ..Paint::of(&stack) };
                let paint =
                    paint.mixed(Mix { metal: base, tint: [1.0; 3], dielectric: [0.04; 3], matt: base, metallic });
                let here = if metallic > 0.0 { paint.metal_of(&level) } else { paint.plastic_of(&level) };
                let lobes = varied.painted([coat, alpha], &paint).unwrap();
                for theta in [0.0, 1.0, 1.3] {
                    let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                    let (found, sum) = (lobes.row(wo).albedo_dir, traced(&here, &color, 30_000, wo));
                    let apart = (0..3).map(|c: usize| (found[c] - sum[c]).abs()).fold(0.0, f64::max);
                    if base != [1.0; 3] {
                        if metallic > 0.0 { &mut metals } else { &mut others }.push(apart);
                    } else {
                        let limit = if metallic > 0.0 { 0.004 } else { 0.015 };
                        assert!(apart < limit, "{ior} {nm} {coat} {metallic} {theta}: {found:?} {sum:?}");
                    }
                    assert!(found.iter().all(|albedo| *albedo < 1.002), "{found:?}");
                }
            }
        }
    }
    for (differences, limits) in [(&mut metals, [0.01, 0.05]), (&mut others, [0.01, 0.05])] {
        differences.sort_by(f64::total_cmp);
        let [median, most] = [differences.len() / 2, differences.len() - 1].map(|i| differences[i]);
        assert!(median < limits[0] && most < limits[1], "{median} {most}");
    }
}

/// Oracle: the light of one facet by quadrature, which shaders show. What rows have below makes no more than all light of it, also where the eye is flat.
#[test]
fn facets_and_light_from_below_return_no_more_than_falls_in() {
    let color = Color::Spectral;
    let stack = filmed(1.8, 500.0);
    for alpha in [0.1, 0.32, 0.7] {
        let family = Family::new(&stack, [alpha; 2], [alpha; 2], true).unwrap();
        let varied = Varied::with(&stack, &color, Some(Varying::Family(family)), SETTINGS);
        let level = family.apply(&stack, [alpha; 2]);
        for metallic in [0.0, 0.5, 1.0] {
            let white = Mix { metal: [1.0; 3], tint: [1.0; 3], dielectric: [0.04; 3], matt: [1.0; 3], metallic };
            let lobes = varied.painted([alpha; 2], &Paint::of(&level).mixed(white)).unwrap();
            for theta in [0.0, 1.0, 1.3, 1.5, 1.553] {
                let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                let (row, facet) = (lobes.row(wo), lobes.first.as_ref().unwrap().energy(wo));
                let returned = [0, 1, 2].map(|c: usize| {
                    facet[c] + row.wide[c] + row.lobes.iter().map(|lobe| lobe.strength[c] * lobe.share).sum::<f64>()
                });
                assert!(returned.iter().all(|sum| *sum < 1.004), "{alpha} {metallic} {theta}: {returned:?}");
            }
        }
    }
}

/// Oracle: the film by itself at another F0. One facet of a mix reflects the mean of both surfaces, at every angle and in every channel.
#[test]
fn one_facet_of_a_mix_is_the_mean_of_both() {
    let stack = filmed(1.6, 350.0);
    let family = Family::new(&stack, [0.2; 2], [0.2; 2], true).unwrap();
    let few = FitSettings { paths: 500, ..SETTINGS };
    let varied = Varied::with(&stack, &Color::Spectral, Some(Varying::Family(family)), few);
    let mix = Mix { metal: [0.9, 0.5, 0.2], tint: [1.0; 3], dielectric: [0.04; 3], matt: [0.1; 3], metallic: 0.3 };
    let level = family.apply(&stack, [0.2; 2]);
    let paint = Paint::of(&level).mixed(mix);
    let first = varied.painted([0.2; 2], &paint).unwrap().first.unwrap();
    let [metal, plastic] = [paint.metal_of(&level), paint.plastic_of(&level)]
        .map(|stack| Interface::of(&stack, 0).unwrap().sampled(&Color::Spectral));
    for cos in [1.0, 0.6, 0.1] {
        let [found, metal, plastic] = [&first.reflectance, &metal, &plastic].map(|sampled| sampled.rgb(cos));
        for c in 0..3 {
            assert!((found[c] - 0.3 * metal[c] - 0.7 * plastic[c]).abs() < 1e-12, "{found:?} {metal:?} {plastic:?}");
        }
    }
}
