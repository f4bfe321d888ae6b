//! Yardsticks on the device against their specifications in f64.

use glam::DVec3;
use luthier_gpu::{Gpu, Package, Scene, Shader};
use luthier_manifest::{LayerRecord, Manifest, MaterialEntry};
use luthier_shader::{CoatNumbers, Form, Yardstick};

use crate::adapter::gpu;
use crate::evaluate::{Pair, pairs};

/// Largest relative error of a device. The rounding of a dozen products is a tenth of it.
const TOLERANCE: f64 = 1e-5;

/// D of GGX, glTF 2.0, Appendix B.3.2.
fn density(alpha: f64, cos_theta_h: f64) -> f64 {
    let alpha_sq = alpha * alpha;
    let term = cos_theta_h * cos_theta_h * (alpha_sq - 1.0) + 1.0;
    alpha_sq / (std::f64::consts::PI * term * term)
}

/// Smith's Lambda of GGX, Heitz 2014, eq. 72.
fn lambda(alpha: f64, cosine: f64) -> f64 {
    let tan_sq = (1.0 - cosine * cosine).max(0.0) / (cosine * cosine);
    0.5 * ((1.0 + alpha * alpha * tan_sq).sqrt() - 1.0)
}

/// Microfacet lobe without reflectance: D G / (4 cos cos), G of Heitz 2014, eq. 99.
fn lobe(alpha: f64, wi: DVec3, wo: DVec3, h: DVec3) -> f64 {
    let masking = 1.0 / (1.0 + lambda(alpha, wi.z) + lambda(alpha, wo.z));
    density(alpha, h.z) * masking / (4.0 * wi.z * wo.z)
}

fn schlick(f0: f64, f90: f64, cosine: f64) -> f64 {
    f0 + (f90 - f0) * (1.0 - cosine).powi(5)
}

/// The surface of glTF: `fresnel_mix` of a dielectric over Lambert's base, B.3.5.
fn gltf(numbers: &CoatNumbers, c: usize, wi: DVec3, wo: DVec3, h: DVec3) -> f64 {
    let fresnel = schlick(numbers.f0[c], 1.0, wo.dot(h));
    let diffuse = (1.0 - fresnel) * numbers.diffuse[c] / std::f64::consts::PI;
    diffuse + fresnel * lobe(numbers.alpha, wi, wo, h)
}

/// `fresnel_coat(normal, ior = 1.5, weight = 1, base, layer)` of KHR_materials_clearcoat: `mix(base, layer, fr)` with the reflectance at the eye.
fn gltf_clearcoat(numbers: &CoatNumbers, c: usize, wi: DVec3, wo: DVec3, h: DVec3) -> f64 {
    let f0 = ((1.0 - 1.5) / (1.0_f64 + 1.5)).powi(2);
    let fr = schlick(f0, 1.0, wo.z);
    gltf(numbers, c, wi, wo, h) * (1.0 - fr) + lobe(numbers.coat_alpha, wi, wo, h) * fr
}

/// `surfaceShading` of Filament's `surface_shading_model_standard.fs` with a clear coat of 1, in the names of its functions.
fn filament_clearcoat(numbers: &CoatNumbers, c: usize, wi: DVec3, wo: DVec3, h: DVec3) -> f64 {
    let below_coat = |f0: f64| (f0 * (f0 * (0.941_892 - 0.263_008 * f0) + 0.346_479) - 0.028_599_8).clamp(0.0, 1.0);
    let f0 = numbers.f0.map(below_coat);
    let f90 = f0.iter().map(|f0| f0 * 50.0 * 0.33).sum::<f64>().clamp(0.0, 1.0);
    let l_o_h = wi.dot(h);
    let fr = schlick(f0[c], f90, l_o_h) * lobe(numbers.alpha.max(numbers.coat_alpha), wi, wo, h);
    let fd = numbers.diffuse[c] / std::f64::consts::PI;
    let fcc = schlick(0.04, 1.0, l_o_h);
    let kelemen = 0.25 / (l_o_h * l_o_h);
    (fd + fr) * (1.0 - fcc) + density(numbers.coat_alpha, h.z) * kelemen * fcc
}

/// f cos_theta_i of a yardstick; 0 where a direction is below the horizon.
fn twin(yardstick: Yardstick, numbers: &CoatNumbers, wi: DVec3, wo: DVec3) -> [f64; 3] {
    if wi.z <= 0.0 || wo.z <= 0.0 {
        return [0.0; 3];
    }
    let h = (wi + wo).normalize();
    let value = match yardstick {
        Yardstick::Gltf => gltf,
        Yardstick::GltfClearcoat => gltf_clearcoat,
        Yardstick::FilamentClearcoat => filament_clearcoat,
    };
    [0, 1, 2].map(|c| value(numbers, c, wi, wo, h) * wi.z)
}

/// A metal below a glossy coat, a painted surface smoother than its coat, a rough surface.
fn materials() -> [CoatNumbers; 3] {
    [
        CoatNumbers { f0: [0.91, 0.62, 0.31], alpha: 0.35, diffuse: [0.0; 3], coat_alpha: 0.04 },
        CoatNumbers { f0: [0.04; 3], alpha: 0.1, diffuse: [0.7, 0.1, 0.02], coat_alpha: 0.2 },
        CoatNumbers { f0: [0.08, 0.05, 0.03], alpha: 0.9, diffuse: [0.2, 0.3, 0.4], coat_alpha: 0.6 },
    ]
}

fn scene(gpu: &Gpu, yardstick: Yardstick) -> Scene {
    let materials: Vec<MaterialEntry> = materials()
        .iter()
        .map(|_| MaterialEntry { layers: vec![LayerRecord::default()], ..MaterialEntry::default() })
        .collect();
    let manifest = Manifest { bindings: vec![Yardstick::binding()], ..Manifest::new("test", materials, Vec::new()) };
    let shaders = vec![Shader::wgsl(Form::Full, yardstick.wgsl())];
    let package = Package::from_parts(manifest, Vec::new(), shaders).unwrap();
    let words: Vec<[f32; 4]> = self::materials().iter().flat_map(CoatNumbers::words).collect();
    gpu.scene(&package, Form::Full).unwrap().with_words(&words).unwrap()
}

/// Numbers as the buffer has them: rounded to f32.
fn rounded(numbers: &CoatNumbers) -> CoatNumbers {
    let single = |value: f64| f64::from(value as f32);
    let [f0, diffuse] = [numbers.f0, numbers.diffuse].map(|values| values.map(single));
    CoatNumbers { f0, diffuse, alpha: single(numbers.alpha), coat_alpha: single(numbers.coat_alpha) }
}

/// Oracle: the formulas of the specifications above, at the directions that the device was given.
#[test]
fn yardsticks_have_the_values_of_their_specifications() {
    let Some(gpu) = gpu() else { return };
    let double = |v: &[f32; 3]| DVec3::from_array(v.map(f64::from)).normalize();
    // Directions at the horizon have an own test for models; here the rounding of a cosine of 1e-7 would be all of the error.
    let pairs: Vec<Pair> = pairs(0x5eed).into_iter().filter(|(wi, wo)| wi[2].min(wo[2]) > 0.01).collect();
    assert!(pairs.len() > 3000, "{}", pairs.len());
    for yardstick in Yardstick::ALL {
        let scene = scene(&gpu, yardstick);
        let mut worst = (0.0, String::new());
        for (number, numbers) in (0..).zip(materials()) {
            let device = scene.evaluate(number, &pairs).unwrap();
            for ((wi, wo), got) in pairs.iter().zip(&device) {
                let expected = twin(yardstick, &rounded(&numbers), double(wi), double(wo));
                for c in 0..3 {
                    let error = (f64::from(got[c]) - expected[c]).abs() / expected[c];
                    if error > worst.0 {
                        worst =
                            (error, format!("material {number} wi {wi:?} wo {wo:?}: {} for {}", got[c], expected[c]));
                    }
                }
            }
        }
        eprintln!("{}: {:.2e} at {}", yardstick.name(), worst.0, worst.1);
        assert!(worst.0 <= TOLERANCE, "{}: {:.2e} at {}", yardstick.name(), worst.0, worst.1);
    }
}

#[test]
fn yardsticks_are_dark_below_the_horizon() {
    let Some(gpu) = gpu() else { return };
    let (up, down) = ([0.0, 0.6, 0.8], [0.6, 0.0, -0.8]);
    for yardstick in Yardstick::ALL {
        let values = scene(&gpu, yardstick).evaluate(1, &[(up, down), (down, up), (down, down)]).unwrap();
        assert_eq!(values, [[0.0; 3]; 3], "{}", yardstick.name());
    }
}
