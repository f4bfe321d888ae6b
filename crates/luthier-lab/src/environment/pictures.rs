//! Light of places in pictures, and as sums over all texels of the surroundings.

use std::f64::consts::PI;
use std::sync::Arc;

use glam::DVec3;
use luthier::{Bake, MemoryStore, lit};
use luthier_environment::Environment;
use luthier_gpu::{Camera, Gpu, RenderSettings, Scene, Shape};
use luthier_manifest::{Form, ShadingModel};
use luthier_material::Material;
use luthier_terminal::Outcome;

/// Half the side of the square that a pixel sees. It is so small that a pixel shows one place.
const HALF_EXTENT: f32 = 1e-4;

/// A place on the ball: normal, direction to the eye.
pub(super) struct Point {
    normal: DVec3,
    wo: DVec3,
}

impl Point {
    /// Angle between normal and eye.
    pub(super) fn theta_deg(&self) -> f64 {
        libm::acos(self.normal.dot(self.wo).clamp(-1.0, 1.0)).to_degrees()
    }
}

/// Places under the middles of the pixels of a square picture of `size` pixels a side.
pub(super) fn points(size: u32) -> Vec<Point> {
    let camera = Shape::Sphere.camera();
    let (eye, half) = (f64::from(camera.eye[2]), f64::from(camera.half_extent));
    let mut points = Vec::new();
    for [x, y] in (0..size).flat_map(|y| (0..size).map(move |x| [x, y])) {
        let [x, y] = [x, y].map(|i| (2.0 * (f64::from(i) + 0.5) / f64::from(size) - 1.0) * half);
        let ray = DVec3::new(x, -y, -eye).normalize();
        let b = eye * ray.z;
        let discriminant = b * b - (eye * eye - 1.0);
        // Away from the silhouette, where f32 and f64 may disagree on a hit.
        if discriminant > 1e-3 {
            let t = -b - discriminant.sqrt();
            points.push(Point { normal: t * ray + eye * DVec3::Z, wo: -ray });
        }
    }
    points
}

/// A texel: its direction, and radiance times solid angle in each sky.
pub(super) type Texel = (DVec3, Vec<[f64; 3]>);

/// The texels of maps of one size.
pub(super) fn texels(skies: &[Arc<Environment>]) -> Vec<Texel> {
    let map = skies[0].map();
    let (width, height) = (map.width, map.height);
    let mut texels = Vec::new();
    for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
        let [above, below] = [y, y + 1].map(|y| libm::cos(PI * f64::from(y) / f64::from(height)));
        let solid_angle = 2.0 * PI / f64::from(width) * (above - below);
        let (sin_theta, cos_theta) = libm::sincos(PI * (f64::from(y) + 0.5) / f64::from(height));
        let (sin_phi, cos_phi) = libm::sincos(2.0 * PI * ((f64::from(x) + 0.5) / f64::from(width) - 0.5));
        let lights = skies.iter().map(|sky| {
            let texel = sky.map().texel(x, y);
            [0, 1, 2].map(|c| solid_angle * f64::from(texel[c]))
        });
        let direction = DVec3::new(sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi);
        texels.push((direction, lights.collect()));
    }
    texels
}

/// Radiance of all places in pictures, with the default samples of a pixel and with one.
pub(super) struct Shown {
    pub(super) of_all: Vec<[f64; 3]>,
    pub(super) of_one: Vec<[f64; 3]>,
}

impl Shown {
    pub(super) fn new(scene: &Scene, points: &[Point], sky: &Arc<Environment>) -> Outcome<Self> {
        let environment = Arc::clone(sky);
        let settings =
            RenderSettings { size: 1, lights: Vec::new(), environment, ..RenderSettings::new(Shape::Sphere)? };
        let of_one = colors(scene, points, &RenderSettings { samples: 1, ..settings.clone() })?;
        Ok(Self { of_all: colors(scene, points, &settings)?, of_one })
    }
}

/// Radiance of all places under each sky, in pictures and as a sum over all texels.
pub(super) struct Pictures {
    pub(super) alpha: f64,
    pub(super) shown: Vec<Shown>,
    pub(super) summed: Vec<Vec<[f64; 3]>>,
}

impl Pictures {
    pub(super) fn new(
        gpu: &Gpu,
        material: &Material,
        model: ShadingModel,
        points: &[Point],
        skies: &[Arc<Environment>],
        texels: &[Texel],
    ) -> Outcome<Self> {
        let mut shaded = material.clone();
        shaded.bake.model = Some(model);
        let package = Bake::lit().package(&lit(&[shaded]), &MemoryStore::default())?;
        let scene = gpu.scene(&package, Form::Baked)?;
        let shown = skies.iter().map(|sky| Shown::new(&scene, points, sky)).collect::<Outcome<_>>()?;
        let mut summed = vec![Vec::new(); skies.len()];
        for point in points {
            let sums = sums(&scene, point, texels, skies.len())?;
            summed.iter_mut().zip(sums).for_each(|(all, sum)| all.push(sum));
        }
        let alpha = package.manifest.materials[0].layers.first().map_or(0.0, |layer| layer.alpha);
        Ok(Self { alpha, shown, summed })
    }
}

/// Colours of points, each rendered as a picture of one pixel.
fn colors(scene: &Scene, points: &[Point], settings: &RenderSettings) -> Outcome<Vec<[f64; 3]>> {
    let colors = points.iter().map(|point| {
        let target = point.normal.as_vec3().to_array();
        let camera = Camera { target, half_extent: HALF_EXTENT, ..settings.camera };
        let image = scene.render(&[0], &RenderSettings { camera, ..settings.clone() })?;
        Ok([0, 1, 2].map(|c| f64::from(image.texel(0, 0)[c])))
    });
    colors.collect()
}

fn local(frame: [DVec3; 3], direction: DVec3) -> [f32; 3] {
    frame.map(|axis| direction.dot(axis) as f32)
}

/// The sum over the texels above the horizon of a place, in each sky.
fn sums(scene: &Scene, point: &Point, texels: &[Texel], skies: usize) -> Outcome<Vec<[f64; 3]>> {
    let n = point.normal;
    let t = if n.y.abs() < 0.9 { DVec3::Y } else { DVec3::X }.cross(n).normalize();
    let frame = [t, n.cross(t), n];
    let wo = local(frame, point.wo);
    let above: Vec<&Texel> = texels.iter().filter(|(direction, _)| direction.dot(n) > 0.0).collect();
    let pairs: Vec<([f32; 3], [f32; 3])> = above.iter().map(|(direction, _)| (local(frame, *direction), wo)).collect();
    let mut sums = vec![[0.0; 3]; skies];
    for ((_, light), value) in above.iter().zip(scene.evaluate(0, &pairs)?) {
        for (sum, light) in sums.iter_mut().zip(light) {
            (0..3).for_each(|c| sum[c] += light[c] * f64::from(value[c]));
        }
    }
    Ok(sums)
}

pub(super) fn mean(values: &[[f64; 3]]) -> f64 {
    values.iter().flatten().sum::<f64>() / (3 * values.len()) as f64
}

/// Root of the mean squared difference over the mean.
pub(super) fn error(values: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let squares: f64 = values.iter().flatten().zip(truth.iter().flatten()).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / (3 * truth.len()) as f64).sqrt() / mean(truth)
}
