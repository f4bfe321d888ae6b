//! `bake --watch`.

use std::fs;
use std::process::{Child, Command, Stdio};

use luthier_workshop::Patience;
use luthier_workshop::material_texts::matte;

use crate::workshop::Workshop;

/// A process that ends with the test.
struct Watcher(Child);

impl Drop for Watcher {
    fn drop(&mut self) {
        let _ = self.0.kill();
        let _ = self.0.wait();
    }
}

impl Watcher {
    /// Waits until something holds.
    fn until(&self, what: &str, mut holds: impl FnMut() -> bool) {
        let mut patience = Patience::with(self.0.id());
        while !holds() {
            patience.wait_for(what);
        }
    }
}

#[test]
fn changed_files_are_baked_and_broken_ones_waited_for() {
    let workshop = Workshop::with(&[("a/first.toml", &matte("first"))]);
    let events = fs::File::create(workshop.path("events")).unwrap();
    let child = Command::new(env!("CARGO_BIN_EXE_luthier"))
        .current_dir(workshop.path(""))
        .args(["bake", "a", "--watch", "--events", "--quiet", "--no-cache"])
        .stderr(Stdio::from(events))
        .spawn();
    let watcher = Watcher(child.unwrap());
    let manifest = || fs::read_to_string(workshop.path("out/manifest.json")).unwrap_or_default();
    watcher.until("the first bake", || manifest().contains("first"));
    workshop.write("a/second.toml", matte("second"));
    watcher.until("another file", || manifest().contains("second"));
    let good = manifest();
    workshop.write("a/second.toml", "schema = 1\nname = \"second\"\nbroken");
    watcher.until("an error", || workshop.text("events").contains("cannot be used"));
    assert_eq!(manifest(), good);
    fs::remove_file(workshop.path("a/second.toml")).unwrap();
    watcher.until("a file less", || !manifest().is_empty() && !manifest().contains("second"));
    workshop.write("a/first.toml", matte("third"));
    watcher.until("another name", || manifest().contains("third"));
    let published = || workshop.text("events").lines().filter(|line| line.contains("\"published\"")).count();
    // A line follows the files.
    watcher.until("an event for each bake", || published() == 4);
}
