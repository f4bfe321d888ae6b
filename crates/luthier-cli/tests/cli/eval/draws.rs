//! Drawn directions on the device: of every model, for shipped materials with their tables. A histogram against the density, the integral of
//! the density against the share of draws above the horizon, mean weights against the integral of f cos_theta_i.
//!
//! Integrals are over the disc of directions seen from above, in polar coordinates about the mirrored eye: radii are logarithmic there and
//! square roots at the horizon, so that the midpoint rule meets no edge.

use std::f64::consts::TAU;

use luthier::{Bake, MemoryStore};
use luthier_export::Shader;
use luthier_gpu::Scene;
use luthier_manifest::{Form, FunctionGroup, ShadingModel};
use luthier_material::Material;

use super::twin::{gpu, shipped};

/// Materials: coats over metals, a coat over a diffuse base, two coats, brushed metals, films, flakes, patina.
const MATERIALS: [&str; 8] = [
    "car-paint",
    "red-lacquer",
    "house-paint",
    "varnished-brass",
    "brushed-aluminium",
    "soap-film",
    "copper-patina",
    "polished-gold",
];
/// Of these, those of which simulations are fitted.
pub(super) const FITTED: [&str; 4] = ["car-paint", "red-lacquer", "varnished-brass", "copper-patina"];

/// Angles of the eye, degrees.
pub(super) const EYES: [f64; 3] = [0.0, 40.0, 75.0];
const DRAWS: u32 = 1 << 16;
/// Nodes of the integrals along radii and around, and of them in one bin.
pub(super) const NODES: [u32; 2] = [192, 512];
const BIN: [u32; 2] = [12, 64];
const BINS: usize = (NODES[0] / BIN[0] * (NODES[1] / BIN[1])) as usize;
/// Radii fall by this power of e before they are linear.
const DECADES: f64 = 10.0;
/// Normal quantile of 1 - 1e-3 / 200: fewer histograms than that are judged, at a family significance of 1e-3.
const QUANTILE: f64 = 4.42;

/// What a call gives, by its number.
#[derive(Clone, Copy)]
pub(super) enum Call {
    Pdf,
    Light,
    Direction,
    Weight,
    Albedo,
    /// Sum of the weights of the proposals of all parts.
    Proposed,
}

/// `luthier_eval` with the number of another call in the length of the direction to the eye.
const BODY: &str = "
    let call = u32(round(log2(length(wo))));
    let prepared = PREPARE(material, wo / f32(1u << call));
    if call == 0u {
        return vec3<f32>(luthier_pdf(prepared, wi));
    }
    if call == 1u {
        return luthier_light(prepared, wi);
    }
    if call == 4u {
        return luthier_albedo(prepared);
    }
    if call == 5u {
        var sum = vec3<f32>(0.0);
        for (var part = 0u; part < LUTHIER_PROPOSALS; part++) {
            sum += luthier_propose(prepared, part, wi).weight;
        }
        return sum;
    }
    let drawn = luthier_sample(prepared, wi);
    if call == 2u {
        return select(vec3<f32>(0.0, 0.0, -1.0), drawn.wi, drawn.pdf > 0.0);
    }
    return drawn.weight;";

/// A package of materials, for a place whose flakes are tilted and whose patina is half grown.
pub(super) fn scene(materials: &[Material]) -> Option<Scene> {
    let gpu = gpu()?;
    let functions = [FunctionGroup::Propose, FunctionGroup::Albedo].into_iter().collect();
    let bake = Bake { functions, refuses: false, ..Bake::wgsl(&[Form::Baked]) };
    let mut package = bake.package(materials, &MemoryStore::default()).unwrap();
    let wgsl = package.wgsl(Form::Baked).unwrap().replace("fn luthier_eval(", "fn emitted_eval(");
    let mut prepare = "luthier_prepare".to_owned();
    let mut place = String::new();
    if wgsl.contains("fn luthier_place(") {
        prepare = "prepare_there".to_owned();
        place = "\nfn prepare_there(material: u32, wo: vec3<f32>) -> LuthierPrepared {\n    var place = luthier_place();\n    \
                 place.alpha_factor = 1.2;\n"
            .to_owned();
        for (member, value) in [
            ("flake_normal", "normalize(vec3<f32>(0.1, 0.2, 1.0))"),
            // Narrow lobes aside of the mirrored eye are too narrow for the nodes.
            (
                "inner_normal",
                "normalize(vec3<f32>(select(0.0, 0.05, luthier_layer(material, 0u).alpha > 0.1), 0.0, 1.0))",
            ),
            ("patina", "select(-1.0, 0.4, luthier_patina_amount(material, 0.5) >= 0.0)"),
        ] {
            if wgsl.contains(&format!("    {member}: ")) {
                place += &format!("    place.{member} = {value};\n");
            }
        }
        place += "    return luthier_prepare_at(place, material, wo);\n}\n";
    }
    let body = BODY.replace("PREPARE", &prepare);
    let wgsl = format!(
        "{wgsl}{place}\nfn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{{body}\n}}\n"
    );
    package.shaders = vec![Shader::wgsl(Form::Baked, wgsl)];
    Some(gpu.scene(&package, Form::Baked).unwrap())
}

/// The disc about the mirrored eye.
pub(super) struct Disc {
    middle: [f64; 2],
}

impl Disc {
    /// The disc of directions seen by an eye.
    pub(super) fn new(wo: [f32; 3]) -> Self {
        Self { middle: [-f64::from(wo[0]), -f64::from(wo[1])] }
    }

    /// Distance to the horizon.
    fn reach(&self, psi: f64) -> f64 {
        let (sin, cos) = libm::sincos(psi);
        let [x, y] = self.middle;
        let along = x * cos + y * sin;
        libm::sqrt((along * along + 1.0 - x * x - y * y).max(0.0)) - along
    }

    /// Direction at coordinates in 0..1, and solid angle over area there.
    pub(super) fn at(&self, t: f64, turn: f64) -> ([f32; 3], f64) {
        let psi = TAU * turn;
        let (sin, cos) = libm::sincos(psi);
        let reach = self.reach(psi);
        let tau = 1.0 - (1.0 - t) * (1.0 - t);
        let scale = libm::expm1(DECADES);
        let s = libm::expm1(DECADES * tau) / scale;
        let slope = DECADES * libm::exp(DECADES * tau) / scale * 2.0 * (1.0 - t);
        let [x, y] = [self.middle[0] + reach * s * cos, self.middle[1] + reach * s * sin];
        // (reach - r) times the distance to the horizon on the other side, without cancellation.
        let rest = -libm::expm1(DECADES * (tau - 1.0)) / -libm::expm1(-DECADES);
        let z = libm::sqrt((reach * rest * (reach * s + self.reach(psi + TAU / 2.0))).max(1e-30));
        ([x as f32, y as f32, z as f32], reach * s * reach * slope * TAU / z)
    }

    /// The bin of a direction.
    fn bin(&self, w: [f32; 3]) -> usize {
        let [x, y] = [f64::from(w[0]) - self.middle[0], f64::from(w[1]) - self.middle[1]];
        let turn = (libm::atan2(y, x) / TAU).rem_euclid(1.0);
        let s = (libm::hypot(x, y) / self.reach(TAU * turn)).min(1.0);
        let tau = libm::log1p(s * libm::expm1(DECADES)) / DECADES;
        let t = 1.0 - libm::sqrt((1.0 - tau).max(0.0));
        let [i, j] = [t * f64::from(NODES[0]), turn * f64::from(NODES[1])].map(|v| v as u32);
        bin_of(i.min(NODES[0] - 1), j.min(NODES[1] - 1))
    }
}

fn bin_of(i: u32, j: u32) -> usize {
    (i / BIN[0] * (NODES[1] / BIN[1]) + j / BIN[1]) as usize
}

/// Calls of a function of a material that is seen from wo.
pub(super) fn calls(scene: &Scene, material: u32, wo: [f32; 3], call: Call, arguments: &[[f32; 3]]) -> Vec<[f32; 3]> {
    let scale = (1u32 << call as u32) as f32;
    let eye = wo.map(|v| v * scale);
    let pairs: Vec<_> = arguments.iter().map(|&argument| (argument, eye)).collect();
    scene.evaluate(material, &pairs).unwrap()
}

/// Numbers in 0..1 that look random (SplitMix64, Steele, Lea and Flood 2014).
pub(super) fn random(seed: u64) -> Vec<[f32; 3]> {
    let number = |i: u64| {
        let mut z = (seed << 32).wrapping_add(i + 1).wrapping_mul(0x9E37_79B9_7F4A_7C15);
        z = (z ^ (z >> 30)).wrapping_mul(0xBF58_476D_1CE4_E5B9);
        z = (z ^ (z >> 27)).wrapping_mul(0x94D0_49BB_1331_11EB);
        ((z ^ (z >> 31)) >> 40) as f32 / (1 << 24) as f32
    };
    (0..u64::from(DRAWS)).map(|i| [0, 1, 2].map(|k| number(3 * i + k))).collect()
}

/// Numbers that fill the cube evenly: the first in steps, the others by Roberts 2018, multiples of the powers of the root of x^3 = x + 1.
fn even() -> Vec<[f32; 3]> {
    let part = |i: u32, step: f64| (f64::from(i) * step).fract().min(0.999_999) as f32;
    let first = |i: u32| ((f64::from(i) + 0.5) / f64::from(DRAWS)) as f32;
    (0..DRAWS).map(|i| [first(i), part(i, 0.754_877_666_246_692_7), part(i, 0.569_840_290_998_053_2)]).collect()
}

/// Normal quantile of a chi-square statistic (Wilson and Hilferty 1931).
fn normal(chi_sq: f64, degrees: f64) -> f64 {
    let spread = 2.0 / (9.0 * degrees);
    (libm::cbrt(chi_sq / degrees) - (1.0 - spread)) / libm::sqrt(spread)
}

/// Chi-square of counts against shares, bins of fewer than ten expected draws taken together, as a normal quantile.
fn misfit(counts: &[f64], expected: &[f64]) -> f64 {
    let (mut chi_sq, mut bins, mut rare) = (0.0, 0.0, (0.0, 0.0));
    for (&count, &share) in counts.iter().zip(expected) {
        let share = share * f64::from(DRAWS);
        if share < 10.0 {
            rare = (rare.0 + count, rare.1 + share);
        } else {
            chi_sq += (count - share) * (count - share) / share;
            bins += 1.0;
        }
    }
    if rare.1 >= 10.0 {
        chi_sq += (rare.0 - rare.1) * (rare.0 - rare.1) / rare.1;
        bins += 1.0;
    } else if rare.0 > 40.0 {
        // Of ten expected draws, not once in 1e12.
        return f64::INFINITY;
    }
    if bins < 2.0 { 0.0 } else { normal(chi_sq, bins - 1.0) }
}

pub(super) fn mean(value: [f32; 3]) -> f64 {
    value.iter().map(|&v| f64::from(v)).sum::<f64>() / 3.0
}

/// What was found of a model.
#[derive(Default)]
pub(super) struct Found {
    misfit: f64,
    share: f64,
    weight: f64,
    greatest: f64,
    pub(super) albedo: f64,
    lost: f64,
    variance: f64,
    pub(super) faults: Vec<String>,
}

/// A third of the materials of every model, each from one angle, another for the next.
#[test]
fn directions_are_drawn_as_the_density_says() {
    drawn_as_the_density_says(|at| if at % 3 == 1 { vec![EYES[at / 3 % EYES.len()]] } else { Vec::new() });
}

#[test]
#[ignore = "two minutes: scripts/nightly.sh tests"]
fn directions_are_drawn_as_the_density_says_from_all_angles() {
    drawn_as_the_density_says(|_| EYES.to_vec());
}

/// Judges draws of all models; `eyes` gives the angles for a material, by its place among those of all models.
fn drawn_as_the_density_says(eyes: impl Fn(usize) -> Vec<f64>) {
    let only = std::env::var("LUTHIER_DRAWS").ok();
    let mut faults = Vec::new();
    let (mut seed, mut at) = (0, 0);
    for model in ShadingModel::ALL {
        if only.as_deref().is_some_and(|only| only != model.name()) {
            continue;
        }
        let named = if model == ShadingModel::Lobes { &FITTED[..] } else { &MATERIALS[..] };
        let mut materials = shipped(model.name());
        materials.retain(|material| named.contains(&material.name.as_str()));
        assert_eq!(materials.len(), named.len());
        let seen: Vec<Vec<f64>> = (at..at + materials.len()).map(&eyes).collect();
        at += materials.len();
        let (materials, seen): (Vec<_>, Vec<_>) =
            materials.into_iter().zip(seen).filter(|(_, eyes)| !eyes.is_empty()).unzip();
        let Some(scene) = scene(&materials) else { return };
        let mut found = Found::default();
        for ((number, material), eyes) in (0..).zip(&materials).zip(seen) {
            for theta in eyes {
                seed += 1;
                judge(&scene, number, theta, seed, &format!("{} {} {theta}", model.name(), material.name), &mut found);
            }
        }
        eprintln!(
            "| `{}` | {:.1} | {:.1e} | {:.2} | {:.0}% | {:.2} | {:.3} | {:.2e} |",
            model.name(),
            found.misfit,
            found.share,
            found.greatest,
            100.0 * found.lost,
            found.variance,
            found.albedo,
            found.weight
        );
        faults.append(&mut found.faults);
    }
    assert!(faults.is_empty(), "{}", faults.join("\n"));
}

/// Draws of a material that is seen from an angle, with what is wrong with them.
pub(super) fn judge(scene: &Scene, material: u32, theta: f64, seed: u64, what: &str, found: &mut Found) {
    let (sin, cos) = libm::sincos(theta.to_radians());
    let wo = [sin * 0.8, sin * 0.6, cos].map(|w| w as f32);
    let disc = Disc::new(wo);
    let call = |call, arguments: &[[f32; 3]]| calls(scene, material, wo, call, arguments);

    let nodes: Vec<(u32, u32)> = (0..NODES[0]).flat_map(|i| (0..NODES[1]).map(move |j| (i, j))).collect();
    let places: Vec<([f32; 3], f64)> = nodes
        .iter()
        .map(|&(i, j)| disc.at((f64::from(i) + 0.5) / f64::from(NODES[0]), (f64::from(j) + 0.5) / f64::from(NODES[1])))
        .collect();
    let directions: Vec<[f32; 3]> = places.iter().map(|place| place.0).collect();
    let cell = 1.0 / f64::from(NODES[0] * NODES[1]);
    let (pdfs, lights) = (call(Call::Pdf, &directions), call(Call::Light, &directions));
    let mut expected = vec![0.0; BINS + 1];
    let mut reflected = [0.0; 3];
    for (((i, j), (_, area)), (pdf, light)) in nodes.iter().zip(&places).zip(pdfs.iter().zip(&lights)) {
        expected[bin_of(*i, *j)] += area * cell * f64::from(pdf[0]);
        for (sum, value) in reflected.iter_mut().zip(light) {
            *sum += area * cell * f64::from(*value);
        }
    }
    let above: f64 = expected.iter().sum();
    expected[BINS] = (1.0 - above).max(0.0);

    let mut counts = vec![0.0; BINS + 1];
    for wi in call(Call::Direction, &random(seed)) {
        counts[if wi[2] > 0.0 { disc.bin(wi) } else { BINS }] += 1.0;
    }
    let misfit = misfit(&counts, &expected);

    let draws = even();
    let lost = call(Call::Direction, &draws).iter().filter(|wi| wi[2] <= 0.0).count() as f64 / f64::from(DRAWS);
    let weights = call(Call::Weight, &draws);
    let mut sum = [0.0; 3];
    let mut greatest = 0.0_f64;
    let mut square = 0.0;
    for weight in &weights {
        square += mean(*weight) * mean(*weight) / f64::from(DRAWS);
        sum.iter_mut().zip(weight).for_each(|(sum, &value)| *sum += f64::from(value) / f64::from(DRAWS));
        greatest = greatest.max(mean(*weight));
    }
    let energy = reflected.iter().sum::<f64>() / 3.0;
    let apart = (0..3).map(|c| (sum[c] - reflected[c]).abs()).fold(0.0, f64::max) / energy.max(1e-3);
    let variance = (square / (energy * energy).max(1e-12) - 1.0).max(0.0);
    let proposed = call(Call::Proposed, &draws).iter().map(|&weight| mean(weight)).sum::<f64>() / f64::from(DRAWS);
    let proposed = (proposed - energy).abs() / energy.max(1e-3);
    let albedo = call(Call::Albedo, &draws[..1])[0];
    let off = (0..3).map(|c| (f64::from(albedo[c]) - reflected[c]).abs()).fold(0.0, f64::max);
    let share = (above + lost - 1.0).abs();
    eprintln!(
        "{what}: misfit {misfit:.1}, above {above:.4}, lost {lost:.4}, weights {apart:.1e} off, proposals {proposed:.1e}, \
         variance {variance:.3}, greatest {:.2}, reflects {energy:.3}, \
         albedo {off:.3} off",
        greatest / energy.max(1e-6)
    );
    if !weights.iter().flatten().all(|value| value.is_finite()) {
        found.faults.push(format!("{what}: a weight is not finite"));
    }
    if misfit > QUANTILE {
        found.faults.push(format!("{what}: the histogram is off by {misfit:.1} deviations"));
    }
    if share > 1e-3 {
        found
            .faults
            .push(format!("{what}: {above} of the density is above the horizon, and {lost} of the draws are not"));
    }
    if apart > 0.01 {
        found.faults.push(format!("{what}: weights have the mean {sum:?}, and f cos the integral {reflected:?}"));
    }
    if proposed > 0.01 {
        found.faults.push(format!("{what}: the weights of all proposals are off by {proposed}"));
    }
    // Lobes draw each part from what it is made of, by its reflectance and where it leaves.
    if what.starts_with("lobes") && greatest > 1.5 * energy {
        found.faults.push(format!("{what}: a weight is {} of the mean", greatest / energy));
    }
    found.misfit = found.misfit.max(misfit);
    found.share = found.share.max(share);
    found.weight = found.weight.max(apart);
    found.greatest = found.greatest.max(greatest / energy.max(1e-6));
    found.albedo = found.albedo.max(off);
    found.lost = found.lost.max(lost);
    found.variance = found.variance.max(variance);
}
