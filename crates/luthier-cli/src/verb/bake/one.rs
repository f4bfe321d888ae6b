//! The bake of one package in three steps: read its files, make all of it, publish it.

use std::path::PathBuf;

use luthier::{Bake, Files, Source, Sources};
use luthier_bake::{Observer, Silent};
use luthier_export::{Encoded, MANIFEST};
use luthier_manifest::SurfaceEntry;
use luthier_material::{Diagnostic, Material};
use luthier_shader::Form;
use luthier_terminal::{Failure, Outcome, complain, valid};
use serde_json::Value;

use super::locked::LockFile;
use super::stamp::{Kept, Stamp};
use super::{pipeline, words};
use crate::cli::BakeOptions;
use crate::interrupt::whole;
use crate::materials::{refuse_environment, shows_environment, tell_misses, valid_surfaces};
use crate::progress::{BakeProgress, event, published};
use crate::store::{near, store};
use crate::verb::check::diagnostics;

/// A package whose files were read and are valid.
pub(super) struct Begun<'a> {
    options: &'a BakeOptions,
    /// The files that were found, without files that materials name.
    files: Vec<PathBuf>,
    stamp: Stamp,
    lock: LockFile,
    progress: BakeProgress,
    found: Found,
}

/// A package as its files and its stamp describe it.
enum Found {
    /// The folder is up to date.
    Current(Kept),
    /// The package has to be baked.
    Set(Set),
}

/// Materials and surfaces that are to be baked.
struct Set {
    materials: Vec<Material>,
    surfaces: Vec<SurfaceEntry>,
    /// Warnings that were printed.
    told: Vec<Diagnostic>,
}

/// A package after its second step; made, unless the options ask for less.
pub(super) struct Made<'a> {
    begun: Begun<'a>,
    encoded: Option<Encoded>,
    /// The outcome, as JSON and as text, of options that ask for less than a package.
    said: Option<(Value, String)>,
}

/// The end of a package's bake: published, compared, or only counted.
#[derive(Default)]
pub(super) struct Done {
    pub(super) json: Value,
    pub(super) text: String,
    /// All files that the bake read.
    pub(super) read: Vec<PathBuf>,
    /// True where `--check` found that a bake would change the folder.
    pub(super) is_stale: bool,
}

impl<'a> Begun<'a> {
    /// Parses the files of a package, and refuses what cannot be baked.
    pub(super) fn read(options: &'a BakeOptions, found: Files) -> Outcome<Self> {
        let progress = BakeProgress::new();
        let found = found.without_scenes();
        let files = found.paths().map(PathBuf::from).collect();
        let lock = LockFile::beside(&options.sources.paths, options.pipeline.relock)?;
        let stamp = Stamp::new(options, &found);
        let kept = stamp.current(lock.text()).filter(|_| options.pipeline.takes_stamp());
        if let Some(kept) = kept {
            return Ok(Self { options, files, stamp, lock, progress, found: Found::Current(kept) });
        }
        let forms = options.emission.forms();
        let shading = options.shading.in_forms(&forms);
        let mut sources = Sources::of(found);
        sources.put_first(lock.names());
        sources.refuse(&shading);
        sources.doubt_energy(&shading, near()?);
        let told = sources.materials.iter().flat_map(Source::diagnostics).cloned().collect();
        let surfaces = valid_surfaces(&sources.surfaces)?;
        let materials = shading.shaded(valid(sources.materials, options.quiet)?);
        let is_shown = materials.iter().any(|material| shows_environment(material, &forms));
        refuse_environment(&options.emission.functions, is_shown)?;
        if forms == [Form::Full] && !options.limits.options().budget.is_empty() {
            return Err(Failure::Usage(anyhow::anyhow!(
                "limits are those of tables, and a bake of --form full has no tables"
            )));
        }
        progress.ends("read");
        Ok(Self { options, files, stamp, lock, progress, found: Found::Set(Set { materials, surfaces, told }) })
    }

    /// The files that the bake reads.
    fn read_files(&self) -> Vec<PathBuf> {
        match &self.found {
            Found::Current(kept) => kept.files(&self.files),
            Found::Set(set) => pipeline::read_files(&self.files, &set.materials),
        }
    }

    /// The files that the bake depends on: those that it reads, and the lock as it is found.
    pub(super) fn needed(&self) -> Vec<PathBuf> {
        self.read_files().into_iter().chain(self.lock.file().map(PathBuf::from)).collect()
    }

    /// Makes the package, or as much of it as the options ask for.
    pub(super) fn make(self) -> Outcome<Made<'a>> {
        let Self { options, lock, progress, .. } = &self;
        let Found::Set(set) = &self.found else { return Ok(Made { begun: self, encoded: None, said: None }) };
        progress.resumes();
        let pool = options.pool()?;
        let observer: &(dyn Observer + Sync) =
            if options.quiet && !options.pipeline.events { &Silent } else { progress };
        let limits = options.limits.options();
        let layout = limits.layout.or(options.costs_of.row_layout()?);
        let bake = Bake {
            options: luthier_bake::Options { locked: lock.decisions(), layout, ..limits },
            targets: options.emission.targets(),
            shading: options.shading.in_forms(&options.emission.forms()),
            functions: options.emission.functions(),
            names: options.emission.names.names(),
            surfaces: set.surfaces.clone(),
            observer,
            ..Bake::default()
        };
        let materials = &set.materials;
        if options.pipeline.dry_run {
            let missing = pool.install(|| bake.missing(materials, store()?).map_err(Failure::from))?;
            return Ok(Made { encoded: None, said: Some(pipeline::missing(&missing)), begun: self });
        }
        if let Some(share) = options.pipeline.shard {
            pool.install(|| bake.share(materials, store()?, share).map_err(Failure::from))?;
            return Ok(Made { encoded: None, said: Some(pipeline::share(options, share, progress)), begun: self });
        }
        let store = store()?;
        let encoded = pool.install(|| {
            let mut package = bake.package(materials, store)?;
            // A bake that writes a lock is made again from it, so that the next bake changes nothing.
            if let Some(next) = lock.next(&package.manifest) {
                let locked = luthier_bake::Options { locked: &next.decisions, ..bake.options };
                package = Bake { options: locked, ..bake.clone() }.package(materials, store)?;
            }
            progress.ends("make");
            options.encoded(&package)
        })?;
        progress.ends("encode");
        Ok(Made { encoded: Some(encoded), said: None, begun: self })
    }
}

impl Made<'_> {
    /// Publishes the package, where one was made and is not only to be compared.
    pub(super) fn publish(self) -> Outcome<Done> {
        let read = self.begun.read_files();
        let Self { begun: Begun { options, stamp, lock, progress, found, .. }, encoded, said } = self;
        let set = match found {
            Found::Current(kept) => {
                event("up-to-date", &options.out.join(MANIFEST));
                let (json, text) = kept.say(options);
                return Ok(Done { json, text, read, is_stale: false });
            }
            Found::Set(set) => set,
        };
        let Some(encoded) = encoded else {
            let (json, text) = said.unwrap_or_default();
            return Ok(Done { json, text, read, ..Done::default() });
        };
        let manifest = &encoded.manifest;
        if options.pipeline.check {
            return Ok(Done { read, ..pipeline::check(options, &encoded, lock.stale(manifest))? });
        }
        progress.resumes();
        whole(&options.out, || encoded.write(&options.out))?;
        progress.ends("write");
        if let Some(why) = lock.write(manifest)? {
            complain(&why);
        }
        published(&options.out);
        let told = [set.told, tell_misses(manifest, &set.materials, options.quiet)].concat();
        let mut json = words::summary(options, manifest, &progress);
        json["diagnostics"] = diagnostics(&told);
        let text = if options.quiet { String::new() } else { words::text(options, manifest, &progress) };
        // This bake may have written the lock.
        let lock = LockFile::beside(&options.sources.paths, false)?;
        stamp.keep(lock.text(), &encoded, &set.materials, &json, told.len());
        Ok(Done { json, text, read, is_stale: false })
    }
}
