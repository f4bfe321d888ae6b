//! Pictures whose pixels are known in closed form.

use std::sync::{Arc, OnceLock};

use luthier_gpu::{Backdrop, Blur, Environment, GpuError, Light, Package, RenderSettings, Scene, Shape, Sky};
use luthier_lut::{AtlasLayout, Image, Mapping, TableKind, TexelFormat};
use luthier_manifest::LayerRecord;
use luthier_shader::Form;

use crate::adapter::gpu;
use crate::bake_by_hand::{Table, artefacts, axis, conductor, dielectric, diffuse, row_layout, square_layout};

pub(crate) const SIZE: u32 = 65;

/// The camera of the sphere: distance of the eye and half the picture's side, in radii.
const EYE: f64 = 7.0;
const HALF_EXTENT: f64 = 1.22;

pub(crate) fn uniform(radiance: f32) -> Arc<Environment> {
    Arc::new(Environment::sky(&Sky::uniform([radiance; 3])).unwrap())
}

/// Blurring takes a while, and one dark environment is like another.
static DARK: OnceLock<Arc<Environment>> = OnceLock::new();

pub(crate) fn dark() -> RenderSettings {
    RenderSettings {
        size: SIZE,
        samples: 1,
        lights: Vec::new(),
        light_angular_radius: 0.0,
        environment: DARK.get_or_init(|| uniform(0.0)).clone(),
        ..RenderSettings::new(Shape::Sphere).unwrap()
    }
}

pub(crate) fn sun(direction: [f32; 3], irradiance: [f32; 3]) -> Vec<Light> {
    vec![Light::Directional { direction, irradiance }]
}

/// Constant tables: reflectance `fresnel`, albedo `fgd`.
pub(crate) fn tables(fresnel: f32, fgd: f32) -> Vec<Table> {
    vec![
        Table::new(TableKind::Fresnel, row_layout(), TexelFormat::Rgba16Float, |_, _| [fresnel; 4]),
        Table::new(TableKind::Distribution, square_layout("theta_h"), TexelFormat::R16Float, |_, _| [1.0; 4]),
        Table::new(TableKind::Fgd, square_layout("cos_theta"), TexelFormat::Rgba16Float, |_, _| [fgd; 4]),
    ]
}

/// The tables of [`tables`] with pi alpha^2 D of GGX.
pub(crate) fn ggx_tables(fresnel: f32, fgd: f32) -> Vec<Table> {
    let mut plain = tables(fresnel, fgd);
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
    plain
}

pub(crate) fn tiled(layer: LayerRecord, fgd: Option<u32>) -> LayerRecord {
    LayerRecord {
        tiles: layer.tiles.with([
            (TableKind::Fresnel, Some(0)),
            (TableKind::Distribution, Some(0)),
            (TableKind::Fgd, fgd),
        ]),
        ..layer
    }
}

/// Normal of the ball under the centre of a pixel, and the direction to the eye; `None` beside the ball.
pub(crate) fn hit(x: u32, y: u32) -> Option<([f64; 3], [f64; 3])> {
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

pub(crate) fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// Holds every pixel on the ball against a function of normal and direction to the eye.
pub(crate) fn check(image: &Image, tolerance: f64, expected: impl Fn([f64; 3], [f64; 3]) -> [f64; 3]) {
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

pub(crate) fn scene_of(materials: Vec<Vec<LayerRecord>>, tables: &[Table]) -> Option<Scene> {
    let artefacts: Package = artefacts(Form::Baked, materials, tables);
    Some(gpu()?.scene(&artefacts, Form::Baked).unwrap())
}

#[test]
fn a_white_furnace_shows_nothing_but_albedo() {
    let mirror = |alpha, fgd| vec![tiled(conductor(alpha, [0.1; 3], [9.0; 3]), fgd)];
    let coated = vec![tiled(dielectric(0.1, 1.5), None), diffuse([0.5; 3], 0.0)];
    let materials = vec![mirror(0.01, None), mirror(0.9, Some(0)), coated, vec![diffuse([0.25, 0.5, 1.0], 0.0)]];
    let Some(scene) = scene_of(materials, &tables(0.25, 0.75)) else { return };
    let furnace = RenderSettings { environment: uniform(0.8), ..dark() };
    let render = |material| scene.render(&[material], &furnace).unwrap();
    check(&render(0), 1e-3, |_, _| [0.8 * 0.25; 3]);
    check(&render(1), 1e-3, |_, _| [0.8 * 0.75; 3]);
    // A quarter at the coat; three quarters in, half back, three quarters out.
    check(&render(2), 1e-3, |_, _| [0.8 * (0.25 + 0.75 * 0.5 * 0.75); 3]);
    check(&render(3), 1e-5, |_, _| [0.2, 0.4, 0.8]);
}

/// The albedo is that of the table at the cosine to the eye; f16 texels.
#[test]
fn a_white_furnace_shows_the_albedo_table() {
    let mut tables = tables(0.25, 0.0);
    let layout = tables[2].layout.clone();
    tables[2] = Table::new(TableKind::Fgd, layout, TexelFormat::Rgba16Float, |_, [cos, alpha]| {
        [(0.2 + 0.3 * cos + 0.1 * alpha) as f32; 4]
    });
    let metal = vec![tiled(conductor(0.4, [0.1; 3], [9.0; 3]), Some(0))];
    let Some(scene) = scene_of(vec![metal], &tables) else { return };
    let furnace = RenderSettings { environment: uniform(1.0), ..dark() };
    check(&scene.render(&[0], &furnace).unwrap(), 1e-3, |n, wo| [0.2 + 0.3 * dot(n, wo) + 0.1 * 0.4; 3]);
}

#[test]
fn absorption_follows_the_refracted_directions() {
    let coat = LayerRecord { optical_depth: [0.5, 0.0, 2.0], ..tiled(dielectric(0.1, 1.5), None) };
    let Some(scene) = scene_of(vec![vec![coat, diffuse([1.0; 3], 0.0)]], &tables(0.0, 0.0)) else { return };
    let furnace = RenderSettings { environment: uniform(1.0), ..dark() };
    let path = |cos: f64| 1.0 / (1.0 - (1.0 - cos * cos) / 2.25).sqrt();
    check(&scene.render(&[0], &furnace).unwrap(), 1e-4, |n, wo| {
        [0.5, 0.0, 2.0].map(|depth: f64| (-depth * (path(dot(n, wo)) + path(2.0 / 3.0))).exp())
    });
}

#[test]
fn a_lambertian_ball_follows_the_cosine() {
    let Some(scene) = scene_of(vec![vec![diffuse([0.2, 0.5, 0.9], 0.0)]], &[]) else { return };
    let settings = RenderSettings { lights: sun([3.0, 4.0, 12.0], [2.0, 3.0, 4.0]), exposure: 0.5, ..dark() };
    check(&scene.render(&[0], &settings).unwrap(), 1e-5, |n, _| {
        let cos = dot(n, [3.0 / 13.0, 4.0 / 13.0, 12.0 / 13.0]).max(0.0);
        [0.2 * 2.0, 0.5 * 3.0, 0.9 * 4.0].map(|v| 0.5 * v * cos / std::f64::consts::PI)
    });
}

/// A point light is a directional one that turns and fades from place to place.
#[test]
fn point_lights_fall_with_the_square_of_the_distance() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let position = [1.0, 2.0, 2.0];
    let lights = vec![Light::Point { position: position.map(|v: f64| v as f32), intensity: [8.0; 3] }];
    check(&scene.render(&[0], &RenderSettings { lights, ..dark() }).unwrap(), 1e-5, |n, _| {
        let to_light = [0, 1, 2].map(|c| position[c] - n[c]);
        let distance_sq = dot(to_light, to_light);
        [8.0 * (dot(n, to_light) / distance_sq.sqrt()).max(0.0) / distance_sq / std::f64::consts::PI; 3]
    });
}

/// Mirrors show the environment, blurred as the host blurs it; a white base shows its irradiance.
#[test]
fn the_environment_on_the_device_is_that_of_the_host() {
    let materials = |alpha| vec![tiled(conductor(alpha, [0.1; 3], [9.0; 3]), None)];
    let base = vec![diffuse([1.0; 3], 0.0)];
    let alphas = [1e-7, 0.01, 0.2, 1.0];
    let all = alphas.map(materials).into_iter().chain([base]).collect();
    let Some(scene) = scene_of(all, &tables(1.0, 1.0)) else { return };
    let environment = Arc::new(Environment::sky(&Sky::default()).unwrap());
    let settings = RenderSettings { environment: environment.clone(), ..dark() };
    for (i, alpha) in alphas.into_iter().enumerate() {
        check(&scene.render(&[i as u32], &settings).unwrap(), 3e-4, |n, wo| {
            let cos = dot(n, wo);
            environment.mirrored(Blur::Ggx, alpha, [0, 1, 2].map(|c| 2.0 * cos * n[c] - wo[c]))
        });
    }
    check(&scene.render(&[4], &settings).unwrap(), 3e-4, |n, _| environment.diffuse(n));
}

/// A highlight of the smoothest surface is there, finite, and carries the same energy for any size of the light that
/// the pixels resolve.
#[test]
fn a_highlight_keeps_its_energy() {
    let plain = ggx_tables(1.0, 1.0);
    let Some(scene) = scene_of(vec![vec![tiled(conductor(1e-3, [0.1; 3], [9.0; 3]), None)]], &plain) else { return };
    let energy = |radius: f32| {
        let settings = RenderSettings {
            samples: 4,
            lights: sun([0.2, 0.3, 1.0], [1.0; 3]),
            light_angular_radius: radius,
            backdrop: Backdrop::Plain([0.0; 3]),
            ..dark()
        };
        let image = scene.render(&[0], &settings).unwrap();
        assert!(image.data.iter().all(|v| v.is_finite() && *v >= 0.0));
        image.data.iter().map(|v| f64::from(*v)).sum::<f64>()
    };
    let (narrow, wide) = (energy(0.05), energy(0.1));
    assert!(narrow > 0.0 && (wide / narrow - 1.0).abs() < 0.05, "{narrow} {wide}");
}

#[test]
fn pixels_beside_the_shape_are_backdrop() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let settings = RenderSettings { backdrop: Backdrop::Plain([0.3, 0.2, 0.1]), samples: 2, ..dark() };
    let image = scene.render(&[0], &settings).unwrap();
    for (x, y) in [(0, 0), (SIZE - 1, 0), (0, SIZE - 1), (SIZE - 1, SIZE - 1)] {
        let [r, g, b] = image.texel(x, y) else { panic!("three channels") };
        assert!(*r > 0.05 && *r < 0.3 && (g / r - 2.0 / 3.0).abs() < 1e-5 && (b / r - 1.0 / 3.0).abs() < 1e-5);
    }
}

/// The middle of the map lies behind the shape, its right half on the right.
#[test]
fn the_environment_can_be_seen_behind() {
    let Some(scene) = scene_of(vec![vec![diffuse([0.0; 3], 0.0)]], &[]) else { return };
    let mut map = Image::zeros(64, 32, 3);
    for y in 0..32 {
        for x in 0..64 {
            map.texel_mut(x, y).copy_from_slice(&[x as f32, y as f32, 1.0]);
        }
    }
    let environment = Arc::new(Environment::new(map).unwrap());
    let settings = RenderSettings { backdrop: Backdrop::Environment, environment: environment.clone(), ..dark() };
    let image = scene.render(&[0], &settings).unwrap();
    let coordinate = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(SIZE) - 1.0) * HALF_EXTENT;
    for (x, y) in [(0, 0), (SIZE - 1, 0), (0, SIZE - 1), (SIZE - 1, SIZE - 1)] {
        let ray = [coordinate(x), -coordinate(y), -EYE];
        let length = dot(ray, ray).sqrt();
        let expected = environment.radiance(ray.map(|v| v / length));
        for (got, expected) in image.texel(x, y).iter().zip(expected) {
            assert!((f64::from(*got) - expected).abs() < 1e-2, "{x} {y}: {:?} {expected}", image.texel(x, y));
        }
    }
    assert!(image.texel(SIZE - 1, 0)[0] > 32.0 && image.texel(0, 0)[0] < 32.0);
}

/// A white Lambertian surface in a furnace is as bright as the furnace wherever it is hit, and the share of pixels that hit
/// follows from the geometry: roots of the torus' quartic along the ray, found by its sign on 4000 points; the square's
/// projection.
#[test]
fn torus_and_plane_cover_what_they_should() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    for shape in [Shape::Torus, Shape::Plane] {
        let settings = RenderSettings { environment: uniform(1.0), backdrop: Backdrop::Plain([0.0; 3]), ..dark() };
        let settings = RenderSettings { shape, camera: shape.camera(), ..settings };
        let image = scene.render(&[0], &settings).unwrap();
        let inside = |p: [f64; 3]| match shape {
            Shape::Torus => ((p[0] * p[0] + p[2] * p[2]).sqrt() - 0.72).hypot(p[1]) < 0.3,
            _ => p[1] < 0.0,
        };
        let eye = settings.camera.eye.map(f64::from);
        let half = f64::from(settings.camera.half_extent);
        let distance = dot(eye, eye).sqrt();
        let (sin, cos) = (eye[1] / distance, eye[2] / distance);
        let (mut wrong, mut hits) = (0, 0);
        for y in 0..SIZE {
            for x in 0..SIZE {
                let at = |i: u32| (2.0 * (f64::from(i) + 0.5) / f64::from(SIZE) - 1.0) * half;
                let (across, up) = (at(x), -at(y));
                let through = [across, up * cos, -up * sin];
                let ray = [0, 1, 2].map(|c| through[c] - eye[c]);
                let point = |t: f64| [0, 1, 2].map(|c| eye[c] + t * ray[c]);
                let entry = (0..4000).map(|i| point(0.8 + 0.4 * f64::from(i) / 4000.0)).find(|p| inside(*p));
                let expected = entry.is_some_and(|p| shape == Shape::Torus || p[0].abs().max(p[2].abs()) < 1.0);
                hits += u32::from(expected);
                let [r, _, _] = image.texel(x, y) else { panic!("three channels") };
                assert!(*r == 0.0 || (*r - 1.0).abs() < 1e-5, "{shape:?} {x} {y}: {r}");
                wrong += u32::from((*r > 0.5) != expected);
            }
        }
        // Grazing rays and edges that pass a pixel's centre within the step of the search.
        assert!(hits > 800 && wrong < hits / 100, "{shape:?}: {wrong} of {hits}");
    }
}

#[test]
fn each_sphere_of_the_grid_has_its_material() {
    let shades = |i: usize| 0.2 + 0.03 * i as f64;
    let materials = (0..25).map(|i| vec![diffuse([shades(i), 0.5, 1.0], 0.0)]).collect();
    let Some(scene) = scene_of(materials, &[]) else { return };
    let settings = RenderSettings { environment: uniform(1.0), backdrop: Backdrop::Plain([0.0; 3]), ..dark() };
    let settings = RenderSettings { shape: Shape::Grid, camera: Shape::Grid.camera(), size: 100, ..settings };
    let image = scene.render(&(0..25).collect::<Vec<_>>(), &settings).unwrap();
    for i in 0..25_u32 {
        // Centres are 1.05 apart in a picture 5.5 wide.
        let place = |cell: i32| ((0.5 + f64::from(cell) * 1.05 / 5.5) * 100.0) as u32;
        let (column, row) = ((i % 5) as i32 - 2, (i / 5) as i32 - 2);
        let [r, g, b] = image.texel(place(column), place(row)) else { panic!("three channels") };
        let expected = shades(i as usize) as f32;
        assert!((r - expected).abs() < 1e-4 && (g - 0.5).abs() < 1e-4 && (b - 1.0).abs() < 1e-4, "{i}: {r} {expected}");
    }
    assert!(matches!(scene.render(&[0], &settings), Err(GpuError::Setting { name: "materials", .. })));
}

#[test]
fn settings_out_of_range_are_errors() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let refused = |settings: RenderSettings| matches!(scene.render(&[0], &settings), Err(GpuError::Setting { .. }));
    assert!(refused(RenderSettings { size: 0, ..dark() }));
    assert!(refused(RenderSettings { size: 100_000, ..dark() }));
    assert!(refused(RenderSettings { samples: 0, ..dark() }));
    assert!(refused(RenderSettings { environment_samples: 5000, ..dark() }));
    assert!(refused(RenderSettings { lights: sun([0.0; 3], [1.0; 3]), ..dark() }));
    assert!(refused(RenderSettings { lights: sun([1.0; 3], [-1.0; 3]), ..dark() }));
    assert!(refused(RenderSettings { light_angular_radius: f32::NAN, ..dark() }));
    assert!(refused(RenderSettings { exposure: f32::INFINITY, ..dark() }));
    let mut above = dark();
    above.camera.eye = [0.0, 3.0, 0.0];
    assert!(refused(above));
    assert!(matches!(scene.render(&[9], &dark()), Err(GpuError::NoMaterial { material: 9, .. })));
    let Some(gpu) = gpu() else { return };
    let full = gpu.scene(&artefacts(Form::Full, vec![vec![diffuse([1.0; 3], 0.0)]], &[]), Form::Full).unwrap();
    assert!(matches!(full.render(&[0], &dark()), Err(GpuError::Prefiltered { .. })));
    let sampled = RenderSettings { environment: uniform(1.0), environment_samples: 4, ..dark() };
    check(&full.render(&[0], &sampled).unwrap(), 1e-5, |_, _| [1.0; 3]);
}

/// A white ball is exposed just below one, as the documentation of the exposure promises.
#[test]
fn a_white_ball_is_exposed_just_below_one() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let settings = RenderSettings { samples: 1, ..RenderSettings::new(Shape::Sphere).unwrap() };
    let image = scene.render(&[0], &settings).unwrap();
    let brightest = image.data.iter().copied().fold(0.0, f32::max);
    assert!((0.9..1.0).contains(&brightest), "{brightest}");
}

/// Passes are counted before each of them, and short ones add up to the same picture.
#[test]
fn whoever_watches_is_told_of_every_pass() {
    let metal = tiled(conductor(0.2, [0.1; 3], [9.0; 3]), None);
    let Some(scene) = scene_of(vec![vec![metal]], &ggx_tables(0.1, 0.1)) else { return };
    // More evaluations than any adapter makes in a pass.
    let settings = RenderSettings { size: 64, samples: 4, environment_samples: 512, ..dark() };
    let settings = RenderSettings { environment: uniform(0.5), ..settings };
    let told = std::cell::RefCell::new(Vec::new());
    let tell = |done: usize, count: usize| {
        told.borrow_mut().push((done, count));
        true
    };
    let parts = [luthier_gpu::Shown::Material(0)];
    let watched = scene.render_watched(&parts, &settings, &tell).unwrap().unwrap();
    let told = told.into_inner();
    assert!(told.len() > 1 && told.iter().enumerate().all(|(i, pass)| *pass == (i, told.len())), "{told:?}");
    assert_eq!(watched, scene.render_shown(&parts, &settings).unwrap());
    let stopped = scene.render_watched(&parts, &settings, &|done, _| done < 1).unwrap();
    assert!(stopped.is_none());
}
