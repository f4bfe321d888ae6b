//! `luthier audit`: judges a table of another program.

use std::path::Path;

use luthier_export::input;
use luthier_lut::Image;
use luthier_report::{Audit, Stated, StatedError, audit};
use luthier_table::{Nodes, Stored, rgbd};
use luthier_terminal::{Failure, Outcome, complain, files, print};
use luthier_texture::{Samples, table};
use serde_json::json;

use crate::cli::{AuditOptions, NodesName, SamplesName};

/// Reads the table, judges it and prints the verdict.
pub(crate) fn run(options: &AuditOptions) -> Outcome {
    let bytes = input::image(&options.file).map_err(files(&options.file, "read"))?;
    let mut table = read(options, &bytes)?;
    if options.preset.is_some_and(|preset| preset.stored == Stored::Rgbd) && table.format.starts_with("PNG") {
        table.image = rgbd::decode_image(&table.image);
    }
    for note in &table.notes {
        complain(&format!("warning: {}: {note}", options.file.display()));
    }
    if let Some(crop) = &options.crop {
        table.image = cropped(&table.image, crop)?;
    }
    let stated = Stated {
        preset: options.preset,
        model: options.model.as_deref(),
        ior: options.ior.as_deref(),
        axes: options.axes.as_deref(),
        nodes: options.nodes.map(|nodes| match nodes {
            NodesName::Centres => Nodes::CENTRES,
            NodesName::Ends => Nodes::Ends,
        }),
        values: options.values.as_deref(),
        channels: options.channel.as_ref().map(|names| names.iter().map(|&name| name as usize).collect()),
        min_cos: options.min_cos,
        min_alpha: options.min_alpha,
    };
    let (statement, words) =
        stated.statement(table.image.channels, table.samples.step()).map_err(|error| match &error {
            StatedError::Unknown { what, name, known } => {
                Failure::unknown(what, name, &known.iter().map(String::as_str).collect::<Vec<_>>())
            }
            _ => Failure::Usage(error.into()),
        })?;
    let found = audit(&table.image, &statement).map_err(Failure::input)?;
    let held = found.is_within(options.max_error);
    if options.json {
        let value = json!({
            "file": options.file,
            "format": table.format,
            "stated": words,
            "line": found.verdict_line(),
            "max_error": options.max_error,
            "held": held,
            "audit": found,
        });
        print(&format!("{value:#}"))?;
    } else {
        print(&text(&options.file, &table.format, &words, &found, options.max_error, held))?;
    }
    if held { Ok(()) } else { Err(Failure::Verdict) }
}

fn read(options: &AuditOptions, bytes: &[u8]) -> Outcome<table::Table> {
    let path = options.file.display();
    let Some(size) = &options.size else {
        return table::read(bytes).map_err(|source| {
            let hint = match source {
                luthier_texture::TextureError::UnknownContainer => {
                    "; raw values need --size WxH, --channels and --samples"
                }
                _ => "",
            };
            Failure::Input(anyhow::anyhow!("{path}: {source}{hint}"))
        });
    };
    let sides: Option<(u32, u32)> =
        size.split_once('x').and_then(|(w, h)| Some((w.trim().parse().ok()?, h.trim().parse().ok()?)));
    let (width, height) =
        sides.ok_or_else(|| Failure::Usage(anyhow::anyhow!("`{size}` is no size; write it as 64x64, width first")))?;
    let samples = match options.samples {
        SamplesName::Unorm8 => Samples::Unorm8,
        SamplesName::Unorm16 => Samples::Unorm16,
        SamplesName::Half => Samples::Half,
        SamplesName::Float => Samples::Float,
    };
    table::raw(bytes, width, height, options.channels, samples).map_err(|source| {
        let hint = "the file is WxH texels of --channels values of the type of --samples";
        Failure::Input(anyhow::anyhow!("{path}: {source}; {hint}"))
    })
}

fn cropped(image: &Image, crop: &[u32]) -> Outcome<Image> {
    let part = <&[u32; 4]>::try_from(crop).ok().filter(|[x, y, width, height]| {
        [(x, width, image.width), (y, height, image.height)]
            .into_iter()
            .all(|(start, length, size)| *length > 0 && start.checked_add(*length).is_some_and(|end| end <= size))
    });
    let Some(&[x, y, width, height]) = part else {
        let (width, height) = (image.width, image.height);
        let sentence = format!("--crop is X,Y,W,H inside the {width} x {height} texels of the file");
        return Err(Failure::Usage(anyhow::anyhow!(sentence)));
    };
    let mut part = Image::zeros(width, height, image.channels);
    for row in 0..height {
        for column in 0..width {
            part.texel_mut(column, row).copy_from_slice(image.texel(x + column, y + row));
        }
    }
    Ok(part)
}

fn text(file: &Path, format: &str, words: &str, found: &Audit, max_error: f64, held: bool) -> String {
    let [width, height] = found.size;
    format!(
        "{}: {format}, {width} x {height}\nstated: {words}\n{}\nas stated within {max_error}: {}\n",
        file.display(),
        found.to_text(),
        if held { "held" } else { "not held" }
    )
}
