use std::fs::File;
use std::io::{self, Read};
use std::path::{Component, Path, PathBuf};

use luthier_lut::Image;
use luthier_manifest::{FileEntry, Manifest, ManifestError, MapEntry, TableEntry};
use sha2::{Digest, Sha256};
use thiserror::Error;

use crate::{MAX_BYTES, Texture, TextureError, ktx2, png};

/// File name of the manifest.
pub const MANIFEST: &str = "manifest.json";

/// Most bytes of any file of a bake: the texels of the largest texture, and as much again for what is around them.
pub const MAX_FILE_BYTES: u64 = 2 * MAX_BYTES;

/// A bake in its folder, of which nothing is believed before it is checked: the manifest's schema, that files are regular ones within the
/// folder, their sizes and hashes, and that texels are those that the manifest describes.
#[derive(Debug, Clone, PartialEq)]
pub struct BakeFolder {
    /// Path without links, so that a file's place can be compared with it.
    root: PathBuf,
    /// Path as it was named, for messages.
    named: PathBuf,
    manifest: Manifest,
    sha256: String,
}

/// Why a bake cannot be read from its folder.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum FolderError {
    /// A folder without a manifest.
    #[error("no bake in {}: run `luthier bake` first", folder.display())]
    NoBake {
        /// The folder.
        folder: PathBuf,
    },
    /// A file cannot be read.
    #[error("cannot read {}: {source}", path.display())]
    Read {
        /// The file.
        path: PathBuf,
        /// Error of the system.
        source: io::Error,
    },
    /// The manifest names a file outside its own folder.
    #[error("the manifest names `{path}`, which is not a path inside its folder")]
    Outside {
        /// Path as in the manifest.
        path: String,
    },
    /// A folder, a pipe or a device where a file is expected.
    #[error("{} is not a regular file", path.display())]
    NotAFile {
        /// The path.
        path: PathBuf,
    },
    /// A file larger than any of a bake.
    #[error("{} has more than {} MiB, the most that a file of a bake may have", path.display(), MAX_FILE_BYTES >> 20)]
    TooLarge {
        /// The file.
        path: PathBuf,
    },
    /// A file is not the one that the manifest describes.
    #[error(
        "{} is not the file that the manifest describes (SHA-256 {found}, manifest {expected}); bake again",
        path.display()
    )]
    Hash {
        /// The file.
        path: PathBuf,
        /// Hash of its bytes, hex.
        found: String,
        /// Hash in the manifest, hex.
        expected: String,
    },
    /// The manifest is not one, or contradicts a texture.
    #[error("{}: {source}", path.display())]
    Manifest {
        /// The file.
        path: PathBuf,
        /// Fault of the manifest.
        source: ManifestError,
    },
    /// A texture or a map cannot be decoded.
    #[error("{}: {source}", path.display())]
    Texture {
        /// The file.
        path: PathBuf,
        /// Fault of the texture or map.
        source: TextureError,
    },
    /// A map of another size than the manifest says.
    #[error("{} is {} x {}; the manifest says {} x {}", path.display(), found[0], found[1], expected[0], expected[1])]
    MapSize {
        /// The file.
        path: PathBuf,
        /// Size of the image.
        found: [u32; 2],
        /// Size in the manifest.
        expected: [u32; 2],
    },
    /// A text is not UTF-8.
    #[error("{} is not UTF-8 text", path.display())]
    Text {
        /// The file.
        path: PathBuf,
    },
}

impl BakeFolder {
    /// Reads the manifest of a folder.
    ///
    /// # Errors
    /// [`FolderError`], with [`FolderError::NoBake`] where there is no manifest.
    pub fn open(folder: &Path) -> Result<Self, FolderError> {
        let named = folder.to_owned();
        let path = folder.join(MANIFEST);
        let root = match folder.canonicalize() {
            Ok(root) if path.exists() => root,
            _ => return Err(FolderError::NoBake { folder: named }),
        };
        let bytes = regular(&root, &path, MANIFEST)?;
        let unusable = |source| FolderError::Manifest { path: path.clone(), source };
        let text = std::str::from_utf8(&bytes).map_err(|_| FolderError::Text { path: path.clone() })?;
        let manifest = Manifest::from_json(text).map_err(unusable)?;
        Ok(Self { root, named, manifest, sha256: hex(&bytes) })
    }

    /// The manifest of the bake.
    pub fn manifest(&self) -> &Manifest {
        &self.manifest
    }

    /// SHA-256 of the manifest, hex.
    pub fn sha256(&self) -> &str {
        &self.sha256
    }

    /// The bytes of a file of the bake.
    ///
    /// # Errors
    /// [`FolderError::Outside`] for a path that leaves the folder, by its words or through a link, [`FolderError::NotAFile`],
    /// [`FolderError::TooLarge`], [`FolderError::Read`], [`FolderError::Hash`].
    pub fn read(&self, entry: &FileEntry) -> Result<Vec<u8>, FolderError> {
        let relative = Path::new(&entry.path);
        if entry.path.is_empty() || !relative.components().all(|c| matches!(c, Component::Normal(_))) {
            return Err(FolderError::Outside { path: entry.path.clone() });
        }
        let path = self.named.join(relative);
        let bytes = regular(&self.root, &path, &entry.path)?;
        let found = hex(&bytes);
        if !found.eq_ignore_ascii_case(&entry.sha256) {
            return Err(FolderError::Hash { path, found, expected: entry.sha256.clone() });
        }
        Ok(bytes)
    }

    /// A text of the bake.
    ///
    /// # Errors
    /// As [`BakeFolder::read`], and [`FolderError::Text`].
    pub fn text(&self, entry: &FileEntry) -> Result<String, FolderError> {
        String::from_utf8(self.read(entry)?).map_err(|_| FolderError::Text { path: self.named.join(&entry.path) })
    }

    /// The texels of a table as they ship.
    ///
    /// # Errors
    /// As [`BakeFolder::read`], [`FolderError::Texture`], and [`FolderError::Manifest`] where they are not those of the entry.
    pub fn texture(&self, table: &TableEntry) -> Result<Texture, FolderError> {
        let path = || self.named.join(&table.texture.path);
        let bytes = self.read(&table.texture)?;
        let texture = ktx2::decode(&bytes).map_err(|source| FolderError::Texture { path: path(), source })?;
        let Texture { format, width, height, bytes } = &texture;
        let checked = table.check([*width, *height], *format, bytes.len());
        checked.map_err(|source| FolderError::Manifest { path: self.named.join(MANIFEST), source })?;
        Ok(texture)
    }

    /// A map of a material: RGBA, linear.
    ///
    /// # Errors
    /// As [`BakeFolder::read`], [`FolderError::Texture`], and [`FolderError::MapSize`].
    pub fn map(&self, map: &MapEntry) -> Result<Image, FolderError> {
        let path = || self.named.join(&map.file.path);
        let bytes = self.read(&map.file)?;
        let image = png::decode(&bytes).map_err(|source| FolderError::Texture { path: path(), source })?;
        let (found, expected) = ([image.width, image.height], [map.width, map.height]);
        if found == expected { Ok(image) } else { Err(FolderError::MapSize { path: path(), found, expected }) }
    }
}

/// The bytes of a regular file that lies within a folder, wherever links lead.
fn regular(root: &Path, path: &Path, named: &str) -> Result<Vec<u8>, FolderError> {
    let unreadable = |source| FolderError::Read { path: path.to_owned(), source };
    let target = path.canonicalize().map_err(unreadable)?;
    if !target.starts_with(root) {
        return Err(FolderError::Outside { path: named.to_owned() });
    }
    // Asked before it is opened: opening a pipe waits for its writer.
    let metadata = target.metadata().map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(FolderError::NotAFile { path: path.to_owned() });
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(FolderError::TooLarge { path: path.to_owned() });
    }
    let mut bytes = Vec::new();
    File::open(&target).and_then(|file| file.take(MAX_FILE_BYTES).read_to_end(&mut bytes)).map_err(unreadable)?;
    Ok(bytes)
}

fn hex(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

#[cfg(test)]
mod tests;
