//! Each broken file under `tests/broken/`, and each surface under `tests/broken-surfaces/`, gives exactly the messages in the `.expected` file
//! beside it, but for those of pictures: parsing does not open them. The tests of `luthier check` compare whole files.
//!
//! `LUTHIER_ACCEPT=1 cargo test -p luthier-material --test broken` writes the expectations anew: read the difference, and keep what
//! is said of pictures.

use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use luthier_material::{FileKind, Severity, parse, parse_surface};

/// All files of both folders.
fn files() -> impl Iterator<Item = PathBuf> {
    let tests = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../tests");
    let listed = |name: &str| fs::read_dir(tests.join(name)).unwrap().map(|entry| entry.unwrap().path());
    listed("broken").chain(listed("broken-surfaces")).collect::<Vec<_>>().into_iter()
}

fn cases() -> Vec<PathBuf> {
    let mut cases: Vec<PathBuf> = files().filter(|path| path.extension().is_some_and(|e| e == "toml")).collect();
    cases.sort();
    cases
}

/// System messages differ between platforms; ours must not.
fn nothing_to_read(_: &str) -> io::Result<String> {
    Err(io::Error::new(io::ErrorKind::NotFound, "no such file"))
}

fn rendered(path: &Path) -> String {
    let text = fs::read_to_string(path).unwrap();
    let label = path.file_name().unwrap().to_str().unwrap();
    let found = match FileKind::of(&text) {
        FileKind::Surface => parse_surface(label, &text).err(),
        _ => parse(label, &text, &nothing_to_read).err(),
    };
    match found {
        None => panic!("{label} parses"),
        Some(diagnostics) => {
            assert!(diagnostics.iter().any(|d| d.severity == Severity::Error), "{label} fails without an error");
            assert!(diagnostics.iter().all(|d| d.line >= 1 && d.column >= 1 && d.label == label), "{label}");
            diagnostics.iter().map(|d| d.render(&text) + "\n").collect()
        }
    }
}

/// Expected messages of the text alone, without those about pictures that are not there.
fn of_the_text(expected: &str) -> String {
    let mut is_of_text = true;
    let lines = expected.split_inclusive('\n').filter(|line| {
        if line.starts_with("error: ") || line.starts_with("warning: ") {
            is_of_text = !line.starts_with("error: cannot use the map `");
        }
        is_of_text
    });
    lines.collect()
}

#[test]
fn messages_are_as_expected() {
    let cases = cases();
    assert!(cases.len() >= 10, "{} cases", cases.len());
    let mut wrong = Vec::new();
    for case in &cases {
        let found = rendered(case);
        let path = case.with_extension("expected");
        if std::env::var_os("LUTHIER_ACCEPT").is_some() {
            fs::write(&path, &found).unwrap();
        }
        let expected = of_the_text(&fs::read_to_string(&path).unwrap_or_default().replace("\r\n", "\n"));
        if found != expected {
            wrong.push(format!("{}\nexpected:\n{expected}\nfound:\n{found}", case.display()));
        }
    }
    assert!(wrong.is_empty(), "{}", wrong.join("\n"));
}

#[test]
fn every_expectation_has_its_case() {
    for path in files() {
        if path.extension().is_some_and(|e| e == "expected") {
            assert!(path.with_extension("toml").exists(), "{}", path.display());
        }
    }
}
