//! A bake read back from its folder.

use std::path::{Path, PathBuf};

use luthier_lut::{FileEntry, Image, Manifest, TableKind};
use luthier_texture::ktx2;

use crate::bake_files::{MANIFEST, sha256};
use crate::failure::{Failure, Outcome, files};

/// The manifest of a bake.
pub(crate) fn manifest(folder: &Path) -> Outcome<Manifest> {
    let path = folder.join(MANIFEST);
    if !path.exists() {
        let hint = format!("no bake in {}: run `luthier bake` first", folder.display());
        return Err(Failure::Files(anyhow::anyhow!(hint)));
    }
    let json = std::fs::read(&path).map_err(files(&path, "read"))?;
    let unusable = |source: anyhow::Error| Failure::Input(source.context(path.display().to_string()));
    let json = String::from_utf8(json).map_err(|source| unusable(source.into()))?;
    Manifest::from_json(&json).map_err(|source| unusable(source.into()))
}

/// The texels of all tables, as a shader reads them.
pub(crate) fn textures(folder: &Path, manifest: &Manifest) -> Outcome<Vec<(TableKind, Image)>> {
    manifest
        .tables
        .iter()
        .map(|table| {
            let (path, bytes) = read(folder, &table.texture)?;
            let damaged = |source| Failure::Input(anyhow::Error::new(source).context(path.display().to_string()));
            let image = ktx2::decode(&bytes).and_then(|texture| texture.image()).map_err(damaged)?;
            Ok((table.kind, image))
        })
        .collect()
}

fn read(folder: &Path, entry: &FileEntry) -> Outcome<(PathBuf, Vec<u8>)> {
    let path = folder.join(&entry.path);
    let bytes = std::fs::read(&path).map_err(files(&path, "read"))?;
    if sha256(&bytes) != entry.sha256 {
        let text = format!("{} is not the file that the manifest names; bake again", path.display());
        return Err(Failure::Input(anyhow::anyhow!(text)));
    }
    Ok((path, bytes))
}
