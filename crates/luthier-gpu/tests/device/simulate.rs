//! The simulation on the device against that in f64, of the same records.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;
use luthier_gpu::{Facets, GpuError, RenderSettings, Scene, Shown, SimulationSettings};
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_manifest::{LayerKind, LayerRecord};
use luthier_optics::fresnel::interface;
use luthier_optics::microfacet::{distribution, lambda};
use luthier_optics::stack::{Distribution, Surface};
use luthier_shader::Form;
use num_complex::Complex64;

use crate::adapter::gpu;
use crate::bake_by_hand::{artefacts, conductor, dielectric, diffuse};
use crate::render::{check, dark, dot, sun, uniform};

/// The records as the reference takes them, at one of the three wavelengths.
fn monochrome(records: &[LayerRecord], c: usize) -> Monochrome {
    // Indices of records are over that of the medium above.
    let mut above = 1.0;
    let mut layers = Vec::new();
    for r in records {
        let index = Complex64::new(r.ior_n[c], r.ior_k[c]) * above;
        let [alpha_x, alpha_y] = r.alpha_xy;
        let surface = Surface { distribution: r.distribution, alpha_x, alpha_y, rotation: r.rotation };
        let below = match r.kind {
            LayerKind::Dielectric => MonochromeBelow::dielectric(index.re, r.optical_depth[c]),
            LayerKind::Conductor => MonochromeBelow::Conductor { ior: index },
            LayerKind::Diffuse => MonochromeBelow::Diffuse { albedo: r.albedo[c], sigma: r.sigma },
        };
        layers.push((surface, below));
        above = if r.kind == LayerKind::Dielectric { index.re } else { above };
    }
    Monochrome::bare(&layers)
}

fn gold(alpha: f64) -> LayerRecord {
    // Relative to a coat of index 1.5.
    conductor(alpha, [0.12, 0.35, 0.97], [2.32, 1.6, 1.25])
}

fn brushed(record: LayerRecord, alpha_xy: [f64; 2], rotation: f64) -> LayerRecord {
    LayerRecord { alpha_xy, rotation, alpha: (alpha_xy[0] * alpha_xy[1]).sqrt(), ..record }
}

/// One stack for each part of the simulation.
fn stacks() -> Vec<(&'static str, Vec<LayerRecord>)> {
    let beckmann = |record: LayerRecord| LayerRecord { distribution: Distribution::Beckmann, ..record };
    let tinted = LayerRecord { optical_depth: [0.05, 0.4, 1.2], ..dielectric(0.15, 1.5) };
    vec![
        ("coat on metal", vec![dielectric(0.1, 1.5), gold(0.3)]),
        ("tinted coat on Oren-Nayar", vec![tinted, diffuse([0.9, 0.6, 0.3], 0.5)]),
        (
            "anisotropic, crossed",
            vec![brushed(dielectric(0.1, 1.5), [0.3, 0.1], 1.0), brushed(gold(0.3), [0.15, 0.5], 0.3)],
        ),
        ("three layers", vec![dielectric(0.3, 1.3), dielectric(0.2, 1.4), gold(0.2)]),
        ("Beckmann", vec![beckmann(dielectric(0.3, 1.5)), beckmann(gold(0.4))]),
        ("narrow coat on a rough metal", vec![dielectric(0.02, 1.5), gold(0.4)]),
        ("rough coat on a narrow metal", vec![dielectric(0.4, 1.5), gold(0.02)]),
        ("total reflection under the first layer", vec![dielectric(0.3, 1.6), dielectric(0.2, 0.75), gold(0.3)]),
        (
            "an index for each channel",
            vec![LayerRecord { ior_n: [1.4, 1.5, 1.6], ..dielectric(0.2, 1.5) }, diffuse([0.8; 3], 0.0)],
        ),
        ("rough metal alone", vec![gold(0.8)]),
    ]
}

/// A direction by its polar angle and azimuth in degrees.
fn at(theta: f64, phi: f64) -> DVec3 {
    let (theta, phi) = (theta.to_radians(), phi.to_radians());
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

fn single(d: DVec3) -> [f32; 3] {
    [d.x as f32, d.y as f32, d.z as f32]
}

/// How a stack is compared: its name, samples on the device, samples of the reference.
type Effort = (&'static str, u32, u64);

/// Device and reference within four standard errors of their difference, and the mean over pairs and channels within four of these and 1 %.
fn assert_agrees(facets: Facets, mode: InterfaceMode, efforts: &[Effort]) {
    let Some(gpu) = gpu() else { return };
    let stacks = stacks();
    let materials = stacks.iter().map(|(_, layers)| layers.clone()).collect();
    let scene = gpu.scene(&artefacts(Form::Full, materials, &[]), Form::Full).unwrap();
    let pairs = [
        (at(20.0, 40.0), at(25.0, 200.0)),
        (at(50.0, 10.0), at(40.0, 170.0)),
        (at(10.0, 0.0), at(60.0, 100.0)),
        (at(70.0, 30.0), at(65.0, 230.0)),
    ];
    let settings = SimulationSettings { facets, seed: 5 };
    let single: Vec<_> = pairs.iter().map(|(wi, wo)| (single(*wi), single(*wo))).collect();
    let mut wrong = Vec::new();
    for &(name, samples, reference) in efforts {
        let number = stacks.iter().position(|(other, _)| *other == name).unwrap();
        let device = scene.simulate(number as u32, &single, samples, &settings).unwrap();
        let (mut sums, mut variance) = ([0.0; 2], 0.0);
        for c in 0..3 {
            let stack = monochrome(&stacks[number].1, c);
            for ((wi, wo), found) in pairs.iter().zip(&device) {
                let mc = LayeredMc { samples: reference, seed: 3 + c as u64, ..LayeredMc::new(mode) };
                let expected = mc.estimate(&stack, *wi, *wo);
                let error = expected.variance().sqrt().hypot(found.std_err[c]);
                let apart = found.mean[c] - expected.mean;
                // The rest is f32.
                let is_near = apart.abs() <= 4.0 * error + 2e-5 * expected.mean;
                if !is_near {
                    wrong.push(format!("{name} {c} {wi} {wo}: {} against {expected:?}", found.mean[c]));
                }
                sums[0] += found.mean[c];
                sums[1] += expected.mean;
                variance += error * error;
            }
        }
        // Channels share their paths on the device: their errors may add up.
        let (share, noise) = (sums[0] / sums[1] - 1.0, (3.0 * variance).sqrt() / sums[1]);
        eprintln!("{facets:?}, {name}: {share:+.5} (noise {noise:.5})");
        let is_near = share.abs() < (4.0 * noise + 2e-5).min(0.01);
        if !is_near {
            wrong.push(format!("{name}: {share:+} of noise {noise}"));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn one_facet_is_the_reference() {
    let efforts: Vec<Effort> = stacks().iter().map(|(name, _)| (*name, 1 << 16, 1 << 15)).collect();
    assert_agrees(Facets::One, InterfaceMode::OneFacet, &efforts);
}

#[test]
fn walks_are_the_reference() {
    let names = [
        "coat on metal",
        "tinted coat on Oren-Nayar",
        "anisotropic, crossed",
        "three layers",
        "Beckmann",
        "rough metal alone",
    ];
    assert_agrees(Facets::Walk, InterfaceMode::SmithWalk, &names.map(|name| (name, 1 << 15, 1 << 13)));
}

#[test]
#[ignore = "minutes: scripts/nightly.sh tests"]
fn the_reference_with_many_samples() {
    let efforts: Vec<Effort> = stacks().iter().map(|(name, _)| (*name, 1 << 18, 1 << 17)).collect();
    assert_agrees(Facets::One, InterfaceMode::OneFacet, &efforts);
    assert_agrees(Facets::Walk, InterfaceMode::SmithWalk, &efforts);
}

fn scene(layers: Vec<LayerRecord>) -> Option<Scene> {
    gpu().map(|gpu| gpu.scene(&artefacts(Form::Full, vec![layers], &[]), Form::Full).unwrap())
}

const PART: [Shown; 1] = [Shown::Material(0)];

/// Oracle: Lambert's law, and the formula of Torrance and Sparrow; one sample has no noise then.
#[test]
fn balls_under_a_sun_have_their_closed_forms() {
    let to_light = DVec3::new(-0.4, 0.6, 0.7).normalize();
    let lit = RenderSettings { lights: sun(single(to_light), [2.0, 1.0, 0.5]), ..dark() };
    let one = SimulationSettings { facets: Facets::One, seed: 1 };

    let Some(matte) = scene(vec![diffuse([0.8, 0.4, 0.2], 0.0)]) else { return };
    let mut simulation = matte.simulation(&PART, &lit, &one).unwrap();
    simulation.add(1).unwrap();
    check(&simulation.image(), 2e-6, |n, _| {
        let cos = dot(n, to_light.to_array()).max(0.0);
        [0.8 * 2.0, 0.4, 0.2 * 0.5].map(|v| v * FRAC_1_PI * cos)
    });

    let (alpha, metal) = (0.4, [Complex64::new(0.2, 3.5), Complex64::new(0.9, 2.4), Complex64::new(1.4, 1.9)]);
    let record = conductor(alpha, metal.map(|n| n.re), metal.map(|n| n.im));
    let shiny = scene(vec![record]).unwrap();
    let mut simulation = shiny.simulation(&PART, &lit, &one).unwrap();
    simulation.add(1).unwrap();
    check(&simulation.image(), 2e-5, |n, wo| {
        let (n, wo) = (DVec3::from_array(n), DVec3::from_array(wo));
        let (cos_i, cos_o, wh) = (n.dot(to_light), n.dot(wo), (to_light + wo).normalize());
        if cos_i <= 0.0 {
            return [0.0; 3];
        }
        let cos_h = n.dot(wh);
        let d = distribution(Distribution::Ggx, alpha, cos_h, 1.0 - cos_h * cos_h);
        let g2 = 1.0 / (1.0 + lambda(Distribution::Ggx, alpha, cos_i) + lambda(Distribution::Ggx, alpha, cos_o));
        let light = [2.0, 1.0, 0.5];
        [0, 1, 2].map(|c: usize| {
            let fresnel = interface(Complex64::new(1.0, 0.0), metal[c], wo.dot(wh)).unpolarised();
            light[c] * d * g2 * fresnel / (4.0 * cos_o)
        })
    });
}

/// Oracle: the formula of Torrance and Sparrow in f64, of the directions that the device gets. What is off is single precision.
#[test]
fn narrow_facets_have_their_closed_form() {
    let metal = Complex64::new(0.2, 3.5);
    let wo = at(40.0, 20.0);
    for alpha in [0.1, 0.01, 0.001] {
        let record = conductor(alpha, [metal.re; 3], [metal.im; 3]);
        let Some(scene) = scene(vec![record]) else { return };
        // Half vectors within two slopes of the normal.
        let lights: Vec<DVec3> = (0..64)
            .map(|i| {
                let (radius, phi) = (alpha * f64::from(i % 8) / 4.0, f64::from(i / 8));
                let wh = DVec3::new(radius * phi.cos(), radius * phi.sin(), 1.0).normalize();
                2.0 * wo.dot(wh) * wh - wo
            })
            .collect();
        let pairs: Vec<_> = lights.iter().map(|wi| (single(*wi), single(wo))).collect();
        let one = SimulationSettings { facets: Facets::One, seed: 1 };
        let mut worst: f64 = 0.0;
        for ((wi, wo), found) in pairs.iter().zip(scene.simulate(0, &pairs, 1, &one).unwrap()) {
            let [wi, wo] = [wi, wo].map(|d| DVec3::from_array(d.map(f64::from)));
            let wh = (wi + wo).normalize();
            let d = distribution(Distribution::Ggx, alpha, wh.z, wh.x * wh.x + wh.y * wh.y);
            let g2 = 1.0 / (1.0 + lambda(Distribution::Ggx, alpha, wi.z) + lambda(Distribution::Ggx, alpha, wo.z));
            let fresnel = interface(Complex64::new(1.0, 0.0), metal, wo.dot(wh)).unpolarised();
            worst = worst.max((found.mean[0] / (d * g2 * fresnel / (4.0 * wo.z)) - 1.0).abs());
        }
        eprintln!("alpha {alpha}: {worst:.2e}");
        assert!(worst < 1e-5, "alpha {alpha}: {worst}");
    }
}

/// Oracle: a stack that absorbs nothing is invisible in even surroundings.
#[test]
fn white_stacks_are_invisible() {
    let Some(white) = scene(vec![dielectric(0.3, 1.5), dielectric(0.1, 1.2), diffuse([1.0; 3], 0.0)]) else { return };
    let even = RenderSettings { environment: uniform(1.0), size: 24, ..dark() };
    let mut simulation = white.simulation(&PART, &even, &SimulationSettings::default()).unwrap();
    simulation.add(20).unwrap();
    simulation.add(44).unwrap();
    assert_eq!(simulation.samples(), 64);
    let (image, noise) = (simulation.image(), simulation.noise());
    let middle = |x: &u32, y: &u32| x.abs_diff(12) + y.abs_diff(12) < 9;
    let (mut sum, mut variance, mut count) = (0.0, 0.0, 0.0);
    for (x, y) in (0..24).flat_map(|y| (0..24).map(move |x| (x, y))).filter(|(x, y)| middle(x, y)) {
        sum += f64::from(image.texel(x, y)[0]);
        variance += f64::from(noise.texel(x, y)[0]).powi(2);
        count += 1.0;
    }
    let (mean, error) = (sum / count, variance.sqrt() / count);
    eprintln!("{mean} (noise {error})");
    assert!((mean - 1.0).abs() < 4.0 * error && error < 0.01, "{mean} {error}");
    // Equal seeds give equal pictures, whatever the passes.
    let mut again = white.simulation(&PART, &even, &SimulationSettings::default()).unwrap();
    again.add(64).unwrap();
    let apart = image.data.iter().zip(&again.image().data).map(|(a, b)| (a - b).abs()).fold(0.0, f32::max);
    assert!(apart < 1e-5, "{apart}");
    // Samples that are called off between two submissions are none.
    let (before, asked) = (again.image(), std::cell::Cell::new(0));
    let is_late = || asked.replace(asked.get() + 1) == 2;
    assert!(!again.add_unless(8192, &is_late).unwrap());
    assert_eq!((asked.get(), again.samples()), (3, 64));
    assert!(again.image() == before);
}

#[test]
fn what_is_not_simulated_is_refused() {
    let Some(gpu) = gpu() else { return };
    let film =
        LayerRecord { film_ior_n: [1.4; 3], film_thickness_nm: 300.0, film_thickness_max_nm: 300.0, ..gold(0.2) };
    let glow = LayerRecord { reradiation: Some([[0.3; 3]; 3]), ..diffuse([0.5; 3], 0.0) };
    let tower = [vec![dielectric(0.2, 1.1); 8], vec![gold(0.2)]].concat();
    let cases = [(vec![film], "films"), (vec![glow], "fluorescent"), (tower, "8 layers")];
    let materials = cases.iter().map(|(layers, _)| layers.clone()).collect();
    let scene = gpu.scene(&artefacts(Form::Full, materials, &[]), Form::Full).unwrap();
    let up = [0.0, 0.0, 1.0];
    for (i, (_, word)) in cases.iter().enumerate() {
        let settings = SimulationSettings::default();
        let error = scene.simulate(i as u32, &[(up, up)], 1, &settings).unwrap_err();
        assert!(matches!(error, GpuError::NotSimulated { .. }) && error.to_string().contains(word), "{error}");
        assert!(scene.simulation(&[Shown::Material(i as u32)], &dark(), &settings).is_err());
    }
    let error = scene.simulate(9, &[(up, up)], 1, &SimulationSettings::default()).unwrap_err();
    assert!(matches!(error, GpuError::NoMaterial { material: 9, .. }));
}
