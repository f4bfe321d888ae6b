//! The front door of luthier: files of materials become a package of tables and shaders. Every fault is a diagnostic with its place in a file.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! - [`Sources`]: scenes, surfaces and materials, each file read once, with diagnostics that have places in files;
//! - [`Shading`]: the caller's choice of models, before that of the files; [`Bake`]: all options of a bake;
//! - [`Bake::package`]: materials to a [`Package`], which is in memory until [`Package::write`] publishes it in a folder;
//! - [`refusals`]: every reason to refuse or doubt a material;
//! - [`function`]: a model of a material as a function of two directions, without a bake.
//!
//! A bake computes what its [`Store`] lacks: [`MemoryStore`] starts empty, `luthier_store::DiskStore` keeps results between processes. An
//! [`Observer`] is told of every job, and may cancel the bake.
//!
//! Modules, each of which uses only earlier ones: paths, pictures, refusals, shading, sources, function, bake.

mod bake;
mod error;
pub mod function;
mod paths;
mod pictures;
pub mod refusals;
mod shading;
mod sources;

pub use bake::{Bake, lit, of_materials, outline, row_layout, source_hash};
pub use error::Error;
pub use paths::{find, inner_files};
pub use pictures::{read_image, read_picture};
pub use shading::Shading;
pub use sources::{
    Files, SceneSource, Source, Sources, SurfaceSource, TomlFile, named_files, parse, read_materials, refuse,
    surface_map,
};

#[doc(inline)]
pub use luthier_bake::{MemoryStore, Missing, Observer, Options};

/// A machine's part of a bake, by number.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Share};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
///
/// // The second of three machines.
/// let (bake, store) = (Bake::wgsl(&[Form::Baked]), MemoryStore::default());
/// bake.share(&[luthier::parse("gold.toml", text)?], &store, Share { index: 2, count: 3 })?;
/// # Ok::<(), luthier::Error>(())
/// ```
#[doc(inline)]
pub use luthier_bake::Share;

/// The observer of a bake that names none.
///
/// ```
/// use luthier::{Bake, Form, Observer, Silent};
///
/// let bake = Bake { observer: &Silent, ..Bake::wgsl(&[Form::Baked]) };
/// assert!(!bake.observer.is_cancelled(), "as in every bake that names no observer");
/// ```
#[doc(inline)]
pub use luthier_bake::Silent;

/// A place for results of jobs: in memory, on a disk, or of a program's own.
///
/// ```
/// use std::sync::Arc;
/// use std::sync::atomic::{AtomicUsize, Ordering};
///
/// use luthier::{Bake, Form, MemoryStore, Store};
/// use luthier_bake::{Artefact, Task};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
///
/// /// A store that counts what it is given.
/// #[derive(Default)]
/// struct Counting(MemoryStore, AtomicUsize);
///
/// impl Store for Counting {
///     fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>> {
///         self.0.get(task)
///     }
///     fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>) {
///         self.1.fetch_add(1, Ordering::Relaxed);
///         self.0.put(task, artefact);
///     }
/// }
///
/// let (store, materials) = (Counting::default(), [luthier::parse("gold.toml", text)?]);
/// let bake = Bake::wgsl(&[Form::Baked]);
/// bake.package(&materials, &store)?;
/// let jobs = store.1.load(Ordering::Relaxed);
/// bake.package(&materials, &store)?;
/// assert_eq!(store.1.load(Ordering::Relaxed), jobs, "the second bake computes nothing");
/// # Ok::<(), luthier::Error>(())
/// ```
#[doc(inline)]
pub use luthier_bake::Store;

#[doc(inline)]
pub use luthier_export::{Compression, PackageError, sha256};

/// A package as files, before they are written.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Compression};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
/// # let bake = Bake::wgsl(&[Form::Baked]);
/// # let package = bake.package(&[luthier::parse("gold.toml", text)?], &MemoryStore::default())?;
/// # let folder = tempfile::tempdir()?;
///
/// // Files of which each has its hash in its name, so that browsers may keep them.
/// let out = folder.path().join("out");
/// let encoded = package.encode(Compression::None)?.for_folder(&out).with_hashed_names();
/// encoded.write(&out)?;
/// assert!(encoded.is_in(&out) && encoded.stale(&out)?.is_empty());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(inline)]
pub use luthier_export::Encoded;

/// A written package, read part by part.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Folder};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
/// # let bake = Bake::wgsl(&[Form::Baked]);
/// # let package = bake.package(&[luthier::parse("gold.toml", text)?], &MemoryStore::default())?;
/// # let folder = tempfile::tempdir()?;
///
/// package.write(folder.path())?;
/// // A part of a bake, without the rest.
/// let bake = Folder::open(folder.path())?;
/// let manifest = bake.manifest();
/// let shader = bake.text(&manifest.shaders[0].file)?;
/// assert!(shader.contains("fn luthier_eval("));
/// let texture = bake.texture(&manifest.tables[0])?;
/// assert_eq!(texture.bytes.len() as u64, manifest.tables[0].texel_bytes);
/// assert_eq!(bake.read(&manifest.material_buffer)?.len() % 16, 0);
/// // All of it.
/// assert_eq!(bake.textures()?.len(), bake.package()?.tables.len());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(inline)]
pub use luthier_export::Folder;

/// The result of a bake: write it, read it back, or give its parts to a renderer.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Compression, Package};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
/// # let bake = Bake::wgsl(&[Form::Baked]);
/// # let package = bake.package(&[luthier::parse("gold.toml", text)?], &MemoryStore::default())?;
/// # let folder = tempfile::tempdir()?;
///
/// let out = folder.path().join("out");
/// package.write(&out)?;
/// let read = Package::read(&out)?;
/// assert_eq!(read.texel_bytes(), package.texel_bytes());
///
/// // For a renderer: texels of each table, and the shader with the names of its bindings.
/// for (kind, image) in read.textures()? {
///     assert_eq!(read.table(kind).map(|texture| texture.width), Some(image.width));
/// }
/// assert!(read.shader(Form::Baked)?.interface.function("luthier_eval").is_some());
///
/// // For files of one's own.
/// let encoded = package.encode(Compression::None)?;
/// assert!(encoded.files.iter().any(|(path, _)| path == "shaders/baked.wgsl"));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(inline)]
pub use luthier_export::Package;

/// The form of a shader: it reads tables, or computes all.
///
/// ```
/// use luthier::{Form, ShadingModel};
///
/// assert_eq!(Form::from_name("full"), Some(Form::Full));
/// assert!(ShadingModel::Lobes.has(Form::Baked) && !ShadingModel::Lobes.has(Form::Full));
/// ```
#[doc(inline)]
pub use luthier_manifest::Form;

/// A group of functions that a shader has if a program asks for it.
///
/// ```
/// use luthier::{Bake, Form, FunctionGroup, MemoryStore};
///
/// let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// let functions = [FunctionGroup::Albedo, FunctionGroup::Environment4].into_iter().collect();
/// let bake = Bake { functions, ..Bake::wgsl(&[Form::Full]) };
/// let package = bake.package(&[luthier::parse("chalk.toml", text)?], &MemoryStore::default())?;
/// assert!(package.wgsl(Form::Full)?.contains("fn luthier_albedo("));
/// assert_eq!(FunctionGroup::Environment4.environment_reads(), Some(4));
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(inline)]
pub use luthier_manifest::FunctionGroup;

#[doc(inline)]
pub use luthier_manifest::Functions;

/// First word of the names of a package, and its place among the bindings of a program.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Names};
///
/// let chalk = luthier::parse("chalk.toml", "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n")?;
/// let names = Names { prefix: "wall".to_owned(), first_binding: 16, ..Names::default() };
/// let package = Bake { names, ..Bake::wgsl(&[Form::Full]) }.package(&[chalk], &MemoryStore::default())?;
/// let wgsl = package.wgsl(Form::Full)?;
/// assert!(wgsl.contains("fn wall_eval(") && wgsl.contains("@group(0) @binding(22)") && wgsl.contains("WALL_MATERIAL_CHALK"));
/// // The runtime calls functions by luthier's own names.
/// assert!(package.in_own_names().wgsl(Form::Full)?.contains("fn luthier_eval("));
/// # Ok::<(), luthier::Error>(())
/// ```
#[doc(inline)]
pub use luthier_manifest::Names;

/// The description of a package, as `manifest.json` has it.
///
/// ```
/// use luthier::{Bake, Form, MemoryStore, Manifest};
/// # let text = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n[bake]\nmodel = \"microfacet\"\n";
/// # let bake = Bake::wgsl(&[Form::Baked]);
/// # let package = bake.package(&[luthier::parse("gold.toml", text)?], &MemoryStore::default())?;
/// # let folder = tempfile::tempdir()?;
/// # let (manifest, kind) = (package.manifest, package.tables[0].kind);
///
/// let read = Manifest::from_json(&manifest.to_json()?)?;
/// assert_eq!(read.material_index("gold"), Some(0));
/// assert_eq!(read.surface_index("gold"), None, "a material, and no surface");
/// assert!(read.table(kind).is_some_and(|table| table.texel_bytes > 0));
/// // Models may lack a form: materials without it are those that are not among these numbers.
/// assert!(read.has(Form::Full) && read.partial(Form::Full).is_none());
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[doc(inline)]
pub use luthier_manifest::Manifest;

/// A reflectance model by its name.
///
/// ```
/// use luthier::{Form, ShadingModel};
///
/// for model in ShadingModel::ALL.into_iter().filter(|model| model.has(Form::Full)) {
///     assert_eq!(ShadingModel::from_name(model.name()), Some(model));
///     println!("{}: {}", model.name(), model.title());
/// }
/// assert!(ShadingModel::Lobes.is_fitted() && ShadingModel::Elek.is_path() && ShadingModel::Belcour.is_statistical());
/// ```
#[doc(inline)]
pub use luthier_manifest::ShadingModel;

/// A language of shaders.
///
/// ```
/// use luthier::Target;
///
/// assert_eq!(Target::from_name("msl"), Some(Target::Msl));
/// let files: Vec<String> = Target::TEXT.iter().map(|target| format!("shaders/full.{}", target.extension())).collect();
/// assert!(files.contains(&"shaders/full.wgsl".to_owned()));
/// ```
#[doc(inline)]
pub use luthier_manifest::Target;

/// A fault or a doubt, with its place in a file.
///
/// ```
/// use luthier::Source;
///
/// let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 80\n";
/// let source = Source::of_text("chalk.toml".as_ref(), text.to_owned());
/// for diagnostic in source.diagnostics() {
///     // A line for a log, an underlined place for a terminal, a span for an editor.
///     assert!(diagnostic.is_error() && diagnostic.to_string().starts_with("chalk.toml:5:10: error: "));
///     assert!(diagnostic.render_coloured(text).contains("80") && diagnostic.render(text).contains("^^"));
///     assert_eq!(&text[diagnostic.span.clone()], "80");
/// }
/// ```
#[doc(inline)]
pub use luthier_material::Diagnostic;

/// A material that is valid: its layers, its settings, and where each value stands.
///
/// ```
/// use luthier::{Severity, ShadingModel};
///
/// let text = "schema = 1\nname = \"oak\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n\
///             [[layer]]\ntype = \"diffuse\"\nalbedo = 0.4\nmaps = { albedo = \"grain.png\" }\n";
/// let mut oak = luthier::parse("oak.toml", text)?;
/// assert_eq!((oak.stack.layers.len(), oak.model()), (2, ShadingModel::Lobes));
/// assert_eq!(oak.images()[0].picture.path, "grain.png");
/// assert_eq!(oak.place("layer.0.ior"), "oak.toml:5");
///
/// // A program's own rule, told at a place of the file; another model; a drawing of the layers.
/// let told = oak.diagnostic(Severity::Warning, "layer.0.alpha", "this game has smooth varnish only", None);
/// assert_eq!((told.line, told.is_error()), (6, false));
/// oak.shade_by(ShadingModel::Elek);
/// assert_eq!(oak.model(), oak.model_without_fit());
/// assert!(oak.cross_section().parts.len() > oak.stack.layers.len(), "the air, too");
/// # Ok::<(), luthier::Error>(())
/// ```
#[doc(inline)]
pub use luthier_material::Material;

/// The weight of a diagnostic.
///
/// ```
/// use luthier::Severity;
///
/// assert_eq!(Severity::Warning.name(), "warning");
/// assert!(Severity::Error < Severity::Warning, "errors come first in a sorted list");
/// ```
#[doc(inline)]
pub use luthier_material::Severity;
