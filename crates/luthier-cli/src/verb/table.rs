//! `table`: tables that engines read beside a material.

use luthier_lut::{ErrorStats, Image, TexelFormat};
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_table::{Container, DfgTable, Found, Layout, Preset, Stored, search};
use luthier_terminal::{Failure, Outcome, files, print};
use luthier_texture::{Texture, ktx2, png};
use serde_json::{Value as Json, json};

use crate::cli::{DistributionName, FunctionName, TableOptions};

/// Bakes a table, writes it and says what it is.
pub(crate) fn run(options: &TableOptions) -> Outcome {
    let FunctionName::Dfg = options.function;
    let (Found { table, texels, error, held }, bytes) = match options.preset {
        Some(preset) => of_preset(preset, options)?,
        None => searched(options)?,
    };
    std::fs::write(&options.output, &bytes).map_err(files(&options.output, "write"))?;
    let described = described(&table, &error);
    if options.json {
        let preset = options.preset.map(|preset| json!({ "name": preset.name, "source": preset.source }));
        let value = json!({
            "file": options.output, "bytes": bytes.len(), "table": described, "preset": preset, "max_abs": options.max_abs, "held": held,
            "error": error, "min_cos": options.min_cos, "min_alpha": options.min_alpha,
        });
        print(&format!("{value:#}"))?;
    } else {
        print(&text(options, &table, &texels, &error, bytes.len()))?;
    }
    if held { Ok(()) } else { Err(Failure::Verdict) }
}

fn of_preset(preset: &Preset, options: &TableOptions) -> Outcome<(Found, Vec<u8>)> {
    let Some(container) = preset.container else {
        let known: Vec<&str> = Preset::ALL.iter().filter(|p| p.container.is_some()).map(|p| p.name).collect();
        let name = preset.name;
        let known = known.join(", ");
        return Err(Failure::Usage(anyhow::anyhow!(
            "the table of {name} holds more than a split sum, and cannot be baked yet; `luthier audit --preset {name}` judges it. There are {known}"
        )));
    };
    let table = preset.table();
    let texels = table.bake();
    let error = table.error(&texels, options.min_cos, options.min_alpha);
    let bytes = match container {
        Container::Ktx2 => ktx2_file(&texels, options.no_zstd)?,
        Container::Png => png::encode_image(&texels).map_err(Failure::input)?,
        Container::Raw => raw(&texels, table.stored),
        Container::JavaScript => javascript(&texels, &table, &error).into_bytes(),
    };
    Ok((Found { table, texels, error, held: true }, bytes))
}

fn searched(options: &TableOptions) -> Outcome<(Found, Vec<u8>)> {
    let masking = Masking::ALL
        .into_iter()
        .find(|masking| masking.name() == options.masking)
        .ok_or_else(|| Failure::unknown("masking term", &options.masking, &Masking::ALL.map(Masking::name)))?;
    let distribution = match options.distribution {
        DistributionName::Ggx => Distribution::Ggx,
        DistributionName::Beckmann => Distribution::Beckmann,
    };
    let max_abs = options.max_abs.unwrap_or(f64::INFINITY);
    let found = search(distribution, masking, max_abs, options.min_cos, options.min_alpha);
    let bytes = ktx2_file(&found.texels, options.no_zstd)?;
    Ok((found, bytes))
}

/// A KTX2 file of half floats, of two channels or four.
fn ktx2_file(texels: &Image, is_plain: bool) -> Outcome<Vec<u8>> {
    let format = if texels.channels == 2 { TexelFormat::Rg16Float } else { TexelFormat::Rgba16Float };
    let Image { width, height, .. } = *texels;
    let texture = Texture { format, width, height, bytes: format.encode(texels) };
    if is_plain { ktx2::encode_plain(&texture) } else { ktx2::encode(&texture) }.map_err(Failure::input)
}

fn raw(texels: &Image, stored: Stored) -> Vec<u8> {
    let values = texels.data.iter();
    match stored {
        Stored::Unorm16 => values.flat_map(|v| ((v * 65535.0).round() as u16).to_le_bytes()).collect(),
        Stored::Unorm8 | Stored::Unorm10 => values.map(|v| (v * 255.0).round() as u8).collect(),
        Stored::Half => values.flat_map(|v| half::f16::from_f32(*v).to_le_bytes()).collect(),
        Stored::Float => values.flat_map(|v| v.to_le_bytes()).collect(),
    }
}

/// The module of three.js: the words of half floats, row by row.
fn javascript(texels: &Image, table: &DfgTable, error: &ErrorStats) -> String {
    let row = |row: &[f32]| {
        let words: Vec<String> = row.iter().map(|v| format!("0x{:04x}", half::f16::from_f32(*v).to_bits())).collect();
        format!("\t{}", words.join(", "))
    };
    let rows: Vec<String> = texels.data.chunks_exact((texels.width * texels.channels) as usize).map(row).collect();
    format!(
        "// {}.\n// Largest error as sampled: {:.2e}.\nexport const DFG_LUT_DATA = new Uint16Array( [\n{}\n] );\n",
        words(table),
        error.max_abs_err,
        rows.join(",\n")
    )
}

/// The table in words.
fn words(table: &DfgTable) -> String {
    let DfgTable { distribution, masking, layout, values, size: [width, height], stored } = table;
    let values = values.iter().map(|value| value.name()).collect::<Vec<_>>().join(",");
    let (name, masking, stored) = (distribution.name(), masking.name(), stored.name());
    format!("Split sum, {name}, masking {masking}; {values} over {}; {width} x {height}, {stored}", axes(layout))
}

/// Axes in the grammar of `luthier audit --axes`, and where their nodes are.
fn axes(layout: &Layout) -> String {
    let nodes = if layout.angle.nodes == luthier_table::Nodes::Ends { "ends" } else { "centres" };
    format!("{layout}, nodes at {nodes}")
}

fn described(table: &DfgTable, error: &ErrorStats) -> Json {
    let DfgTable { distribution, masking, layout, values, size, stored } = table;
    json!({
        "model": format!("{}-{}", distribution.name(), masking.name()),
        "axes": layout.to_string(),
        "nodes": if layout.angle.nodes == luthier_table::Nodes::Ends { "ends" } else { "centres" },
        "values": values.iter().map(|value| value.name()).collect::<Vec<_>>(),
        "size": size,
        "stored": stored.name(),
        "max_abs_err": error.max_abs_err,
    })
}

fn text(options: &TableOptions, table: &DfgTable, texels: &Image, error: &ErrorStats, bytes: usize) -> String {
    let texel_bytes = texels.data.len() * if table.stored == Stored::Unorm8 { 1 } else { 2 };
    let at = &error.worst.at;
    let held = match options.max_abs {
        Some(limit) if error.max_abs_err <= limit => format!("\nholds {limit}"),
        Some(limit) => format!("\nno table holds {limit}; this one is the most accurate"),
        None => String::new(),
    };
    format!(
        "{}: {bytes} bytes, of which {texel_bytes} are texels\n{}\nerror as sampled: max {:.2e} at cos_theta {:.3}, alpha {:.3}; rms {:.2e}\n  over \
         cos_theta >= {}, alpha >= {}; bilinear, 8-bit weights{held}\n",
        options.output.display(),
        words(table),
        error.max_abs_err,
        at[0],
        at[1],
        error.rms_err,
        options.min_cos,
        options.min_alpha,
    )
}
