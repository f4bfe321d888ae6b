//! Tables that engines read beside a material.

use luthier_layers::num_complex::Complex64;
use luthier_lut::{ErrorStats, Image};
use luthier_optics::color::Color;
use luthier_optics::masking::Correlation;
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{
    DfgTable, EnergyDomain, EnergyPreset, FilmLayout, FilmTable, Found, FresnelLayout, FresnelTable, Layout, LtcError,
    LtcTable, Preset, SPLIT_SUM, SheenTable, Stored, Value, search,
};
use numpy::PyArray3;
use pyo3::prelude::*;
use serde_json::{Value as Json, json};

use crate::arrays;
use crate::audit::nodes;
use crate::fault::{unknown, value};
use crate::interrupt::at_once;

/// Texels, and what they are as JSON.
type Texels<'py> = (Bound<'py, PyArray3<f32>>, String);

/// Wavelengths of the values of three wavelengths, nm: CONVENTIONS.md.
const WAVELENGTHS_NM: [f64; 3] = [680.0, 550.0, 440.0];
/// Lowest cosine and alpha that count for area lights, as for `luthier table ltc`.
const LTC_FROM: [f64; 2] = [0.02, 0.002];
/// Least albedo that counts for sheen, as for `luthier table sheen`.
const MIN_ALBEDO: f64 = 1e-3;
/// Indices over which errors of tables of energy count, as for `luthier table energy`.
const INDICES: [f64; 2] = [1.05, 2.5];

fn distribution(name: &str) -> PyResult<Distribution> {
    match name {
        "ggx" => Ok(Distribution::Ggx),
        "beckmann" => Ok(Distribution::Beckmann),
        _ => Err(unknown("distribution", name, &["ggx", "beckmann"])),
    }
}

fn error(stats: &ErrorStats) -> Json {
    json!({
        "max_abs_err": stats.max_abs_err, "rms_err": stats.rms_err, "p99_abs_err": stats.p99_abs_err, "worst": stats.worst,
        "points": stats.points,
    })
}

fn lobe_error(error: &LtcError) -> Json {
    json!({ "median": error.median, "p95": error.p95 })
}

fn of_dfg<'py>(
    py: Python<'py>,
    table: &DfgTable,
    texels: Image,
    stats: &ErrorStats,
    held: bool,
) -> PyResult<Texels<'py>> {
    let about = json!({
        "distribution": table.distribution.name(),
        "masking": table.masking.name(),
        "axes": table.layout.to_string(),
        "values": table.values.iter().map(|value| value.name()).collect::<Vec<_>>(),
        "size": table.size,
        "stored": table.stored.name(),
        "held": held,
        "error": error(stats),
    });
    Ok((arrays::image(py, texels)?, about.to_string()))
}

/// The split sum of an engine, or the smallest that holds an error.
#[pyfunction]
pub(crate) fn table_dfg<'py>(
    py: Python<'py>,
    preset: Option<&str>,
    max_abs: f64,
    distribution_name: &str,
    masking: &str,
    size: Option<[u32; 2]>,
    lowest: [f64; 2],
) -> PyResult<Texels<'py>> {
    let Some(name) = preset else {
        let names = Masking::ALL.map(Masking::name);
        let found = Masking::ALL.into_iter().find(|one| one.name() == masking);
        let masking = found.ok_or_else(|| unknown("masking term", masking, &names))?;
        let distribution = distribution(distribution_name)?;
        let found = at_once(py, move |_| search(distribution, masking, &SPLIT_SUM, max_abs, lowest[0], lowest[1]))?;
        let Found { table, texels, error, held } = found;
        return of_dfg(py, &table, texels, &error, held);
    };
    let names: Vec<&str> = Preset::ALL.iter().map(|preset| preset.name).collect();
    let mut table = Preset::named(name).ok_or_else(|| unknown("preset", name, &names))?.table();
    table.size = size.unwrap_or(table.size);
    let (table, texels, stats) = at_once(py, move |_| {
        let texels = table.bake();
        let stats = table.error(&texels, lowest[0], lowest[1]);
        (table, texels, stats)
    })?;
    let held = stats.max_abs_err <= max_abs;
    of_dfg(py, &table, texels, &stats, held)
}

/// The albedo of Charlie's cloth.
#[pyfunction]
pub(crate) fn table_cloth<'py>(
    py: Python<'py>,
    visibility: &str,
    axes: &str,
    nodes_name: &str,
    size: [u32; 2],
    lowest: [f64; 2],
) -> PyResult<Texels<'py>> {
    let value_of = match visibility {
        "neubelt" => Value::Cloth,
        "estevez-kulla" => Value::Sheen,
        _ => return Err(unknown("visibility", visibility, &["neubelt", "estevez-kulla"])),
    };
    let layout = Layout::parse(axes, nodes(nodes_name)?).map_err(value)?;
    // The distribution and the masking are of split sums, which this table does not hold.
    let (distribution, masking) = (Distribution::Ggx, Masking::SmithCorrelated);
    let table =
        DfgTable { distribution, masking, layout, values: vec![value_of], size, stored: Stored::Float, base: None };
    let (table, texels, stats) = at_once(py, move |_| {
        let texels = table.bake();
        let stats = table.error(&texels, lowest[0], lowest[1]);
        (table, texels, stats)
    })?;
    let about = json!({
        "distribution": "charlie", "visibility": visibility, "axes": table.layout.to_string(), "values": [value_of.name()], "size": size,
        "error": error(&stats),
    });
    Ok((arrays::image(py, texels)?, about.to_string()))
}

/// The tables of energy compensation of a renderer, each with its name; parts of a table follow each other.
#[pyfunction]
pub(crate) fn table_energy<'py>(
    py: Python<'py>,
    preset: &str,
    lowest: [f64; 2],
) -> PyResult<Vec<(String, Texels<'py>)>> {
    let names: Vec<&str> = EnergyPreset::ALL.iter().map(|preset| preset.name).collect();
    let preset = EnergyPreset::named(preset).ok_or_else(|| unknown("preset", preset, &names))?;
    let domain = EnergyDomain { min_cos: lowest[0], min_alpha: lowest[1], ior: INDICES };
    let mut all = Vec::new();
    for file in preset.files {
        let parts = at_once(py, move |_| {
            let texels = preset.bake(file);
            let tables = preset.tables(file);
            let measured = tables.into_iter().zip(texels).map(|(table, texels)| {
                let stats = table.error(&texels, domain);
                (table, texels, stats)
            });
            measured.collect::<Vec<_>>()
        })?;
        let count = parts.len();
        for (part, (table, texels, stats)) in parts.into_iter().enumerate() {
            let name = if count == 1 { file.name.to_owned() } else { format!("{}-{part}", file.name) };
            let about = json!({
                "surface": table.surface.name(),
                "distribution": table.distribution.name(),
                "masking": table.masking.name(),
                "axes": table.layout.to_string(),
                "values": table.values.iter().map(|value| value.name()).collect::<Vec<_>>(),
                "size": table.size,
                "stored": table.stored.name(),
                "error": error(&stats),
            });
            all.push((name, (arrays::image(py, texels)?, about.to_string())));
        }
    }
    Ok(all)
}

/// The colour of a plane under a thin film.
#[pyfunction]
#[expect(clippy::too_many_arguments, reason = "the options of the command")]
pub(crate) fn table_film<'py>(
    py: Python<'py>,
    film: [f64; 2],
    base: [f64; 2],
    above: f64,
    axes: &str,
    nodes_name: &str,
    size: [u32; 2],
    three_wavelengths: bool,
    min_cos: f64,
) -> PyResult<Texels<'py>> {
    let layout = FilmLayout::parse(axes, nodes(nodes_name)?).map_err(value)?;
    let [film, below] = [film, base].map(|[n, k]| Complex64::new(n, k));
    let color = if three_wavelengths { Color::ThreeWavelengths(WAVELENGTHS_NM) } else { Color::Spectral };
    let table = FilmTable { above, film, below, color, layout, size, stored: Stored::Float };
    let (table, texels, stats) = at_once(py, move |_| {
        let texels = table.bake();
        let stats = table.error(&texels, min_cos);
        (table, texels, stats)
    })?;
    let about =
        json!({ "axes": table.layout.to_string(), "values": ["r", "g", "b"], "size": size, "error": error(&stats) });
    Ok((arrays::image(py, texels)?, about.to_string()))
}

/// The reflectance of a plane of any index.
#[pyfunction]
pub(crate) fn table_fresnel<'py>(
    py: Python<'py>,
    axes: &str,
    nodes_name: &str,
    size: [u32; 3],
    min_cos: f64,
) -> PyResult<Texels<'py>> {
    let layout = FresnelLayout::parse(axes, nodes(nodes_name)?).map_err(value)?;
    let table = FresnelTable { layout, size, stored: Stored::Float };
    let (table, texels, stats) = at_once(py, move |_| {
        let texels = table.bake();
        let stats = table.error(&texels, min_cos);
        (table, texels, stats)
    })?;
    let about =
        json!({ "axes": table.layout.to_string(), "values": ["reflectance"], "size": size, "error": error(&stats) });
    Ok((arrays::image(py, texels)?, about.to_string()))
}

/// Matrices and norms of linearly transformed cosines of a rough metal.
#[pyfunction]
pub(crate) fn table_ltc<'py>(py: Python<'py>, distribution_name: &str, masking: &str) -> PyResult<[Texels<'py>; 2]> {
    let masking = match masking {
        "correlated" => Correlation::Height,
        "separable" => Correlation::Separable,
        other => return Err(unknown("masking term", other, &["correlated", "separable"])),
    };
    let table = LtcTable { masking, ..LtcTable::of_engines(distribution(distribution_name)?) };
    let (table, texels, between) = at_once(py, move |_| {
        let texels = table.bake();
        let between = table.error_between_texels(&texels, LTC_FROM[0], LTC_FROM[1]);
        (table, texels, between)
    })?;
    let about = |values: Json| {
        let axes = table.layout.to_string();
        json!({ "axes": axes, "values": values, "size": table.size, "error": lobe_error(&between) }).to_string()
    };
    Ok([
        (arrays::image(py, texels.matrices)?, about(json!(["m11", "m31", "m13", "m33"]))),
        (arrays::image(py, texels.norms)?, about(json!(["albedo", "bias", "zero", "clipped_sphere"]))),
    ])
}

/// Linearly transformed cosines of a layer of fibres.
#[pyfunction]
pub(crate) fn table_sheen(py: Python<'_>) -> PyResult<Texels<'_>> {
    let table = SheenTable::of_engines();
    let (table, texels, [lobe, albedo]) = at_once(py, move |_| {
        let texels = table.bake();
        let errors = table.error_between_texels(&texels, MIN_ALBEDO);
        (table, texels, errors)
    })?;
    let about = json!({
        "axes": table.layout.to_string(), "values": ["a", "b", "albedo"], "size": table.size, "error": lobe_error(&lobe),
        "error_albedo": lobe_error(&albedo),
    });
    Ok((arrays::image(py, texels)?, about.to_string()))
}
