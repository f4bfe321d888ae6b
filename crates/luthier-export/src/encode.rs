//! A package as files.

use std::collections::BTreeMap;
use std::path::Path;

use luthier_lut::{AtlasLayout, Axis, Image, Mapping, RowBase, TableKind, Tile, Values};
use luthier_manifest::{FileEntry, Manifest, ShaderEntry, TableEntry, material_buffer};
use luthier_texture::{Metadata, exr, ktx2, png};
use rayon::prelude::*;

use crate::origins::from_folder;
use crate::{GENERATOR, MANIFEST, Package, PackageError, Shader, Table, publish, sha256};

/// Compression of the texels inside KTX2 files.
///
/// ```
/// use luthier_export::Compression;
///
/// assert_eq!(Compression::default(), Compression::Zstd);
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Compression {
    /// Zstandard, a supercompression scheme of KTX2.
    #[default]
    Zstd,
    /// No compression, for loaders without a decompressor.
    None,
}

/// The files of a package, with their paths relative to the folder, and the manifest that names them by their hashes.
///
/// ```
/// use luthier_export::{Encoded, GENERATOR};
/// use luthier_manifest::Manifest;
///
/// let files = vec![("shaders/baked.wgsl".to_owned(), b"fn shade() {}".to_vec())];
/// let encoded = Encoded { manifest: Manifest::new(GENERATOR, Vec::new(), Vec::new()), files };
/// let folder = tempfile::tempdir()?;
/// assert_eq!(encoded.stale(folder.path())?, ["manifest.json", "shaders/baked.wgsl"]);
/// encoded.write(folder.path())?;
/// assert!(encoded.is_in(folder.path()));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct Encoded {
    /// The manifest.
    pub manifest: Manifest,
    /// All files but the manifest.
    pub files: Vec<(String, Vec<u8>)>,
}

impl Package {
    /// Publishes the package in a folder as `luthier bake` does: with compressed texels, and with paths of sources from the folder. The folder
    /// changes at once or not at all.
    ///
    /// # Errors
    /// Those of [`Package::encode`] and [`Encoded::write`](crate::Encoded::write).
    pub fn write(&self, folder: &Path) -> Result<(), PackageError> {
        self.encode(Compression::Zstd)?.for_folder(folder).write(folder)
    }

    /// Encodes tables (KTX2, their unrounded values as EXR, a picture as PNG), shaders, maps and the material buffer.
    ///
    /// # Errors
    /// [`PackageError::NoTruth`] for a package that was read from a folder; [`PackageError::Texels`].
    pub fn encode(&self, compression: Compression) -> Result<Encoded, PackageError> {
        let mut manifest = self.manifest.clone();
        let mut files = Files::default();
        let parts = self.tables.iter().flat_map(|table| Part::ALL.map(|part| (table, part))).collect::<Vec<_>>();
        let encoded = parts.par_iter().map(|&(table, part)| self.encode_part(table, part, compression));
        let mut encoded = encoded.collect::<Vec<_>>().into_iter();
        for entry in &mut manifest.tables {
            let TableEntry { kind, texture, truth, picture, .. } = entry;
            for ((part, file), bytes) in Part::ALL.into_iter().zip([texture, truth, picture]).zip(&mut encoded) {
                *file = files.add(format!("tables/{}.{}", kind.name(), part.extension()), bytes?);
            }
        }
        // Materials that have one picture share its file.
        let mut shared: BTreeMap<&[u8], FileEntry> = BTreeMap::new();
        for (entry, map) in manifest.materials.iter_mut().flat_map(|m| &mut m.maps).zip(&self.maps) {
            let file = shared.entry(map.png.as_slice());
            entry.file = file.or_insert_with(|| files.add(entry.file.path.clone(), map.png.clone())).clone();
        }
        let mut words = material_buffer(&manifest.materials);
        words.resize(manifest.material_texture.words(), [0.0; 4]);
        let bytes = words.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        manifest.material_buffer = files.add("materials.bin".to_owned(), bytes);
        manifest.shaders.clear();
        for Shader { form, target, bytes, interface, checks } in &self.shaders {
            let file = files.add(format!("shaders/{form}.{}", target.extension()), bytes.clone());
            let (target, form, interface) = (*target, *form, Some(interface.clone()));
            let materials = manifest.partial(form);
            manifest.shaders.push(ShaderEntry { target, form, file, materials, interface, checks: checks.clone() });
        }
        Ok(Encoded { manifest, files: files.0 })
    }

    /// A file of a table.
    fn encode_part(&self, table: &Table, part: Part, compression: Compression) -> Result<Vec<u8>, PackageError> {
        let kind = table.kind;
        let (Some(truth), Some(entry)) = (&table.truth, self.manifest.table(kind)) else {
            return Err(PackageError::NoTruth { kind });
        };
        // Thickness without slopes has one of the kind's four channels.
        let channels = if truth.channels == 1 { &["Y"] } else { kind.facts().channels };
        Ok(match (part, compression) {
            (Part::Texture, Compression::Zstd) => ktx2::encode(&table.texture)?,
            (Part::Texture, Compression::None) => ktx2::encode_plain(&table.texture)?,
            (Part::Truth, _) => exr::encode(truth, channels, &metadata(entry))?,
            (Part::Picture, _) => png::encode_image(&picture(kind, truth))?,
        })
    }
}

/// The files of a table.
#[derive(Debug, Clone, Copy)]
enum Part {
    /// Texels as devices read them.
    Texture,
    /// Values before they were rounded.
    Truth,
    /// A picture for people.
    Picture,
}

impl Part {
    const ALL: [Self; 3] = [Self::Texture, Self::Truth, Self::Picture];

    fn extension(self) -> &'static str {
        match self {
            Self::Texture => "ktx2",
            Self::Truth => "exr",
            Self::Picture => "png",
        }
    }
}

impl Encoded {
    /// Makes the manifest name source files by their paths from a folder.
    #[must_use]
    pub fn for_folder(mut self, folder: &Path) -> Self {
        let manifest = &mut self.manifest;
        let materials = manifest.materials.iter_mut().map(|material| &mut material.source);
        let surfaces = manifest.surfaces.iter_mut().map(|surface| &mut surface.source);
        let scene = manifest.choice.iter_mut().map(|choice| &mut choice.source);
        materials.chain(surfaces).chain(scene).for_each(|source| *source = from_folder(folder, source));
        self
    }

    /// Gives files names with the hashes of their contents before the extension: `tables/fresnel.0123456789abcdef.ktx2`. The manifest keeps its name,
    /// so its replacement alone switches from one bake to the next.
    #[must_use]
    pub fn with_hashed_names(mut self) -> Self {
        let entries = self.manifest.files_mut();
        let renamed: BTreeMap<String, String> = entries
            .map(|entry| {
                let name = publish::hashed(&entry.path, &entry.sha256);
                (std::mem::replace(&mut entry.path, name.clone()), name)
            })
            .collect();
        for (path, _) in &mut self.files {
            if let Some(name) = renamed.get(path) {
                path.clone_from(name);
            }
        }
        self
    }

    /// Publishes all files in a folder at once, see [`publish`](crate::publish()).
    ///
    /// # Errors
    /// [`PackageError::Write`], [`PackageError::Table`].
    pub fn write(&self, folder: &Path) -> Result<(), PackageError> {
        let manifest = self.manifest.to_json()?;
        let mut files: Vec<(&str, &[u8])> =
            self.files.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice())).collect();
        files.push((MANIFEST, manifest.as_bytes()));
        publish::publish(folder, &files)
    }

    /// True where a folder holds this generation, and no other program has published another since.
    pub fn is_in(&self, folder: &Path) -> bool {
        let manifest = self.manifest.to_json();
        manifest.is_ok_and(|manifest| publish::current(folder, MANIFEST).as_deref() == Some(manifest.as_bytes()))
    }

    /// The files that [`Self::write`] would change in a folder, sorted: files that the folder lacks or has with other bytes, and files that its
    /// manifest names and this one does not.
    ///
    /// # Errors
    /// [`PackageError::Table`] for a manifest that is no JSON.
    pub fn stale(&self, folder: &Path) -> Result<Vec<String>, PackageError> {
        let manifest = self.manifest.to_json()?;
        let files = self.files.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice()));
        let all: BTreeMap<&str, &[u8]> = files.chain([(MANIFEST, manifest.as_bytes())]).collect();
        let others = all.iter().filter(|(path, bytes)| publish::current(folder, path).as_deref() != Some(**bytes));
        let mut stale: Vec<String> = others.map(|(path, _)| (*path).to_owned()).collect();
        stale.extend(publish::named(folder).into_iter().filter(|path| !all.contains_key(path.as_str())));
        stale.sort();
        Ok(stale)
    }
}

/// Files by their paths.
#[derive(Default)]
struct Files(Vec<(String, Vec<u8>)>);

impl Files {
    fn add(&mut self, path: String, bytes: Vec<u8>) -> FileEntry {
        let entry = FileEntry { path: path.clone(), sha256: sha256(&bytes) };
        self.0.push((path, bytes));
        entry
    }
}

/// Metadata of the unquantised values of a table.
fn metadata(table: &TableEntry) -> Metadata {
    let AtlasLayout { x, y, apron, columns, tiles, base } = &table.layout;
    let hashes = lines(table, |tile| &tile.input_hash);
    let mut pairs = vec![
        ("generator", GENERATOR.to_owned()),
        ("table", table.kind.name().to_owned()),
        ("model", lines(table, |tile| &tile.model)),
        ("axis.x", axis(x)),
        ("tile.names", lines(table, |tile| &tile.name)),
        ("tile.count", tiles.to_string()),
        ("tile.columns", columns.to_string()),
        ("tile.apron", apron.to_string()),
        ("texel.format", table.format.name().to_owned()),
        ("input.sha256", sha256(hashes.as_bytes())),
    ];
    if let Some(y) = y {
        pairs.push(("axis.y", axis(y)));
    }
    if *base == RowBase::Schlick {
        pairs.push(("row.base", "schlick".to_owned()));
    }
    pairs.into_iter().map(|(key, value)| (key.to_owned(), value)).collect()
}

/// A text of each tile of a table, one per line.
fn lines(table: &TableEntry, of: fn(&Tile) -> &String) -> String {
    table.tiles.iter().map(|tile| of(tile).as_str()).collect::<Vec<_>>().join("\n")
}

fn axis(axis: &Axis) -> String {
    let Axis { quantity, unit, min, max, size, mapping } = axis;
    let mapping = match mapping {
        Mapping::Linear => "linear".to_owned(),
        Mapping::Power { exponent } => format!("power {exponent}"),
        Mapping::Rational { bend } => format!("rational {bend}"),
        Mapping::Logarithmic => "logarithmic".to_owned(),
        Mapping::Periodic => "periodic".to_owned(),
        Mapping::Apart => "apart".to_owned(),
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("{quantity}: {min} to {max}{unit}, {size} nodes, {mapping}")
}

/// A picture of a table for people: its first three channels, brought into 0..1 where they are signed.
fn picture(kind: TableKind, truth: &Image) -> Image {
    let channels = truth.channels.min(3);
    let mut data = Vec::with_capacity(truth.texel_count() * channels as usize);
    for texel in truth.texels() {
        for &value in &texel[..channels as usize] {
            data.push(if kind.facts().values == Values::Signed { 0.25 * value + 0.5 } else { value });
        }
    }
    Image { width: truth.width, height: truth.height, channels, data }
}
