//! `environment`: pictures under detailed surroundings, against sums over every texel of these.

use std::f64::consts::PI;
use std::fmt::Write as _;
use std::sync::Arc;

use glam::DVec3;
use luthier::{Bake, MemoryStore, lit, read_materials};
use luthier_environment::{Environment, Scenery};
use luthier_gpu::{Camera, Gpu, RenderSettings, Scene, Shape};
use luthier_manifest::{Form, FunctionGroup, ShadingModel};
use luthier_material::Material;
use luthier_terminal::{Bar, Failure, Outcome, deliver, open, valid};

use crate::cli::{EnvironmentOptions, call};

/// Models that are measured in addition to `lobes`.
const PAPERS: [ShadingModel; 2] = [ShadingModel::Elek, ShadingModel::Belcour];

/// Groups of functions with ever more reads for each lobe; the last is the default.
const STEPS: [FunctionGroup; 6] = [
    FunctionGroup::Environment1,
    FunctionGroup::Environment2,
    FunctionGroup::Environment4,
    FunctionGroup::Environment8,
    FunctionGroup::Environment16,
    FunctionGroup::Environment,
];

/// Half the side of the square that a pixel sees. It is so small that a pixel shows one place.
const HALF_EXTENT: f32 = 1e-4;

/// Surroundings that are measured: the hardest.
const SKIES: [Scenery; 3] = [Scenery::CloudySun, Scenery::StripStudio, Scenery::NightStreet];

/// Compares pictures of materials.
pub(crate) fn run(options: &EnvironmentOptions) -> Outcome {
    let gpu = open(options.adapter.name.as_deref())?;
    let materials = valid(read_materials(&options.sources.paths)?, false)?;
    let skies: Vec<Arc<Environment>> = SKIES
        .into_iter()
        .map(|scenery| scenery.environment(options.rows).map(Arc::new))
        .collect::<Result<_, _>>()
        .map_err(Failure::input)?;
    let points = points(options.size);
    let texels = texels(&skies);
    let bar = Bar::new("materials");
    let (mut rows, mut steps) = (Vec::new(), Vec::new());
    for (i, material) in materials.iter().enumerate() {
        let lobes = Pictures::new(&gpu, material, ShadingModel::Lobes, &points, &skies, &texels)?;
        let papers: Vec<Pictures> = PAPERS
            .iter()
            .map(|model| Pictures::new(&gpu, material, *model, &points, &skies, &texels))
            .collect::<Outcome<_>>()?;
        for (sky, scenery) in SKIES.into_iter().enumerate() {
            let truth = &lobes.summed[sky];
            let mut row = format!(
                "| {} | {:.3} | {} | {:.3} | {:.4} | {:.4} |",
                material.name,
                lobes.alpha,
                scenery.name(),
                mean(truth),
                error(&lobes.shown[sky].of_all, truth),
                error(&lobes.shown[sky].of_one, truth)
            );
            for paper in &papers {
                let shown = &paper.shown[sky].of_all;
                let (own, lobes) = (error(shown, &paper.summed[sky]), error(shown, truth));
                let _ = write!(row, " {own:.3} | {lobes:.3} |");
            }
            rows.push(row);
        }
        steps.extend(step_rows(&gpu, material, &lobes.summed, &points, &skies)?);
        bar.set(i as u64 + 1, materials.len() as u64);
    }
    drop(bar);
    deliver(&page(&rows, &steps, points.len(), options), options.destination.output.as_deref())
}

/// Rows of the table of reads: the errors of every step under each sky.
fn step_rows(
    gpu: &Gpu,
    material: &Material,
    summed: &[Vec<[f64; 3]>],
    points: &[Point],
    skies: &[Arc<Environment>],
) -> Outcome<Vec<String>> {
    let mut rows: Vec<String> =
        SKIES.iter().map(|scenery| format!("| {} | {} |", material.name, scenery.name())).collect();
    let mut shaded = material.clone();
    shaded.bake.model = Some(ShadingModel::Lobes);
    let store = MemoryStore::default();
    for step in STEPS {
        let functions = [step, FunctionGroup::Sample].into_iter().collect();
        let package = Bake { functions, ..Bake::lit() }.package(&lit(&[shaded.clone()]), &store)?;
        let scene = gpu.scene(&package, Form::Baked)?;
        for ((row, sky), truth) in rows.iter_mut().zip(skies).zip(summed) {
            let shown = Shown::new(&scene, points, sky)?;
            let _ = write!(row, " {:.3} | {:.3} |", error(&shown.of_all, truth), error(&shown.of_one, truth));
        }
    }
    Ok(rows)
}

/// A place on the ball: normal, direction to the eye.
struct Point {
    normal: DVec3,
    wo: DVec3,
}

/// Places under the middles of the pixels of a square picture of `size` pixels a side.
fn points(size: u32) -> Vec<Point> {
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
type Texel = (DVec3, Vec<[f64; 3]>);

fn texels(skies: &[Arc<Environment>]) -> Vec<Texel> {
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
struct Shown {
    of_all: Vec<[f64; 3]>,
    of_one: Vec<[f64; 3]>,
}

impl Shown {
    fn new(scene: &Scene, points: &[Point], sky: &Arc<Environment>) -> Outcome<Self> {
        let environment = Arc::clone(sky);
        let settings =
            RenderSettings { size: 1, lights: Vec::new(), environment, ..RenderSettings::new(Shape::Sphere)? };
        let of_one = colors(scene, points, &RenderSettings { samples: 1, ..settings.clone() })?;
        Ok(Self { of_all: colors(scene, points, &settings)?, of_one })
    }
}

/// Radiance of all places under each sky, in pictures and as a sum over all texels.
struct Pictures {
    alpha: f64,
    shown: Vec<Shown>,
    summed: Vec<Vec<[f64; 3]>>,
}

impl Pictures {
    fn new(
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

fn mean(values: &[[f64; 3]]) -> f64 {
    values.iter().flatten().sum::<f64>() / (3 * values.len()) as f64
}

/// Root of the mean squared difference over the mean.
fn error(values: &[[f64; 3]], truth: &[[f64; 3]]) -> f64 {
    let squares: f64 = values.iter().flatten().zip(truth.iter().flatten()).map(|(a, b)| (a - b) * (a - b)).sum();
    (squares / (3 * truth.len()) as f64).sqrt() / mean(truth)
}

fn page(rows: &[String], steps: &[String], points: usize, options: &EnvironmentOptions) -> String {
    let mut page = format!(
        "# Environment\n\nGenerated by `{} --size {} --rows {}`.\n\n",
        call("environment", &options.sources.paths),
        options.size,
        options.rows
    );
    page.push_str(INTRODUCTION);
    let _ = writeln!(page, "Places: {points}.\n");
    let mut head = "| material | alpha | sky | mean | lobes | lobes, one sample |".to_owned();
    for model in PAPERS {
        let _ = write!(head, " {0}, own sum | {0}, sum of lobes |", model.name());
    }
    let _ = writeln!(page, "{head}\n|---|--:|---|--:|--:|--:|{}", "--:|--:|".repeat(PAPERS.len()));
    for row in rows {
        let _ = writeln!(page, "{row}");
    }
    page.push_str(READS);
    let mut head = "| material | sky |".to_owned();
    for step in STEPS {
        let _ = write!(head, " {} | one sample |", step.environment_reads().unwrap_or(0));
    }
    let _ = writeln!(page, "{head}\n|---|---|{}", "--:|--:|".repeat(STEPS.len()));
    for row in steps {
        let _ = writeln!(page, "{row}");
    }
    page
}

const INTRODUCTION: &str = "\
Pictures show surroundings that were filtered beforehand. This page compares what they show on a ball with sums over every texel of the
map, each through `luthier_eval`. Sums have no noise. Skies are those of `luthier environment --sky`.

Figures are roots of the mean squared difference over all places and channels, over the mean of the sum. `lobes` is the model `lobes` against its own
sum. Of other models the first figure is against their own sum, and the second against that of lobes, which the simulation of the stack made: what a
picture of that model is off in all. All models but `lobes` show the same light of surroundings, so that their second figures are equal.
`alpha` is the slope parameter of the first interface. Pictures have as many samples of a pixel as those of `luthier preview` by default, 16, each of
which turns the directions of the look-up. With one sample there are no directions but those of a call of `luthier_environment`.
Sums resolve no lobes narrower than a texel of the map, so that smooth materials are not here.

";

const READS: &str = "
## Reads

Shaders with the functions `environment-1` to `environment-16` have fewer reads for each lobe than the 32 of `environment`; the remainder keeps its nine. Figures
are those of `lobes` above, for each number of reads: with 16 samples of a pixel, then with one. More reads leave narrower blurs, which is what pictures of many
samples gain; those of one sample gain fewer dots.

Not every pair is within .02 of the mean. The error of silver-paint grows about with the square of the blur, while narrower blurs show dots in pictures of one
sample. Blurs and points were chosen by these nine pairs: other materials and skies may be off by more.

";
