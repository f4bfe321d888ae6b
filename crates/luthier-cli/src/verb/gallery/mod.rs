//! `gallery`: many materials side by side, as a page or as a picture.

mod page;
#[cfg(feature = "gpu")]
mod sheet;

use luthier_terminal::Outcome;

use crate::cli::GalleryOptions;

/// Writes a page or a contact sheet.
pub(crate) fn run(options: &GalleryOptions) -> Outcome {
    #[cfg(feature = "gpu")]
    if let Some(output) = &options.output {
        return sheet::write(options, output);
    }
    match &options.html {
        Some(html) => page::write(options, html),
        // The definition of the command line requires one of them.
        None => Ok(()),
    }
}
