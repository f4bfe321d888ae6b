//! Stamps record the files that a bake read and wrote. By them the next bake knows at once that nothing has changed.

use std::collections::BTreeMap;
use std::fmt::Display;
use std::fs::File;
use std::io;
use std::path::{Path, PathBuf};
use std::time::SystemTime;

use luthier::Files;
use luthier_bake::{Key, Missing};
use luthier_export::{Encoded, GENERATOR, MANIFEST, input, shared};
use luthier_material::Material;
use luthier_terminal::complain;
use rayon::prelude::*;
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use crate::cli::BakeOptions;
use crate::store::disk;
use crate::verb::bake::pipeline;
use crate::watched::{State, all_named, state};

/// The kind of stamps in the store.
const KIND: &str = "stamp";

/// Folders that a killed bake leaves. The next bake sweeps them.
const LEFT: [&str; 2] = [".luthier-new", ".luthier-ready"];

/// The inputs of a bake, and the place of its stamp.
pub(super) struct Stamp {
    out: PathBuf,
    /// The options, the program, and the hash of each file.
    inputs: String,
}

/// A stamp as it is kept.
#[derive(Serialize, Deserialize)]
pub(super) struct Kept {
    inputs: String,
    /// Other files that materials name, and the hash of all of them.
    named: Vec<PathBuf>,
    named_hash: String,
    /// Files of the bake.
    outputs: Vec<(String, Option<State>)>,
    warnings: usize,
    summary: Value,
}

/// Gives the manifest in a folder the present time, in the file system and in the stamp.
pub(super) fn date(out: &Path) -> io::Result<()> {
    let _lock = shared(out);
    let manifest = out.join(MANIFEST);
    let before = state(&manifest);
    File::options().write(true).open(&manifest)?.set_modified(SystemTime::now())?;
    let (Ok(Some(store)), Some(address)) = (disk(), address(out)) else { return Ok(()) };
    let kept = store.bytes(KIND, address).and_then(|bytes| serde_json::from_slice::<Kept>(&bytes).ok());
    let Some(mut kept) = kept else { return Ok(()) };
    if let Some((_, then)) = kept.outputs.iter_mut().find(|(path, then)| path == MANIFEST && *then == before) {
        *then = state(&manifest);
        store.put_bytes(KIND, address, &serde_json::to_vec(&kept)?);
    }
    Ok(())
}

/// The address of the stamp of a folder.
fn address(out: &Path) -> Option<Key> {
    Some(Key::of(out.canonicalize().ok()?.to_string_lossy().as_bytes()))
}

impl Stamp {
    pub(super) fn new(options: &BakeOptions, files: &Files) -> Self {
        let BakeOptions { shading, limits, emission, costs_of, no_zstd, hashed_names, .. } = options;
        let program = std::env::current_exe().ok().and_then(|path| state(&path));
        let decided = format!(
            "{GENERATOR} {program:?} {shading:?} {limits:?} {emission:?} {:?} {no_zstd} {hashed_names}",
            costs_of.load().ok().flatten()
        );
        let materials = files.materials.par_iter().map(|file| hashed(&file.path, Key::of(&file.bytes)));
        let surfaces = files.surfaces.iter().map(|file| hashed(&file.path, Key::of(file.text.as_bytes())));
        let hashes: Vec<String> = materials.collect::<Vec<_>>().into_iter().chain(surfaces).collect();
        Self { out: options.out.clone(), inputs: format!("{decided} {}", hashes.concat()) }
    }

    /// The inputs of a stamp, with the lock as it is now.
    fn inputs(&self, lock: &str) -> String {
        Key::of(format!("{} {lock}", self.inputs).as_bytes()).to_string()
    }

    /// The stamp of the last bake into the folder, if its inputs were the same and its files have not changed since.
    pub(super) fn current(&self, lock: &str) -> Option<Kept> {
        let bytes = disk().ok()??.bytes(KIND, address(&self.out)?)?;
        let kept: Kept = serde_json::from_slice(&bytes).ok()?;
        let is_same = kept.inputs == self.inputs(lock)
            && kept.named_hash == hash(&kept.named)
            && !LEFT.iter().any(|left| self.out.join(left).exists())
            && kept.outputs.iter().all(|(path, then)| then.is_some() && *then == state(&self.out.join(path)));
        is_same.then_some(kept)
    }

    /// Keeps the stamp of a bake, unless another program has published into the folder since.
    pub(super) fn keep(&self, lock: &str, encoded: &Encoded, materials: &[Material], summary: &Value, warnings: usize) {
        let (Ok(Some(store)), Some(address)) = (disk(), address(&self.out)) else { return };
        let _lock = shared(&self.out);
        if !encoded.is_in(&self.out) {
            return;
        }
        let named = all_named(materials);
        let paths = encoded.files.iter().map(|(path, _)| path.as_str()).chain([MANIFEST]);
        let kept = Kept {
            inputs: self.inputs(lock),
            named_hash: hash(&named),
            named,
            outputs: paths.map(|path| (path.to_owned(), state(&self.out.join(path)))).collect(),
            warnings,
            summary: summary.clone(),
        };
        if let Ok(bytes) = serde_json::to_vec(&kept) {
            store.put_bytes(KIND, address, &bytes);
        }
    }
}

impl Kept {
    /// All files that the bake read.
    pub(super) fn files(&self, files: &[PathBuf]) -> Vec<PathBuf> {
        files.iter().chain(&self.named).cloned().collect()
    }

    /// The outcome of a bake that had nothing to do, as JSON and in words: a check and a dry run have objects of their own. Standard error gets
    /// the number of earlier warnings.
    pub(super) fn say(&self, options: &BakeOptions) -> (Value, String) {
        if options.pipeline.dry_run {
            return pipeline::missing(&Missing { jobs: BTreeMap::new(), is_all: true });
        }
        let mut summary = self.summary.clone();
        summary["up_to_date"] = json!(true);
        if options.pipeline.check {
            summary = pipeline::compared(&[], &[]);
        }
        if options.json || options.quiet {
            return (summary, String::new());
        }
        if self.warnings > 0 {
            let (count, s) = (self.warnings, if self.warnings == 1 { "" } else { "s" });
            complain(&format!("{count} warning{s}, as before: `luthier check` shows all of materials"));
        }
        (summary, format!("up to date: {}", options.out.join(MANIFEST).display()))
    }
}

/// A hash of the paths and bytes of some files.
fn hash(files: &[PathBuf]) -> String {
    let hashes = files.par_iter().map(|path| match input::image(path) {
        Ok(bytes) => hashed(path, Key::of(&bytes)),
        Err(error) => hashed(path, error),
    });
    Key::of(hashes.collect::<Vec<_>>().concat().as_bytes()).to_string()
}

/// A line to be hashed: a path, and the hash of its bytes or the reason why it cannot be read.
fn hashed(path: &Path, hash: impl Display) -> String {
    format!("{} {hash}\n", path.display())
}
