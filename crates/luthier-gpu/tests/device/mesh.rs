//! Pictures of meshes, against spheres in closed form and pictures of them.

use std::f64::consts::PI;
use std::sync::Arc;

use luthier_gpu::{Backdrop, GpuError, Light, Package, RenderSettings, Scene, Shader, Shape};
use luthier_lut::Image;
use luthier_manifest::{LayerRecord, ShadingModel};
use luthier_mesh::{Mesh, Soup, Triangle, Vertex};
use luthier_shader::{Form, MaterialSet, Target};

use crate::adapter::gpu;
use crate::bake_by_hand::{conductor, diffuse, manifest};
use crate::render::{check, dark, dot, ggx_tables, scene_of, sun, tiled, uniform};

/// A sphere of triangles about the origin: tangents along the parallels and coordinates are those of [`Shape::Sphere`].
fn sphere(rows: u32) -> Soup {
    let mut soup = Soup { has_uv: true, plain: vec![[0.5, 0.4, 0.3]], ..Soup::default() };
    for (row, column) in (0..=rows).flat_map(|row| (0..=2 * rows).map(move |column| (row, column))) {
        let (sin, cos) = (PI * f64::from(row) / f64::from(rows)).sin_cos();
        let (s, c) = (PI * (f64::from(column) / f64::from(rows) - 1.0)).sin_cos();
        let normal = [sin * s, cos, sin * c].map(|v| v as f32);
        let uv = [f64::from(column) / f64::from(2 * rows), f64::from(row) / f64::from(rows)].map(|v| v as f32);
        soup.vertices.push(Vertex { position: normal, normal, tangent: [0.0; 4], uv });
    }
    let columns = 2 * rows + 1;
    for (row, column) in (0..rows).flat_map(|row| (0..2 * rows).map(move |column| (row, column))) {
        let [a, b] = [row * columns + column, (row + 1) * columns + column];
        soup.triangles.extend([[a, b, b + 1], [a, b + 1, a + 1]].map(|corners| Triangle {
            corners,
            part: 0,
            material: 0,
        }));
    }
    soup
}

/// The sphere over a plain floor at this height.
fn over_floor(height: f32) -> Soup {
    let mut soup = sphere(48);
    let first = soup.vertices.len() as u32;
    for [x, z] in [[-2.0, -2.0], [-2.0, 2.0], [2.0, 2.0], [2.0, -2.0]] {
        let (position, normal) = ([x, height, z], [0.0, 1.0, 0.0]);
        soup.vertices.push(Vertex { position, normal, tangent: [0.0; 4], uv: [0.0; 2] });
    }
    soup.triangles.extend([[0, 1, 2], [0, 2, 3]].map(|t| Triangle {
        corners: t.map(|i| first + i),
        part: 1,
        material: 0,
    }));
    soup
}

fn shown(soup: Soup, settings: RenderSettings) -> RenderSettings {
    let mesh = Some(Arc::new(Mesh::new(soup).unwrap()));
    RenderSettings { shape: Shape::Mesh, mesh, ..settings }
}

#[test]
fn a_furnace_and_a_sun_know_no_difference_between_spheres() {
    let Some(scene) = scene_of(vec![vec![diffuse([0.25, 0.5, 1.0], 0.0)]], &[]) else { return };
    let furnace = shown(sphere(96), RenderSettings { environment: uniform(0.8), ..dark() });
    check(&scene.render(&[0], &furnace).unwrap(), 1e-3, |_, _| [0.2, 0.4, 0.8]);
    let to_light = [0.6, 0.48, 0.64];
    let lit = shown(sphere(96), RenderSettings { lights: sun(to_light.map(|v| v as f32), [PI as f32; 3]), ..dark() });
    check(&scene.render(&[0], &lit).unwrap(), 4e-3, |n, _| [0.25, 0.5, 1.0].map(|a| a * dot(n, to_light).max(0.0)));
}

/// Mean absolute difference of two pictures over the mean of the second.
fn apart(a: &Image, b: &Image) -> f64 {
    let sum = |values: &mut dyn Iterator<Item = f32>| values.map(f64::from).sum::<f64>();
    sum(&mut a.data.iter().zip(&b.data).map(|(a, b)| (a - b).abs())) / sum(&mut b.data.iter().copied())
}

/// A scene of one material by the model `microfacet`, computed in full.
fn microfacet(layer: LayerRecord) -> Option<Scene> {
    let mut manifest = manifest(vec![vec![layer]], &[]);
    manifest.materials[0].model = ShadingModel::Microfacet;
    let set = MaterialSet::from_manifest(&manifest);
    let wgsl = luthier_shader::emit(&set, Form::Full, Target::Wgsl).unwrap();
    manifest.bindings = luthier_shader::bindings(&set, Form::Full);
    let package = Package::from_parts(manifest, Vec::new(), vec![Shader::wgsl(Form::Full, wgsl)]).unwrap();
    Some(gpu()?.scene(&package, Form::Full).unwrap())
}

/// Highlights of an anisotropic metal lie where tangents put them: those of the sphere in closed form.
#[test]
fn tangents_are_those_of_the_sphere() {
    let metal = LayerRecord { alpha_xy: [0.12, 0.5], ..conductor(0.25, [0.1; 3], [9.0; 3]) };
    let Some(scene) = microfacet(metal) else { return };
    let lights = sun([0.3, 0.5, 0.8], [1.0; 3]);
    let settings =
        || RenderSettings { samples: 2, environment_samples: 1, lights: lights.clone(), backdrop: NONE, ..dark() };
    let closed = scene.render(&[0], &settings()).unwrap();
    let meshed = scene.render(&[0], &shown(sphere(64), settings())).unwrap();
    let found = apart(&meshed, &closed);
    assert!(found < 0.02, "{found}");
    // Turned by a right angle they would not be.
    let mut turned = sphere(64);
    turned.vertices.iter_mut().for_each(|vertex| vertex.uv = [vertex.uv[1], vertex.uv[0]]);
    let turned = apart(&scene.render(&[0], &shown(turned, settings())).unwrap(), &closed);
    assert!(turned > 0.2, "{turned}");
}

const NONE: Backdrop = Backdrop::Plain([0.0; 3]);

/// Every pixel of a floor is lit or in the shadow of the sphere as a ray from it to the light says, in closed form.
#[test]
fn a_sphere_casts_its_shadow() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let to_light = [-0.48, 0.64, 0.6];
    let lights = sun(to_light.map(|v| v as f32), [PI as f32; 3]);
    let settings = RenderSettings {
        lights,
        backdrop: Backdrop::Plain([0.0; 3]),
        size: 96,
        camera: Shape::Mesh.camera(),
        ..dark()
    };
    let settings = RenderSettings { camera: luthier_gpu::Camera { half_extent: 2.2, ..settings.camera }, ..settings };
    for environment_samples in [0, 2] {
        let settings = shown(over_floor(-1.0), RenderSettings { environment_samples, ..settings.clone() });
        let image = scene.render(&[0], &settings).unwrap();
        let eye = settings.camera.eye.map(f64::from);
        let distance = dot(eye, eye).sqrt();
        let (sin, cos) = (eye[1] / distance, eye[2] / distance);
        let (mut lit, mut dark, mut wrong) = (0, 0, 0);
        for (y, x) in (0..96).flat_map(|y| (0..96).map(move |x| (y, x))) {
            let at = |i: u32| (2.0 * (f64::from(i) + 0.5) / 96.0 - 1.0) * 2.2;
            let (across, up) = (at(x), -at(y));
            let through = [across, up * cos, -up * sin];
            let ray = [0, 1, 2].map(|c| through[c] - eye[c]);
            let t = (-1.0 - eye[1]) / ray[1];
            let floor = [0, 1, 2].map(|c| eye[c] + t * ray[c]);
            // Squared distances of rays from the centre of the sphere.
            let passes = |from: [f64; 3], along: [f64; 3]| {
                let b = dot(from, along) / dot(along, along).sqrt();
                (dot(from, from) - b * b, b < 0.0)
            };
            let seen = passes(eye, ray).0;
            let (shade, towards) = passes(floor, to_light);
            if seen < 1.02 || floor[0].abs().max(floor[2].abs()) > 1.95 || (0.94..1.04).contains(&shade) {
                continue;
            }
            let is_dark = shade < 1.0 && towards;
            let expected = if is_dark { [0.0; 3] } else { [0.5, 0.4, 0.3].map(|a| a * to_light[1]) };
            let found = image.texel(x, y);
            let is_right = (0..3).all(|c| (f64::from(found[c]) - expected[c]).abs() < 2e-3);
            (lit, dark, wrong) = (lit + u32::from(!is_dark), dark + u32::from(is_dark), wrong + u32::from(!is_right));
        }
        assert!(lit > 800 && dark > 150 && wrong == 0, "{lit} lit, {dark} dark, {wrong} wrong, {environment_samples}");
    }
}

/// A sun behind the sphere, as a place on the floor sees it, is hidden; a lamp in the same direction before the sphere is not.
#[test]
fn lights_are_hidden_by_what_is_nearer_alone() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let at_floor = |light| {
        let camera = luthier_gpu::Camera { eye: [0.0, 5.0, 5.0], target: [0.0, -1.0, 1.0], half_extent: 0.01 };
        let settings = RenderSettings { lights: vec![light], camera, size: 2, ..dark() };
        f64::from(scene.render(&[0], &shown(over_floor(-1.0), settings)).unwrap().texel(0, 0)[0])
    };
    let towards = [0.0, 0.4, -0.15];
    assert_eq!(at_floor(Light::Directional { direction: towards, irradiance: [1.0; 3] }), 0.0);
    let lit = at_floor(Light::Point { position: [0.0, -0.6, 0.85], intensity: [1.0; 3] });
    // Albedo 0.5 over pi, the cosine, the squared distance.
    let distance_sq = 0.4f64 * 0.4 + 0.15 * 0.15;
    let expected = 0.5 / PI * 0.4 / distance_sq.sqrt() / distance_sq;
    assert!((lit / expected - 1.0).abs() < 0.03, "{lit} {expected}");
}

/// The shadow of a sphere is that of any material, not that of the first one alone.
#[test]
fn parts_of_every_material_cast_shadows() {
    let Some(scene) = scene_of(vec![vec![diffuse([1.0; 3], 0.0)]], &[]) else { return };
    let picture = |material: u32| {
        let mut soup = over_floor(-1.0);
        soup.triangles.iter_mut().for_each(|triangle| triangle.material = material);
        let lights = sun([-0.48, 0.64, 0.6], [1.0; 3]);
        let settings = RenderSettings { lights, size: 32, camera: Shape::Mesh.camera(), ..dark() };
        scene.render(&vec![0; material as usize + 1], &shown(soup, settings)).unwrap().data
    };
    assert!(picture(1) == picture(0));
}

#[test]
fn what_needs_coordinates_is_refused_without_them() {
    let metal = |alpha_xy| vec![tiled(LayerRecord { alpha_xy, ..conductor(0.25, [0.1; 3], [9.0; 3]) }, Some(0))];
    let Some(scene) = scene_of(vec![metal([0.1, 0.3]), metal([0.25; 2])], &ggx_tables(1.0, 1.0)) else { return };
    let settings = shown(Soup { has_uv: false, ..sphere(8) }, RenderSettings { size: 8, ..dark() });
    let refused = scene.render(&[0], &settings).unwrap_err();
    assert!(
        matches!(&refused, GpuError::NoTextureCoordinates { material, .. } if material == "m0-material"),
        "{refused}"
    );
    assert!(refused.to_string().contains("anisotropic"));
    scene.render(&[1], &settings).unwrap();
    let none = RenderSettings { mesh: None, ..settings };
    assert!(matches!(scene.render(&[1], &none), Err(GpuError::Setting { name: "mesh", .. })));
}
