//! An editor's loop: a text comes in at each key, its mistakes come out with their places, and a bake computes what the text changed. A new text
//! ends the bake of the one before. Run with `cargo run -p luthier --example editor`.
#![expect(clippy::print_stdout, reason = "it shows what happens")]

use std::path::Path;
use std::sync::atomic::{AtomicBool, AtomicUsize, Ordering};

use luthier::{Bake, Error, Form, MemoryStore, Observer, Options, Package, Shading, Source, refuse};
use luthier_bake::{BakeError, JobKind};

const LACQUER: &str = "schema = 1
name = \"lacquer\"

[[layer]]
type = \"dielectric\"
ior = 1.5
alpha = 0.1
thickness_um = 20
absorption_per_um = [0.002, 0.03, 0.04]

[[layer]]
type = \"conductor\"
ior = \"ag\"
alpha = 0.3

[bake]
model = \"elek\"
";

/// A bake that is watched: it counts jobs, and ends when a key is pressed.
#[derive(Default)]
struct Watch {
    ran: AtomicUsize,
    kept: AtomicUsize,
    is_stale: AtomicBool,
    /// Someone types as soon as a job is done. An editor sets `is_stale` from the thread of its window.
    is_typing: bool,
}

impl Observer for Watch {
    fn planned(&self, _jobs: usize) {}
    fn batch(&self, _kind: JobKind, _is_running: bool) {}
    fn finished(&self, _kind: JobKind) {
        self.ran.fetch_add(1, Ordering::Relaxed);
        self.is_stale.store(self.is_typing, Ordering::Relaxed);
    }
    fn found(&self, _kind: JobKind, jobs: usize) {
        self.kept.fetch_add(jobs, Ordering::Relaxed);
    }
    fn is_cancelled(&self) -> bool {
        self.is_stale.load(Ordering::Relaxed)
    }
}

/// An open file. The store has the results of all texts so far.
#[derive(Default)]
struct Editor {
    store: MemoryStore,
}

impl Editor {
    /// Bakes a text; `None` where it has mistakes, or where another came first.
    fn bake(&self, about: &str, text: &str, watch: &Watch) -> Result<Option<Package>, Error> {
        let mut sources = [Source::of_text(Path::new("lacquer.toml"), text.to_owned())];
        refuse(&mut sources, |material| Shading::default().doubts(material));
        for diagnostic in sources[0].diagnostics() {
            println!("{about}: {diagnostic}");
        }
        let Some(material) = sources[0].material() else { return Ok(None) };
        // Sizes of tables are searched for when the file is done: fixed ones leave the tables of other layers as they are.
        let options = Options { search: false, ..Options::default() };
        let bake = Bake { observer: watch, options, ..Bake::wgsl(&[Form::Baked]) };
        let package = match bake.package(std::slice::from_ref(material), &self.store) {
            Err(Error::Bake(BakeError::Cancelled)) => {
                println!("{about}: stopped, results kept: {}", self.store.len());
                return Ok(None);
            }
            package => package?,
        };
        let [ran, kept] = [&watch.ran, &watch.kept].map(|count| count.load(Ordering::Relaxed));
        println!("{about}: jobs that ran {ran}, results kept {kept}, bytes of tables {}", package.texel_bytes());
        Ok(Some(package))
    }
}

fn main() -> Result<(), Error> {
    let editor = Editor::default();
    editor.bake("a slip", &LACQUER.replace("1.5", "\"1.5\""), &Watch::default())?;
    editor.bake("the first text", LACQUER, &Watch { is_typing: true, ..Watch::default() })?;
    editor.bake("once more", LACQUER, &Watch::default())?;
    editor.bake("another colour", &LACQUER.replace("0.03", "0.01"), &Watch::default())?;
    editor.bake("another metal", &LACQUER.replace("ag", "cu"), &Watch::default())?;
    Ok(())
}
