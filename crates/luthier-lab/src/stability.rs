//! `stability`: every method on cases that make methods fail.

use luthier::{Bake, MemoryStore, of_materials};
use luthier_bake::Options;
use luthier_export::GENERATOR;
use luthier_gpu::Gpu;
use luthier_lut::{RowBase, TexelFormat};
use luthier_manifest::{Budget, ColorMode, ShadingModel};
use luthier_material::{BakeSettings, Material};
use luthier_report::stability::{Cell, Stability, StressCase, cases, model_cells, shader_cells};
use luthier_terminal::{Bar, Failure, Outcome, Shaders, complain, deliver, open};

use crate::cli::StabilityOptions;
use crate::lobes;
use crate::parity::subject;

/// Runs every method on every stress case.
pub(crate) fn run(options: &StabilityOptions) -> Outcome {
    let gpu = open(options.adapter.name.as_deref())?;
    let cases = cases();
    let bar = Bar::new("models in f64");
    let done = std::sync::atomic::AtomicU64::new(0);
    let count = cases.len() as u64;
    let mut cells = model_cells(&cases, &|| {
        bar.set(done.fetch_add(1, std::sync::atomic::Ordering::Relaxed) + 1, count);
    });
    drop(bar);
    let adapter = gpu_cells(&gpu, &cases, &mut cells)?;
    let report = Stability::new(GENERATOR, Some(adapter), cells);
    let json = options.format.json.then(|| report.to_json().map_err(Failure::input));
    let text = json.unwrap_or_else(|| Ok(report.to_markdown(&command(options))))?;
    deliver(&text, options.destination.output.as_deref())?;
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

/// Tables that a bake may have.
struct Tables {
    /// Name of the tables; `None` for those that ship by default.
    name: Option<&'static str>,
    /// Options of the bake that makes them.
    options: Options<'static>,
    /// Models that are run with them.
    models: &'static [ShadingModel],
}

/// The default tables, for all models, and tables that settings and budgets can choose instead, for the models that read all of them: rows of every
/// family, D from a table, computed phases.
fn tables() -> Vec<Tables> {
    let default = Options::default();
    let models: &[ShadingModel] = &[ShadingModel::Elek, ShadingModel::GranierHeidrich];
    let of =
        |name, options, rows| Tables { name: Some(name), options: Options { rows: Some(rows), ..options }, models };
    let fixed = Options { search: false, ..default };
    // With the fewest bytes for tables that are not fixed, D and phases are computed.
    let budget = Options { budget: Budget { max_bytes: Some(1 << 20), ..Budget::default() }, ..default };
    let (plain, schlick) = (RowBase::Zero, RowBase::Schlick);
    vec![
        Tables { name: None, options: default, models: &ShadingModel::ALL },
        of("rows of rgba8unorm, table of D", fixed, (plain, TexelFormat::Rgba8Unorm)),
        of("rows of rg11b10ufloat, computed phases", budget, (plain, TexelFormat::Rg11b10Ufloat)),
        of("rows of rgb10a2unorm", default, (plain, TexelFormat::Rgb10a2Unorm)),
        of("Schlick rows of rgba8unorm", default, (schlick, TexelFormat::Rgba8Unorm)),
        of("Schlick rows of rgb10a2unorm", default, (schlick, TexelFormat::Rgb10a2Unorm)),
    ]
}

/// Appends the cells of shaders and tables; the name of the adapter.
fn gpu_cells(gpu: &Gpu, cases: &[StressCase], cells: &mut Vec<Cell>) -> Outcome<String> {
    let all = tables();
    let total: usize = all.iter().map(|tables| tables.models.len() * cases.len()).sum();
    let bar = Bar::new("shaders");
    let (mut adapter, mut done) = (String::new(), 0);
    for Tables { name, options, models } in &all {
        let materials: Vec<Material> =
            models.iter().flat_map(|model| (0..).zip(cases).map(|(n, case)| material(n, case, *model))).collect();
        let bake = Bake { options: *options, refuses: false, ..Bake::wgsl(&[]) };
        let package = bake.package(&materials, &MemoryStore::default())?;
        for first in (0..materials.len()).step_by(cases.len()) {
            let stacks = cases.iter().map(|case| case.stack.clone()).collect();
            let package = of_materials(&package, first..first + cases.len())?;
            let shaders = Shaders::new(gpu, &package)?;
            adapter = luthier_report::Device::name(&shaders);
            let subject = subject(&package, stacks)?;
            let found = shader_cells(&subject, Some(&shaders), cases, *name, &mut || {
                done += 1;
                bar.set(done, total as u64);
            });
            cells.extend(found.map_err(Failure::input)?);
        }
    }
    Ok(adapter)
}

/// The n-th case as a material that the baker takes.
fn material(n: u32, case: &StressCase, model: ShadingModel) -> Material {
    let color = if case.is_spectral { ColorMode::Spectral } else { ColorMode::ThreeWavelengths };
    let bake = BakeSettings { model: Some(model), color: Some(color), ..BakeSettings::default() };
    lobes::material(format!("case-{n}-{}", model.name()), case.stack.clone(), bake)
}

/// The command line that makes the page.
fn command(options: &StabilityOptions) -> String {
    let output = options.destination.output.as_ref().map_or(String::new(), |path| format!(" -o {}", path.display()));
    format!("luthier-lab stability{output}")
}
