//! A build script that bakes the materials of a folder: copy it to `build.rs`, with `luthier` among the build dependencies.
#![expect(clippy::print_stdout, reason = "Cargo reads standard output")]

use luthier::{Bake, MemoryStore, Shading, Sources};
use std::path::Path;

fn main() -> Result<(), luthier::Error> {
    let mut sources = Sources::read(["materials"])?;
    sources.check(&Shading::default());
    println!("cargo::rerun-if-changed=materials");
    for file in sources.files() {
        println!("cargo::rerun-if-changed={}", file.display());
    }
    for diagnostic in sources.diagnostics() {
        println!("cargo::{}={diagnostic}", diagnostic.severity.name());
    }
    let out = std::env::var("OUT_DIR").unwrap_or_default();
    Ok(Bake::default().of(&sources, &MemoryStore::default())?.write(&Path::new(&out).join("materials"))?)
}
