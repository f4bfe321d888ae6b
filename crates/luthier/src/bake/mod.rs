//! Packages made from materials.

mod emit;
mod entries;
mod maps;

use std::collections::BTreeMap;

use luthier_bake::{BakedMaterial, ImageReader, Missing, Observer, Options, Share, Silent, Store};
use luthier_export::{GENERATOR, Package, Table};
use luthier_lut::{Atlas, RowLayout, TableKind};
use luthier_manifest::{Form, FunctionGroup, Functions, Manifest, Names, SurfaceEntry, TableEntry, Target};
use luthier_material::{Diagnostic, Material};
use luthier_shader::ShaderError;
use luthier_texture::Texture;

use self::emit::emit;
use self::entries::{material_entries, table_entry};
use crate::pictures::measure_texels;
use crate::refusals::{of_domain, of_parts};
use crate::{Error, Shading, Sources, read_image};

pub use emit::of_materials;
pub use entries::source_hash;

/// The options of a bake. The default makes the package that `luthier bake` writes.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Target};
///
/// let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// let chalk = luthier::parse("chalk.toml", text)?;
/// let bake = Bake { targets: vec![Target::Msl], ..Bake::default() }.in_forms(&[Form::Baked]);
/// let package = bake.package(&[chalk], &MemoryStore::default())?;
/// assert!(package.shaders[0].text().contains("metal::float3"));
/// # Ok::<(), luthier::Error>(())
/// ```
#[derive(Clone)]
pub struct Bake<'a> {
    /// Models, and forms of the shaders.
    pub shading: Shading,
    /// Limits and formats of tables, and whether they are searched for.
    pub options: Options<'a>,
    /// Languages of the shaders.
    pub targets: Vec<Target>,
    /// Groups of functions of each shader.
    pub functions: Functions,
    /// Names in shaders and places of their resources, where several packages are linked into one program.
    pub names: Names,
    /// Surfaces of the materials, by their numbers.
    pub surfaces: Vec<SurfaceEntry>,
    /// The observer of all jobs, which may cancel the bake.
    pub observer: &'a dyn Observer,
    /// True where materials outside the domain of their model are refused. Tests at the limits of models set it to false.
    pub refuses: bool,
}

impl Default for Bake<'_> {
    fn default() -> Self {
        Self {
            shading: Shading::default(),
            options: Options::default(),
            targets: vec![Target::Wgsl, Target::Glsl450, Target::GlslEs300],
            functions: Functions::default(),
            names: Names::default(),
            surfaces: Vec::new(),
            observer: &Silent,
            refuses: true,
        }
    }
}

impl<'a> Bake<'a> {
    /// A package with shaders in WGSL only.
    ///
    /// ```
    /// use luthier::{Bake, Form, MemoryStore};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    ///
    /// let package = Bake::wgsl(&[Form::Full]).package(&[luthier::parse("chalk.toml", chalk)?], &MemoryStore::default())?;
    /// assert_eq!((package.shaders.len(), package.tables.len()), (1, 0));
    /// # Ok::<(), luthier::Error>(())
    /// ```
    pub fn wgsl(forms: &[Form]) -> Self {
        let shading = Shading { forms: forms.to_vec(), ..Shading::default() };
        Self { shading, targets: vec![Target::Wgsl], ..Self::default() }
    }

    /// A package for a renderer: all forms of the shader in WGSL, with functions for a blurred environment and for drawn directions.
    /// [`lit`](crate::lit) gives its materials the tables that such a renderer reads.
    ///
    /// ```
    /// use luthier::{Bake, Form, MemoryStore};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    ///
    /// let materials = luthier::lit(&[luthier::parse("chalk.toml", chalk)?]);
    /// let package = Bake::lit().in_forms(&[Form::Full]).package(&materials, &MemoryStore::default())?;
    /// assert!(package.wgsl(Form::Full)?.contains("fn luthier_sample("));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn lit() -> Self {
        Self { functions: [FunctionGroup::Environment, FunctionGroup::Sample].into_iter().collect(), ..Self::wgsl(&[]) }
    }

    /// Restricts the shaders to some forms.
    #[must_use]
    pub fn in_forms(mut self, forms: &[Form]) -> Self {
        self.shading.forms = forms.to_vec();
        self
    }

    /// Bakes the materials and surfaces of sources. Call [`Sources::refuse`] first: its diagnostics have places in the files.
    ///
    /// ```
    /// use luthier::{Bake, Form, MemoryStore, Shading, Sources};
    /// # let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
    /// # let folder = tempfile::tempdir()?;
    /// # std::fs::write(folder.path().join("chalk.toml"), chalk)?;
    ///
    /// let mut sources = Sources::read([folder.path()])?;
    /// sources.refuse(&Shading::default());
    /// let package = Bake::wgsl(&[Form::Full]).of(&sources, &MemoryStore::default())?;
    /// package.write(&folder.path().join("out"))?;
    /// assert!(folder.path().join("out/shaders/full.wgsl").exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`]; [`Error::Refused`] where a source is unusable, or is a scene: luthier-scene chooses the models of its materials.
    pub fn of(&self, sources: &Sources, store: &dyn Store) -> Result<Package, Error> {
        if !sources.is_usable() {
            let diagnostics: Vec<Diagnostic> = sources.diagnostics().filter(|d| d.is_error()).cloned().collect();
            return Err(refused(diagnostics));
        }
        if let Some(scene) = sources.scenes.first() {
            let sentence = format!("{} is a scene, whose models are chosen: it is no part of a package", scene.label);
            return Err(Error::Refused { sentence, diagnostics: Vec::new() });
        }
        let surfaces = sources.surface_entries();
        Self { surfaces, ..self.clone() }.package(&sources.materials(&Shading::default()), store)
    }

    /// Bakes materials: the tables that they need, then shaders that read these tables. Results that the store has are not computed again; new
    /// results go into it. A file that a material names is found relative to the material's own file. The bytes of the package depend on the
    /// arguments and the files only.
    ///
    /// ```
    /// use luthier::{Bake, Form, MemoryStore};
    ///
    /// let text = "schema = 1\nname = \"red\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.05, 0.05]\n";
    /// let package = Bake::default().package(&[luthier::parse("red.toml", text)?], &MemoryStore::default())?;
    /// assert!(package.wgsl(Form::Baked)?.contains("fn luthier_eval("));
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`].
    pub fn package(&self, materials: &[Material], store: &dyn Store) -> Result<Package, Error> {
        let (materials, forms) = &self.settled(materials)?;
        let read = &read_image as ImageReader<'_>;
        if *forms == [Form::Full] {
            // Without a shader that reads them there are no tables.
            let options = Options { search: false, ..self.options() };
            let mut outline = luthier_bake::outline_with(materials, &options, read, store)?;
            outline.materials.iter_mut().for_each(BakedMaterial::forget_tables);
            return self.assembled(materials, forms, &outline.materials, Vec::new());
        }
        let baked = luthier_bake::bake_with(materials, &self.options(), read, self.observer, store)?;
        let mut package = self.assembled(materials, forms, &baked.materials, baked.atlases)?;
        package.manifest.searches = baked.searches;
        Ok(package)
    }

    /// Computes a share of a bake's jobs into a store, where the bake that follows finds the results.
    ///
    /// ```
    /// use luthier::{Bake, Form, MemoryStore, Share};
    /// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
    ///
    /// // Two machines with one store, one after the other.
    /// let (materials, store) = ([luthier::parse("gold.toml", text)?], MemoryStore::default());
    /// let bake = Bake::wgsl(&[Form::Baked]);
    /// bake.share(&materials, &store, Share { index: 1, count: 2 })?;
    /// bake.share(&materials, &store, Share { index: 2, count: 2 })?;
    /// let package = bake.package(&materials, &store)?;
    /// assert_eq!(package, bake.package(&materials, &MemoryStore::default())?);
    /// # Ok::<(), luthier::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`].
    pub fn share(&self, materials: &[Material], store: &dyn Store, share: Share) -> Result<(), Error> {
        let (materials, forms) = self.settled(materials)?;
        if forms == [Form::Full] {
            return Ok(());
        }
        Ok(luthier_bake::bake_share(&materials, &self.options(), &read_image, self.observer, store, share)?)
    }

    /// The jobs that a bake would run because a store lacks their results.
    ///
    /// ```
    /// use luthier::{Bake, Form, MemoryStore};
    /// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
    ///
    /// let (materials, store) = ([luthier::parse("gold.toml", text)?], MemoryStore::default());
    /// let bake = Bake::wgsl(&[Form::Baked]);
    /// assert!(!bake.missing(&materials, &store)?.jobs.is_empty());
    /// bake.package(&materials, &store)?;
    /// assert!(bake.missing(&materials, &store)?.jobs.is_empty());
    /// # Ok::<(), luthier::Error>(())
    /// ```
    ///
    /// # Errors
    /// [`Error`].
    pub fn missing(&self, materials: &[Material], store: &dyn Store) -> Result<Missing, Error> {
        let (materials, forms) = self.settled(materials)?;
        if forms == [Form::Full] {
            return Ok(Missing { jobs: BTreeMap::new(), is_all: true });
        }
        Ok(luthier_bake::missing(&materials, &self.options(), &read_image, store)?)
    }

    /// The options, with a layout of rows where functions or languages decide it.
    fn options(&self) -> Options<'a> {
        Options { layout: self.options.layout.or_else(|| row_layout(&self.functions, &self.targets)), ..self.options }
    }

    /// The materials as they are baked, and the forms of their shaders.
    fn settled(&self, materials: &[Material]) -> Result<(Vec<Material>, Vec<Form>), Error> {
        let mut materials = self.shading.shaded(materials.to_vec());
        materials.iter_mut().for_each(measure_texels);
        if self.refuses {
            refuse_foreign(&materials)?;
        }
        let forms = forms(&materials, &self.shading.forms)?;
        Ok((materials, forms))
    }

    fn assembled(
        &self,
        materials: &[Material],
        forms: &[Form],
        baked: &[BakedMaterial],
        atlases: Vec<Atlas>,
    ) -> Result<Package, Error> {
        let (entries, maps) = material_entries(materials, baked)?;
        let tables = atlases.iter().map(|atlas| TableEntry {
            tiles: atlas.tiles.clone(),
            ..table_entry(atlas.kind, &atlas.layout, atlas.format)
        });
        let (functions, surfaces) = (self.functions.clone(), self.surfaces.clone());
        let names = self.names.clone();
        let manifest = Manifest { functions, surfaces, names, ..Manifest::new(GENERATOR, entries, tables.collect()) };
        let table =
            |atlas: Atlas| Table { kind: atlas.kind, texture: Texture::from_atlas(&atlas), truth: Some(atlas.truth) };
        let tables = atlases.into_iter().map(table).collect();
        let mut package = Package::from_parts(manifest, tables, Vec::new())?;
        package.maps = maps;
        emit(&mut package, &self.targets, forms)?;
        Ok(package)
    }
}

/// The layout of rows that functions and languages of shaders decide: a sampler's where a view is prepared once for many lights (on an NVIDIA H200 its
/// reads then hide behind the arithmetic, and those of a buffer add to it), and where a language has no storage buffers. Else the materials decide.
///
/// ```
/// use luthier::{Functions, Target, row_layout};
/// use luthier_lut::RowLayout;
///
/// // WebGL 2 has no storage buffers. In WGSL the materials decide.
/// assert_eq!(row_layout(&Functions::default(), &[Target::Wgsl, Target::GlslEs300]), Some(RowLayout::Filtered));
/// assert_eq!(row_layout(&Functions::default(), &[Target::Wgsl]), None);
/// ```
pub fn row_layout(functions: &Functions, targets: &[Target]) -> Option<RowLayout> {
    let has_buffers = !targets.contains(&Target::GlslEs300);
    (!functions.is_eval_alone() || !has_buffers).then_some(RowLayout::Filtered)
}

/// The manifest of a bake that is not made: materials, tables without tiles, searches, no files. This takes little computing, unless a material has a
/// budget or lobes; then it helps if the store has their results.
///
/// ```
/// use luthier::{MemoryStore, Options};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
///
/// let gold = luthier::parse("gold.toml", text)?;
/// let manifest = luthier::outline(&[gold], &Options::default(), &MemoryStore::default())?;
/// for table in &manifest.tables {
///     println!("{}: {:?}, {} bytes", table.kind.name(), table.format, table.texel_bytes);
/// }
/// assert!(manifest.shaders.is_empty() && manifest.tables.iter().all(|table| table.tiles.is_empty()));
/// # Ok::<(), luthier::Error>(())
/// ```
///
/// # Errors
/// [`Error`].
pub fn outline(materials: &[Material], options: &Options<'_>, store: &dyn Store) -> Result<Manifest, Error> {
    let mut materials = materials.to_vec();
    materials.iter_mut().for_each(measure_texels);
    let outline = luthier_bake::outline_with(&materials, options, &read_image, store)?;
    let (entries, _) = material_entries(&materials, &outline.materials)?;
    let tables = outline.tables.iter().map(|(kind, layout, format)| table_entry(*kind, layout, *format)).collect();
    Ok(Manifest { searches: outline.searches, ..Manifest::new(GENERATOR, entries, tables) })
}

/// Tables that the environment of pictures reads beside the shader: reflectance and albedo of every interface.
const ENVIRONMENT_TABLES: [TableKind; 3] = [TableKind::Fresnel, TableKind::Fgd, TableKind::Film];

/// Texels of the table of energies, over the view and the slope parameter, if only pictures read it. A table of the size that a bake searches for
/// takes three times as long, more than all the rest of a first picture.
const ENERGY_SIZE: [u32; 2] = [32, 16];

/// Copies of materials that also ask for the tables that a blurred environment reads, as far as their slope distributions have such tables.
///
/// ```
/// use luthier_lut::TableKind;
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
///
/// let lit = luthier::lit(&[luthier::parse("gold.toml", text)?]);
/// assert!(lit[0].bake.asks_for(TableKind::Fgd), "the albedo, by which an environment is weighed");
/// # Ok::<(), luthier::Error>(())
/// ```
pub fn lit(materials: &[Material]) -> Vec<Material> {
    let mut lit = materials.to_vec();
    let is_of_pictures =
        |material: &Material| !material.model().is_statistical() && !material.bake.asks_for(TableKind::Fgd);
    let is_small = materials.iter().all(is_of_pictures);
    // Lobes have their own energies.
    for material in lit.iter_mut().filter(|material| !material.model().is_fitted()) {
        // Facets without walks have no table of albedos: renderers draw directions instead.
        let has_walks = material.stack.layers.iter().all(|layer| layer.surface.distribution.has_walks());
        let tables = ENVIRONMENT_TABLES.into_iter().filter(|kind| has_walks || *kind != TableKind::Fgd);
        material.bake.tables.extend(tables);
        if is_small && has_walks {
            material.bake.fgd.size = Some(ENERGY_SIZE);
        }
    }
    lit
}

/// Refuses materials outside the domain of their model, and parts that their model does not have.
fn refuse_foreign(materials: &[Material]) -> Result<(), Error> {
    let doubts = materials.iter().flat_map(|material| [of_domain(material, None), of_parts(material, None)].concat());
    let diagnostics: Vec<Diagnostic> = doubts.filter(Diagnostic::is_error).collect();
    if diagnostics.is_empty() { Ok(()) } else { Err(refused(diagnostics)) }
}

/// A refusal in the words of its first diagnostic.
fn refused(diagnostics: Vec<Diagnostic>) -> Error {
    let sentence = diagnostics.first().map_or_else(String::new, |first| format!("{}: {}", first.label, first.message));
    Error::Refused { sentence, diagnostics }
}

/// The forms of the shaders: those asked for, which all materials must have, or every form that some model has.
fn forms(materials: &[Material], asked: &[Form]) -> Result<Vec<Form>, Error> {
    let lacking = |form: Form| materials.iter().find(|material| !material.model().has(form));
    if asked.is_empty() {
        let has = |form: Form| materials.iter().any(|material| material.model().has(form));
        return Ok(Form::ALL.into_iter().filter(|&form| has(form)).collect());
    }
    for &form in asked {
        if let Some(material) = lacking(form) {
            let (material, model) = (material.name.clone(), material.model());
            return Err(ShaderError::NoForm { material, model, form }.into());
        }
    }
    Ok(asked.to_vec())
}
