//! Files, bakes and screenshots for the window.

use std::collections::{BTreeMap, BTreeSet};
use std::hash::{DefaultHasher, Hash, Hasher};
use std::path::{Path, PathBuf};
use std::sync::{Mutex, MutexGuard, PoisonError};

use luthier::{Bake, MemoryStore, Source, find, lit, named_files};
use luthier_export::Package;
use luthier_gpu::ToneMapping;
use luthier_lut::Image;
use luthier_manifest::ModelPart;
use luthier_manifest::Reflectance;
use luthier_material::{Diagnostic, Material};
use luthier_report::{PictureComparison, compare_pictures};
use luthier_store::Layers;
use luthier_terminal::{Failure, Outcome};
use luthier_texture::png;
use luthier_view::{Differences, Form, Host, MaterialFile, Screenshot};

use crate::cli::Shading;
use crate::simulated;
use crate::store::store;
use crate::watched::{State, seen, state};

/// Each watched file with its state; `None` if it cannot be read.
type Stamps = BTreeMap<PathBuf, Option<State>>;

/// Files at the last look.
#[derive(Default)]
struct Seen {
    /// Files as they were when they were read. `None` before that.
    files: Option<(Stamps, Vec<MaterialFile>)>,
    /// States that differ from those: files that are perhaps being written.
    changing: Option<Stamps>,
}

/// The command, as the window sees it.
pub(crate) struct ViewHost {
    paths: Vec<PathBuf>,
    screenshot: Option<PathBuf>,
    /// Whether lobes may be fitted.
    fits: bool,
    /// Reflectances in place of those of files.
    fresnel: Option<Reflectance>,
    seen: Mutex<Seen>,
    /// Results of the jobs of the last bake: most serve the next.
    store: MemoryStore,
}

impl ViewHost {
    pub(crate) fn new(paths: Vec<PathBuf>, screenshot: Option<PathBuf>, shading: &Shading) -> Self {
        let (fits, fresnel) = (!shading.no_fit, shading.fresnel);
        Self { paths, screenshot, fits, fresnel, seen: Mutex::default(), store: MemoryStore::default() }
    }

    fn package(&self, material: &Material, form: Form) -> Outcome<Package> {
        let mut materials = lit(std::slice::from_ref(material));
        for material in materials.iter_mut().filter(|material| material.model().takes(ModelPart::Reflectance)) {
            material.bake.reflectance = self.fresnel.or(material.bake.reflectance);
        }
        let store = Layers(&[&self.store, store()?]);
        let package = Bake::lit().in_forms(&[form]).package(&materials, &store)?;
        self.store.sweep();
        Ok(package)
    }
}

impl Host for ViewHost {
    fn changed(&self) -> Option<Vec<MaterialFile>> {
        let mut seen = lock(&self.seen);
        let last_files = seen.files.as_ref().map_or(&[][..], |(_, files)| files);
        let now = stamps(&self.paths, last_files);
        if let Some((last, _)) = &seen.files {
            // What a program writes is read when it rests: half a file is no mistake of its author.
            if *last == now || seen.changing.as_ref() != Some(&now) {
                seen.changing = (*last != now).then_some(now);
                return None;
            }
        }
        let files: Vec<MaterialFile> = match find(&self.paths) {
            Ok(paths) => paths.iter().map(|path| file(path)).collect(),
            // The folder is being replaced: its files are missing for a moment.
            Err(_) => last_files.iter().map(|file| self::file(Path::new(&file.label))).collect(),
        };
        let is_new = seen.files.as_ref().is_none_or(|(_, last)| *last != files);
        // Materials may name other files now, so the list of watched files is made anew. A file that changed while it was read is read again.
        let mut watched = stamps(&self.paths, &files);
        watched.iter_mut().for_each(|(path, state)| *state = now.get(path).copied().unwrap_or(*state));
        *seen = Seen { files: Some((watched, files.clone())), changing: None };
        is_new.then_some(files)
    }

    fn bake(&self, material: &Material, form: Form) -> Result<Package, String> {
        if !self.fits && material.model().is_fitted() {
            return Err("the model `lobes` is fitted to a simulation, and --no-fit makes none".to_owned());
        }
        self.package(material, form).map_err(|failure| failure.sentence())
    }

    fn simulated(&self, material: &Material) -> Result<Package, String> {
        let refusals = simulated::refusals(material);
        if !refusals.is_empty() {
            return Err(refusals.join("\n"));
        }
        simulated::package(vec![material.clone()]).map_err(|failure| failure.sentence())
    }

    fn parsed(&self, label: &str, text: &str) -> Result<Material, String> {
        let Source { text, parsed, .. } = Source::of_text(Path::new(label), text.to_owned());
        parsed.map(|parsed| parsed.material).map_err(|diagnostics| rendered(&diagnostics, &text))
    }

    fn compare(&self, a: &Image, b: &Image, tone: ToneMapping) -> Option<Differences> {
        let PictureComparison { rms_err, flip_mean, .. } = compare_pictures(a, b, |v| tone.value(v)).ok()?;
        Some(Differences { rms_err, flip_mean })
    }

    fn save(&self, screenshot: &Screenshot, number: u32, asked: bool) -> Result<String, String> {
        let path = match &self.screenshot {
            Some(path) if asked => numbered(path, number),
            _ => free(),
        };
        let bytes =
            png::encode_rgb(screenshot.width, screenshot.height, &screenshot.rgb8).map_err(|e| e.to_string())?;
        // A program that waits for the file never reads a part.
        match luthier_export::replace(&path, &bytes) {
            Ok(()) => Ok(path.display().to_string()),
            Err(source) => Err(format!("cannot write {}: {source}", path.display())),
        }
    }
}

/// A material file as it is now.
fn file(path: &Path) -> MaterialFile {
    let Source { label, text, parsed } = match Source::read(path) {
        Ok(source) => source,
        Err(error) => {
            let label = path.to_string_lossy().into_owned();
            return MaterialFile { label, material: Err(Failure::from(error).sentence()), revision: 0 };
        }
    };
    match parsed {
        Ok(parsed) => {
            let revision = revision(&parsed.material);
            MaterialFile { label, material: Ok(parsed.material), revision }
        }
        Err(diagnostics) => MaterialFile { label, material: Err(rendered(&diagnostics, &text)), revision: 0 },
    }
}

fn rendered(diagnostics: &[Diagnostic], text: &str) -> String {
    diagnostics.iter().map(|diagnostic| diagnostic.render(text)).collect::<Vec<_>>().join("\n\n")
}

/// Stamps of the files that may change the materials: the material files, the files that they name, and the CSV files beside these.
fn stamps(paths: &[PathBuf], files: &[MaterialFile]) -> Stamps {
    let mut watched: BTreeSet<PathBuf> = find(paths).unwrap_or_default().into_iter().collect();
    watched.extend(files.iter().map(|file| PathBuf::from(&file.label)));
    watched.extend(files.iter().filter_map(|file| file.material.as_ref().ok()).flat_map(named_files));
    let folders: BTreeSet<PathBuf> = watched.iter().map(|path| folder(path)).collect();
    for folder in folders {
        let entries = std::fs::read_dir(folder).into_iter().flatten().flatten();
        watched.extend(entries.map(|entry| entry.path()).filter(|path| path.extension().is_some_and(|e| e == "csv")));
    }
    watched.into_iter().map(seen).collect()
}

fn folder(path: &Path) -> PathBuf {
    match path.parent() {
        Some(parent) if !parent.as_os_str().is_empty() => parent.to_owned(),
        _ => PathBuf::from("."),
    }
}

fn revision(material: &Material) -> u64 {
    let mut hasher = DefaultHasher::new();
    named_files(material).for_each(|path| state(&path).hash(&mut hasher));
    hasher.finish()
}

/// `window.png`, `window-2.png`, ...
fn numbered(path: &Path, number: u32) -> PathBuf {
    if number == 1 {
        return path.to_owned();
    }
    let stem = path.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    path.with_file_name(format!("{stem}-{number}.png"))
}

/// A name in the current folder that nothing has yet.
fn free() -> PathBuf {
    let mut names = (1..).map(|i: u32| PathBuf::from(format!("luthier-view-{i}.png")));
    names.find(|path| !path.exists()).unwrap_or_else(|| "luthier-view-0.png".into())
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn screenshots_are_numbered_from_the_second_on() {
        let path = Path::new("a/window.png");
        assert_eq!(numbered(path, 1), path);
        assert_eq!(numbered(path, 3), Path::new("a/window-3.png"));
    }

    #[test]
    fn a_change_is_told_once() {
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("m.toml");
        let write = |albedo: &str| {
            let text = format!("schema = 1\nname = \"m\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = {albedo}\n");
            std::fs::write(&path, text).unwrap();
        };
        write("0.5");
        let host = ViewHost::new(vec![folder.path().to_owned()], None, &Shading::default());
        // A change is told when the file rests: at the second look.
        let changed = || {
            assert!(host.changed().is_none());
            host.changed().unwrap()
        };
        assert!(host.changed().unwrap()[0].material.is_ok());
        assert!(host.changed().is_none());
        write("0.25");
        assert!(changed()[0].material.is_ok());
        assert!(host.changed().is_none());
        write("25.0");
        let problem = changed()[0].material.clone().unwrap_err();
        assert!(problem.contains("m.toml:5:10") && problem.contains("help"), "{problem}");
        std::fs::remove_file(&path).unwrap();
        assert!(changed()[0].material.as_ref().unwrap_err().contains("m.toml"));
        assert!(host.changed().is_none());
        write("0.25");
        assert!(changed()[0].material.is_ok());
        // Half of a file is not read.
        write("25.0");
        assert!(host.changed().is_none());
        write("0.125");
        assert!(changed()[0].material.is_ok());
        // What does not matter.
        std::fs::write(folder.path().join("note.txt"), "x").unwrap();
        assert!(host.changed().is_none());
        assert!(host.changed().is_none());
    }

    /// Only what tables depend on bakes again.
    #[test]
    fn tables_are_kept_while_they_serve() {
        let text = "schema = 1\nname = \"m\"\n[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3 }\nalpha = 0.2\n\
                    [bake]\nmodel = \"elek\"\nfgd = { size = [8, 8] }\ndistribution = { size = [16, 16] }\ncolor = \"three-wavelengths\"\n";
        let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
        let mut material = luthier_material::parse("m.toml", text, &no_files).unwrap().material;
        let host = ViewHost::new(Vec::new(), None, &Shading::default());
        let first = host.bake(&material, Form::Baked).unwrap();
        luthier_view::Handle::Alpha(0).set(&mut material, 0.4);
        let jobs = host.store.len();
        let rougher = host.bake(&material, Form::Baked).unwrap();
        // Nothing new was computed, and results that this bake did not use would have been swept.
        assert_eq!(host.store.len(), jobs);
        assert_eq!(rougher.tables, first.tables);
        assert_eq!(rougher.manifest.materials[0].layers[0].alpha, 0.4);
        luthier_view::Handle::IorN(0).set(&mut material, 1.2);
        let other = host.bake(&material, Form::Baked).unwrap();
        assert!(other.tables != first.tables);
        let full = host.bake(&material, Form::Full).unwrap();
        assert!(full.tables.is_empty() && full.wgsl(Form::Full).is_ok());
    }
}
