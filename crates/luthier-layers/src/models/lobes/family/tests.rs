//! Families against the simulation of single places.

use std::f64::consts::TAU;

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::ior::{Ior, IorSample};
use luthier_optics::schlick::DIELECTRIC_INDEX;
use luthier_optics::stack::{Base, Diffuse, Distribution, Layer, Slab, Stack, Surface};

use super::{Family, Mix, Paint, SlopeAxis};
use crate::models::lobes::{FitSettings, Judge, Lobes, Varied, Varying};
use crate::references::layered_mc::ColorPaths;

const COLOR: Color = Color::ThreeWavelengths([650.0, 550.0, 450.0]);
const SETTINGS: FitSettings = FitSettings { rows: 10, paths: 16_000, seed: 5 };

/// A base without metal of index 1.5 over that above, over a diffuse one, below a coat that absorbs, or bare.
fn plastic(is_coated: bool, tint: [f64; 3]) -> Stack {
    let slab = |absorption_per_um| Slab { thickness_um: 1.0, absorption_per_um };
    let layer = |base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, 0.5), base };
    let above = Ior::constant(if is_coated { 1.5 } else { 1.0 }, 0.0).unwrap();
    let index = Ior::engine(&above, DIELECTRIC_INDEX);
    let coat = layer(Base::Dielectric { ior: above, slab: slab(tint) });
    let interface = layer(Base::Dielectric { ior: index.with_f0([0.04; 3]), slab: slab([0.0; 3]) });
    let diffuse = layer(Base::Diffuse(Diffuse { albedo: [0.5; 3], sigma: 0.0 }));
    let layers = if is_coated { vec![coat, interface, diffuse] } else { vec![interface, diffuse] };
    Stack { exterior: Ior::vacuum(), layers }
}

fn albedo(stack: &Stack, wo: DVec3) -> [f64; 3] {
    traced(stack, &COLOR, 60_000, wo)
}

/// Albedo of a stack by so many paths.
pub(super) fn traced(stack: &Stack, color: &Color, count: u64, wo: DVec3) -> [f64; 3] {
    let mut sum = [0.0; 3];
    ColorPaths::new(stack, color).trace(11, count, wo, |path| (0..3).for_each(|c| sum[c] += path.weight[c]));
    sum.map(|sum| sum / count as f64)
}

#[test]
fn nodes_and_slope_parameters_are_inverse() {
    let axis = SlopeAxis::new([0.04, 0.49]);
    // Roots .2 to .7: half of the whole range, and 3.5 of seven steps.
    assert_eq!(axis.nodes, 5);
    for place in [0.0, 0.4, 3.0, 4.0] {
        assert!((axis.place(axis.alpha(place)) - place).abs() < 1e-12);
    }
    assert_eq!([axis.place(0.0), axis.place(1.0)], [0.0, 4.0]);
    assert!((axis.alpha(0.0) - 0.04).abs() < 1e-12 && (axis.alpha(4.0) - 0.49).abs() < 1e-12);
    assert_eq!(SlopeAxis::new([0.3, 0.3]), SlopeAxis { least: 0.3, most: 0.3, nodes: 1 });
    let family = Family::new(&plastic(true, [0.0; 3]), [0.0, 1.0], [0.0, 1.0], true).unwrap();
    assert!(family.coat.nodes > 1 && family.base.nodes > 1 && family.nodes() <= 64, "{family:?}");
    // Without a coat there is one axis.
    let bare = Family::new(&plastic(false, [0.0; 3]), [0.0, 1.0], [0.0, 1.0], true).unwrap();
    assert_eq!((bare.coat.nodes, bare.base.nodes, bare.interface), (1, 8, 0));
}

/// Oracle: paths of the stack in one colour. Closed forms in the colour, between those that a fit saw, with and without metal, tint and coat.
#[test]
fn colours_in_closed_form_are_those_of_the_simulation() {
    for (is_coated, tint) in [(true, [0.0; 3]), (true, [0.1, 0.3, 0.7]), (false, [0.0; 3])] {
        let stack = plastic(is_coated, tint);
        for alphas in [[0.02, 0.3], [0.5, 0.1]] {
            let family = Family::new(&stack, [alphas[0]; 2], [alphas[1]; 2], true).unwrap();
            let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), SETTINGS);
            for (color, metallic) in [([0.3, 0.7, 0.95], 1.0), ([0.9, 0.4, 0.1], 0.0)] {
                let level = family.apply(&stack, alphas);
                let paint = Paint::of(&level).mixed(Mix {
                    metal: color,
                    tint: [1.0; 3],
                    dielectric: [0.04; 3],
                    matt: color,
                    metallic,
                });
                let here = if metallic > 0.0 { paint.metal_of(&level) } else { paint.plastic_of(&level) };
                let lobes = varied.painted(alphas, &paint).unwrap();
                for theta in [0.0, 1.0] {
                    let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                    let (found, expected) = (lobes.row(wo).albedo_dir, albedo(&here, wo));
                    for c in 0..3 {
                        // Noise of both; and paths of many lengths as one length, worst over a bright diffuse base.
                        let limit = if tint == [0.0; 3] { 0.012 } else { 0.05 };
                        let apart = (found[c] - expected[c]).abs();
                        assert!(apart < limit, "{is_coated} {alphas:?} {metallic} {theta}: {found:?} {expected:?}");
                    }
                }
            }
        }
    }
}

/// Oracle: the simulation of the dielectric in its colour. Light that meets the base from one direction, in rows of a family and between colours that a fit saw.
#[test]
fn light_that_meets_the_base_is_that_of_the_simulation() {
    let (stack, alphas) = (plastic(true, [0.1, 0.3, 0.7]), [0.1, 0.3]);
    let family = Family::new(&stack, [alphas[0]; 2], [alphas[1]; 2], true).unwrap();
    let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), SETTINGS);
    let level = family.apply(&stack, alphas);
    let mix = Mix { metal: [0.8; 3], tint: [1.0; 3], dielectric: [0.04; 3], matt: [0.9, 0.4, 0.1], metallic: 0.0 };
    let paint = Paint::of(&level).mixed(mix);
    let [lobes, halved] = [0.0, 0.5].map(|metallic| varied.painted(alphas, &Paint { metallic, ..paint }).unwrap());
    let alone = Lobes::with(&paint.plastic_of(&level), &COLOR, SETTINGS);
    for theta in [0.0, 0.7, 1.2] {
        let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
        let [met, half] = [&lobes, &halved].map(|lobes| lobes.row(wo).base.unwrap().met.unwrap());
        let expected = alone.row(wo).base.unwrap().of_one_direction(paint.albedo, paint.albedo);
        for c in 0..3 {
            assert!((met[c] - expected[c]).abs() < 0.02, "{theta}: {met:?} {expected:?}");
            assert!((half[c] - 0.5 * met[c]).abs() < 1e-3, "{theta}: {half:?} {met:?}");
        }
    }
}

/// Oracle: paths of the stack in one colour with its edge tint. Rows know the effect of a tint from one tint at one F0, without a coat exactly of one facet.
#[test]
fn edge_tints_are_those_of_the_simulation() {
    for is_coated in [true, false] {
        let stack = plastic(is_coated, [0.0; 3]);
        for alphas in [[0.02, 0.1], [0.02, 0.3], [0.5, 0.1], [0.3, 0.8]] {
            let family = Family::new(&stack, [alphas[0]; 2], [alphas[1]; 2], true).unwrap().tinted(true);
            let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), SETTINGS);
            let level = family.apply(&stack, alphas);
            for (metal, tint) in [([0.5, 0.7, 0.95], [0.0, 0.5, 0.8]), ([0.95, 0.5, 0.7], [0.0, 0.5, 0.8])] {
                let paint =
                    Paint::of(&level).mixed(Mix { metal, tint, dielectric: [0.04; 3], matt: metal, metallic: 1.0 });
                let lobes = varied.painted(alphas, &paint).unwrap();
                for theta in [0.0, 1.0, 1.4] {
                    let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                    let (found, expected) = (lobes.row(wo).albedo_dir, albedo(&paint.metal_of(&level), wo));
                    for c in 0..3 {
                        // A tint of 0 is the farthest from the one that rows know.
                        let limit = if tint[c] > 0.0 { 0.02 } else { 0.03 };
                        let apart = (found[c] - expected[c]).abs();
                        assert!(apart < limit, "{is_coated} {alphas:?} {metal:?} {theta}: {found:?} {expected:?}");
                    }
                }
            }
        }
    }
}

/// Channels of such a simulation are shades of the metal: a coat whose index hangs on the wavelength has, in a spectrum, the energies of its index at the
/// sodium line.
#[test]
fn shades_are_no_wavelengths() {
    let sample = |wavelength_nm, n| IorSample { wavelength_nm, n, k: 0.0 };
    let flint = Ior::sampled(vec![sample(430.0, 1.54), sample(589.3, 1.5), sample(680.0, 1.48)]).unwrap();
    let mut dispersive = plastic(true, [0.0; 3]);
    if let Base::Dielectric { ior, .. } = &mut dispersive.layers[0].base {
        *ior = flint;
    }
    let energies = |stack: &Stack| {
        let family = Family::new(stack, [0.1; 2], [0.3; 2], true).unwrap();
        let settings = FitSettings { paths: 4000, ..SETTINGS };
        let varied = Varied::with(stack, &Color::Spectral, Some(Varying::Family(family)), settings);
        varied.nodes[0].rows[5].to_parts()[2..5].concat()
    };
    let [found, expected] = [&dispersive, &plastic(true, [0.0; 3])].map(energies);
    assert!(found.iter().zip(&expected).all(|(a, b)| (a - b).abs() < 1e-9), "{found:?} {expected:?}");
}

/// Oracle: a midpoint rule over directions of light. Between nodes and rows, lobes send as much light as the albedo says: no more than falls in.
#[test]
fn light_between_nodes_sums_to_the_albedo() {
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        let mut stack = plastic(true, [0.0; 3]);
        stack.layers.iter_mut().for_each(|layer| layer.surface.distribution = distribution);
        let family = Family::new(&stack, [0.1, 0.4], [0.1, 0.5], true).unwrap();
        let settings = FitSettings { paths: 8000, ..SETTINGS };
        let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), settings);
        let mix = Mix { metal: [1.0, 0.8, 0.5], tint: [1.0; 3], dielectric: [0.04; 3], matt: [0.5; 3], metallic: 1.0 };
        let side = 200;
        for alphas in [[0.2, 0.25], [0.13, 0.4], [0.36, 0.14]] {
            let lobes = varied.painted(alphas, &Paint::of(&stack).mixed(mix)).unwrap();
            for theta in [0.05, 0.7, 1.0, 1.2, 1.4] {
                let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                let mut sum = [0.0; 3];
                for (i, j) in (0..side).flat_map(|i| (0..side).map(move |j| (i, j))) {
                    let (z, phi) =
                        ((f64::from(i) + 0.5) / f64::from(side), TAU * (f64::from(j) + 0.5) / f64::from(side));
                    let (sin, (sin_phi, cos_phi)) = ((1.0 - z * z).sqrt(), libm::sincos(phi));
                    let light = lobes.eval(DVec3::new(sin * cos_phi, sin * sin_phi, z), wo);
                    (0..3).for_each(|c| sum[c] += light[c] * TAU / f64::from(side * side));
                }
                let stated = lobes.row(wo).albedo_dir;
                // Rows of other tails than that of GGX have shares that are at no place too small.
                let limit = if distribution == Distribution::Ggx { 0.006 } else { 0.02 };
                let apart = (0..3).map(|c| (sum[c] - stated[c]).abs()).fold(0.0, f64::max);
                assert!(apart < limit, "{distribution:?} {alphas:?} {theta}: {sum:?} {stated:?}");
                assert!(sum[0] < 1.002, "{distribution:?} {alphas:?} {theta}: {sum:?}");
            }
        }
    }
}

/// Light of a mix is the mean of both, and no place returns more than falls in.
#[test]
fn a_mix_is_linear_and_bounded() {
    let stack = plastic(true, [0.0; 3]);
    let family = Family::new(&stack, [0.1, 0.1], [0.04, 0.36], true).unwrap();
    let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), FitSettings { paths: 4000, ..SETTINGS });
    let at = |color: [f64; 3], metallic: f64, alpha: f64| {
        let mix = Mix { metal: color, tint: [1.0; 3], dielectric: [0.04; 3], matt: color, metallic };
        varied.painted([0.1, alpha], &Paint::of(&stack).mixed(mix)).unwrap()
    };
    let (wi, wo) = (DVec3::new(0.3, 0.2, 0.93).normalize(), DVec3::new(-0.5, 0.1, 0.8).normalize());
    let values = [0.0, 0.3, 1.0].map(|metallic| at([0.8, 0.5, 0.2], metallic, 0.2).eval(wi, wo));
    for c in 0..3 {
        let expected = 0.7 * values[0][c] + 0.3 * values[2][c];
        assert!((values[1][c] / expected - 1.0).abs() < 1e-9, "{values:?}");
    }
    for (metallic, alpha) in [(0.0, 0.04), (0.5, 0.1), (1.0, 0.3), (1.0, 0.36)] {
        let white = at([1.0; 3], metallic, alpha);
        assert!(white.rows.iter().all(|row| row.albedo_dir.iter().all(|albedo| *albedo <= 1.0 + 1e-12)));
    }
}

/// Oracle: the judge's own paths half way between nodes, at colours that no fit saw; and rows of a family of one node against the fit of that stack alone.
#[test]
fn errors_between_nodes_are_stated() {
    for (stack, is_metallic) in [(plastic(true, [0.0; 3]), true), (plastic(false, [0.0; 3]), true)] {
        let family = Family::new(&stack, [0.1, 0.1], [0.1, 0.5], is_metallic).unwrap();
        let over = Some(Varying::Family(family));
        let error = Judge::new(&stack, &COLOR, over).error(&Varied::with(&stack, &COLOR, over, SETTINGS));
        assert!(error.lobe < 0.08 && error.albedo < 0.05 && error.lobe_noise > 1e-3, "{error:?}");
    }
    let metal = Stack {
        layers: vec![
            plastic(true, [0.0; 3]).layers[0].clone(),
            Layer {
                base: Base::Conductor { ior: Ior::constant(0.3, 3.0).unwrap() },
                ..plastic(true, [0.0; 3]).layers[1].clone()
            },
        ],
        exterior: Ior::vacuum(),
    };
    let family = Family::new(&metal, [0.2; 2], [0.3; 2], false).unwrap();
    let varied = Varied::with(&metal, &COLOR, Some(Varying::Family(family)), SETTINGS);
    let here = family.apply(&metal, [0.2, 0.3]);
    let (own, alone) = (varied.painted([0.2, 0.3], &Paint::of(&here)).unwrap(), Lobes::with(&here, &COLOR, SETTINGS));
    for wo in [DVec3::Z, DVec3::new(0.8, 0.0, 0.6)] {
        let [own, alone] = [own.row(wo).albedo_dir, alone.row(wo).albedo_dir];
        assert!((0..3).all(|c| (own[c] - alone[c]).abs() < 0.01), "{own:?} {alone:?}");
    }
}

/// Painted lobes are in line between steps of a row. Oracle: the stored rows, in colours at the very view, down to the horizon, where what crosses a smooth coat is
/// steep.
#[test]
fn painted_lobes_are_the_stored_rows_down_to_the_horizon() {
    let stack = plastic(true, [0.0; 3]);
    let alphas = [0.001, 0.6];
    let family = Family::new(&stack, [alphas[0]; 2], [alphas[1]; 2], true).unwrap();
    let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), FitSettings { paths: 4000, ..SETTINGS });
    let paint = Paint::of(&stack).mixed(Mix {
        metal: [0.9; 3],
        tint: [1.0; 3],
        dielectric: [0.04; 3],
        matt: [0.9; 3],
        metallic: 1.0,
    });
    let lobes = varied.painted(alphas, &paint).unwrap();
    let stored = &varied.nodes[0];
    for cos_theta in [0.002, 0.004, 0.008, 0.03, 0.2] {
        let place = stored.axis.place(cos_theta);
        let first = place as usize;
        let [low, high] = [first, first + 1].map(|row| varied.stored(0, row));
        let row = low.between(&high, place - first as f64);
        let expected = family.row_in(&row, alphas, (&stored.frame, cos_theta), &paint, None);
        let found = lobes.row(DVec3::new((1.0 - cos_theta * cos_theta).sqrt(), 0.0, cos_theta));
        let [found, expected] = [&found, &expected].map(|row| row.lobes[0].strength[0] * row.lobes[0].share);
        assert!((found / expected - 1.0).abs() < 0.03, "{cos_theta}: {found} {expected}");
    }
}

/// Nothing comes from below facets that reflect a little more than everything, as quadrature and halves of a row have it, and no number is lost.
#[test]
fn facets_above_one_have_nothing_below() {
    let stack = plastic(false, [0.0; 3]);
    let family = Family::new(&stack, [0.3; 2], [0.3; 2], false).unwrap();
    let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), FitSettings { paths: 400, ..SETTINGS });
    let mut row = varied.stored(0, 0);
    row.albedo_dir = [-1e-4; 3];
    for energy in [0.0, 0.1] {
        row.wide = [energy; 3];
        row.base = None;
        row.lobes.iter_mut().for_each(|lobe| lobe.strength = [energy; 3]);
        let found = family.row_in(&row, [0.3; 2], (&varied.nodes[0].frame, 0.5), &Paint::of(&stack), None);
        assert_eq!((found.wide, found.lobes[0].strength, found.lobes[1].strength), ([0.0; 3], [0.0; 3], [0.0; 3]));
        assert!(found.albedo_dir.iter().all(|albedo| (albedo - 1.0001).abs() < 1e-12), "{:?}", found.albedo_dir);
    }
}

/// Oracle: paths of the stack with its dielectric at another F0, in one colour. Rows know an F0 of .04: bare, below a coat, and of an index that bends light, over
/// the albedo of a base and as a `metallic-roughness` surface. A coat leaves out light that some facets of a rough base reflect and others let through.
#[test]
fn another_f0_of_the_dielectric_is_that_of_the_simulation() {
    let mut apart: [Vec<f64>; 2] = Default::default();
    for (is_coated, ior) in [(false, 1.5), (false, 1.0), (false, 4.4), (true, 2.25), (true, 1.5)] {
        let mut stack = plastic(is_coated, [0.0; 3]);
        let number = stack.layers.len() - 2;
        if let Base::Dielectric { ior: index, .. } = &mut stack.layers[number].base {
            *index = Ior::constant(ior, 0.0).unwrap().with_f0([0.04; 3]);
        }
        for alphas in [[0.02, 0.1], [0.02, 0.4], [0.3, 0.8]] {
            let family = Family::new(&stack, [alphas[0]; 2], [alphas[1]; 2], true).unwrap();
            let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), SETTINGS);
            let level = family.apply(&stack, alphas);
            for (dielectric, matt, is_engine) in [
                ([0.0, 0.1, 0.2], [0.9, 0.5, 0.2], true),
                ([0.4, 0.6, 0.9], [0.9, 0.5, 0.2], true),
                ([0.02, 0.2, 0.4], [0.9; 3], false),
                ([0.4, 0.2, 0.6], [1.0; 3], false),
            ] {
                let mix = Mix { metal: [0.5; 3], tint: [1.0; 3], dielectric, matt, metallic: 0.0 };
                let plain = Paint::of(&level).mixed(mix);
                let paint = if is_engine { plain } else { Paint { albedo: matt, ..plain } };
                let lobes = varied.painted(alphas, &paint).unwrap();
                for theta in [0.0, 0.8, 1.3] {
                    let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                    let (found, expected) = (lobes.row(wo).albedo_dir, albedo(&paint.plastic_of(&level), wo));
                    for c in 0..3 {
                        // Noise of a white base, which returns all light, is that of the oracle.
                        let limit = if is_coated { 0.05 } else { 0.03 };
                        let off = (found[c] - expected[c]).abs();
                        assert!(off < limit, "{ior} {alphas:?} {mix:?} {theta}: {found:?} {expected:?}");
                        assert!(found[c] < 1.001, "{found:?}");
                        apart[usize::from(is_coated)].push(off);
                    }
                }
            }
        }
    }
    for apart in &mut apart {
        apart.sort_by(f64::total_cmp);
        assert!(apart[apart.len() / 2] < 0.005, "{:?}", apart[apart.len() / 2]);
    }
}

/// Oracle: paths of the stack with as much absorption as a place has. Rows of bases that keep their colours know lengths of light in a slab that varies: over
/// metals, over a diffuse base below another interface, and below the first interface alone.
#[test]
fn lengths_above_other_bases_are_those_of_the_simulation() {
    let mut apart = Vec::new();
    let layer = |base| Layer { films: vec![], surface: Surface::isotropic(Distribution::Ggx, 0.5), base };
    let index = |n, k| Ior::constant(n, k).unwrap();
    let coat = || plastic(true, [0.2, 0.5, 1.0]).layers.remove(0);
    let metal = |n, k| layer(Base::Conductor { ior: index(n, k) });
    let plain = |n| {
        let slab = Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] };
        layer(Base::Dielectric { ior: index(n, 0.0), slab })
    };
    let diffuse = |albedo| layer(Base::Diffuse(Diffuse { albedo, sigma: 0.0 }));
    for layers in [
        vec![coat(), metal(0.2, 3.5)],
        vec![coat(), metal(2.5, 3.5)],
        vec![coat(), plain(1.6), diffuse([0.9, 0.5, 0.0])],
        vec![coat(), diffuse([0.9, 0.5, 0.2])],
    ] {
        let stack = Stack { exterior: Ior::vacuum(), layers };
        for alphas in [[0.02, 0.1], [0.3, 0.3], [0.1, 0.7]] {
            let interface = super::base_interface(&stack).unwrap();
            let alphas = if interface == 0 { [alphas[1]; 2] } else { alphas };
            let family = Family::new(&stack, [alphas[0]; 2], [alphas[1]; 2], false).unwrap().below_varied_slab(true);
            let varied = Varied::with(&stack, &COLOR, Some(Varying::Family(family)), SETTINGS);
            for factor in [0.0, 0.3, 1.0, 2.0] {
                let mut level = family.apply(&stack, alphas);
                if let Base::Dielectric { slab, .. } = &mut level.layers[0].base {
                    slab.thickness_um *= factor;
                }
                let lobes = varied.painted(alphas, &Paint::of(&level)).unwrap();
                for theta in [0.0, 0.8, 1.3] {
                    let wo = DVec3::new(libm::sin(theta), 0.0, libm::cos(theta));
                    let (found, expected) = (lobes.row(wo).albedo_dir, albedo(&level, wo));
                    for c in 0..3 {
                        let off = (found[c] - expected[c]).abs();
                        assert!(
                            off < 0.025,
                            "{alphas:?} {factor} {theta}: {found:?} {expected:?} {:?}",
                            stack.layers[1]
                        );
                        apart.push(off);
                    }
                }
            }
        }
    }
    apart.sort_by(f64::total_cmp);
    assert!(apart[apart.len() / 2] < 0.002, "{:?}", apart[apart.len() / 2]);
}
