//! The preview ball where its pixels are known in closed form.

use luthier_gpu::{Artefacts, BallSettings, GpuError, Scene, Sky};
use luthier_lut::{AtlasLayout, Image, LayerRecord, Mapping, TableKind, TexelFormat};
use luthier_shader::Form;

use crate::adapter::gpu;
use crate::bake_by_hand::{Table, artefacts, axis, conductor, dielectric, diffuse};

const SIZE: u32 = 65;

/// The camera that `BallSettings` documents no knob for: distance of the eye and half the picture's side, in radii.
const EYE: f64 = 7.0;
const HALF_EXTENT: f64 = 1.22;

fn dark() -> BallSettings {
    BallSettings {
        size: SIZE,
        samples: 1,
        light_irradiance: [0.0; 3],
        light_angular_radius: 0.0,
        sky: Sky::uniform([0.0; 3]),
        ..BallSettings::default()
    }
}

/// Constant tables: reflectance `fresnel`, albedo `fgd`.
fn tables(fresnel: f32, fgd: f32) -> Vec<Table> {
    let row = AtlasLayout { x: axis("cos_theta", 1.0, 8, Mapping::Linear), y: None, apron: 0, columns: 1, tiles: 1 };
    let square = |x: &str| AtlasLayout {
        x: axis(x, 1.5, 8, Mapping::Linear),
        y: Some(axis("alpha", 1.0, 8, Mapping::Linear)),
        ..row.clone()
    };
    vec![
        Table::new(TableKind::Fresnel, row.clone(), TexelFormat::Rgba16Float, |_, _| [fresnel; 4]),
        Table::new(TableKind::Distribution, square("theta_h"), TexelFormat::R16Float, |_, _| [1.0; 4]),
        Table::new(TableKind::Fgd, square("cos_theta"), TexelFormat::Rgba16Float, |_, _| [fgd; 4]),
    ]
}

fn tiled(layer: LayerRecord, fgd: Option<u32>) -> LayerRecord {
    LayerRecord { fresnel_tile: Some(0), distribution_tile: Some(0), fgd_tile: fgd, ..layer }
}

/// Normal of the ball under the centre of a pixel, and the direction to the eye; `None` beside the ball.
fn hit(x: u32, y: u32) -> Option<([f64; 3], [f64; 3])> {
    let coordinate = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(SIZE) - 1.0) * HALF_EXTENT;
    let at = [coordinate(x), -coordinate(y)];
    let length = (at[0] * at[0] + at[1] * at[1] + EYE * EYE).sqrt();
    let ray = [at[0] / length, at[1] / length, -EYE / length];
    let b = EYE * ray[2];
    let discriminant = b * b - (EYE * EYE - 1.0);
    // Away from the silhouette, where f32 and f64 may disagree on a hit.
    if discriminant < 1e-3 {
        return None;
    }
    let t = -b - discriminant.sqrt();
    Some(([t * ray[0], t * ray[1], EYE + t * ray[2]], ray.map(|v| -v)))
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Holds every pixel on the ball against a function of normal and direction to the eye.
fn check(image: &Image, tolerance: f64, expected: impl Fn([f64; 3], [f64; 3]) -> [f64; 3]) {
    assert_eq!((image.width, image.height, image.channels), (SIZE, SIZE, 3));
    let mut hits = 0;
    for y in 0..SIZE {
        for x in 0..SIZE {
            let Some((n, wo)) = hit(x, y) else { continue };
            hits += 1;
            let expected = expected(n, wo);
            for (got, expected) in image.texel(x, y).iter().zip(expected) {
                assert!((f64::from(*got) - expected).abs() <= tolerance, "pixel {x} {y}: {got} against {expected}");
            }
        }
    }
    assert!(hits > 2000, "{hits}");
}

fn scene_of(materials: Vec<Vec<LayerRecord>>, tables: &[Table]) -> Option<Scene> {
    let artefacts: Artefacts = artefacts(Form::Baked, materials, tables);
    Some(gpu()?.scene(&artefacts, "baked").unwrap())
}

#[test]
fn a_white_furnace_shows_nothing_but_albedo() {
    let mirror = |alpha, fgd| vec![tiled(conductor(alpha, [0.1; 3], [9.0; 3]), fgd)];
    let coated = vec![tiled(dielectric(0.1, 1.5), None), diffuse([0.5; 3], 0.0)];
    let materials = vec![mirror(0.01, None), mirror(0.9, Some(0)), coated, vec![diffuse([0.25, 0.5, 1.0], 0.0)]];
    let Some(scene) = scene_of(materials, &tables(0.25, 0.75)) else { return };
    let furnace = BallSettings { sky: Sky::uniform([0.8; 3]), ..dark() };
    let render = |material| scene.render_ball(material, &furnace).unwrap();
    check(&render(0), 1e-3, |_, _| [0.8 * 0.25; 3]);
    check(&render(1), 1e-3, |_, _| [0.8 * 0.75; 3]);
    // A quarter at the coat; three quarters in, half back, three quarters out.
    check(&render(2), 1e-3, |_, _| [0.8 * (0.25 + 0.75 * 0.5 * 0.75); 3]);
    check(&render(3), 1e-5, |_, _| [0.2, 0.4, 0.8]);
}

#[test]
fn absorption_follows_the_refracted_directions() {
    let coat = LayerRecord { optical_depth: [0.5, 0.0, 2.0], ..tiled(dielectric(0.1, 1.5), None) };
    let Some(scene) = scene_of(vec![vec![coat, diffuse([1.0; 3], 0.0)]], &tables(0.0, 0.0)) else { return };
    let furnace = BallSettings { sky: Sky::uniform([1.0; 3]), ..dark() };
    let path = |cos: f64| 1.0 / (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
    check(&scene.render_ball(0, &furnace).unwrap(), 1e-4, |n, wo| {
        [0.5, 0.0, 2.0].map(|depth: f64| (-depth * (path(dot(n, wo)) + path(2.0 / 3.0))).exp())
    });
}

#[test]
fn a_lambertian_ball_follows_the_cosine() {
    let Some(scene) = scene_of(vec![vec![diffuse([0.2, 0.5, 0.9], 0.0)]], &[]) else { return };
    let settings =
        BallSettings { light_direction: [3.0, 4.0, 12.0], light_irradiance: [2.0, 3.0, 4.0], exposure: 0.5, ..dark() };
    check(&scene.render_ball(0, &settings).unwrap(), 1e-5, |n, _| {
        let cos = dot(n, [3.0 / 13.0, 4.0 / 13.0, 12.0 / 13.0]).max(0.0);
        [0.2 * 2.0, 0.5 * 3.0, 0.9 * 4.0].map(|v| 0.5 * v * cos / std::f64::consts::PI)
    });
}

#[test]
fn the_sky_on_the_device_is_the_sky_of_the_host() {
    let materials = |alpha| vec![tiled(conductor(alpha, [0.1; 3], [9.0; 3]), None)];
    let base = vec![diffuse([1.0; 3], 0.0)];
    let alphas = [1e-3, 0.2, 1.0];
    let all = alphas.map(materials).into_iter().chain([base]).collect();
    let Some(scene) = scene_of(all, &tables(1.0, 1.0)) else { return };
    let sky = Sky::default();
    let settings = BallSettings { sky, ..dark() };
    for (i, alpha) in alphas.into_iter().enumerate() {
        check(&scene.render_ball(i as u32, &settings).unwrap(), 1e-4, |n, wo| {
            let cos = dot(n, wo);
            sky.radiance([0, 1, 2].map(|c| 2.0 * cos * n[c] - wo[c]), alpha)
        });
    }
    check(&scene.render_ball(3, &settings).unwrap(), 1e-4, |n, _| sky.irradiance(n).map(|e| e / std::f64::consts::PI));
}

/// A highlight of the smoothest surface is there, finite, and carries the same energy for any size of the light that
/// the pixels resolve.
#[test]
fn a_highlight_keeps_its_energy() {
    let mut plain = tables(1.0, 1.0);
    // pi alpha^2 D of GGX, so that the widened lobe stays normalised.
    let layout = AtlasLayout {
        x: axis("theta_h", std::f64::consts::FRAC_PI_2, 512, Mapping::Power { exponent: 8.0 }),
        y: Some(axis("alpha", 1.0, 512, Mapping::Power { exponent: 2.0 })),
        ..plain[1].layout.clone()
    };
    plain[1] = Table::new(TableKind::Distribution, layout, TexelFormat::R32Float, |_, [theta_h, alpha]| {
        let (sin, cos) = theta_h.sin_cos();
        let a = alpha.max(1e-3);
        [(1.0 / (cos * cos + sin * sin / (a * a)).powi(2)) as f32; 4]
    });
    let Some(scene) = scene_of(vec![vec![tiled(conductor(1e-3, [0.1; 3], [9.0; 3]), None)]], &plain) else { return };
    let energy = |radius: f32| {
        let settings = BallSettings {
            samples: 4,
            light_direction: [0.2, 0.3, 1.0],
            light_irradiance: [1.0; 3],
            light_angular_radius: radius,
            backdrop: [0.0; 3],
            ..dark()
        };
        let image = scene.render_ball(0, &settings).unwrap();
        assert!(image.data.iter().all(|v| v.is_finite() && *v >= 0.0));
        image.data.iter().map(|v| f64::from(*v)).sum::<f64>()
    };
    let (narrow, wide) = (energy(0.05), energy(0.1));
    assert!(narrow > 0.0 && (wide / narrow - 1.0).abs() < 0.05, "{narrow} {wide}");
}

#[test]
fn pixels_beside_the_ball_are_backdrop() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let settings = BallSettings { backdrop: [0.3, 0.2, 0.1], samples: 2, ..dark() };
    let image = scene.render_ball(0, &settings).unwrap();
    for (x, y) in [(0, 0), (SIZE - 1, 0), (0, SIZE - 1), (SIZE - 1, SIZE - 1)] {
        let [r, g, b] = image.texel(x, y) else { panic!("three channels") };
        assert!(*r > 0.05 && *r < 0.3 && (g / r - 2.0 / 3.0).abs() < 1e-5 && (b / r - 1.0 / 3.0).abs() < 1e-5);
    }
}

#[test]
fn settings_out_of_range_are_errors() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let refused = |settings: BallSettings| matches!(scene.render_ball(0, &settings), Err(GpuError::Setting { .. }));
    assert!(refused(BallSettings { size: 0, ..dark() }));
    assert!(refused(BallSettings { size: 100_000, ..dark() }));
    assert!(refused(BallSettings { samples: 0, ..dark() }));
    assert!(refused(BallSettings { light_direction: [0.0; 3], ..dark() }));
    assert!(refused(BallSettings { light_angular_radius: f32::NAN, ..dark() }));
    assert!(refused(BallSettings { exposure: f32::INFINITY, ..dark() }));
    assert!(matches!(scene.render_ball(9, &dark()), Err(GpuError::NoMaterial { material: 9, .. })));
    let Some(gpu) = gpu() else { return };
    let full = gpu.scene(&artefacts(Form::Full, vec![vec![diffuse([1.0; 3], 0.0)]], &[]), "full").unwrap();
    assert!(matches!(full.render_ball(0, &dark()), Err(GpuError::PreviewForm { .. })));
}

/// What the documentation of the exposure promises.
#[test]
fn a_white_ball_is_exposed_just_below_one() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let image = scene.render_ball(0, &BallSettings { samples: 1, ..BallSettings::default() }).unwrap();
    let brightest = image.data.iter().copied().fold(0.0, f32::max);
    assert!((0.9..1.0).contains(&brightest), "{brightest}");
}
