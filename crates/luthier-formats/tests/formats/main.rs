//! Numbers out and in again, and the files that say them.

mod files;
mod round_trip;

use std::io::{self, ErrorKind};
use std::path::PathBuf;

use luthier_formats::{Exported, Format, Settings, exported, files as written};
use luthier_import::{Import, import};
use luthier_material::{Material, parse};

/// A folder of this repository.
fn folder(path: &str) -> PathBuf {
    PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../..").join(path)
}

/// A material file of this repository, and a reader of what lies beside it.
fn of_repository(path: &str) -> (Material, impl Fn(&str) -> io::Result<Vec<u8>> + use<>) {
    let path = folder(path);
    let text = std::fs::read_to_string(&path).unwrap();
    let beside = path.parent().unwrap().to_owned();
    let words = beside.clone();
    let parsed = parse(&path.display().to_string(), &text, &|name| std::fs::read_to_string(words.join(name)));
    (parsed.unwrap_or_else(|errors| panic!("{errors:?}")).material, move |name: &str| std::fs::read(beside.join(name)))
}

/// The materials of a text of another format.
fn imported(label: &str, text: &str) -> Vec<(Material, Import)> {
    let none = |_: &str| Err(ErrorKind::NotFound.into());
    read(&import(label, text.as_bytes(), &none).unwrap())
}

fn read(import: &Import) -> Vec<(Material, Import)> {
    let materials = import.materials.iter().map(|of| {
        let parsed = parse("x.toml", &of.text, &|_| Err(ErrorKind::NotFound.into()));
        (parsed.unwrap_or_else(|errors| panic!("{errors:?}\n{}", of.text)).material, import.clone())
    });
    materials.collect()
}

/// A material in a format, with few paths.
fn quick(material: &Material, format: Format, files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Exported {
    exported(material, format, &Settings::quick(), files)
}

/// The pictures of an import.
fn beside(import: &Import) -> impl Fn(&str) -> io::Result<Vec<u8>> {
    move |name: &str| import.pictures.get(name).cloned().ok_or_else(|| ErrorKind::NotFound.into())
}

/// A material, written, imported again and exported again.
fn again(once: &Exported) -> Exported {
    let files = written(once.format, std::slice::from_ref(once), "test").unwrap();
    let name = once.format.file_name();
    let reader = |path: &str| files.get(path).cloned().ok_or_else(|| io::Error::from(ErrorKind::NotFound));
    let import = import(name, &files[name], &reader).unwrap();
    let [(material, import)] = &read(&import)[..] else { panic!("{import:?}") };
    quick(material, once.format, &beside(import))
}
