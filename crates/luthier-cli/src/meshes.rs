//! Meshes that the command line names.

use std::path::Path;

use luthier_export::input;
use luthier_gpu::{Mesh, soup};
use luthier_terminal::{Failure, Outcome, complain, files};

/// Reads a glTF file, with the buffers beside it. Warnings name the parts that pictures do not show.
pub(crate) fn read(path: &Path) -> Outcome<Mesh> {
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
