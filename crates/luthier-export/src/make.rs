//! Packages made from materials.

use std::borrow::Cow;
use std::collections::BTreeMap;
use std::io;
use std::ops::Range;
use std::path::Path;

use luthier_bake::{
    BakeError, BakedMaterial, ImageReader, MapSource, MaterialMap, Missing, Observer, Options, Share, Silent, Store,
    height_normals,
};
use luthier_lut::{Atlas, AtlasLayout, Image, Picture, PictureSamples, TableKind, TexelFormat};
use luthier_manifest::{
    FileEntry, Form, Functions, Manifest, MapEntry, MaterialEntry, MaterialTexture, SurfaceEntry, TableEntry, Target,
    material_buffer,
};
use luthier_material::{Diagnostic, Material};
use luthier_shader::{MaterialSet, ShaderError};
use luthier_texture::{Texture, TextureError, png};
use rayon::prelude::*;
use thiserror::Error;

use crate::{
    GENERATOR, Map, Package, PackageError, Shader, Table, input, of_domain, of_parts, pictures, sha256, sources,
};

/// How a package is made, beside what its materials say. The default is all that `luthier bake` writes.
#[derive(Clone)]
pub struct Bake<'a> {
    /// Limits, formats, whether tables are searched for.
    pub options: Options<'a>,
    /// Languages of the shaders.
    pub targets: Vec<Target>,
    /// Forms of the shaders, or none for all that the models have; with [`Form::Full`] alone the package has no tables.
    pub forms: Vec<Form>,
    /// Groups of functions of each shader.
    pub functions: Functions,
    /// Surfaces of the materials, by their numbers.
    pub surfaces: Vec<SurfaceEntry>,
    /// Told what happens.
    pub observer: &'a dyn Observer,
    /// Whether materials outside the domain of their model are refused; tests at the limits of models take them.
    pub refuses: bool,
}

impl Default for Bake<'_> {
    fn default() -> Self {
        Self {
            options: Options::default(),
            targets: vec![Target::Wgsl, Target::Glsl450, Target::GlslEs300],
            forms: Vec::new(),
            functions: Functions::default(),
            surfaces: Vec::new(),
            observer: &Silent,
            refuses: true,
        }
    }
}

impl Bake<'_> {
    /// A package for a renderer: shaders in WGSL only.
    pub fn wgsl(forms: &[Form]) -> Self {
        Self { targets: vec![Target::Wgsl], forms: forms.to_vec(), ..Self::default() }
    }

    /// The materials as they are baked, and this with the forms that they have.
    fn settled<'m>(&self, materials: &'m [Material]) -> Result<(Cow<'m, [Material]>, Self), ExportError> {
        let is_closed = self.forms.contains(&Form::Full);
        let materials = if is_closed { Cow::Owned(unfitted(materials)) } else { Cow::Borrowed(materials) };
        if self.refuses {
            refuse_foreign(&materials)?;
        }
        let forms = forms(&materials, &self.forms)?;
        Ok((materials, Self { forms, ..self.clone() }))
    }

    /// Computes a share of the jobs of a bake into a store: the bake that follows finds the results there.
    ///
    /// # Errors
    /// [`ExportError`].
    pub fn share(&self, materials: &[Material], store: &dyn Store, share: Share) -> Result<(), ExportError> {
        let (materials, bake) = self.settled(materials)?;
        if bake.forms == [Form::Full] {
            return Ok(());
        }
        Ok(luthier_bake::bake_share(&materials, &bake.options, &pictures::read_image, bake.observer, store, share)?)
    }

    /// The jobs that a bake would run because a store lacks their results.
    ///
    /// # Errors
    /// [`ExportError`].
    pub fn missing(&self, materials: &[Material], store: &dyn Store) -> Result<Missing, ExportError> {
        let (materials, bake) = self.settled(materials)?;
        if bake.forms == [Form::Full] {
            return Ok(Missing { jobs: BTreeMap::new(), is_all: true });
        }
        Ok(luthier_bake::missing(&materials, &bake.options, &pictures::read_image, store)?)
    }
}

impl ExportError {
    /// All that is known of the places in files that it is about.
    pub fn diagnostics(&self) -> &[Diagnostic] {
        match self {
            Self::Refused { diagnostics, .. } | Self::Bake(BakeError::Budget { diagnostics, .. }) => diagnostics,
            _ => &[],
        }
    }
}

/// Why no package came of materials.
#[derive(Debug, Error)]
#[non_exhaustive]
pub enum ExportError {
    /// A file cannot be read, or a folder not listed.
    #[error("cannot {action} {path}: {source}")]
    File {
        /// The action in words.
        action: &'static str,
        /// The file or folder.
        path: String,
        /// Error of the system.
        source: io::Error,
    },
    /// A folder without material files.
    #[error("no *.toml in the folder {folder}")]
    NoFiles {
        /// The folder.
        folder: String,
    },
    /// Materials that are not valid, or outside the domain of their model.
    #[error("{sentence}")]
    Refused {
        /// The refusal in a sentence.
        sentence: String,
        /// All that is wrong.
        diagnostics: Vec<Diagnostic>,
    },
    /// The materials do not go together, or no tables hold their budget.
    #[error(transparent)]
    Bake(#[from] BakeError),
    /// No shader came out.
    #[error(transparent)]
    Shader(#[from] ShaderError),
    /// A map that a material names is no picture.
    #[error("{material}: map {map}: {reason}")]
    Map {
        /// The material file.
        material: String,
        /// The map, as the file names it.
        map: String,
        /// Fault of the picture.
        reason: String,
    },
    /// The parts do not make a package.
    #[error(transparent)]
    Package(#[from] PackageError),
}

impl Package {
    /// Bakes materials: tables as they need, then shaders that read them. Where the form `full` is asked for, materials that name no model
    /// take one of their own that has it ([`unfitted`]). What the store has is not computed again; what is computed goes
    /// into it. Files that materials name are read beside the materials' own files.
    ///
    /// # Errors
    /// [`ExportError`]. The bytes depend on nothing but the arguments and the files.
    pub fn new(materials: &[Material], bake: &Bake<'_>, store: &dyn Store) -> Result<Self, ExportError> {
        let (materials, bake) = &bake.settled(materials)?;
        let read = &pictures::read_image as ImageReader<'_>;
        if bake.forms == [Form::Full] {
            // Without a shader that reads them there are no tables.
            let options = Options { search: false, ..bake.options };
            let mut outline = luthier_bake::outline_with(materials, &options, read, store)?;
            outline.materials.iter_mut().for_each(BakedMaterial::forget_tables);
            return Self::assemble(materials, &outline.materials, Vec::new(), bake);
        }
        let baked = luthier_bake::bake_with(materials, &bake.options, read, bake.observer, store)?;
        let mut package = Self::assemble(materials, &baked.materials, baked.atlases, bake)?;
        package.manifest.searches = baked.searches;
        Ok(package)
    }

    fn assemble(
        materials: &[Material],
        baked: &[BakedMaterial],
        atlases: Vec<Atlas>,
        bake: &Bake<'_>,
    ) -> Result<Self, ExportError> {
        let (entries, maps) = material_entries(materials, baked)?;
        let entry = |atlas: &Atlas| TableEntry {
            tiles: atlas.tiles.clone(),
            ..table_entry(atlas.kind, &atlas.layout, atlas.format)
        };
        let tables = atlases.iter().map(entry).collect();
        let (functions, surfaces) = (bake.functions.clone(), bake.surfaces.clone());
        let manifest = Manifest { functions, surfaces, ..Manifest::new(GENERATOR, entries, tables) };
        let table =
            |atlas: Atlas| Table { kind: atlas.kind, texture: Texture::from_atlas(&atlas), truth: Some(atlas.truth) };
        let tables = atlases.into_iter().map(table).collect();
        let mut package = Self::from_parts(manifest, tables, Vec::new())?;
        package.maps = maps;
        package.emit(&bake.targets, &bake.forms)?;
        Ok(package)
    }

    /// Emits and validates the shaders, and describes what they bind. The bindings are those of the first form.
    fn emit(&mut self, targets: &[Target], forms: &[Form]) -> Result<(), ExportError> {
        let manifest = &mut self.manifest;
        manifest.material_texture = MaterialTexture::of(material_buffer(&manifest.materials).len());
        let set = MaterialSet::from_manifest(manifest);
        let wanted: Vec<(Form, Target)> =
            forms.iter().flat_map(|&form| targets.iter().map(move |&target| (form, target))).collect();
        let shader = |(form, target)| {
            let bytes = match target {
                Target::SpirV => luthier_shader::emit_spirv(&set, form),
                _ => luthier_shader::emit(&set, form, target).map(String::into_bytes),
            };
            Ok(Shader { form, target, bytes: bytes?, interface: luthier_shader::interface(&set, form)? })
        };
        self.shaders = wanted.into_par_iter().map(shader).collect::<Result<_, ShaderError>>()?;
        let bindings = luthier_shader::bindings(&set, forms.first().copied().unwrap_or(Form::Baked));
        manifest.bindings = bindings;
        Ok(())
    }

    /// The package of some of the materials, by their numbers: with all tables, without surfaces, and with shaders for these materials alone.
    ///
    /// # Errors
    /// [`ExportError`].
    pub fn of_materials(&self, numbers: Range<usize>) -> Result<Self, ExportError> {
        let mut package = self.clone();
        package.manifest.materials = self.manifest.materials[numbers.clone()].to_vec();
        package.manifest.surfaces.clear();
        let kept = |map: &Map| numbers.contains(&(map.material as usize));
        package.maps = self.maps.iter().filter(|map| kept(map)).cloned().collect();
        package.maps.iter_mut().for_each(|map| map.material -= numbers.start as u32);
        let (mut targets, mut forms) = (Vec::new(), Vec::new());
        for Shader { form, target, .. } in &self.shaders {
            if !targets.contains(target) {
                targets.push(*target);
            }
            if !forms.contains(form) {
                forms.push(*form);
            }
        }
        // Forms that only others lack.
        let is_new = |form: &Form| !self.manifest.has(*form) && package.manifest.has(*form);
        forms.extend(Form::ALL.into_iter().filter(is_new));
        package.emit(&targets, &forms)?;
        Ok(package)
    }
}

/// The manifest that a bake of these materials would have, without its files: materials, tables without tiles, searches. Takes little
/// computing, unless a material has a budget or lobes, of which the store has what was computed before.
///
/// # Errors
/// [`ExportError`].
pub fn outline(materials: &[Material], options: &Options<'_>, store: &dyn Store) -> Result<Manifest, ExportError> {
    let outline = luthier_bake::outline_with(materials, options, &pictures::read_image, store)?;
    let (entries, _) = material_entries(materials, &outline.materials)?;
    let tables = outline.tables.iter().map(|(kind, layout, format)| table_entry(*kind, layout, *format)).collect();
    Ok(Manifest { searches: outline.searches, ..Manifest::new(GENERATOR, entries, tables) })
}

/// The hash of a material file and of all that it names: of its text, followed by the hash of each file, if it names any.
///
/// # Errors
/// [`ExportError::File`].
pub fn source_hash(material: &Material) -> Result<String, ExportError> {
    let mut text = material.text.clone();
    for path in &material.files {
        text.push_str(&sha256(&named_file(material, path)?));
    }
    Ok(sha256(text.as_bytes()))
}

/// The materials, each of the model that it has where nothing is simulated.
pub fn unfitted(materials: &[Material]) -> Vec<Material> {
    let mut unfitted = materials.to_vec();
    unfitted.iter_mut().for_each(|material| material.bake.model = Some(material.model_without_fit()));
    unfitted
}

/// Refuses materials outside the domain of their model, and parts that their model does not have.
fn refuse_foreign(materials: &[Material]) -> Result<(), ExportError> {
    let doubts = materials.iter().flat_map(|material| [of_domain(material, None), of_parts(material, None)].concat());
    let diagnostics: Vec<Diagnostic> = doubts.filter(Diagnostic::is_error).collect();
    let Some(first) = diagnostics.first() else { return Ok(()) };
    Err(ExportError::Refused { sentence: format!("{}: {}", first.label, first.message), diagnostics })
}

/// The forms of the shaders of materials: those that are asked for, or all that the models of all materials have.
fn forms(materials: &[Material], asked: &[Form]) -> Result<Vec<Form>, ExportError> {
    let lacking = |form: Form| materials.iter().find(|material| !material.model().has(form));
    for &form in asked {
        if let Some(material) = lacking(form) {
            let (material, model) = (material.name.clone(), material.model());
            return Err(ShaderError::NoForm { material, model, form }.into());
        }
    }
    let all = || Form::ALL.into_iter().filter(|&form| lacking(form).is_none()).collect();
    Ok(if asked.is_empty() { all() } else { asked.to_vec() })
}

/// The manifest's entry of a table, without its tiles and files.
fn table_entry(kind: TableKind, layout: &AtlasLayout, format: TexelFormat) -> TableEntry {
    let [width, height] = layout.size();
    TableEntry {
        kind,
        layout: layout.clone(),
        format,
        texel_bytes: u64::from(width) * u64::from(height) * u64::from(format.texel_bytes()),
        texture: FileEntry::default(),
        truth: FileEntry::default(),
        picture: FileEntry::default(),
        tiles: Vec::new(),
    }
}

/// The manifest's entries of the materials, and their maps.
fn material_entries(
    materials: &[Material],
    baked: &[BakedMaterial],
) -> Result<(Vec<MaterialEntry>, Vec<Map>), ExportError> {
    let (mut entries, mut maps) = (Vec::with_capacity(materials.len()), Vec::new());
    for (number, (material, baked)) in (0..).zip(materials.iter().zip(baked)) {
        let mut own = Vec::with_capacity(baked.maps.len());
        for map in &baked.maps {
            let (entry, picture, png) = self::map(material, map)?;
            maps.push(Map { material: number, slot: map.slot, layer: map.layer, picture, png });
            own.push(entry);
        }
        entries.push(MaterialEntry {
            name: material.name.clone(),
            source: material.source.clone(),
            source_hash: source_hash(material)?,
            class: material.class.symbol().to_owned(),
            model: baked.model,
            color: baked.color,
            wavelengths_nm: material.bake.wavelengths_nm(),
            constants: baked.constants.clone(),
            layers: baked.records.clone(),
            maps: own,
        });
    }
    Ok((entries, maps))
}

/// A map as it ships: a picture as its material reads it, noise as a grey PNG.
fn map(material: &Material, map: &MaterialMap) -> Result<(MapEntry, Picture, Vec<u8>), ExportError> {
    let unusable = |reason| ExportError::Map { material: material.source.clone(), map: map.source.label(), reason };
    let sentence = |source: TextureError| unusable(source.to_string());
    let (named, (picture, bytes)) = match &map.source {
        MapSource::Picture(named, texels) => {
            let read = pictures::read(&material.source, named, *texels).map_err(unusable)?;
            (Some(named), pictures::file(read, named).map_err(unusable)?)
        }
        MapSource::Heights { picture: named, height } => {
            let heights = pictures::read_image(&material.source, named).map_err(unusable)?;
            let normals = height_normals(&heights, *height);
            let bytes = png::encode_rgb(normals.width, normals.height, &codes(&normals)).map_err(sentence)?;
            (Some(named), (bits8(&normals), bytes))
        }
        MapSource::Noise { .. } => {
            let texels = map.source.texels().unwrap_or_else(|| Image::zeros(1, 1, 1));
            (None, (bits8(&texels), png::encode_gray(&texels).map_err(sentence)?))
        }
    };
    let layer = map.layer.map_or_else(String::new, |layer| format!("-{layer}"));
    let path = format!("maps/{}-{}{layer}.png", material.name, map.slot.name());
    let entry = MapEntry {
        slot: map.slot,
        layer: map.layer,
        source: map.source.label(),
        file: FileEntry { path, sha256: sha256(&bytes) },
        width: picture.width,
        height: picture.height,
        factor: map.factor,
        srgb: picture.is_srgb,
        transform: named.and_then(|named| named.transform).map(|transform| transform.matrix()),
    };
    Ok((entry, picture, bytes))
}

/// Values from 0 to 1 as codes of 8 bits.
fn codes(image: &Image) -> Vec<u8> {
    image.data.iter().map(|value| (255.0 * value.clamp(0.0, 1.0)).round() as u8).collect()
}

/// An image of values from 0 to 1 in steps of 1/255.
fn bits8(image: &Image) -> Picture {
    let Image { width, height, channels, .. } = *image;
    Picture { width, height, channels, is_srgb: false, samples: PictureSamples::Bits8(codes(image)) }
}

/// A file that a material names.
fn named_file(material: &Material, path: &str) -> Result<Vec<u8>, ExportError> {
    let path = sources::beside(&material.source, path);
    input::image(&path).map_err(|source| file("read", &path, source))
}

/// An error of the system about a file.
pub(crate) fn file(action: &'static str, path: &Path, source: io::Error) -> ExportError {
    ExportError::File { action, path: path.display().to_string(), source }
}
