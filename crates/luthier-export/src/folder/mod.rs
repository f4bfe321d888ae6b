//! Reads the folder of a bake; no other code does.

use std::fs::File;
use std::io::Read;
use std::path::{Component, Path, PathBuf};

use luthier_lut::{Image, Picture, TableKind};
use luthier_manifest::{FileEntry, Manifest, MapEntry, TableEntry, Target};
use luthier_texture::{Texture, ktx2, picture};
use sha2::{Digest, Sha256};

use crate::publish::{self, READY};
use crate::{MANIFEST, MAX_FILE_BYTES, Map, Package, PackageError, Shader, Table};

/// A bake in its folder. Everything is checked before it is used: the schema of the manifest, that files are regular and inside the folder, their
/// sizes and hashes, and that texels match the manifest.
///
/// ```
/// use luthier_export::{Encoded, Folder, GENERATOR, PackageError};
/// use luthier_manifest::{FileEntry, Manifest};
///
/// let folder = tempfile::tempdir()?;
/// let manifest = Manifest::new(GENERATOR, Vec::new(), Vec::new());
/// Encoded { manifest, files: Vec::new() }.write(folder.path())?;
/// let bake = Folder::open(folder.path())?;
/// assert_eq!(bake.manifest().generator, GENERATOR);
/// let secret = FileEntry { path: "../secret".to_owned(), sha256: String::new() };
/// assert!(matches!(bake.read(&secret), Err(PackageError::Outside { .. })));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Folder {
    /// Path without links, so that a file's place can be compared with it.
    root: PathBuf,
    /// Path as it was named, for messages.
    named: PathBuf,
    manifest: Manifest,
    sha256: String,
}

impl Package {
    /// Reads the bake in a folder: its manifest, tables, shaders in WGSL, and maps. While luthier publishes into the folder, this waits.
    ///
    /// # Errors
    /// [`PackageError`] when a file is missing, damaged, from another bake or outside the folder; those of [`Package::from_parts`].
    pub fn read(folder: &Path) -> Result<Self, PackageError> {
        let _lock = publish::shared(folder);
        Folder::open(folder)?.package()
    }
}

impl Folder {
    /// Reads the manifest of a folder.
    ///
    /// # Errors
    /// [`PackageError`], with [`PackageError::NoBake`] where there is no manifest.
    pub fn open(folder: &Path) -> Result<Self, PackageError> {
        let named = folder.to_owned();
        let path = [folder.join(READY).join(MANIFEST), folder.join(MANIFEST)].into_iter().find(|path| path.exists());
        let (Some(path), Ok(root)) = (path, folder.canonicalize()) else {
            return Err(PackageError::NoBake { folder: named });
        };
        let bytes = regular(&root, &path, MANIFEST)?;
        let text = std::str::from_utf8(&bytes).map_err(|_| PackageError::Text { path: path.clone() })?;
        let manifest = Manifest::from_json(text).map_err(|source| PackageError::Manifest { path, source })?;
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
    /// [`PackageError::Outside`] for a path that leaves the folder, by its words or through a link, [`PackageError::NotAFile`],
    /// [`PackageError::TooLarge`], [`PackageError::Read`], [`PackageError::Hash`].
    pub fn read(&self, entry: &FileEntry) -> Result<Vec<u8>, PackageError> {
        let relative = Path::new(&entry.path);
        if entry.path.is_empty() || !relative.components().all(|c| matches!(c, Component::Normal(_))) {
            return Err(PackageError::Outside { path: entry.path.clone() });
        }
        let path = self.named.join(relative);
        let bytes = self.bytes(&path, &entry.path)?;
        let found = hex(&bytes);
        if !found.eq_ignore_ascii_case(&entry.sha256) {
            return Err(PackageError::Hash { path, found, expected: entry.sha256.clone() });
        }
        Ok(bytes)
    }

    /// A text of the bake.
    ///
    /// # Errors
    /// As [`Folder::read`], and [`PackageError::Text`].
    pub fn text(&self, entry: &FileEntry) -> Result<String, PackageError> {
        String::from_utf8(self.read(entry)?).map_err(|_| PackageError::Text { path: self.named.join(&entry.path) })
    }

    /// The texels of a table as they ship.
    ///
    /// # Errors
    /// As [`Folder::read`], [`PackageError::Texture`], and [`PackageError::Manifest`] where they are not those of the entry.
    pub fn texture(&self, table: &TableEntry) -> Result<Texture, PackageError> {
        let bytes = self.read(&table.texture)?;
        let path = self.named.join(&table.texture.path);
        let texture = ktx2::decode(&bytes).map_err(|source| PackageError::Texture { path, source })?;
        let Texture { format, width, height, bytes } = &texture;
        let checked = table.check([*width, *height], *format, bytes.len());
        checked.map_err(|source| PackageError::Manifest { path: self.named.join(MANIFEST), source })?;
        Ok(texture)
    }

    /// The texels of all tables, as a shader reads them.
    ///
    /// # Errors
    /// As [`Folder::texture`], and [`PackageError::Texels`].
    pub fn textures(&self) -> Result<Vec<(TableKind, Image)>, PackageError> {
        self.manifest.tables.iter().map(|table| Ok((table.kind, self.texture(table)?.image()?))).collect()
    }

    /// A map of a material: its file, and its texels.
    ///
    /// # Errors
    /// As [`Folder::read`], [`PackageError::Texture`], and [`PackageError::MapSize`].
    pub fn map(&self, map: &MapEntry) -> Result<(Vec<u8>, Picture), PackageError> {
        let path = self.named.join(&map.file.path);
        let bytes = self.read(&map.file)?;
        let decoded = picture::decode(&bytes).map_err(|source| PackageError::Texture { path: path.clone(), source })?;
        let picture = Picture { is_srgb: map.srgb, ..decoded.picture };
        let (found, expected) = (picture.size(), [map.width, map.height]);
        if found == expected { Ok((bytes, picture)) } else { Err(PackageError::MapSize { path, found, expected }) }
    }

    /// Everything that a renderer needs: tables, shaders in WGSL, maps.
    ///
    /// # Errors
    /// Those of the other functions, and of [`Package::from_parts`].
    pub fn package(&self) -> Result<Package, PackageError> {
        let manifest = &self.manifest;
        let tables = manifest.tables.iter().map(|t| Ok(Table { kind: t.kind, texture: self.texture(t)?, truth: None }));
        let tables = tables.collect::<Result<_, PackageError>>()?;
        let texts = manifest.shaders.iter().filter(|s| s.target == Target::Wgsl);
        let shaders = texts
            .map(|entry| {
                let read = Shader::wgsl(entry.form, self.text(&entry.file)?);
                let interface = entry.interface.clone().unwrap_or(read.interface);
                Ok(Shader { interface, checks: entry.checks.clone(), ..read })
            })
            .collect::<Result<_, PackageError>>()?;
        let mut package = Package::from_parts(manifest.clone(), tables, shaders)?;
        for (material, entry) in (0..).zip(&manifest.materials) {
            for map in &entry.maps {
                let (png, picture) = self.map(map)?;
                package.maps.push(Map { material, slot: map.slot, layer: map.layer, picture, png });
            }
        }
        Ok(package)
    }

    /// The bytes of a file. An interrupted publication may have left it among the files that are ready.
    fn bytes(&self, path: &Path, named: &str) -> Result<Vec<u8>, PackageError> {
        let ready = self.named.join(READY).join(named);
        regular(&self.root, if ready.exists() { &ready } else { path }, named)
    }
}

/// The bytes of a regular file that lies inside a folder after links are followed.
fn regular(root: &Path, path: &Path, named: &str) -> Result<Vec<u8>, PackageError> {
    let unreadable = |source| PackageError::Read { path: path.to_owned(), source };
    let target = path.canonicalize().map_err(unreadable)?;
    if !target.starts_with(root) {
        return Err(PackageError::Outside { path: named.to_owned() });
    }
    // This comes before opening, because opening a pipe waits for its writer.
    let metadata = target.metadata().map_err(unreadable)?;
    if !metadata.is_file() {
        return Err(PackageError::NotAFile { path: path.to_owned() });
    }
    if metadata.len() > MAX_FILE_BYTES {
        return Err(PackageError::TooLarge { path: path.to_owned() });
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
