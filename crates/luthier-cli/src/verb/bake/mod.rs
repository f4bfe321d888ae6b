//! `bake`: files into a folder, and `merge`, which finds the results of shares in the store.

mod locked;
mod pipeline;
mod stamp;
mod watch;
mod words;

use std::collections::BTreeSet;
use std::path::PathBuf;
use std::time::Instant;

use luthier_bake::{Observer, Silent};
use luthier_export::{Bake, Compression, MANIFEST, Package, Source, find, gather, read_all, refuse, refuse_surfaces};
use luthier_manifest::Functions;
use luthier_material::Diagnostic;
use luthier_shader::{Form, Target};
use luthier_terminal::{Failure, Outcome, complain, print, valid};

use self::locked::LockFile;
use self::stamp::Stamp;
use crate::cli::{BakeOptions, Emission};
use crate::interrupt::whole;
use crate::materials::{refuse_environment, shaded, shows_environment, valid_surfaces};
use crate::misses;
use crate::progress::BakeProgress;
use crate::store::{disk, store};
use crate::verb::check::diagnostics;
use crate::verb::scene;

/// Bakes files into a folder. The folder changes only once everything is made.
pub(crate) fn run(options: &BakeOptions) -> Outcome {
    if options.pipeline.shard.is_some() {
        need_store("--shard")?;
    }
    if options.pipeline.watch { watch::run(options) } else { once(options).map(drop) }
}

/// Bakes from what the shares of other processes left in the store, and says what it had to compute itself.
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

/// Bakes once; the files that the bake read.
fn once(options: &BakeOptions) -> Outcome<Vec<PathBuf>> {
    let start = Instant::now();
    if let Some(scenes) = scene::find(&options.sources.paths)? {
        if options.pipeline.is_any() {
            return Err(Failure::Usage(anyhow::anyhow!(
                "--check, --depfile, --dry-run, --relock, --shard and --watch are for materials, not for scenes"
            )));
        }
        scene::run(options, &scenes)?;
        return Ok(scenes);
    }
    if options.allow_miss || !options.budgets.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "--allow-miss and --budgets are for scenes (docs/pages/scenes.md)"
        )));
    }
    let mut found = gather(&find(&options.sources.paths)?)?;
    let files = [found.materials.as_slice(), &found.surface_files].concat();
    let lock = LockFile::beside(&options.sources.paths, options.pipeline.relock)?;
    let stamp = Stamp::new(options, &files, lock.text());
    let progress = BakeProgress::new(options.pipeline.events);
    if let Some(kept) = stamp.current().filter(|_| options.pipeline.takes_stamp()) {
        let read = stamp.files(&files, &kept);
        pipeline::write_depfile(options, &read, &lock)?;
        progress.event("up-to-date", &options.out.join(MANIFEST));
        kept.say(options)?;
        return Ok(read);
    }
    let forms = options.emission.forms();
    let mut sources = read_all(&found.materials)?;
    refuse(&mut sources, |material| options.shading.doubts(material, &forms));
    let mut told: Vec<Diagnostic> = sources.iter().flat_map(Source::diagnostics).cloned().collect();
    refuse_surfaces(&mut found.surfaces, &sources);
    let surfaces = valid_surfaces(&found.surfaces)?;
    let materials = shaded(valid(sources, options.quiet)?, &options.shading, &forms);
    let is_shown = materials.iter().any(shows_environment) && forms != [Form::Full];
    refuse_environment(&options.emission.functions, is_shown)?;
    let limits = luthier_bake::Options { locked: lock.decisions(), ..options.limits.options() };
    if forms == [Form::Full] && !limits.budget.is_empty() {
        return Err(Failure::Usage(anyhow::anyhow!(
            "limits are those of tables, and a bake of --form full has no tables"
        )));
    }
    progress.ends("read");
    let pool = rayon::ThreadPoolBuilder::new()
        .num_threads(options.threads.map_or(0, usize::from))
        .build()
        .map_err(|source| Failure::Files(anyhow::Error::new(source).context("cannot start threads")))?;
    let observer: &(dyn Observer + Sync) = if options.quiet && !options.pipeline.events { &Silent } else { &progress };
    let (targets, functions) = (options.emission.targets(), options.emission.functions());
    let bake = Bake { options: limits, targets, forms, functions, surfaces, observer, ..Bake::default() };
    let read = pipeline::read_files(&files, &materials);
    if options.pipeline.dry_run {
        let missing = pool.install(|| bake.missing(&materials, store()?).map_err(Failure::from))?;
        pipeline::say_missing(options, &missing)?;
        return Ok(read);
    }
    if let Some(share) = options.pipeline.shard {
        pool.install(|| bake.share(&materials, store()?, share).map_err(Failure::from))?;
        pipeline::say_share(options, share, &progress)?;
        return Ok(read);
    }
    let store = store()?;
    let encoded = pool.install(|| {
        let mut package = Package::new(&materials, &bake, store)?;
        // A bake that writes a lock is the bake that the lock gives: the next one finds nothing to do.
        if let Some(next) = lock.next(&package.manifest) {
            let locked = luthier_bake::Options { locked: &next.decisions, ..bake.options };
            package = Package::new(&materials, &Bake { options: locked, ..bake.clone() }, store)?;
        }
        progress.ends("make");
        Ok::<_, Failure>(package.encode(options.compression())?)
    })?;
    progress.ends("encode");
    let manifest = &encoded.manifest;
    if options.pipeline.check {
        pipeline::check(options, &encoded, lock.stale(manifest))?;
        return Ok(read);
    }
    whole(&options.out, || encoded.write(&options.out))?;
    progress.ends("write");
    if let Some(why) = lock.write(manifest)? {
        complain(&why);
    }
    progress.event("published", &options.out.join(MANIFEST));
    told.extend(misses::name(manifest, options.quiet)?);
    pipeline::write_depfile(options, &read, &lock)?;
    let mut summary = words::summary(options, manifest, &progress, start);
    summary["diagnostics"] = diagnostics(&told);
    if options.json {
        print(&format!("{summary:#}"))?;
    } else if !options.quiet {
        print(&words::text(options, manifest, &progress, start))?;
    }
    // The lock may be another one now.
    let lock = LockFile::beside(&options.sources.paths, false)?;
    Stamp::new(options, &files, lock.text()).keep(&encoded, &materials, &summary, told.len());
    Ok(read)
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
    pub(super) fn compression(&self) -> Compression {
        if self.no_zstd { Compression::None } else { Compression::Zstd }
    }
}
