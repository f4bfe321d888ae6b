//! `bake`: files into a folder, and `merge`, which finds the results of shares in the store.

mod depfile;
mod locked;
mod one;
mod pipeline;
mod stamp;
mod watch;
mod words;

use std::collections::BTreeSet;
use std::path::PathBuf;

use luthier::{Bake, Files};
use luthier_export::{Compression, Encoded, Package};
use luthier_manifest::Functions;
use luthier_shader::{Form, Target};
use luthier_terminal::{Failure, Outcome, Sources, print};

use self::depfile::Depfile;
use self::one::{Begun, Done, Made};
use crate::cli::{BakeOptions, Emission};
use crate::store::disk;
use crate::verb::scene;

/// Bakes files into a folder. The folder changes only once everything is made.
pub(crate) fn run(options: &BakeOptions) -> Outcome {
    if options.pipeline.shard.is_some() {
        need_store("--shard")?;
    }
    if options.pipeline.watch { watch::run(options) } else { once(options).map(drop) }
}

/// Bakes from the results that shares of other processes left in the store, and reports the jobs that it had to run itself.
pub(crate) fn merge(options: &BakeOptions) -> Outcome {
    let pipeline = &options.pipeline;
    if let Some(option) =
        [(pipeline.shard.is_some(), "--shard"), (pipeline.watch, "--watch")].iter().find(|(is_given, _)| *is_given)
    {
        return Err(Failure::Usage(anyhow::anyhow!("`{}` is for `luthier bake`", option.1)));
    }
    need_store("merge")?;
    once(options).map(drop)
}

fn need_store(user: &str) -> Outcome {
    match disk()? {
        Some(_) => Ok(()),
        None => Err(Failure::Usage(anyhow::anyhow!(
            "`{user}` needs a store: name its folder with --cache, or by the variable LUTHIER_CACHE"
        ))),
    }
}

/// Bakes once. Returns the files that the bake read.
fn once(options: &BakeOptions) -> Outcome<Vec<PathBuf>> {
    let mut found = Files::packages(&options.sources.paths)?;
    let outer = &mut found[0].2;
    if !outer.scenes.is_empty() {
        scene::refuse_mixture(outer)?;
        if options.pipeline.is_any() {
            return Err(Failure::Usage(anyhow::anyhow!(
                "--check, --depfile, --dry-run, --relock, --shard and --watch are for materials, not for scenes"
            )));
        }
        let scenes = std::mem::take(&mut outer.scenes);
        let read = scenes.iter().map(|scene| scene.path.clone()).collect();
        scene::run(options, scenes)?;
        return Ok(read);
    }
    if options.allow_miss || !options.budgets.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "--allow-miss and --budgets are for scenes (docs/pages/scenes.md)"
        )));
    }
    let (packages, files): (Vec<(String, BakeOptions)>, Vec<Files>) =
        found.into_iter().map(|(name, paths, files)| (package(options, name, paths), files)).unzip();
    // No package is made before all are valid, and none is written before all are made.
    let begun = packages.iter().zip(files).map(|((_, options), files)| Begun::read(options, files));
    let begun = begun.collect::<Outcome<Vec<_>>>()?;
    let needed = begun.iter().flat_map(Begun::needed).collect();
    let depfile = Depfile::of(&packages, needed)?;
    let made = begun.into_iter().map(Begun::make).collect::<Outcome<Vec<_>>>()?;
    let done = made.into_iter().map(Made::publish).collect::<Outcome<Vec<Done>>>()?;
    depfile.map_or(Ok(()), |depfile| depfile.write())?;
    say(options, &packages, &done)?;
    if done.iter().any(|done| done.is_stale) {
        return Err(Failure::Verdict);
    }
    Ok(done.into_iter().flat_map(|done| done.read).collect())
}

/// The name and the options of one package. A package of folders inside goes into a folder of its name.
fn package(options: &BakeOptions, name: String, paths: Vec<PathBuf>) -> (String, BakeOptions) {
    let out = if name.is_empty() { options.out.clone() } else { options.out.join(&name) };
    (name, BakeOptions { sources: Sources { paths }, out, ..options.clone() })
}

/// Prints the outcome of all packages. In JSON, the first package's object holds the others by name.
fn say(options: &BakeOptions, packages: &[(String, BakeOptions)], done: &[Done]) -> Outcome {
    if options.json {
        let mut first = done[0].json.clone();
        if let [_, inner @ ..] = packages {
            let inner = inner.iter().zip(&done[1..]).map(|((name, _), done)| (name.clone(), done.json.clone()));
            first["packages"] = inner.collect();
        }
        return print(&format!("{first:#}"));
    }
    let said = packages.iter().zip(done).filter(|(_, done)| !done.text.is_empty());
    let texts = said.map(|((name, _), done)| {
        let heading = if name.is_empty() { String::new() } else { format!("{name}:\n") };
        heading + done.text.trim_end()
    });
    let texts: Vec<String> = texts.collect();
    if texts.is_empty() { Ok(()) } else { print(&texts.join("\n\n")) }
}

impl Emission {
    /// The languages of the shaders to write, each once.
    pub(super) fn targets(&self) -> Vec<Target> {
        let asked: BTreeSet<Target> = self.target.iter().copied().collect();
        if asked.is_empty() { Bake::default().targets } else { asked.into_iter().collect() }
    }

    /// The forms that are asked for, each once.
    fn forms(&self) -> Vec<Form> {
        self.form.iter().copied().collect::<BTreeSet<Form>>().into_iter().collect()
    }

    /// The groups of functions of each shader.
    pub(super) fn functions(&self) -> Functions {
        self.functions.iter().copied().collect()
    }
}

impl BakeOptions {
    /// As many threads as are asked for.
    pub(super) fn pool(&self) -> Outcome<rayon::ThreadPool> {
        let threads = rayon::ThreadPoolBuilder::new().num_threads(self.threads.map_or(0, usize::from));
        threads.build().map_err(|source| Failure::Files(anyhow::Error::new(source).context("cannot start threads")))
    }

    /// The files of a package, as these options ask for them.
    pub(super) fn encoded(&self, package: &Package) -> Outcome<Encoded> {
        let compression = if self.no_zstd { Compression::None } else { Compression::Zstd };
        let encoded = package.encode(compression)?.for_folder(&self.out);
        Ok(if self.hashed_names { encoded.with_hashed_names() } else { encoded })
    }
}
