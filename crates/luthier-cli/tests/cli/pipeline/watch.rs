//! `bake --watch`.

use std::fs;
use std::process::{Child, Command, Stdio};
use std::time::{Duration, Instant};

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

/// Waits until something holds; fails after a minute.
fn wait(what: &str, mut holds: impl FnMut() -> bool) {
    let start = Instant::now();
    while !holds() {
        assert!(start.elapsed() < Duration::from_secs(60), "{what}");
        std::thread::sleep(Duration::from_millis(50));
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
    let _watcher = Watcher(child.unwrap());
    let manifest = || fs::read_to_string(workshop.path("out/manifest.json")).unwrap_or_default();
    wait("the first bake", || manifest().contains("first"));
    workshop.write("a/second.toml", matte("second"));
    wait("another file", || manifest().contains("second"));
    let good = manifest();
    workshop.write("a/second.toml", "schema = 1\nname = \"second\"\nbroken");
    wait("an error", || workshop.text("events").contains("cannot be used"));
    assert_eq!(manifest(), good);
    fs::remove_file(workshop.path("a/second.toml")).unwrap();
    wait("a file less", || !manifest().is_empty() && !manifest().contains("second"));
    workshop.write("a/first.toml", matte("third"));
    wait("another name", || manifest().contains("third"));
    let published = || workshop.text("events").lines().filter(|line| line.contains("\"published\"")).count();
    // A line follows the files.
    wait("an event for each bake", || published() == 4);
}
