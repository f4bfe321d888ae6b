//! The environment as lobes show it: against energies, and against the directions of a brute force.

use luthier_gpu::{Package, RenderSettings, Scene, Shader};
use luthier_lut::{AtlasLayout, Axis, Mapping, TableKind, TexelFormat};
use luthier_manifest::{FunctionGroup, LobesRecord, ShadingModel};
use luthier_shader::{Form, MaterialSet, Target};

use crate::adapter::gpu;
use crate::bake_by_hand::{Table, axis, conductor, dielectric, manifest, row_layout, texels};
use crate::render::{check, dark, hit, uniform};

/// Relative index of the medium that lobes are in.
const INDEX: f64 = 1.5;

/// Shift over the sine of the view, widths, tail and energy of a lobe.
#[derive(Debug, Clone, Copy)]
struct Lobe(f64, [f64; 2], f64, f64);

const NARROW: Lobe = Lobe(0.05, [0.12, 0.16], 0.3, 0.5);
const BROAD: Lobe = Lobe(-0.1, [0.3, 0.25], 0.9, 0.2);

/// Share of a lobe that leaves the medium, seen from a cosine: of slopes that it draws.
fn share(Lobe(shift, width, tail, _): Lobe, cos_theta: f64) -> f64 {
    const DRAWN: u32 = 1 << 14;
    let sin = (1.0 - cos_theta * cos_theta).sqrt();
    let eye = [sin, 0.0, (cos_theta * cos_theta + INDEX * INDEX - 1.0).sqrt()];
    let leaves = |i: u32| {
        let beyond = 1.0 - (f64::from(i) + 0.5) / f64::from(DRAWN);
        let radius = ((beyond.powf(-tail) - 1.0) / tail).sqrt();
        let (sin_phi, cos_phi) = (2.399_963_229_728_653 * f64::from(i)).sin_cos();
        let [x, y] = [shift * sin + width[0] * radius * cos_phi, width[1] * radius * sin_phi];
        let twice = 2.0 * (x * eye[0] + eye[2]) / (1.0 + x * x + y * y);
        let up = [twice * x - eye[0], twice * y, twice - eye[2]];
        up[2] > 0.0 && up[0] * up[0] + up[1] * up[1] < 1.0
    };
    f64::from((0..DRAWN).filter(|&i| leaves(i)).count() as u32) / f64::from(DRAWN)
}

/// A material of two lobes and a remainder of 0.1 below a first interface with this energy, all of one colour.
fn scene(first: f32, fresnel: f32) -> Option<Scene> {
    let parts = Axis { max: 5.0, ..axis("part", 5.0, 6, Mapping::Apart) };
    let x = axis("cos_theta", 1.0, 17, Mapping::Rational { bend: 1.0 });
    let layout = AtlasLayout { x: x.clone(), y: Some(parts), apron: 1, ..row_layout() };
    let across = layout.row_size();
    let mut lobes = Table::new(TableKind::Lobes, layout, TexelFormat::Rgba32Float, |_, _| [0.0; 4]);
    for i in 0..across {
        let c = x.node((i.max(1) - 1).min(x.size - 1));
        let lobe = |lobe: Lobe| {
            let (Lobe(shift, width, tail, energy), share) = (lobe, share(lobe, c));
            let [sharp_x, sharp_y] = width.map(|width| tail.sqrt() / width);
            [[energy / share, energy / share, energy / share, shift], [sharp_x, sharp_y, 1.0 / tail, share]]
        };
        let albedo = f64::from(first) + NARROW.3 + BROAD.3 + 0.1;
        let ([a, b], [d, e]) = (lobe(NARROW), lobe(BROAD));
        for (j, part) in (0..).zip([[0.1; 4], a, b, d, e, [albedo; 4]]) {
            lobes.truth.texel_mut(j * across + i, 0).copy_from_slice(&part.map(|value| value as f32));
        }
    }
    let tables = [Table::new(TableKind::Fresnel, row_layout(), TexelFormat::Rgba16Float, |_, _| [fresnel; 4]), lobes];
    let coat = dielectric(0.1, INDEX);
    let coat = luthier_manifest::LayerRecord {
        tiles: coat.tiles.with([(TableKind::Fresnel, Some(0)), (TableKind::Lobes, Some(0))]),
        ..coat
    };
    let mut manifest = manifest(vec![vec![coat, conductor(0.2, [0.1; 3], [9.0; 3])]], &tables);
    manifest.materials[0].model = ShadingModel::Lobes;
    manifest.materials[0].constants.lobes = Some(LobesRecord {
        index: INDEX,
        falloff: [0.0; 2],
        integral: 1.0,
        critical_cot_sq: 0.0,
        critical_width: 0.0,
        critical_plain_share: 0.0,
        varying: None,
    });
    manifest.functions = [FunctionGroup::Environment].into_iter().collect();
    let set = MaterialSet::from_manifest(&manifest);
    let wgsl = luthier_shader::emit(&set, Form::Baked, Target::Wgsl).unwrap();
    manifest.bindings = luthier_shader::bindings(&set, Form::Baked);
    let package = Package::from_parts(manifest, texels(&tables), vec![Shader::wgsl(Form::Baked, wgsl)]).unwrap();
    Some(gpu()?.scene(&package, Form::Baked).unwrap())
}

#[test]
fn in_a_white_furnace_lobes_show_their_albedo() {
    let Some(scene) = scene(0.15, 0.3) else { return };
    let furnace = RenderSettings { environment: uniform(0.8), ..dark() };
    let image = scene.render(&[0], &furnace).unwrap();
    check(&image, 2e-3, |_, _| [0.8 * 0.95; 3]);
}

/// Without a first interface, whose energy is given by hand. One sample of a pixel, 32 directions of a lobe: .0363 of the mean was
/// measured.
#[test]
fn lobes_show_the_environment_that_a_brute_force_finds() {
    let Some(scene) = scene(0.0, 0.0) else { return };
    let sky = RenderSettings::new(luthier_gpu::Shape::Sphere).unwrap().environment;
    let [blurred, sampled] = [0, 512].map(|environment_samples| {
        let settings = RenderSettings { environment: sky.clone(), environment_samples, ..dark() };
        scene.render(&[0], &settings).unwrap()
    });
    let (mut squares, mut sum, mut count) = (0.0, 0.0, 0.0);
    for (y, x) in (0..blurred.height).flat_map(|y| (0..blurred.width).map(move |x| (y, x))) {
        if hit(x, y).is_some() {
            for (a, b) in blurred.texel(x, y).iter().zip(sampled.texel(x, y)) {
                squares += f64::from(a - b).powi(2);
                sum += f64::from(*b);
                count += 1.0;
            }
        }
    }
    let error = (squares / count).sqrt() / (sum / count);
    eprintln!("blurred environment in lobes: rms {error:.4} of the mean");
    assert!(error < 0.04, "{error}");
}
