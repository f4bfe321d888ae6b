//! A ball that is path-traced on the device with `luthier_sample`, under a sky with a sun and stripes, against its picture in f64.
//!
//! A ball sees nothing of itself: a path ends in the sky after one draw. The picture in f64 is an integral of the model's twin over all
//! directions, without drawing.

use glam::{DMat3, DVec3};
use luthier_layers::twins::shaded::{Place, Shaded};
use luthier_manifest::{ColorMode, ShadingModel};
use luthier_optics::color::Color;

use super::draws::{Call, Disc, FITTED, NODES, calls, mean, random, scene};
use super::twin::shipped;

/// Pixels along one side of the picture.
const SIDE: u32 = 6;

/// Radiance of the sky.
fn sky(w: DVec3) -> f64 {
    let sun = DVec3::new(-0.48, 0.36, 0.8);
    let stripes = 0.5 + 0.5 * libm::sin(9.0 * w.x + 5.0 * w.y);
    0.2 + 0.6 * stripes * (0.5 + 0.5 * w.z) + 3.0 * libm::exp(12.0 * (w.dot(sun) - 1.0))
}

/// The frames of the pixels that show the ball, whose columns are tangent, bitangent and normal; the eye is far away along z.
fn pixels() -> Vec<DMat3> {
    let at = |i: u32| (2.0 * f64::from(i) + 1.0) / f64::from(SIDE) - 1.0;
    let grid = (0..SIDE).flat_map(|i| (0..SIDE).map(move |j| (at(i), at(j))));
    let frame = |(x, y): (f64, f64)| {
        let z_sq = 1.0 - x * x - y * y;
        (z_sq > 0.02).then(|| {
            let normal = DVec3::new(x, y, z_sq.sqrt());
            let tangent = DVec3::Y.cross(normal).normalize();
            DMat3::from_cols(tangent, normal.cross(tangent), normal)
        })
    };
    grid.filter_map(frame).collect()
}

#[test]
fn a_path_traced_ball_converges_to_the_picture_in_f64() {
    balls_converge(&FITTED[..1]);
}

#[test]
#[ignore = "a minute and a half: scripts/nightly.sh tests"]
fn path_traced_balls_converge_to_their_pictures_in_f64() {
    balls_converge(&FITTED);
}

fn balls_converge(names: &[&str]) {
    let mut materials = shipped(ShadingModel::Lobes.name());
    materials.retain(|material| names.contains(&material.name.as_str()));
    assert_eq!(materials.len(), names.len());
    // A place without flakes: those of the other test are tilted.
    materials.iter_mut().for_each(|material| material.effects = Default::default());
    let Some(scene) = scene(&materials) else { return };
    for (number, material) in (0..).zip(&materials) {
        let wavelengths_nm = material.bake.wavelengths_nm();
        let is_spectral = material.bake.color != Some(ColorMode::ThreeWavelengths);
        let color = if is_spectral { Color::Spectral } else { Color::ThreeWavelengths(wavelengths_nm) };
        let twin = Shaded::new(ShadingModel::Lobes, &material.stack, wavelengths_nm, color, &Place::NONE).unwrap();
        let mut errors = [0.0; 3];
        let mut brightness = 0.0;
        let pixels = pixels();
        for (seed, frame) in (1..).zip(&pixels) {
            let wo = (frame.transpose() * DVec3::Z).as_vec3();
            let (disc, eye) = (Disc::new(wo.to_array()), wo.as_dvec3());
            let cell = 1.0 / f64::from(NODES[0] * NODES[1]);
            let mut expected = 0.0;
            for (i, j) in (0..NODES[0]).flat_map(|i| (0..NODES[1]).map(move |j| (i, j))) {
                let at = |k: u32, of: u32| (f64::from(k) + 0.5) / f64::from(of);
                let (wi, area) = disc.at(at(i, NODES[0]), at(j, NODES[1]));
                let wi = DVec3::from(wi.map(f64::from));
                expected += area * cell * twin.eval(wi, eye).iter().sum::<f64>() / 3.0 * sky(*frame * wi);
            }
            let draws = random(seed << 20);
            let [directions, weights] =
                [Call::Direction, Call::Weight].map(|call| calls(&scene, number, wo.to_array(), call, &draws));
            let radiance: Vec<f64> = (directions.iter().zip(&weights))
                .map(|(wi, weight)| mean(*weight) * sky(*frame * DVec3::from(wi.map(f64::from))))
                .collect();
            for (error, count) in errors.iter_mut().zip([1 << 8, 1 << 12, 1 << 16]) {
                let found = radiance[..count].iter().sum::<f64>() / count as f64;
                *error += (found - expected) * (found - expected);
            }
            brightness += expected / pixels.len() as f64;
        }
        let errors = errors.map(|sum| (sum / pixels.len() as f64).sqrt() / brightness);
        eprintln!("{}: rms errors over the mean radiance {errors:.4?} of 2^8, 2^12, 2^16 draws", material.name);
        // Random numbers: a quarter of the error for sixteen times the draws, and what tables and f32 are off.
        assert!(errors[1] < 0.4 * errors[0] && errors[2] < 0.4 * errors[1] + 5e-4, "{}: {errors:?}", material.name);
        assert!(errors[2] < 6e-3, "{}: {errors:?}", material.name);
    }
}
