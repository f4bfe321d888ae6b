//! Files of tables, in the containers that engines take.

use std::path::Path;

use luthier_lut::{Image, TexelFormat};
use luthier_table::{Container, Preset, Stored, rgbd};
use luthier_terminal::{Failure, Outcome};
use luthier_texture::ktx2::{Levels, encode_levels};
use luthier_texture::{Metadata, Texture, exr, png};

/// Container and texel type of a file by its ending, if no engine decides: half floats for KTX2 and raw texels, floats for EXR.
pub(super) fn by_ending(path: &Path) -> Outcome<(Container, Stored)> {
    match path.extension().and_then(|ending| ending.to_str()) {
        Some("ktx2") => Ok((Container::Ktx2, Stored::Half)),
        Some("exr") => Ok((Container::Exr, Stored::Float)),
        Some("bin") => Ok((Container::Raw, Stored::Half)),
        _ => Err(Failure::Usage(anyhow::anyhow!(
            "{}: the ending tells the format: .ktx2 and .bin (texels alone) are half floats, .exr is floats",
            path.display()
        ))),
    }
}

/// Refuses a file whose ending does not fit the container that the engine of a preset reads.
pub(super) fn ending_of(preset: &Preset, path: &Path) -> Outcome {
    let Preset { name, container, .. } = preset;
    let (ending, what) = match container {
        Container::Ktx2 => ("ktx2", "KTX2"),
        Container::Png | Container::RgbdPng => ("png", "a PNG"),
        Container::Raw => ("bin", "texels alone"),
        Container::JavaScript => ("js", "a module of JavaScript"),
        Container::Exr => ("exr", "OpenEXR"),
    };
    if path.extension().is_some_and(|found| found == ending) {
        return Ok(());
    }
    Err(Failure::Usage(anyhow::anyhow!(
        "{}: the ending tells the format: the table of {name} is {what}, .{ending}",
        path.display()
    )))
}

/// Key of the statement in the metadata of a file.
const STATEMENT: &str = "luthier.table";

/// A file of texels: `statement` (JSON) stands in its metadata, `words` in the comments of source code. Raw texels hold neither.
pub(super) fn encode(
    container: Container,
    texels: &Image,
    stored: Stored,
    words: &str,
    statement: &str,
    no_zstd: bool,
) -> Outcome<Vec<u8>> {
    let metadata: Metadata = vec![(STATEMENT.to_owned(), statement.to_owned())];
    match container {
        Container::Ktx2 => {
            let format = match texels.channels {
                1 => TexelFormat::R16Float,
                2 => TexelFormat::Rg16Float,
                _ => TexelFormat::Rgba16Float,
            };
            let Image { width, height, .. } = *texels;
            let texture = Texture { format, width, height, bytes: format.encode(texels) };
            let levels = Levels { metadata, ..Levels::one(&texture) };
            encode_levels(&levels, !no_zstd).map_err(Failure::input)
        }
        Container::Png => png::encode_table(texels, &metadata).map_err(Failure::input),
        Container::RgbdPng => {
            let data = rgbd::texels(texels).into_iter().map(|byte| f32::from(byte) / 255.0).collect();
            png::encode_table(&Image { channels: 4, data, ..texels.clone() }, &metadata).map_err(Failure::input)
        }
        Container::Exr => {
            exr::encode(texels, &["R", "G", "B", "A"][..texels.channels as usize], &metadata).map_err(Failure::input)
        }
        Container::Raw => raw(texels, stored),
        Container::JavaScript => Ok(javascript(texels, words).into_bytes()),
    }
}

fn raw(texels: &Image, stored: Stored) -> Outcome<Vec<u8>> {
    let values = texels.data.iter();
    Ok(match stored {
        Stored::Unorm16 => values.flat_map(|v| ((v * 65535.0).round() as u16).to_le_bytes()).collect(),
        Stored::Unorm8 => values.map(|v| (v * 255.0).round() as u8).collect(),
        Stored::Unorm10 => {
            let texture = TexelFormat::Rgb10a2Unorm;
            texture.encode(&rgba(texels))
        }
        Stored::Half => values.flat_map(|v| half::f16::from_f32(*v).to_le_bytes()).collect(),
        Stored::Float => values.flat_map(|v| v.to_le_bytes()).collect(),
        Stored::Rgbd => rgbd::texels(texels),
    })
}

/// The image with four channels; missing ones are 0.
fn rgba(texels: &Image) -> Image {
    let data = texels.texels().flat_map(|texel| (0..4).map(move |c| texel.get(c).copied().unwrap_or(0.0))).collect();
    Image { channels: 4, data, ..texels.clone() }
}

/// The module of three.js: the words of half floats, row by row, and the function that the renderer imports.
fn javascript(texels: &Image, words: &str) -> String {
    let Image { width, height, channels, .. } = *texels;
    let rows = texels.data.chunks_exact((width * channels) as usize).map(|row| {
        let words: Vec<String> = row.iter().map(|v| format!("0x{:04x}", half::f16::from_f32(*v).to_bits())).collect();
        format!("\t{}", words.join(", "))
    });
    let rows: Vec<String> = rows.collect();
    format!(
        "// {words}\nimport {{ DataTexture }} from '../../textures/DataTexture.js';\nimport {{ ClampToEdgeWrapping, HalfFloatType, LinearFilter, \
         RGFormat }} from '../../constants.js';\n\nexport const DFG_LUT_DATA = new Uint16Array( [\n{}\n] );\n\nlet texture = \
         null;\n\nexport function getDFGLUT() {{\n\n\tif ( texture === null ) {{\n\n\t\ttexture = new DataTexture( DFG_LUT_DATA, {width}, {height}, \
         RGFormat, HalfFloatType );\n\t\ttexture.name = 'DFG_LUT';\n\t\ttexture.minFilter = texture.magFilter = LinearFilter;\n\t\ttexture.wrapS = \
         texture.wrapT = ClampToEdgeWrapping;\n\t\ttexture.generateMipmaps = false;\n\t\ttexture.needsUpdate = \
         true;\n\n\t}}\n\n\treturn texture;\n\n}}\n",
        rows.join(",\n")
    )
}
