//! A bake as files: textures, truth, pictures, shaders, manifest.

use luthier_bake::{Bake, MapSource, Options};
use luthier_lut::{Atlas, AtlasLayout, Axis, Image, Mapping, RowBase, TableKind};
use luthier_manifest::{
    FileEntry, LayerRecord, Manifest, MapEntry, MaterialEntry, MaterialTexture, ShaderEntry, TableEntry,
    material_buffer,
};
use luthier_material::Material;
use luthier_shader::{Form, MaterialSet, Target};
use luthier_texture::{Metadata, Texture, exr, ktx2, png};
use rayon::prelude::*;
use sha2::{Digest, Sha256};

use crate::failure::{Failure, Outcome};
use crate::input;
use crate::materials::{beside, read_image};

pub(crate) use luthier_texture::MANIFEST;

/// Program and version, as files and reports name it.
pub(crate) const GENERATOR: &str = concat!("luthier ", env!("CARGO_PKG_VERSION"));

/// The shaders that a bake writes.
#[derive(Debug, Clone)]
pub(crate) struct Shaders {
    pub(crate) targets: Vec<Target>,
    pub(crate) forms: Vec<Form>,
}

impl Default for Shaders {
    fn default() -> Self {
        Self { targets: vec![Target::Wgsl, Target::Glsl450, Target::GlslEs300], forms: Form::ALL.to_vec() }
    }
}

/// Folder of the report beside the manifest.
pub(crate) const REPORT_FOLDER: &str = "report";

/// The report: for programs, for pull requests, and for people.
pub(crate) const REPORT_FILES: [&str; 3] = ["report/report.json", "report/report.md", "report/index.html"];

/// All files of a bake but the manifest, with their paths relative to it.
pub(crate) struct BakeFiles {
    pub(crate) manifest: Manifest,
    pub(crate) files: Vec<(String, Vec<u8>)>,
}

impl BakeFiles {
    /// Encodes tables, emits and validates shaders, and describes it all in the manifest. The bindings are those of the first form.
    pub(crate) fn new(materials: &[Material], bake: &Bake, shaders: &Shaders) -> Outcome<Self> {
        let mut files = Vec::new();
        let mut tables = Vec::new();
        let encoded: Vec<EncodedTable> = bake.atlases.par_iter().map(encode).collect::<Outcome<_>>()?;
        for (atlas, table) in bake.atlases.iter().zip(encoded) {
            let [texture, truth, picture] = [("ktx2", table.texture), ("exr", table.truth), ("png", table.picture)]
                .map(|(extension, bytes)| add(&mut files, format!("tables/{}.{extension}", atlas.kind.name()), bytes));
            tables.push(TableEntry { texture, truth, picture, ..table_entry(atlas) });
        }
        let entries = material_entries(materials, &bake.materials, &mut files)?;
        let mut manifest = Manifest { searches: bake.searches.clone(), ..Manifest::new(GENERATOR, entries, tables) };
        let mut words = material_buffer(&manifest.materials);
        manifest.material_texture = MaterialTexture::of(words.len());
        words.resize(manifest.material_texture.words(), [0.0; 4]);
        let bytes = words.as_flattened().iter().flat_map(|value| value.to_le_bytes()).collect();
        manifest.material_buffer = add(&mut files, "materials.bin".to_owned(), bytes);
        let set = MaterialSet::from_manifest(&manifest);
        let wanted = shaders.forms.iter().flat_map(|&form| shaders.targets.iter().map(move |&target| (form, target)));
        let emitted: Vec<(Form, Target, Vec<u8>)> = wanted
            .collect::<Vec<_>>()
            .into_par_iter()
            .map(|(form, target)| {
                let bytes = match target {
                    Target::SpirV => luthier_shader::emit_spirv(&set, form),
                    _ => luthier_shader::emit(&set, form, target).map(String::into_bytes),
                };
                Ok((form, target, bytes.map_err(Failure::input)?))
            })
            .collect::<Outcome<_>>()?;
        let mut entries = Vec::with_capacity(emitted.len());
        for (form, target, bytes) in emitted {
            let file = add(&mut files, format!("shaders/{}.{}", form.name(), target.extension()), bytes);
            entries.push(ShaderEntry { target, form, file });
        }
        let bindings = luthier_shader::bindings(&set, shaders.forms.first().copied().unwrap_or(Form::Baked));
        (manifest.shaders, manifest.bindings) = (entries, bindings);
        Ok(Self { manifest, files })
    }

    /// The files of a bake without tables, for the form `full`: nothing to read but the material buffer.
    pub(crate) fn without_tables(materials: &[Material], shaders: &Shaders) -> Outcome<Self> {
        let options = Options { search: false, ..Options::default() };
        let mut outline = luthier_bake::outline_with(materials, &options, &read_image).map_err(Failure::input)?;
        for material in &mut outline.materials {
            let bare = material.constants.patina.as_mut().map(|patina| &mut patina.bare);
            for record in material.records.iter_mut().chain(bare) {
                *record = LayerRecord {
                    fresnel_tile: None,
                    distribution_tile: None,
                    fgd_tile: None,
                    phase_tile: None,
                    thickness_tile: None,
                    film_tile: None,
                    escape_tile: None,
                    ..record.clone()
                };
            }
        }
        let bake = Bake { atlases: Vec::new(), materials: outline.materials, searches: Vec::new() };
        Self::new(materials, &bake, shaders)
    }
}

impl BakeFiles {
    /// The files with the texels of the textures uncompressed.
    pub(crate) fn without_zstd(&self) -> Outcome<Self> {
        let (mut manifest, mut files) = (self.manifest.clone(), self.files.clone());
        for texture in manifest.tables.iter_mut().map(|table| &mut table.texture) {
            for (_, bytes) in files.iter_mut().filter(|(path, _)| *path == texture.path) {
                let decoded = ktx2::decode(bytes).map_err(Failure::input)?;
                *bytes = ktx2::encode_plain(&decoded).map_err(Failure::input)?;
                texture.sha256 = sha256(bytes);
            }
        }
        Ok(Self { manifest, files })
    }
}

/// The manifest's entry of a table, but for its files.
pub(crate) fn table_entry(atlas: &Atlas) -> TableEntry {
    let [width, height] = atlas.layout.size();
    TableEntry {
        kind: atlas.kind,
        layout: atlas.layout.clone(),
        format: atlas.format,
        texel_bytes: u64::from(width) * u64::from(height) * u64::from(atlas.format.texel_bytes()),
        texture: FileEntry::default(),
        truth: FileEntry::default(),
        picture: FileEntry::default(),
        tiles: atlas.tiles.clone(),
    }
}

/// The manifest's entries of the materials; the maps are added to `files`.
pub(crate) fn material_entries(
    materials: &[Material],
    baked: &[luthier_bake::BakedMaterial],
    files: &mut Vec<(String, Vec<u8>)>,
) -> Outcome<Vec<MaterialEntry>> {
    let mut entries = Vec::with_capacity(materials.len());
    for (material, baked) in materials.iter().zip(baked) {
        entries.push(MaterialEntry {
            name: material.name.clone(),
            source: material.source.clone(),
            source_hash: source_hash(material)?,
            class: material.class.letter().to_string(),
            model: baked.model,
            color: baked.color,
            wavelengths_nm: material.bake.wavelengths_nm(),
            constants: baked.constants.clone(),
            layers: baked.records.clone(),
            maps: baked.maps.iter().map(|map| self::map(material, map, files)).collect::<Outcome<_>>()?,
        });
    }
    Ok(entries)
}

/// A map as it ships: an image as it is, noise as a grey PNG.
fn map(material: &Material, map: &luthier_bake::MaterialMap, files: &mut Vec<(String, Vec<u8>)>) -> Outcome<MapEntry> {
    let label = map.source.label();
    let unusable = |error: anyhow::Error| Failure::Input(error.context(format!("{}: map {label}", material.source)));
    let bytes = match &map.source {
        MapSource::File(path) => named_file(material, path)?,
        MapSource::Noise { .. } => {
            let texels = map.source.texels().unwrap_or_else(|| Image::zeros(1, 1, 1));
            png::encode_gray(&texels).map_err(|source| unusable(source.into()))?
        }
    };
    let Image { width, height, .. } = png::decode(&bytes).map_err(|source| unusable(source.into()))?;
    let layer = map.layer.map_or_else(String::new, |layer| format!("-{layer}"));
    let file = add(files, format!("maps/{}-{}{layer}.png", material.name, map.slot.name()), bytes);
    Ok(MapEntry { slot: map.slot, layer: map.layer, source: label, file, width, height })
}

/// A file that a material names.
fn named_file(material: &Material, path: &str) -> Outcome<Vec<u8>> {
    let path = beside(&material.source, path);
    input::image(&path).map_err(crate::failure::files(&path, "read"))
}

/// The hash of a material file and of all that it names: of its text, followed by the hash of each file, if it names any.
pub(crate) fn source_hash(material: &Material) -> Outcome<String> {
    let mut text = material.text.clone();
    for path in &material.files {
        text.push_str(&sha256(&named_file(material, path)?));
    }
    Ok(sha256(text.as_bytes()))
}

/// SHA-256 in hex.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

fn add(files: &mut Vec<(String, Vec<u8>)>, path: String, bytes: Vec<u8>) -> FileEntry {
    let entry = FileEntry { path: path.clone(), sha256: sha256(&bytes) };
    files.push((path, bytes));
    entry
}

struct EncodedTable {
    texture: Vec<u8>,
    truth: Vec<u8>,
    picture: Vec<u8>,
}

fn encode(atlas: &Atlas) -> Outcome<EncodedTable> {
    // Thickness without slopes is one channel of the kind's four.
    let channels = if atlas.truth.channels == 1 { &["Y"] } else { atlas.kind.channels() };
    let encoded = || {
        Ok::<_, luthier_texture::TextureError>(EncodedTable {
            texture: ktx2::encode(&Texture::from_atlas(atlas))?,
            truth: exr::encode(&atlas.truth, channels, &metadata(atlas))?,
            picture: png::encode_image(&picture(atlas))?,
        })
    };
    encoded().map_err(Failure::input)
}

/// Metadata of the unquantised values of a table.
fn metadata(atlas: &Atlas) -> Metadata {
    let AtlasLayout { x, y, apron, columns, tiles, base } = &atlas.layout;
    let joined = |f: &dyn Fn(&luthier_lut::Tile) -> String| atlas.tiles.iter().map(f).collect::<Vec<_>>().join("\n");
    let hashes = joined(&|t| t.input_hash.clone());
    let mut pairs = vec![
        ("generator", GENERATOR.to_owned()),
        ("table", atlas.kind.name().to_owned()),
        ("model", joined(&|t| t.model.clone())),
        ("axis.x", axis(x)),
        ("tile.names", joined(&|t| t.name.clone())),
        ("tile.count", tiles.to_string()),
        ("tile.columns", columns.to_string()),
        ("tile.apron", apron.to_string()),
        ("texel.format", atlas.format.name().to_owned()),
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

fn axis(axis: &Axis) -> String {
    let Axis { quantity, unit, min, max, size, mapping } = axis;
    let mapping = match mapping {
        Mapping::Linear => "linear".to_owned(),
        Mapping::Power { exponent } => format!("power {exponent}"),
        Mapping::Rational { bend } => format!("rational {bend}"),
        Mapping::Logarithmic => "logarithmic".to_owned(),
        Mapping::Periodic => "periodic".to_owned(),
    };
    let unit = if unit.is_empty() { String::new() } else { format!(" {unit}") };
    format!("{quantity}: {min} to {max}{unit}, {size} nodes, {mapping}")
}

/// A table as something to look at: its first three channels, brought into 0..1 where they are signed.
fn picture(atlas: &Atlas) -> Image {
    let truth = &atlas.truth;
    let channels = truth.channels.min(3);
    let mut data = Vec::with_capacity(truth.texel_count() * channels as usize);
    for texel in truth.texels() {
        for &value in &texel[..channels as usize] {
            data.push(if atlas.kind == TableKind::Phase { 0.25 * value + 0.5 } else { value });
        }
    }
    Image { width: truth.width, height: truth.height, channels, data }
}
