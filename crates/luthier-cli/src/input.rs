//! Texts that the command line names.

use std::io::{self, Read};
use std::path::Path;

use luthier_export::input::{self, TEXT_MAX};
use luthier_terminal::{Failure, Outcome, files};

/// A text that the command line names.
pub(crate) fn named_text(path: &Path) -> Outcome<String> {
    input::text(path).map_err(files(path, "read"))
}

/// The text of a file, or of standard input for `-`, and its name in messages.
pub(crate) fn labelled(path: &Path) -> Outcome<(String, String)> {
    if path == Path::new("-") {
        return Ok((standard()?, "standard input".to_owned()));
    }
    Ok((named_text(path)?, path.display().to_string()))
}

/// Standard input, to its end.
fn standard() -> Outcome<String> {
    let mut text = String::new();
    let read = io::stdin().take(TEXT_MAX + 1).read_to_string(&mut text).and_then(|length| {
        if length as u64 > TEXT_MAX {
            Err(io::Error::other(format!("it is larger than {} MiB", TEXT_MAX >> 20)))
        } else {
            Ok(())
        }
    });
    read.map_err(|source| Failure::Files(anyhow::Error::new(source).context("cannot read standard input")))?;
    Ok(text)
}
