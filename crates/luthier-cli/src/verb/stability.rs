use luthier_bake::Silent;
use luthier_lut::ShadingModel;
use luthier_material::{BakeSettings, ColorSetting, LayerExtras, Material, ModelSetting, SurfaceClass};
use luthier_report::Subject;
use luthier_report::stability::{Stability, StressCase, cases, model_cells, shader_cells};

use crate::bake_files::{GENERATOR, material_entries};
use crate::cli::StabilityOptions;
use crate::device::open;
use crate::failure::{Failure, Outcome, files};
use crate::materials::read_image;
use crate::output::{complain, print};
use crate::progress::Bar;
use crate::verb::parity::Compiled;

/// Runs every method on every stress case.
pub(crate) fn run(options: &StabilityOptions) -> Outcome {
    let gpu = open(options.adapter.as_deref())?;
    let cases = cases();
    let bar = Bar::new("models in f64");
    let done = std::sync::atomic::AtomicU64::new(0);
    let count = cases.len() as u64;
    let mut cells = model_cells(&cases, &|| {
        bar.set(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1, count);
    });
    drop(bar);
    let materials: Vec<Material> = ShadingModel::ALL
        .iter()
        .flat_map(|model| (0..).zip(&cases).map(|(n, case)| material(n, case, *model)))
        .collect();
    let baking = Bar::new("baking");
    let bake = luthier_bake::bake(&materials, &read_image, &Silent).map_err(Failure::input)?;
    drop(baking);
    let entries = material_entries(&materials, &bake.materials, &mut Vec::new())?;
    let bar = Bar::new("shaders");
    let (mut adapter, mut done) = (String::new(), 0);
    for entries in entries.chunks(cases.len()) {
        let stacks = cases.iter().map(|case| case.stack.clone()).collect();
        let compiled = Compiled::new(&gpu, &bake.atlases, entries, stacks)?;
        adapter = luthier_report::Device::name(&compiled.shaders);
        let subject = Subject {
            manifest: &compiled.manifest,
            textures: compiled.textures.clone(),
            stacks: compiled.stacks.clone(),
        };
        let mut progress = || {
            done += 1;
            bar.set(done, materials.len() as u64);
        };
        cells.extend(shader_cells(&subject, Some(&compiled.shaders), &cases, &mut progress).map_err(Failure::input)?);
    }
    drop(bar);
    let report = Stability::new(GENERATOR, Some(adapter), cells);
    let text =
        if options.json { report.to_json().map_err(Failure::input)? } else { report.to_markdown(&command(options)) };
    match &options.output {
        Some(path) => std::fs::write(path, text).map_err(files(path, "write"))?,
        None => print(&text)?,
    }
    for cell in report.not_finite() {
        complain(&format!("{}, {}, {}: not finite", cell.level.name(), cell.method, cell.case));
    }
    for cell in report.unexplained() {
        let fault = cell.fault.map_or("", |fault| fault.name());
        complain(&format!(
            "{}, {}, {}: {fault} by {:.2e}, unexplained",
            cell.level.name(),
            cell.method,
            cell.case,
            cell.error
        ));
    }
    for formula in report.broken_formulas() {
        complain(&format!("{}: {}: not as listed", formula.row, formula.formulation));
    }
    if report.holds() { Ok(()) } else { Err(Failure::Verdict) }
}

/// The n-th case as a material that the baker takes.
fn material(n: u32, case: &StressCase, model: ShadingModel) -> Material {
    let color = if case.is_spectral { ColorSetting::Spectral } else { ColorSetting::ThreeWavelengths };
    Material {
        name: format!("case-{n}-{}", model.name()),
        source: String::new(),
        text: String::new(),
        files: Vec::new(),
        description: String::new(),
        references: Vec::new(),
        class: SurfaceClass::of(&case.stack),
        layers: vec![LayerExtras::default(); case.stack.layers.len()],
        stack: case.stack.clone(),
        effects: luthier_material::Effects::default(),
        budget: luthier_material::BudgetSettings::default(),
        bake: BakeSettings {
            model: ModelSetting::from_name(model.name()),
            color: Some(color),
            ..BakeSettings::default()
        },
    }
}

/// The command line that makes the page.
fn command(options: &StabilityOptions) -> String {
    let output = options.output.as_ref().map_or(String::new(), |path| format!(" -o {}", path.display()));
    format!("luthier stability{output}")
}
