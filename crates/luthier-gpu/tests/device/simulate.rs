//! The simulation on the device against that in f64, of the same records.

use glam::DVec3;
use luthier_gpu::{Facets, GpuError, RenderSettings, Shape, Shown, SimulationSettings};
use luthier_layers::layered_mc::{InterfaceMode, LayeredMc};
use luthier_layers::monochrome::{Monochrome, MonochromeBelow};
use luthier_manifest::{LayerKind, LayerRecord};
use luthier_optics::stack::{Distribution, Surface};
use luthier_shader::Form;
use num_complex::Complex64;

use crate::adapter::gpu;
use crate::bake_by_hand::{artefacts, conductor, dielectric, diffuse};

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

/// Device and reference within four standard errors of their difference, and means over the pairs within 1 %.
fn assert_agrees(facets: Facets, mode: InterfaceMode, samples: u32, reference: u64) {
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
    for (i, (name, records)) in stacks.iter().enumerate() {
        let device = scene.simulate(i as u32, &single, samples, &settings).unwrap();
        for c in 0..3 {
            let stack = monochrome(records, c);
            let (mut sums, mut variance) = ([0.0; 2], 0.0);
            for ((wi, wo), found) in pairs.iter().zip(&device) {
                let mc = LayeredMc { samples: reference, seed: 3 + c as u64, ..LayeredMc::new(mode) };
                let expected = mc.estimate(&stack, *wi, *wo);
                let error = expected.std_err.hypot(found.std_err[c]);
                let apart = found.mean[c] - expected.mean;
                // Roundings of f32 apart.
                if !(apart.abs() <= 4.0 * error + 2e-5 * expected.mean) {
                    wrong.push(format!("{name} {c} {wi} {wo}: {} against {expected:?}", found.mean[c]));
                }
                sums[0] += found.mean[c];
                sums[1] += expected.mean;
                variance += error * error;
            }
            let (share, noise) = (sums[0] / sums[1] - 1.0, variance.sqrt() / sums[1]);
            eprintln!("{name}, channel {c}: {share:+.4} (noise {noise:.4})");
            if !(share.abs() < 0.01) {
                wrong.push(format!("{name} {c}: {share}"));
            }
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn one_facet_is_the_reference() {
    assert_agrees(Facets::One, InterfaceMode::OneFacet, 1 << 15, 1 << 16);
}

#[test]
fn walks_are_the_reference() {
    assert_agrees(Facets::Walk, InterfaceMode::SmithWalk, 1 << 15, 1 << 16);
}
