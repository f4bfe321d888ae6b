//! A glTF file in four pictures: by glTF's formula, by the models of a bake, simulated, and the difference of the last two.

use std::collections::BTreeSet;
use std::path::Path;
use std::sync::atomic::{AtomicU64, Ordering};

use glam::{DVec2, DVec3};
use luthier::Bake;
use luthier_gpu::{Backdrop, Camera, Mesh, RenderSettings, Shape};
use luthier_import::GltfPoint;
use luthier_lut::Image;
use luthier_manifest::PlaceValues;
use luthier_report::{Places, Site, Subject, Ways};
use luthier_terminal::{Bar, Failure, Outcome, print};
use rayon::prelude::*;

use crate::cli::{GalleryOptions, ShapeName};
use crate::meshes::judged::{self, formula};
use crate::meshes::scene_file::SceneFile;
use crate::picture::{Format, settings};
use crate::store::store;

/// Paths of a pixel, unless another number is asked for.
const PATHS: u32 = 256;

/// Least cosine of the eye against a normal: others are turned up to it.
const COS_MIN: f64 = 0.02;

/// Largest difference of the picture of differences, whose grey is none.
const SHOWN: f64 = 0.5;

/// Slope parameters that directions are drawn by are not below this: the formulas have no smaller ones.
const ALPHA_MIN: f64 = 1e-3;

/// A place that a sample of a pixel sees.
struct Hit {
    pixel: usize,
    material: usize,
    uv: [f64; 2],
    position: DVec3,
    /// Tangent, bitangent, normal.
    frame: [DVec3; 3],
    /// The direction to the eye, not in the frame.
    to_eye: DVec3,
}

impl Hit {
    /// The frame about a normal that is given in the frame of the surface, and the direction to the eye in it, above the surface.
    fn turned(&self, normal: DVec3) -> ([DVec3; 3], DVec3) {
        let [t, b, n] = self.frame;
        let normal = (normal.x * t + normal.y * b + normal.z * n).normalize();
        let tangent = (t - t.dot(normal) * normal).normalize_or(normal.any_orthonormal_vector());
        let across = normal.cross(tangent);
        let bitangent = if across.dot(b) < 0.0 { -across } else { across };
        let [x, y, z] = [tangent, bitangent, normal].map(|axis| axis.dot(self.to_eye));
        ([tangent, bitangent, normal], DVec3::new(x, y, z.max(COS_MIN)).normalize())
    }
}

/// Writes the sheet.
pub(super) fn write(options: &GalleryOptions, path: &Path, output: &Path) -> Outcome {
    let (sheet, format) = (&options.sheet, Format::of(output)?);
    let look = &sheet.look;
    let refused = [
        ("--mesh", sheet.mesh.is_some()),
        ("--shape", sheet.shape != ShapeName::Sphere),
        ("--grid", !sheet.grid.is_empty()),
        ("--light", !look.light.is_empty()),
        ("--point-light", !look.point_light.is_empty()),
        ("--background", look.background),
        ("--environment-samples", look.environment_samples.is_some()),
        ("--adapter", look.adapter.is_some()),
    ];
    if let Some((name, _)) = refused.iter().find(|(_, is_given)| *is_given) {
        return Err(Failure::Usage(anyhow::anyhow!(
            "leave out {name}: a glTF file has its own shape and materials, and is lit by its surroundings, without an adapter"
        )));
    }
    let (file, mesh, used) = SceneFile::shown(path)?;
    let laid = file.lay(&used, &options.shading)?;
    let package = Bake { targets: Vec::new(), ..Bake::default() }.package(&laid.materials, store()?)?;
    let subject = judged::subject(&package, &laid)?;
    let settings = RenderSettings {
        camera: look.camera.map_or(Shape::Mesh.camera(), |eye| Camera { eye: eye.0, ..Shape::Mesh.camera() }),
        ..settings(look, ShapeName::Sphere, None, sheet.size)?
    };
    let hits = hits(&mesh, &settings);
    let points = points(&file, &hits)?;
    let numbers: Vec<usize> =
        (0..mesh.materials()).map(|n| package.manifest.material_index(&file.name(n)).unwrap_or(0) as usize).collect();
    let paths = options.simulated.unwrap_or(PATHS);
    let samples = settings.samples * settings.samples;
    let lit = lit(&subject, &mesh, &settings, &hits, &points, &numbers, paths.div_ceil(samples))?;
    let names: BTreeSet<&str> =
        used.iter().filter_map(|n| numbers.get(*n).map(|own| package.manifest.materials[*own].model.name())).collect();
    let model = names.into_iter().collect::<Vec<_>>().join(", ");
    let mean = |of: fn(&Ways) -> [f64; 3]| lit.iter().map(|ways| of(ways).iter().sum::<f64>()).sum::<f64>();
    let [of_formula, of_model, of_simulation] =
        [mean(|ways| ways.formula), mean(|ways| ways.model), mean(|ways| ways.simulated)];
    let less = |light: f64| 100.0 * (light / of_simulation.max(f64::MIN_POSITIVE) - 1.0);
    let pictures = pictures(&settings, &hits, &lit, samples);
    let (difference, factor, largest) = difference(&pictures[2], &pictures[1]);
    let [by_formula, by_model, simulated] = pictures;
    let sheet = [
        ("glTF's formula".to_owned(), by_formula),
        (model.clone(), by_model),
        (format!("simulated, {paths} paths"), simulated),
        (format!("simulated - {model}, {factor} x"), difference),
    ];
    format.write(output, luthier_report::sheet(&sheet, options.sheet.columns.unwrap_or(4)), look.tone.into())?;
    print(&format!(
        "light of the whole file against the simulated: glTF's formula {:+.1}%, {model} {:+.1}%\nsimulated less {model}: {factor} times its size about grey; \
         99 of 100 values are within {largest:.4}, noise of {paths} paths included",
        less(of_formula),
        less(of_model)
    ))
}

/// Places that the samples of all pixels see.
fn hits(mesh: &Mesh, settings: &RenderSettings) -> Vec<Hit> {
    let (size, samples) = (settings.size, settings.samples);
    let wide = |v: [f32; 3]| DVec3::from(v.map(f64::from));
    let (eye, target) = (wide(settings.camera.eye), wide(settings.camera.target));
    let forward = (target - eye).normalize();
    let right = forward.cross(DVec3::Y).normalize();
    let [right, up] = [right, right.cross(forward)].map(|v| v * f64::from(settings.camera.half_extent));
    let side = size * samples;
    let sample = |n: u32| -> Option<Hit> {
        let [x, y] = [n % side, n / side];
        let [u, v] = [x, y].map(|i| 2.0 * (f64::from(i) + 0.5) / f64::from(side) - 1.0);
        let ray = (target + u * right - v * up - eye).normalize();
        let meeting = mesh.nearest(eye.as_vec3().to_array(), ray.as_vec3().to_array())?;
        let triangle = mesh.triangles()[meeting.triangle as usize];
        let [b, c] = meeting.weights.map(f64::from);
        let corners = triangle.corners.map(|i| &mesh.vertices()[i as usize]);
        let weights = [1.0 - b - c, b, c];
        let mean = |of: &dyn Fn(usize) -> DVec3| (0..3).map(|i| weights[i] * of(i)).sum::<DVec3>();
        let to_eye = -ray;
        let mut normal = mean(&|i| wide(corners[i].normal)).normalize_or(to_eye);
        if normal.dot(to_eye) < 0.0 {
            normal = -normal;
        }
        let tangent = mean(&|i| {
            let [x, y, z, _] = corners[i].tangent;
            wide([x, y, z])
        });
        let tangent = (tangent - tangent.dot(normal) * normal).normalize_or(normal.any_orthonormal_vector());
        let bitangent = normal.cross(tangent) * if corners[0].tangent[3] < 0.0 { -1.0 } else { 1.0 };
        let frame = [tangent, bitangent, normal];
        let uv = (0..3).map(|i| weights[i] * DVec2::from(corners[i].uv.map(f64::from))).sum::<DVec2>();
        let pixel = (y / samples * size + x / samples) as usize;
        let position = eye + f64::from(meeting.t) * ray;
        Some(Hit { pixel, material: triangle.material as usize, uv: uv.to_array(), position, frame, to_eye })
    };
    (0..side * side).into_par_iter().filter_map(sample).collect()
}

/// The material of each hit as the format means it.
fn points(file: &SceneFile, hits: &[Hit]) -> Outcome<Vec<GltfPoint>> {
    let of = |material: usize| hits.iter().filter(|hit| hit.material == material).map(|hit| hit.uv).collect();
    let found = file.points(&of)?;
    let mut left: Vec<_> = found.into_iter().map(|of| of.points.into_iter()).collect();
    // Parts without a material have that of the format's defaults.
    let none = GltfPoint {
        base_color: [1.0; 3],
        metallic: 1.0,
        alpha: [1.0; 2],
        turn: 0.0,
        f0: [0.04; 3],
        specular: 1.0,
        coat: None,
    };
    Ok(hits.iter().map(|hit| left.get_mut(hit.material).and_then(Iterator::next).unwrap_or(none)).collect())
}

/// The light of every hit in all ways.
fn lit(
    subject: &Subject<'_>,
    mesh: &Mesh,
    settings: &RenderSettings,
    hits: &[Hit],
    points: &[GltfPoint],
    numbers: &[usize],
    count: u32,
) -> Outcome<Vec<Ways>> {
    let varied: Vec<Option<Places>> = numbers.iter().map(|own| Places::of(subject, *own)).collect();
    let (bar, done) = (Bar::new("simulating"), AtomicU64::new(0));
    let ways = hits.par_iter().zip(points).enumerate().map(|(number, (hit, point))| {
        let own = numbers[hit.material];
        let values = varied[hit.material].as_ref().map_or(PlaceValues::NONE, |all| all.at(subject, own, hit.uv));
        let site = Site::new(subject, own, &values).map_err(Failure::input)?;
        let normal = varied[hit.material].as_ref().map_or(DVec3::Z, |all| all.normal_at(subject, own, hit.uv));
        let ([t, b, n], wo) = hit.turned(normal);
        let origin = (hit.position + 1e-3 * hit.frame[2]).as_vec3().to_array();
        let radiance = |wi: DVec3| {
            let direction = wi.x * t + wi.y * b + wi.z * n;
            match mesh.nearest(origin, direction.as_vec3().to_array()) {
                Some(_) => [0.0; 3],
                None => settings.environment.radiance(direction.to_array()),
            }
        };
        let coat = point.coat.map(|[_, alpha]| alpha);
        let alphas: Vec<f64> =
            [Some(point.alpha[1]), coat].into_iter().flatten().map(|alpha| alpha.max(ALPHA_MIN)).collect();
        let ways = site.lit(&formula(point), &alphas, wo, &radiance, count, number as u64);
        let done = done.fetch_add(1, Ordering::Relaxed) + 1;
        if done.is_multiple_of(64) {
            bar.set(done, hits.len() as u64);
        }
        Ok(ways)
    });
    ways.collect()
}

/// The three pictures: formula, model, simulated.
fn pictures(settings: &RenderSettings, hits: &[Hit], lit: &[Ways], samples: u32) -> [Image; 3] {
    let size = settings.size;
    let Backdrop::Plain(backdrop) = settings.backdrop else { unreachable!("--background is refused") };
    let texels = (size * size) as usize;
    let mut seen = vec![0_u32; texels];
    hits.iter().for_each(|hit| seen[hit.pixel] += 1);
    let of: [fn(&Ways) -> [f64; 3]; 3] = [|ways| ways.formula, |ways| ways.model, |ways| ways.simulated];
    of.map(|of| {
        let mut sums = vec![[0.0_f64; 3]; texels];
        for (hit, ways) in hits.iter().zip(lit) {
            let light = of(ways);
            (0..3).for_each(|c| sums[hit.pixel][c] += light[c]);
        }
        let mut image = Image::zeros(size, size, 3);
        let pixels = sums.iter().zip(&seen);
        let values = pixels.flat_map(|(sum, seen)| {
            let behind = f64::from(samples - seen);
            [0, 1, 2].map(|c: usize| {
                let light = sum[c] + behind * f64::from(backdrop[c]);
                f64::from(settings.exposure) * light / f64::from(samples)
            })
        });
        image.data.iter_mut().zip(values).for_each(|(texel, value)| *texel = value as f32);
        image
    })
}

/// The difference of two pictures about grey, brightened by a power of two so that 99 of 100 values that are not alike show; the factor, and the largest of these.
fn difference(a: &Image, b: &Image) -> (Image, f64, f64) {
    let differences: Vec<f64> = a.data.iter().zip(&b.data).map(|(a, b)| f64::from(a - b)).collect();
    let mut sizes: Vec<f64> = differences.iter().map(|d| d.abs()).filter(|d| *d > 0.0).collect();
    sizes.sort_by(f64::total_cmp);
    let largest = sizes.get(sizes.len().saturating_sub(1) * 99 / 100).copied().unwrap_or(0.0);
    let mut factor = 1.0;
    while factor < 1024.0 && 2.0 * factor * largest <= SHOWN {
        factor *= 2.0;
    }
    let mut image = Image::zeros(a.width, a.height, 3);
    image.data.iter_mut().zip(&differences).for_each(|(texel, d)| *texel = (SHOWN + factor * d).clamp(0.0, 1.0) as f32);
    (image, factor, largest)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A normal that leans by .6 towards the tangent sees an eye there by the cosine .6, and the frame stays left-handed where it was.
    #[test]
    fn normals_of_maps_turn_frames() {
        let frame = [DVec3::X, -DVec3::Y, DVec3::Z];
        let hit = Hit { pixel: 0, material: 0, uv: [0.0; 2], position: DVec3::ZERO, frame, to_eye: DVec3::X };
        let (turned, wo) = hit.turned(DVec3::new(0.6, 0.0, 0.8));
        assert!((wo - DVec3::new(0.8, 0.0, 0.6)).length() < 1e-12 && (turned[1] + DVec3::Y).length() < 1e-12, "{wo}");
        let (_, flat) = hit.turned(DVec3::Z);
        assert!(flat.z > 0.0 && (flat.length() - 1.0).abs() < 1e-12);
    }

    /// By hand: a difference of 1/16 is 8 times as large about grey, and equal pictures are grey.
    #[test]
    fn differences_are_shown_about_grey() {
        let image = |values: [f32; 3]| Image { data: values.to_vec(), ..Image::zeros(1, 1, 3) };
        let (shown, factor, largest) = difference(&image([0.5, 0.5, 0.25]), &image([0.4375, 0.5, 0.3125]));
        assert_eq!((factor, largest), (8.0, 0.0625));
        assert_eq!(shown.data, [1.0, 0.5, 0.0]);
        assert_eq!(difference(&image([0.3; 3]), &image([0.3; 3])).0.data, [0.5; 3]);
    }
}
