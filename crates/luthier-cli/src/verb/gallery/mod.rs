//! `gallery`: many materials side by side, as a page or as a picture.

mod page;
#[cfg(feature = "gpu")]
mod scene;
#[cfg(feature = "gpu")]
mod sheet;

use luthier_terminal::{Failure, Outcome};

use crate::cli::GalleryOptions;
use crate::meshes::scene_file::is_scene;

/// Writes a page or a contact sheet.
pub(crate) fn run(options: &GalleryOptions) -> Outcome {
    let paths = &options.sources.paths;
    if let Some(scene) = paths.iter().find(|path| is_scene(&path.to_string_lossy())) {
        #[cfg(feature = "gpu")]
        if let (Some(output), [_]) = (&options.output, paths.as_slice()) {
            return scene::write(options, scene, output);
        }
        return Err(Failure::Usage(anyhow::anyhow!(
            "{} is a glTF file, which has a sheet of its own, by -o; a page, or a sheet of several, takes the material files that `luthier import` writes",
            scene.display()
        )));
    }
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
