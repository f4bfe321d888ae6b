//! The engine that searches for inputs by coverage: libFuzzer on the target named in `LUTHIER_FUZZ_TARGET`.
//! `scripts/fuzz.sh` builds and runs it.
//!
//! For the name `list` it prints the targets and ends: name, parser, inputs, checks and further folders, between tabs.

#![no_main]

use std::io::Write;
use std::process::exit;
use std::sync::LazyLock;

use luthier_fuzz::{TARGETS, Target, target};

static NAME: LazyLock<String> = LazyLock::new(|| std::env::var("LUTHIER_FUZZ_TARGET").unwrap_or_default());

static CHOSEN: LazyLock<&'static Target> = LazyLock::new(|| {
    target(&NAME).unwrap_or_else(|| {
        let names = TARGETS.map(|target| target.name).join(", ");
        panic!("LUTHIER_FUZZ_TARGET is `{}`; it has to be `list` or one of {names}", *NAME)
    })
});

fn begin() {
    if *NAME == "list" {
        let rows = TARGETS.map(|t| [t.name, t.parser, t.reads, t.holds, &t.folders.join(" ")].join("\t") + "\n");
        let written = std::io::stdout().write_all(rows.concat().as_bytes());
        exit(written.is_err().into());
    }
    LazyLock::force(&CHOSEN);
}

libfuzzer_sys::fuzz_target!(init: begin(), |bytes: &[u8]| {
    (CHOSEN.run)(bytes);
});
