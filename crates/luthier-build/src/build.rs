//! The bake of a build script.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::ExitCode;

use luthier::{Bake, Compression, Error, Form, MemoryStore, Sources, Store};
use luthier_store::{DEFAULT_LIMIT, DiskStore};

use crate::{Told, module};

/// A bake in a build script: materials become a package and a module of Rust, both in `OUT_DIR`.
///
/// ```no_run
/// // build.rs
/// fn main() -> std::process::ExitCode {
///     luthier_build::Build::of(["materials"]).run()
/// }
/// ```
#[derive(Clone)]
pub struct Build<'a> {
    /// Files, and folders of which the `*.toml` are baked.
    pub paths: Vec<PathBuf>,
    /// Name of the module, a file, and of the folder of the package.
    pub name: String,
    /// Models, forms, languages, limits and functions of the bake.
    pub bake: Bake<'a>,
    /// Compression of tables. The default is none, so that the program needs no decoder.
    pub compression: Compression,
    /// Folder with the results of jobs, which builds may share; `None` for one in `OUT_DIR`.
    pub store: Option<PathBuf>,
}

impl Build<'_> {
    /// A build of files and folders, with shaders that read tables in WGSL. Its module is `materials.rs`.
    ///
    /// ```
    /// use luthier_build::{Build, luthier::Compression};
    ///
    /// let build = Build { compression: Compression::Zstd, ..Build::of(["materials", "more/oak.toml"]) };
    /// assert_eq!((build.name.as_str(), build.paths.len()), ("materials", 2));
    /// ```
    pub fn of<P: AsRef<Path>>(paths: impl IntoIterator<Item = P>) -> Self {
        Self {
            paths: paths.into_iter().map(|path| path.as_ref().to_owned()).collect(),
            name: "materials".to_owned(),
            bake: Bake::wgsl(&[Form::Baked]),
            compression: Compression::None,
            store: None,
        }
    }

    /// Bakes into `OUT_DIR`, and tells Cargo which files were read and what is wrong with them. The code is that of the build script.
    ///
    /// ```no_run
    /// fn main() -> std::process::ExitCode {
    ///     luthier_build::Build::of(["materials"]).run()
    /// }
    /// ```
    #[must_use = "return the code from `main`: a build goes on otherwise"]
    pub fn run(&self) -> ExitCode {
        let told = match std::env::var_os("OUT_DIR") {
            Some(out) => self.in_folder(Path::new(&out)),
            None => {
                let mut told = Told::default();
                told.fault("OUT_DIR is not set: luthier-build runs in a build script");
                told
            }
        };
        print(&told);
        if told.is_baked { ExitCode::SUCCESS } else { ExitCode::FAILURE }
    }

    /// Bakes into a folder, and returns what [`Build::run`] would print. Where something is wrong, nothing is written but results of jobs.
    ///
    /// ```
    /// let folder = tempfile::tempdir()?;
    /// let file = folder.path().join("chalk.toml");
    /// std::fs::write(&file, "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n")?;
    ///
    /// let out = folder.path().join("out");
    /// let told = luthier_build::Build::of([&file]).in_folder(&out);
    /// assert_eq!(told.lines, [format!("cargo::rerun-if-changed={}", file.display())]);
    /// assert!(std::fs::read_to_string(out.join("materials.rs"))?.contains("pub const CHALK: u32 = 0;"));
    /// assert!(out.join("materials/manifest.json").exists());
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    pub fn in_folder(&self, out: &Path) -> Told {
        let mut told = Told::default();
        // A folder counts as a whole: Cargo sees files that come.
        let mut watched = self.paths.clone();
        let mut sources = match Sources::read(&self.paths) {
            Ok(sources) => sources,
            Err(error) => {
                watch(&watched, &mut told);
                told.error(&error, &Sources::default());
                return told;
            }
        };
        sources.check(&self.bake.shading);
        watched.extend(sources.files());
        watch(&watched, &mut told);
        told.diagnostics(sources.diagnostics(), &sources);
        if !sources.is_usable() {
            return told;
        }
        match self.write(&sources, out, &mut told) {
            Ok(()) => told.is_baked = true,
            Err(error) => told.error(&error, &sources),
        }
        told
    }

    fn write(&self, sources: &Sources, out: &Path, told: &mut Told) -> Result<(), Error> {
        let root = self.store.clone().unwrap_or_else(|| out.join("luthier-store"));
        let disk = DiskStore::open(&root, DEFAULT_LIMIT);
        if let Err(problem) = &disk {
            told.line("warning", &format!("{problem}: every build bakes all"));
        }
        let memory = MemoryStore::default();
        let store: &dyn Store = disk.as_ref().map_or(&memory, |disk| disk);
        let folder = out.join(&self.name);
        let encoded = self.bake.of(sources, store)?.encode(self.compression)?.for_folder(&folder);
        let text = module::text(&encoded.manifest, &self.name)?;
        encoded.write(&folder)?;
        if let Some(problem) = disk.ok().and_then(|disk| disk.close().err()) {
            told.line("warning", &problem.to_string());
        }
        let path = out.join(format!("{}.rs", self.name));
        // A file that is as it was keeps its time.
        if fs::read_to_string(&path).is_ok_and(|old| old == text) {
            return Ok(());
        }
        let write = |source| Error::File { action: "write", path: path.display().to_string(), source };
        fs::write(&path, text).map_err(write)
    }
}

/// Names the files on which the build depends, each once.
fn watch(paths: &[PathBuf], told: &mut Told) {
    for (number, path) in paths.iter().enumerate() {
        if !paths[..number].contains(path) {
            told.line("rerun-if-changed", &path.display().to_string());
        }
    }
}

#[expect(clippy::print_stdout, reason = "Cargo reads standard output")]
fn print(told: &Told) {
    told.lines.iter().for_each(|line| println!("{line}"));
    eprint!("{}", told.faults);
}
