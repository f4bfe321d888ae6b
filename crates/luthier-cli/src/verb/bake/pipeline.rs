//! Questions of build pipelines about a bake: whether it is up to date, what it would do, what it depends on, a share of it.

use std::path::{Path, PathBuf};

use luthier_bake::Share;
use luthier_export::{Encoded, Folder, MANIFEST, Missing};
use luthier_material::Material;
use luthier_terminal::{Failure, Outcome, files, print};
use serde_json::{Value, json};

use super::locked::LockFile;
use crate::cli::{BakeOptions, Pipeline};
use crate::progress::BakeProgress;
use crate::watched::all_named;

impl Pipeline {
    /// Whether anything but events is asked for.
    pub(super) fn is_any(&self) -> bool {
        self.check || self.dry_run || self.watch || self.relock || self.depfile.is_some() || self.shard.is_some()
    }

    /// Whether a bake that was made before needs no second look.
    pub(super) fn takes_stamp(&self) -> bool {
        !self.relock && self.shard.is_none()
    }
}

/// All files that a bake of these materials reads.
pub(super) fn read_files(files: &[PathBuf], materials: &[Material]) -> Vec<PathBuf> {
    files.iter().cloned().chain(all_named(materials)).collect()
}

/// Writes the files that a bake depends on, as a rule of Make, where it is asked for.
pub(super) fn write_depfile(options: &BakeOptions, read: &[PathBuf], lock: &LockFile) -> Outcome {
    let Some(path) = &options.pipeline.depfile else { return Ok(()) };
    let needed: Vec<String> = read.iter().map(PathBuf::as_path).chain(lock.file()).map(escaped).collect();
    let rule = format!("{}: {}\n", escaped(&options.out.join(MANIFEST)), needed.join(" \\\n  "));
    std::fs::write(path, rule).map_err(files(path, "write"))
}

/// A path in a rule of Make.
fn escaped(path: &Path) -> String {
    let text = path.to_string_lossy();
    text.replace('\\', "/").replace('$', "$$").replace('#', "\\#").replace(' ', "\\ ")
}

/// Says what of a folder a bake would change; the verdict is no where that is anything.
pub(super) fn check(options: &BakeOptions, encoded: &Encoded, lock: Option<String>) -> Outcome {
    let mut stale = encoded.stale(&options.out)?;
    stale.extend(lock);
    let before = Folder::open(&options.out).ok();
    let source = |name: &str| before.as_ref()?.manifest().materials.iter().find(|m| m.name == name);
    let changed = |name: &str, hash: &str| source(name).is_none_or(|material| material.source_hash != hash);
    let materials = encoded.manifest.materials.iter().filter(|m| changed(&m.name, &m.source_hash));
    let mut materials: Vec<&str> = materials.map(|m| m.name.as_str()).collect();
    let is_gone = |name: &str| encoded.manifest.material_index(name).is_none();
    let old = before.iter().flat_map(|folder| &folder.manifest().materials);
    materials.extend(old.map(|m| m.name.as_str()).filter(|name| is_gone(name)));
    if options.json {
        print(&format!("{:#}", json!({ "stale": stale, "materials": materials })))?;
    } else if stale.is_empty() {
        if !options.quiet {
            print(&format!("up to date: {}", options.out.join(MANIFEST).display()))?;
        }
    } else {
        let lines = stale.iter().map(|path| format!("stale: {path}"));
        let lines = lines.chain(materials.iter().map(|name| format!("changed: {name}")));
        print(&lines.collect::<Vec<_>>().join("\n"))?;
    }
    if stale.is_empty() { Ok(()) } else { Err(Failure::Verdict) }
}

/// Says which jobs a bake would run.
pub(super) fn say_missing(options: &BakeOptions, missing: &Missing) -> Outcome {
    let jobs = missing.jobs.iter().map(|(kind, count)| (kind.name(), *count));
    if options.json {
        let jobs: Value = jobs.map(|(kind, count)| (kind.to_owned(), json!(count))).collect();
        return print(&format!("{:#}", json!({ "jobs": jobs, "is_all": missing.is_all })));
    }
    let mut lines: Vec<String> = jobs.map(|(kind, count)| format!("{count:>6}  {kind}")).collect();
    if lines.is_empty() {
        lines.push("no job would run: the store has all results".to_owned());
    }
    if !missing.is_all {
        lines.push("and what depends on these".to_owned());
    }
    print(&lines.join("\n"))
}

/// Says what a share took.
pub(super) fn say_share(options: &BakeOptions, share: Share, progress: &BakeProgress) -> Outcome {
    let (run, found) = (progress.run(), progress.had());
    if options.json {
        let seconds: Value = progress.seconds().iter().map(|(kind, s)| (kind.name().to_owned(), json!(s))).collect();
        let share = json!([share.index, share.count]);
        print(&format!("{:#}", json!({ "shard": share, "jobs": run, "found": found, "seconds": seconds })))
    } else if options.quiet {
        Ok(())
    } else {
        print(&format!("share {} of {}: {run} jobs run, {found} were in the store", share.index, share.count))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_are_escaped_as_make_reads_them() {
        assert_eq!(escaped(Path::new("a b/$x#.toml")), "a\\ b/$$x\\#.toml");
    }
}
