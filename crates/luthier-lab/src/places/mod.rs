//! `places`: shaders at places of surfaces that vary, against their f64 twins.

mod cases;
mod page;

use glam::DVec3;
use luthier::{Bake, MemoryStore};
use luthier_export::{GENERATOR, Shader};
use luthier_gpu::Gpu;
use luthier_layers::layers::Layers;
use luthier_layers::models::parts::Parts;
use luthier_layers::twins::shaded::Shaded;
use luthier_manifest::{ColorMode, Form, FunctionGroup, Functions, ShadingModel};
use luthier_material::Material;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_report::{FLOOR, Pair, ParitySet};
use luthier_terminal::{Bar, Failure, Outcome, adapter_label, complain, deliver, open};
use rayon::prelude::*;

use crate::cli::PlacesOptions;
use cases::{Case, Spot};

/// Places at which a row is measured.
const PLACES: usize = 8;

/// Largest difference of the form `full`: arithmetic in single precision, over the brightest channel.
const FULL: f64 = 2e-5;

/// Largest difference of the form `baked`, as `FRESNEL_UNDER_A_COAT` of the parity page: its tables are compared with exact terms.
const BAKED: f64 = 2e-2;

/// One kind of place in one model.
#[derive(Debug)]
pub(crate) struct Row {
    name: &'static str,
    key: &'static str,
    model: ShadingModel,
    /// Errors of the forms, `full` first: the largest, and the median.
    errors: [Option<[f64; 2]>; 2],
    /// The largest difference that the place makes in f64, which is the error of a shader that ignores it.
    made: f64,
}

impl Row {
    fn holds(&self) -> bool {
        let [full, baked] = self.errors;
        full.is_none_or(|[max, _]| max <= FULL) && baked.is_none_or(|[max, _]| max <= BAKED)
    }
}

/// Compares shaders at places with their f64 twins.
pub(crate) fn run(options: &PlacesOptions) -> Outcome {
    let gpu = open(options.adapter.name.as_deref())?;
    let cases = cases::all();
    let all = cases.iter().flat_map(|case| case.models.iter().map(move |&model| (case, model)));
    let asked: Vec<_> = all.filter(|(_, model)| options.model.is_empty() || options.model.contains(model)).collect();
    let bar = Bar::new("comparing");
    let mut rows = Vec::new();
    for &(case, model) in &asked {
        rows.push(measured(case, model, &gpu, options.pairs)?);
        bar.set(rows.len() as u64, asked.len() as u64);
    }
    drop(bar);
    let page = page::write(&rows, GENERATOR, &adapter_label(&gpu), PLACES, options.pairs);
    deliver(&page, options.destination.output.as_deref())?;
    let broken: Vec<&Row> = rows.iter().filter(|row| !row.holds()).collect();
    for row in &broken {
        complain(&format!("{}, {}: {:?}", row.name, row.model.name(), row.errors));
    }
    if broken.is_empty() { Ok(()) } else { Err(Failure::Verdict) }
}

fn measured(case: &Case, model: ShadingModel, gpu: &Gpu, pairs: u32) -> Outcome<Row> {
    let materials = case.materials(model);
    let spots: Vec<Spot> = (0..PLACES).map(|n| case.spot(&materials, n)).collect();
    let pairs = directions(&materials[0], pairs);
    let expected: Vec<Vec<Rgb>> = spots.iter().map(|spot| in_f64(spot, &materials, model, &pairs)).collect();
    let plain = cases::plain(&materials);
    let plain = in_f64(&plain, &materials, model, &pairs);
    let made = expected.iter().flat_map(|values| differences(values, &plain)).fold(0.0, f64::max);
    let mut errors = [None; 2];
    for (form, error) in [Form::Full, Form::Baked].into_iter().zip(&mut errors) {
        // Without tables these models treat facets as level, unlike `Shaded`.
        let is_level = matches!(model, ShadingModel::Belcour | ShadingModel::Yamaguchi);
        if form == Form::Full && is_level {
            continue;
        }
        let found = on_device(case, &materials, &spots, form, gpu, &pairs)?;
        let mut all: Vec<f64> = found.iter().zip(&expected).flat_map(|(f, e)| differences(f, e)).collect();
        all.sort_by(f64::total_cmp);
        *error = Some([all.last().copied().unwrap_or(f64::INFINITY), all[all.len() / 2]]);
    }
    Ok(Row { name: case.name, key: case.key, model, errors, made })
}

/// Pairs of directions: half all over the hemisphere, half near the mirrored one.
fn directions(material: &Material, count: u32) -> Vec<Pair> {
    let layers = Layers::isotropic_rgb(&material.stack).layers;
    let near = if layers.is_empty() { ParitySet::Uniform } else { ParitySet::NearSpecular };
    [(ParitySet::Uniform, count.div_ceil(2)), (near, count / 2)].map(|(set, count)| set.pairs(count, &layers)).concat()
}

/// Values of the f64 twin.
fn in_f64(spot: &Spot, materials: &[Material], model: ShadingModel, pairs: &[Pair]) -> Vec<Rgb> {
    let material = &materials[spot.material];
    let wavelengths_nm = material.bake.wavelengths_nm();
    let color = Color::ThreeWavelengths(wavelengths_nm);
    let shaded = Shaded::with(model, &material.reflecting_stack(), wavelengths_nm, color, &spot.place, Parts::PLAIN);
    let Some(shaded) = shaded else { return Vec::new() };
    let values = pairs.par_iter().map(|&(wi, wo)| {
        let [wi, wo] = [wi, wo].map(|w| DVec3::from(w.map(f64::from)));
        spot.light.map_or_else(|| shaded.eval(wi, wo), |light| shaded.eval_lit(light, wi, wo))
    });
    values.collect()
}

/// Values of the shader at every place. The number of the material chooses the place: materials beyond those of the case are copies.
fn on_device(
    case: &Case,
    materials: &[Material],
    spots: &[Spot],
    form: Form,
    gpu: &Gpu,
    pairs: &[Pair],
) -> Outcome<Vec<Vec<Rgb>>> {
    let mut all = materials.to_vec();
    for n in materials.len()..PLACES {
        let mut copy = materials[0].clone();
        copy.name = format!("{}-{n}", copy.name);
        all.push(copy);
    }
    let functions: Functions = [FunctionGroup::Eval, FunctionGroup::Surface].into_iter().collect();
    let bake = Bake { refuses: false, surfaces: case.surfaces(), functions, ..Bake::wgsl(&[form]) };
    let mut package = bake.package(&all, &MemoryStore::default())?;
    let places: String =
        (0..).zip(spots).map(|(n, spot): (u32, _)| format!("        case {n}u: {{ {} }}\n", spot.make)).collect();
    let (eval, light) = match spots[0].light {
        Some([r, g, b]) => ("luthier_eval_lit_at", format!(", vec3<f32>({r:?}, {g:?}, {b:?})")),
        None => ("luthier_eval_at", String::new()),
    };
    let wgsl = package.wgsl(form).unwrap_or_default().replace("fn luthier_eval(", "fn emitted_eval(")
        + &format!(
            "\nfn luthier_eval(spot: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n    var material = 0u;\n    var place = luthier_place();\n    \
             switch spot {{\n{places}        default: {{}}\n    }}\n    return {eval}(place, material, wi, wo{light});\n}}\n"
        );
    package.shaders = vec![Shader::wgsl(form, wgsl)];
    let scene = gpu.scene(&package, form).inspect_err(|_| complain(case.name))?;
    (0..spots.len() as u32)
        .map(|n| Ok(scene.evaluate(n, pairs)?.into_iter().map(|value| value.map(f64::from)).collect()))
        .collect()
}

/// Differences, each over the brightest channel of the second, or the floor of the parity page.
fn differences<'a>(found: &'a [Rgb], expected: &'a [Rgb]) -> impl Iterator<Item = f64> + 'a {
    found.iter().zip(expected).map(|(found, expected)| {
        let brightest = expected.iter().fold(FLOOR, |most, value| most.max(*value));
        let apart = found.iter().zip(expected).map(|(f, e)| (f - e).abs()).fold(0.0, f64::max);
        if apart.is_nan() { f64::INFINITY } else { apart / brightest }
    })
}

/// The colour of both forms: tables are compared with exact terms of the same colour.
fn at_three_wavelengths(material: &mut Material, model: ShadingModel) {
    material.bake.model = Some(model);
    material.bake.color = Some(ColorMode::ThreeWavelengths);
}
