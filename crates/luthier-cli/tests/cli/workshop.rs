//! A folder for one test, and the command run in it.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::Duration;

use assert_cmd::cargo::cargo_bin_cmd;
use serde_json::Value;
use sha2::{Digest, Sha256};
use tempfile::TempDir;

/// Far more than anything here takes on a busy machine; a hang becomes a failure.
const PATIENCE: Duration = Duration::from_secs(900);

/// An empty folder that goes away with the test.
pub(crate) struct Workshop(TempDir);

impl Workshop {
    pub(crate) fn new() -> Self {
        Self(tempfile::tempdir().unwrap())
    }

    /// A folder with files in it, most of them materials.
    pub(crate) fn with(files: &[(&str, &str)]) -> Self {
        let workshop = Self::new();
        for (name, text) in files {
            workshop.write(name, text);
        }
        workshop
    }

    pub(crate) fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    /// Changes a text file.
    pub(crate) fn edit(&self, name: &str, change: impl FnOnce(String) -> String) {
        self.write(name, change(self.text(name)));
    }

    pub(crate) fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    pub(crate) fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    pub(crate) fn run(&self, args: &[&str]) -> Run {
        run_in(self.0.path(), args)
    }

    /// All that is in a folder, hidden files too: path from there, with forward slashes, and bytes; folders end in a slash.
    pub(crate) fn tree(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut found = BTreeMap::new();
        collect(&self.path(folder), "", &mut found);
        found
    }

    /// The files of [`Self::tree`].
    pub(crate) fn files(&self, folder: &str) -> Vec<String> {
        self.tree(folder).into_keys().filter(|path| !path.ends_with('/')).collect()
    }
}

fn collect(folder: &Path, prefix: &str, found: &mut BTreeMap<String, Vec<u8>>) {
    for entry in fs::read_dir(folder).unwrap() {
        let entry = entry.unwrap();
        let name = format!("{prefix}{}", entry.file_name().to_str().unwrap());
        if entry.file_type().unwrap().is_dir() {
            found.insert(format!("{name}/"), Vec::new());
            collect(&entry.path(), &format!("{name}/"), found);
        } else {
            found.insert(name, fs::read(entry.path()).unwrap());
        }
    }
}

/// Output of a command, and how it ended.
pub(crate) struct Run {
    command: String,
    pub(crate) code: Option<i32>,
    pub(crate) stdout: String,
    pub(crate) stderr: String,
}

impl Run {
    /// A run that was started by other means, and said nothing on standard output.
    #[cfg(feature = "view")]
    pub(crate) fn ended(command: &str, code: Option<i32>, stderr: String) -> Self {
        Self { command: command.to_owned(), code, stdout: String::new(), stderr }
    }

    /// Exit code as expected.
    #[track_caller]
    pub(crate) fn exits(self, code: i32) -> Self {
        assert_eq!(self.code, Some(code), "luthier {}\n{}{}", self.command, self.stdout, self.stderr);
        self
    }

    /// Refused with one error, without a word on standard output.
    #[track_caller]
    pub(crate) fn fails(self, code: i32, parts: &[&str]) -> Self {
        let run = self.exits(code);
        assert_eq!(run.stdout, "", "luthier {}", run.command);
        let errors = run.errors();
        assert_eq!(errors.len(), 1, "luthier {}\n{}", run.command, run.stderr);
        for part in parts {
            assert!(errors[0].contains(part), "luthier {}\nno `{part}` in\n{}", run.command, run.stderr);
        }
        run
    }

    /// Lines that begin an error, but for the one that drivers of a machine without a desktop print.
    pub(crate) fn errors(&self) -> Vec<&str> {
        let is_ours = |line: &&str| line.starts_with("error: ") && !line.contains("XDG_RUNTIME_DIR");
        self.stderr.lines().filter(is_ours).collect()
    }

    #[track_caller]
    pub(crate) fn says(self, parts: &[&str]) -> Self {
        for part in parts {
            assert!(self.stderr.contains(part), "luthier {}\nno `{part}` in\n{}", self.command, self.stderr);
        }
        self
    }

    #[track_caller]
    pub(crate) fn json(&self) -> Value {
        serde_json::from_str(&self.stdout).unwrap()
    }
}

/// Runs `luthier` in a folder; its streams are pipes.
pub(crate) fn run_in(folder: &Path, args: &[&str]) -> Run {
    let output = cargo_bin_cmd!("luthier").current_dir(folder).args(args).timeout(PATIENCE).output().unwrap();
    Run {
        command: args.join(" "),
        code: output.status.code(),
        stdout: String::from_utf8(output.stdout).unwrap(),
        stderr: String::from_utf8(output.stderr).unwrap(),
    }
}

/// Top of the repository.
pub(crate) fn root() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../..")
}

/// The `*.toml` of a folder of the repository, by name.
pub(crate) fn material_files(folder: &str) -> Vec<PathBuf> {
    let entries = fs::read_dir(root().join(folder)).unwrap();
    let mut paths: Vec<PathBuf> = entries.map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|e| e == "toml"));
    paths.sort();
    paths
}

pub(crate) fn file_name(path: &Path) -> &str {
    path.file_name().unwrap().to_str().unwrap()
}

/// SHA-256 in hex.
pub(crate) fn sha256(bytes: &[u8]) -> String {
    Sha256::digest(bytes).iter().map(|byte| format!("{byte:02x}")).collect()
}

/// A program that a test needs: where it is missing the test is skipped with a note, but fails on a build server.
pub(crate) fn is_installed(program: &str, package: &str) -> bool {
    if std::process::Command::new(program).arg("--version").output().is_ok() {
        return true;
    }
    assert!(std::env::var_os("CI").is_none(), "`{program}` is missing: install the package {package}");
    eprintln!("skipped: `{program}` is not installed (Debian package {package})");
    false
}

/// Whether a run ended for want of a graphics adapter. On a build server there must be one.
#[cfg(feature = "gpu")]
pub(crate) fn lacks_adapter(run: &Run) -> bool {
    let lacks = run.code == Some(4) && run.stderr.contains("mesa-vulkan-drivers");
    if lacks {
        assert!(std::env::var_os("CI").is_none(), "{}", run.stderr);
        eprintln!("skipped: {}", run.stderr.trim_end());
    }
    lacks
}
