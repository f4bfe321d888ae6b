//! A folder for one test, and the command run in it.

use std::collections::BTreeMap;
use std::fs;
use std::io::Read;
use std::marker::PhantomData;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use std::sync::mpsc::{self, RecvTimeoutError};

use serde_json::Value;
use tempfile::TempDir;

use crate::{LOOK, Patience, Run};

/// Variable with the folder of a store that the tests of one run share.
const STORE: &str = "LUTHIER_TEST_STORE";

/// A command under test.
pub trait Program {
    /// Its name.
    const NAME: &'static str;
    /// The executable, which `env!("CARGO_BIN_EXE_…")` names.
    const PATH: &'static str;
}

/// A folder that goes away with the test, where a command runs.
#[derive(Debug)]
pub struct Workshop<P> {
    folder: TempDir,
    /// Whether its commands share a store with those of other tests.
    shares: bool,
    program: PhantomData<P>,
}

impl<P: Program> Default for Workshop<P> {
    fn default() -> Self {
        Self::new()
    }
}

impl<P: Program> Workshop<P> {
    /// An empty folder.
    pub fn new() -> Self {
        Self { folder: tempfile::tempdir().unwrap(), shares: true, program: PhantomData }
    }

    /// A folder with files in it, most of them materials.
    pub fn with(files: &[(&str, &str)]) -> Self {
        let workshop = Self::new();
        for (name, text) in files {
            workshop.write(name, text);
        }
        workshop
    }

    /// The path of a file in the folder.
    pub fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join(name)
    }

    /// Writes a file, and makes the folders above it.
    pub fn write(&self, name: &str, content: impl AsRef<[u8]>) {
        let path = self.path(name);
        fs::create_dir_all(path.parent().unwrap()).unwrap();
        fs::write(path, content).unwrap();
    }

    /// Changes a text file.
    pub fn edit(&self, name: &str, change: impl FnOnce(String) -> String) {
        self.write(name, change(self.text(name)));
    }

    /// The text of a file.
    pub fn text(&self, name: &str) -> String {
        fs::read_to_string(self.path(name)).unwrap()
    }

    /// The JSON of a file.
    pub fn json(&self, name: &str) -> Value {
        serde_json::from_str(&self.text(name)).unwrap()
    }

    /// The folder, whose commands have no store but those that they name.
    #[must_use]
    pub fn apart(self) -> Self {
        Self { shares: false, ..self }
    }

    /// Runs the command in the folder; its streams are pipes.
    pub fn run(&self, args: &[&str]) -> Run {
        Self::run_with(self.shares, self.folder.path(), args)
    }

    /// Runs the command in any folder; its streams are pipes.
    pub fn run_in(folder: &Path, args: &[&str]) -> Run {
        Self::run_with(true, folder, args)
    }

    fn run_with(shares: bool, folder: &Path, args: &[&str]) -> Run {
        let said = format!("{} {}", P::NAME, args.join(" "));
        let mut command = Command::new(P::PATH);
        // Tests leave nothing in the caches of who runs them. Those of one run of scripts/test.sh share a store, so that none computes
        // what another has.
        command
            .env("LUTHIER_CACHE", std::env::var_os(STORE).filter(|_| shares).unwrap_or_default())
            .current_dir(folder)
            .args(args);
        // No test opens a window through this.
        command.env_remove("XDG_RUNTIME_DIR").env_remove("NODEVICE_SELECT");
        let mut child = command.stdin(Stdio::null()).stdout(Stdio::piped()).stderr(Stdio::piped()).spawn().unwrap();
        let mut patience = Patience::with(child.id());
        let streams = [all_of(child.stdout.take().unwrap()), all_of(child.stderr.take().unwrap())];
        let [stdout, stderr] = streams.map(|stream| {
            loop {
                match stream.recv_timeout(LOOK) {
                    Ok(text) => return text,
                    Err(RecvTimeoutError::Disconnected) => panic!("{said}: output that is no text"),
                    Err(RecvTimeoutError::Timeout) => {}
                }
                if let Err(did) = patience.look() {
                    child.kill().unwrap();
                    panic!("{said}: {did}");
                }
            }
        });
        Run { command: said, code: child.wait().unwrap().code(), stdout, stderr }
    }

    /// All that is in a folder, hidden files too: path from there, with forward slashes, and bytes; folders end in a slash.
    pub fn tree(&self, folder: &str) -> BTreeMap<String, Vec<u8>> {
        let mut found = BTreeMap::new();
        collect(&self.path(folder), "", &mut found);
        found
    }

    /// The files of [`Self::tree`].
    pub fn files(&self, folder: &str) -> Vec<String> {
        self.tree(folder).into_keys().filter(|path| !path.ends_with('/')).collect()
    }
}

/// All that comes out of a stream, once it ends.
fn all_of(mut stream: impl Read + Send + 'static) -> mpsc::Receiver<String> {
    let (all, ended) = mpsc::channel();
    std::thread::spawn(move || {
        let mut text = String::new();
        stream.read_to_string(&mut text).unwrap();
        // Nobody listens where the test has failed.
        let _ = all.send(text);
    });
    ended
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
