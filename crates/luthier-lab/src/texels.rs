//! `texels`: hashes of the numbers in files of bakes, independent of their containers.

use std::fmt::Write as _;
use std::path::{Path, PathBuf};

use anyhow::Context;
use luthier_export::{input, label, sha256};
use luthier_lut::Image;
use luthier_terminal::{Failure, Outcome, files, print};
use luthier_texture::{TextureError, exr, ktx2, png};

use crate::cli::TexelsOptions;

/// Prints a line for each texture, map and material buffer below the folder: the hash, and the path.
pub(crate) fn run(options: &TexelsOptions) -> Outcome {
    let mut found = Vec::new();
    below(&options.folder, &mut found)?;
    found.sort();
    let mut lines = String::new();
    for path in found {
        let bytes = input::image(&path).map_err(files(&path, "read"))?;
        let ending = path.extension().and_then(|ending| ending.to_str()).unwrap_or_default();
        let numbers = numbers(ending, bytes).with_context(|| format!("cannot decode {}", path.display()));
        let numbers = numbers.map_err(Failure::Input)?;
        if let Some(numbers) = numbers {
            let name = path.strip_prefix(&options.folder).unwrap_or(&path);
            let _ = writeln!(lines, "{}  {}", sha256(&numbers), label(name));
        }
    }
    print(&lines)
}

/// The numbers in a file: format, size and device bytes of a texture, size and values of an image, words of a material buffer. `None` for other
/// files.
fn numbers(ending: &str, bytes: Vec<u8>) -> Result<Option<Vec<u8>>, TextureError> {
    Ok(Some(match ending {
        "ktx2" => {
            let texture = ktx2::decode(&bytes)?;
            let head = format!("{} {}x{}\n", texture.format.name(), texture.width, texture.height);
            [head.as_bytes(), &texture.bytes].concat()
        }
        "exr" => values(&exr::decode(&bytes)?.0),
        "png" => values(&png::decode(&bytes)?),
        "bin" => bytes,
        _ => return Ok(None),
    }))
}

fn values(image: &Image) -> Vec<u8> {
    let mut bytes = format!("{}x{} {}\n", image.width, image.height, image.channels).into_bytes();
    bytes.extend(image.data.iter().flat_map(|value| value.to_le_bytes()));
    bytes
}

/// The files below a folder, without hidden ones.
fn below(folder: &Path, found: &mut Vec<PathBuf>) -> Outcome {
    for entry in std::fs::read_dir(folder).map_err(files(folder, "list"))? {
        let path = entry.map_err(files(folder, "list"))?.path();
        if path.file_name().is_some_and(|name| name.to_string_lossy().starts_with('.')) {
            continue;
        }
        if path.is_dir() { below(&path, found)? } else { found.push(path) }
    }
    Ok(())
}
