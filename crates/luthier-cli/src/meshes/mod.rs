//! Meshes that the command line names.

pub(crate) mod judged;
pub(crate) mod scene_file;

#[cfg(feature = "gpu")]
use std::path::Path;

#[cfg(feature = "gpu")]
use luthier_gpu::Mesh;
#[cfg(feature = "gpu")]
use luthier_terminal::Outcome;

/// Reads a glTF file, with the buffers beside it. Warnings name the parts that pictures do not show.
#[cfg(feature = "gpu")]
pub(crate) fn read(path: &Path) -> Outcome<Mesh> {
    use luthier_export::input;
    use luthier_gpu::soup;
    use luthier_terminal::{Failure, complain, files};

    let bytes = input::mesh(path).map_err(files(path, "read"))?;
    let folder = path.parent().unwrap_or(Path::new(""));
    let unusable =
        |source: luthier_gpu::MeshError| Failure::Input(anyhow::Error::new(source).context(path.display().to_string()));
    let file = soup(&bytes, &|name| input::mesh(&folder.join(name))).map_err(unusable)?;
    if !file.left_out.is_empty() {
        complain(&format!(
            "warning: {} is not shown as it stands in the file: {}",
            path.display(),
            file.left_out.join("; ")
        ));
    }
    Mesh::new(file.soup).map_err(unusable)
}
