//! The audit of a table of another program.

use std::path::Path;

use luthier_export::input;
use luthier_lut::Image;
use luthier_report::{Stated, StatedError, audit as judged};
use luthier_table::{Nodes, Preset, Stored, rgbd};
use luthier_texture::{Samples, table};
use numpy::PyReadonlyArray3;
use pyo3::prelude::*;
use serde_json::json;

use crate::fault::{file, unknown, value};
use crate::interrupt::at_once;

/// A table: a file, or texels with the type of their samples.
#[derive(FromPyObject)]
pub(crate) enum Table<'py> {
    File(String),
    Texels(PyReadonlyArray3<'py, f32>, String),
}

/// Names of a statement.
#[derive(FromPyObject)]
#[pyo3(from_item_all)]
pub(crate) struct Names {
    preset: Option<String>,
    model: Option<String>,
    ior: Option<String>,
    axes: Option<String>,
    nodes: Option<String>,
    values: Option<Vec<String>>,
    channels: Option<Vec<usize>>,
    min_cos: f64,
    min_alpha: f64,
}

/// The nodes of a name.
pub(crate) fn nodes(name: &str) -> PyResult<Nodes> {
    match name {
        "centres" => Ok(Nodes::CENTRES),
        "ends" => Ok(Nodes::Ends),
        _ => Err(unknown("position of nodes", name, &["centres", "ends"])),
    }
}

/// The verdict on a table as JSON.
#[pyfunction]
pub(crate) fn audit(py: Python<'_>, table: Table<'_>, names: Names, max_error: f64) -> PyResult<String> {
    let preset = names.preset.as_deref().map(|name| {
        let known: Vec<&str> = Preset::ALL.iter().map(|preset| preset.name).collect();
        Preset::named(name).ok_or_else(|| unknown("preset", name, &known))
    });
    let preset = preset.transpose()?;
    let table::Table { mut image, samples, format, notes } = match table {
        Table::File(path) => {
            let bytes = input::image(Path::new(&path)).map_err(|error| file(format!("{path}: {error}")))?;
            table::read(&bytes).map_err(|error| value(format!("{path}: {error}")))?
        }
        Table::Texels(texels, samples) => {
            let texels = texels.as_array();
            let (height, width, channels) = texels.dim();
            let samples = match samples.as_str() {
                "unorm8" => Samples::Unorm8,
                "unorm16" => Samples::Unorm16,
                "half" => Samples::Half,
                _ => Samples::Float,
            };
            let data = texels.iter().copied().collect();
            let image = Image { width: width as u32, height: height as u32, channels: channels as u32, data };
            table::Table { image, samples, format: "array".to_owned(), notes: Vec::new() }
        }
    };
    if preset.is_some_and(|preset| preset.stored == Stored::Rgbd) && format.starts_with("PNG") {
        image = rgbd::decode_image(&image);
    }
    let stated = Stated {
        preset,
        model: names.model.as_deref(),
        ior: names.ior.as_deref(),
        axes: names.axes.as_deref(),
        nodes: names.nodes.as_deref().map(nodes).transpose()?,
        values: names.values.as_deref(),
        channels: names.channels,
        min_cos: names.min_cos,
        min_alpha: names.min_alpha,
    };
    let (statement, words) = stated.statement(image.channels, samples.step()).map_err(|error| match &error {
        StatedError::Unknown { what, name, known } => unknown(what, name, known),
        _ => value(error),
    })?;
    let found = at_once(py, move |_| judged(&image, &statement))?.map_err(value)?;
    let verdict = json!({
        "format": format,
        "notes": notes,
        "stated": words,
        "line": found.verdict_line(),
        "max_error": max_error,
        "held": found.is_within(max_error),
        "audit": found,
    });
    Ok(verdict.to_string())
}
