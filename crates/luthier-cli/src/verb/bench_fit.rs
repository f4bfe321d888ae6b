//! `bench --fit`: costs of operations on the adapter at hand, fitted to the times.

use std::path::Path;

use luthier_cost::{CostUnit, DeviceCost, FitSource, StaticCounts, Timing};
use luthier_export::{GENERATOR, Package};
use luthier_gpu::Gpu;
use luthier_shader::{Form, MaterialSet, count};
use luthier_terminal::{Failure, Outcome, adapter_json, deliver};

/// Counts of the WGSL of a package in a form, for some lights.
pub(crate) fn counts(package: &Package, form: Form, lights: u32) -> Outcome<StaticCounts> {
    let wgsl = package.wgsl(form).map_err(Failure::input)?;
    let wide = MaterialSet::from_manifest(&package.manifest).wide_textures();
    count(wgsl, &wide, lights).map_err(Failure::input)
}

/// Whether costs are printed and not written: `-` in place of a file.
pub(crate) fn is_printed_alone(file: &Path) -> bool {
    file == Path::new("-")
}

/// Fits costs to times in picoseconds, net of the harness, writes them to a file unless they are printed alone, and returns what to print of them.
pub(crate) fn fitted(gpu: &Gpu, rows: &[Timing], file: &Path) -> Outcome<String> {
    let adapter = adapter_json(gpu);
    let text = |key: &str| adapter[key].as_str().unwrap_or_default().to_owned();
    let name = match file.file_stem().filter(|_| !is_printed_alone(file)) {
        Some(stem) => stem.to_string_lossy().into_owned(),
        None => "this device".to_owned(),
    };
    let source = FitSource {
        generator: GENERATOR.to_owned(),
        name,
        device: text("name"),
        driver: text("driver"),
        unit: CostUnit::Picoseconds,
        source: format!("times of {} shaders by `luthier bench --fit`", rows.len()),
        family: None,
    };
    let costs = DeviceCost::fitted(source, rows).map_err(Failure::input)?;
    if !is_printed_alone(file) {
        deliver(&costs.to_json().map_err(Failure::input)?, Some(file))?;
    }
    Ok(costs.to_text())
}
