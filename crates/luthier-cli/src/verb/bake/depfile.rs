//! The files that a bake depends on, as a rule that both Make and Ninja read.

use std::collections::BTreeSet;
use std::path::{Path, PathBuf, absolute};
use std::time::SystemTime;

use luthier_export::{MANIFEST, label};
use luthier_terminal::{Failure, Outcome, files};

use super::stamp;
use crate::cli::BakeOptions;

/// A depfile before it is written.
pub(super) struct Depfile {
    path: PathBuf,
    /// The folder of the manifest that is the target.
    out: PathBuf,
    /// Files and folders that the manifest depends on.
    needed: Vec<PathBuf>,
    text: String,
}

impl Depfile {
    /// The rule of packages, where one is asked for. Its target is the manifest of the first package: Ninja wants no other.
    ///
    /// # Errors
    /// [`Failure::Input`] for a name that Make or Ninja cannot read.
    pub(super) fn of(packages: &[(String, BakeOptions)], files: Vec<PathBuf>) -> Outcome<Option<Self>> {
        let (_, first) = &packages[0];
        let Some(path) = &first.pipeline.depfile else { return Ok(None) };
        let outs = packages.iter().map(|(_, options)| options.out.as_path());
        let written: BTreeSet<PathBuf> =
            outs.chain([path.parent().unwrap_or(Path::new(""))]).filter_map(real).collect();
        let folders = packages.iter().flat_map(|(_, options)| &options.sources.paths).filter(|path| path.is_dir());
        // A build that writes into a folder gives it a date after the manifest's, and would run again for ever.
        let folders = folders.filter(|folder| real(folder).is_some_and(|folder| !written.contains(&folder)));
        let (needed, text) = rule(&first.out.join(MANIFEST), files, folders.cloned().collect())?;
        Ok(Some(Self { path: path.clone(), out: first.out.clone(), needed, text }))
    }

    /// Writes the rule. A manifest that did not change gets a new date if a dependency is younger, because Make would build it again and again.
    pub(super) fn write(&self) -> Outcome {
        std::fs::write(&self.path, &self.text).map_err(files(&self.path, "write"))?;
        let manifest = self.out.join(MANIFEST);
        let made = date(&manifest);
        if self.needed.iter().any(|path| date(path) > made) {
            stamp::date(&self.out).map_err(files(&manifest, "date"))?;
        }
        Ok(())
    }
}

/// A folder without links; `None` where there is none.
fn real(folder: &Path) -> Option<PathBuf> {
    let folder = if folder.as_os_str().is_empty() { Path::new(".") } else { folder };
    folder.canonicalize().ok()
}

/// Dependencies of a manifest, and the rule that states them.
fn rule(manifest: &Path, files: Vec<PathBuf>, folders: Vec<PathBuf>) -> Outcome<(Vec<PathBuf>, String)> {
    let target = target(manifest)?;
    let mut names = files.iter().map(|path| dependency(path)).collect::<Outcome<Vec<_>>>()?;
    // A folder is named with `/.` at its end: under its own name it could be the target of another rule.
    names.extend(
        folders
            .iter()
            .map(|path| dependency(&path.join("_")).map(|name| format!("{}.", &name[..name.len() - 1])))
            .collect::<Outcome<Vec<_>>>()?,
    );
    // Make takes `a: b=c` for a variable of the target.
    names.sort_by_key(|name| name.contains('='));
    if let Some(name) = names.first().filter(|name| name.contains('=')) {
        return Err(unreadable(name, "Make takes the first of its names for a variable, because each has a `=`"));
    }
    Ok((files.into_iter().chain(folders).collect(), format!("{target}: {}\n", names.join(" \\\n  "))))
}

/// The manifest in a rule.
fn target(path: &Path) -> Outcome<String> {
    let name = escaped(path)?;
    if name.starts_with('~') {
        return Err(unreadable(&name, "Make takes a `~` at the beginning for a home folder"));
    }
    match name.chars().find(|c| "%=".contains(*c)) {
        Some(special) => {
            Err(unreadable(&name, &format!("no escape of `{special}` in a target is one for both Make and Ninja")))
        }
        None => Ok(name),
    }
}

/// A file in a rule.
fn dependency(path: &Path) -> Outcome<String> {
    let name = escaped(path)?;
    if name.starts_with('~') {
        // Make expands `~` in relative names only.
        return escaped(&absolute(path).map_err(files(path, "find"))?);
    }
    // After a blank, Make takes these for an assignment.
    Ok(if name.starts_with(['=', '+', '?', '!']) { format!("./{name}") } else { name })
}

/// A path in the spelling that Make and Ninja both read.
fn escaped(path: &Path) -> Outcome<String> {
    let name = label(path);
    let refuse = |why: &str| Err(unreadable(&name, why));
    if path.to_str().is_none() {
        return refuse("it is not UTF-8");
    }
    if let Some(c) = name.chars().find(|c| c.is_ascii_control() || "*|;<>^`".contains(*c)) {
        return refuse(&format!("no escape of {c:?} is one for both Make and Ninja"));
    }
    if name.ends_with([':', ')']) {
        return refuse("Make and Ninja take a `:` or `)` at the end of a name for something else");
    }
    // Make and Ninja treat backslashes in front of other signs differently: each halves, keeps or drops them.
    if name.char_indices().any(|(at, c)| c == '\\' && !name[at + 1..].starts_with(is_plain)) {
        return refuse("Make and Ninja read a backslash in front of another sign, or at the end, differently");
    }
    if let Some(other) = confused(path) {
        return refuse(&format!("Make takes it for a pattern, which `{other}` fits"));
    }
    let drive = if cfg!(windows) && name.as_bytes().get(1) == Some(&b':') { 2 } else { 0 };
    let (drive, rest) = name.split_at(drive);
    let rest = rest.replace('$', "$$").replace('#', "\\#").replace(' ', "\\ ").replace(':', "\\:");
    Ok(format!("{drive}{rest}"))
}

/// True for signs in front of which Make and Ninja keep a backslash.
fn is_plain(c: char) -> bool {
    c.is_alphanumeric() || "._-+,@/\\".contains(c)
}

/// The time of the last change of a file.
fn date(path: &Path) -> Option<SystemTime> {
    std::fs::metadata(path).and_then(|file| file.modified()).ok()
}

/// Another file or folder that fits a part of the path, read as a pattern of Make. Where nothing fits, Make takes the path as it is.
fn confused(path: &Path) -> Option<String> {
    path.ancestors().find_map(|path| {
        let name = path.file_name()?.to_str()?;
        let start = name.find(['[', '?'])?;
        let end = name.rfind([']', '?']).filter(|&end| end >= start)? + 1;
        // A pair of brackets stands for one sign.
        let length = name.chars().count();
        let signs = name.matches(['[', ']', '?']).count();
        let is_pair = signs == 2 && !name.contains('?');
        let most = if is_pair { length - name[start..end].chars().count() + 1 } else { length };
        let others = real(path.parent()?)?.read_dir().ok()?.filter_map(Result::ok);
        let mut others = others.map(|other| other.file_name().to_string_lossy().into_owned());
        others.find(|other| {
            let fits = other.starts_with(&name[..start]) && other.ends_with(&name[end..]);
            other != name && fits && other.chars().count() <= most
        })
    })
}

fn unreadable(name: &str, why: &str) -> Failure {
    Failure::Input(anyhow::anyhow!("--depfile cannot name {name:?}: {why}\nhint: rename it, or bake without --depfile"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn rule_of(manifest: &str, files: &[&str]) -> Result<String, String> {
        let files = files.iter().map(PathBuf::from).collect();
        rule(Path::new(manifest), files, Vec::new()).map(|(_, text)| text).map_err(|failure| failure.sentence())
    }

    #[test]
    fn names_are_escaped_as_both_read_them() {
        let files = ["a b/$x#.toml", "10:30:00/x.toml", "a%b~c/d[1]'.png", "é&(e)/f.toml", "g\\h.toml"];
        let expected = "o\\:1/manifest.json: a\\ b/$$x\\#.toml \\\n  10\\:30\\:00/x.toml \\\n  a%b~c/d[1]'.png \\\n  é&(e)/f.toml \\\n  g\\h.toml\n";
        let expected = if cfg!(windows) { expected.replace("g\\h", "g/h") } else { expected.to_owned() };
        assert_eq!(rule_of("o:1/manifest.json", &files).unwrap(), expected);
        assert_eq!(rule_of("m", &["s=3/a.toml", "=b", "c"]).unwrap(), "m: c \\\n  s=3/a.toml \\\n  ./=b\n");
        let home = rule_of("m", &["~/a.toml"]).unwrap();
        assert!(!home.contains(" ~") && home.ends_with("/~/a.toml\n"), "{home}");
    }

    #[cfg(unix)]
    #[test]
    fn names_that_one_of_them_misreads_are_refused() {
        for name in [
            "a*", "a|b", "a;b", "a\tb", "a\nb", "a\rb", "a<", "a>", "a^", "a`", "a:", "a(1)", "a\\", "a\\ b", "a\\#",
            "a\\:b", "a\\$", "a\\%", "s=1",
        ] {
            let error = rule_of("m", &[name]).unwrap_err();
            assert!(error.contains("--depfile cannot name") && error.contains("hint"), "{name:?}: {error}");
        }
        for manifest in ["a%/m", "a=1/m", "~/m"] {
            rule_of(manifest, &["a"]).unwrap_err();
        }
    }

    /// Make would depend on the file that fits, and never look at the one that was read.
    #[test]
    fn a_pattern_that_another_file_fits_is_refused() {
        let folder = tempfile::tempdir().unwrap();
        let at = |name: &str| folder.path().join(name);
        for name in ["a[12].toml", "a[3].toml", "]c[", "d[", "b?.toml"] {
            std::fs::write(at(name), "").unwrap();
            assert_eq!(confused(&at(name)), None, "{name}");
        }
        std::fs::write(at("a1.toml"), "").unwrap();
        assert_eq!(confused(&at("a[12].toml")).as_deref(), Some("a1.toml"));
        std::fs::write(at("bx.toml"), "").unwrap();
        assert_eq!(confused(&at("b?.toml")).as_deref(), Some("bx.toml"));
    }
}
