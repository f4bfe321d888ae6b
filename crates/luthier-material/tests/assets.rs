//! Materials of public collections, `tests/assets`: each keeps the model `lobes` with all that its file has, and says what it has of its source.

use std::fs;
use std::path::{Path, PathBuf};

use luthier_material::{Parsed, left_out, parse};
use luthier_model::ShadingModel;

/// The lines that begin a file, in this order.
const HEADER: [&str; 5] = ["# Source: ", "# Means: ", "# Shown: ", "# Approximated: ", "# Dropped: "];

/// Files, and those of them without a texture, of which there may be few: textures are what is judged.
const FILES: usize = 27;
const PLAIN: usize = 6;

/// Bytes of the folder, with its pictures.
const BYTES: u64 = 60_000;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/assets")
}

/// Files below a folder, by name; none where there is no folder, as of files that are out.
fn below(folder: &Path) -> Vec<PathBuf> {
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).into_iter().flatten().map(|entry| entry.unwrap().path()).collect();
    paths.sort();
    paths
}

fn materials(folder: &Path) -> Vec<(String, String)> {
    let files = below(folder).into_iter().filter(|path| path.extension().is_some_and(|end| end == "toml"));
    files
        .map(|path| (path.file_stem().unwrap().to_str().unwrap().to_owned(), fs::read_to_string(&path).unwrap()))
        .collect()
}

fn read(name: &str, text: &str) -> Parsed {
    let no_files = |_: &str| Err(std::io::ErrorKind::NotFound.into());
    match parse(&format!("{name}.toml"), text, &no_files) {
        Ok(parsed) => parsed,
        Err(errors) => panic!("{}", errors.iter().map(|error| error.render(text)).collect::<String>()),
    }
}

/// Asserts the header lines of a file; none is empty, and the source has a licence.
#[track_caller]
fn header(name: &str, text: &str) {
    for (line, start) in text.lines().zip(HEADER) {
        assert!(line.strip_prefix(start).is_some_and(|rest| !rest.is_empty()), "{name}: `{start}` is not `{line}`");
    }
    let source = text.lines().next().unwrap();
    let licences = ["(CC0)", "(CC-BY 4.0)", "(Apache-2.0)"];
    assert!(licences.iter().any(|licence| source.contains(licence)), "{name}: {source}");
    assert_eq!(source.ends_with("; textures are stand-ins"), text.contains(".png"), "{name}");
}

#[test]
fn all_keep_lobes_whole() {
    let files = materials(&folder());
    assert_eq!(files.len(), FILES);
    let mut plain = 0;
    for (name, text) in files {
        header(&name, &text);
        let Parsed { material, warnings, .. } = read(&name, &text);
        assert_eq!(material.name, name);
        assert!(material.bake.model.is_none() && warnings.is_empty(), "{name}: {warnings:?}");
        assert_eq!(material.model(), ShadingModel::Lobes, "{name}");
        assert_eq!(left_out(&material, ShadingModel::Lobes), [], "{name}");
        plain += usize::from(!text.contains(".png"));
    }
    assert!(plain <= PLAIN, "{plain} have no texture");
}

/// Every file of `out` says why it is out; the test of the command holds it against what `check` says.
#[test]
fn what_is_out_says_why() {
    for (name, text) in materials(&folder().join("out")) {
        header(&name, &text);
        assert!(text.lines().nth(HEADER.len()).unwrap().starts_with("# Out: "), "{name}");
    }
}

#[test]
fn pictures_are_small_and_all_in_use() {
    let texts: String =
        [folder(), folder().join("out")].iter().flat_map(|path| materials(path)).map(|(_, text)| text).collect();
    let files = [below(&folder()), below(&folder().join("out"))].concat();
    let bytes: u64 = files.iter().filter(|path| path.is_file()).map(|path| fs::metadata(path).unwrap().len()).sum();
    assert!(bytes < BYTES, "{bytes} bytes");
    for path in files.iter().filter(|path| path.extension().is_some_and(|end| end == "png")) {
        let name = path.file_name().unwrap().to_str().unwrap();
        assert!(texts.contains(name), "{name} is in no file");
    }
}
