//! Answers for build pipelines: whether a bake is up to date, the jobs that it would run, its files, a share of it.

use std::path::PathBuf;

use luthier::Missing;
use luthier_bake::Share;
use luthier_export::{Encoded, Folder, MANIFEST};
use luthier_material::Material;
use luthier_terminal::Outcome;
use serde_json::{Value, json};

use super::one::Done;
use crate::cli::{BakeOptions, Pipeline};
use crate::progress::BakeProgress;
use crate::watched::all_named;

impl Pipeline {
    /// True where the options ask for anything but events.
    pub(super) fn is_any(&self) -> bool {
        self.check || self.dry_run || self.watch || self.relock || self.depfile.is_some() || self.shard.is_some()
    }

    /// True where a stamp may end the bake early.
    pub(super) fn takes_stamp(&self) -> bool {
        !self.relock && self.shard.is_none()
    }
}

/// All files that a bake of these materials reads.
pub(super) fn read_files(files: &[PathBuf], materials: &[Material]) -> Vec<PathBuf> {
    files.iter().cloned().chain(all_named(materials)).collect()
}

/// The files and materials of a folder that a bake would change.
pub(super) fn check(options: &BakeOptions, encoded: &Encoded, lock: Option<String>) -> Outcome<Done> {
    let mut stale = encoded.stale(&options.out)?;
    stale.extend(lock);
    let before = Folder::open(&options.out).ok();
    let old = before.as_ref().map_or(&[][..], |folder| &folder.manifest().materials);
    let changed = encoded.manifest.materials.iter().filter(|new| {
        let old = old.iter().find(|old| old.name == new.name);
        old.is_none_or(|old| old.source_hash != new.source_hash)
    });
    let gone = old.iter().filter(|old| encoded.manifest.material_index(&old.name).is_none());
    let materials: Vec<&str> = changed.chain(gone).map(|material| material.name.as_str()).collect();
    let text = if !stale.is_empty() {
        let lines = stale.iter().map(|path| format!("stale: {path}"));
        let lines = lines.chain(materials.iter().map(|name| format!("changed: {name}")));
        lines.collect::<Vec<_>>().join("\n")
    } else if options.quiet {
        String::new()
    } else {
        format!("up to date: {}", options.out.join(MANIFEST).display())
    };
    Ok(Done { json: compared(&stale, &materials), text, is_stale: !stale.is_empty(), ..Done::default() })
}

/// The JSON of a check.
pub(super) fn compared(stale: &[String], materials: &[&str]) -> Value {
    json!({ "stale": stale, "materials": materials })
}

/// The jobs that a bake would run, as JSON and in words.
pub(super) fn missing(missing: &Missing) -> (Value, String) {
    let jobs: Vec<_> = missing.jobs.iter().map(|(kind, count)| (kind.name(), *count)).collect();
    let counts: Value = jobs.iter().map(|(kind, count)| ((*kind).to_owned(), json!(count))).collect();
    let mut lines: Vec<String> = jobs.iter().map(|(kind, count)| format!("{count:>6}  {kind}")).collect();
    if lines.is_empty() {
        lines.push("no job would run: the store has all results".to_owned());
    }
    if !missing.is_all {
        lines.push("and what depends on these".to_owned());
    }
    (json!({ "jobs": counts, "is_all": missing.is_all }), lines.join("\n"))
}

/// The jobs that a share took, as JSON and in words.
pub(super) fn share(options: &BakeOptions, share: Share, progress: &BakeProgress) -> (Value, String) {
    let (run, found) = (progress.run(), progress.had());
    let seconds: Value = progress.seconds().iter().map(|(kind, s)| (kind.name().to_owned(), json!(s))).collect();
    let text = format!("share {} of {}: {run} jobs run, {found} were in the store", share.index, share.count);
    let json = json!({ "shard": [share.index, share.count], "jobs": run, "found": found, "seconds": seconds });
    (json, if options.quiet { String::new() } else { text })
}
