//! A bake read back from its folder.

use std::path::Path;

use luthier_lut::{Image, TableKind};
use luthier_texture::{BakeFolder, FolderError};

use crate::failure::{Failure, Outcome};

/// The bake in a folder.
pub(crate) fn open(folder: &Path) -> Outcome<BakeFolder> {
    BakeFolder::open(folder).map_err(unusable)
}

/// The texels of all tables, as a shader reads them.
pub(crate) fn textures(folder: &BakeFolder) -> Outcome<Vec<(TableKind, Image)>> {
    let tables = folder.manifest().tables.iter();
    tables
        .map(|table| Ok((table.kind, folder.texture(table).map_err(unusable)?.image().map_err(Failure::input)?)))
        .collect()
}

/// The failure of a bake that cannot be read: a missing file is a matter of files, all else is wrong with the bake.
pub(crate) fn unusable(source: FolderError) -> Failure {
    match source {
        FolderError::NoBake { .. } | FolderError::Read { .. } => Failure::Files(source.into()),
        _ => Failure::Input(source.into()),
    }
}
