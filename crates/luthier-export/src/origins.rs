//! Paths of source files in manifests. They lead from the manifest's folder, so that a package is the same in every checkout.

use std::path::{Component, MAIN_SEPARATOR, Path, PathBuf, absolute};

/// A path for messages and manifests, with forward slashes on every system.
pub fn label(path: &Path) -> String {
    path.to_string_lossy().replace(MAIN_SEPARATOR, "/")
}

/// A path without folders that a later `..` leaves.
pub fn plain(path: &Path) -> PathBuf {
    let mut plain = PathBuf::new();
    for part in path.components() {
        let leaves =
            part == Component::ParentDir && matches!(plain.components().next_back(), Some(Component::Normal(_)));
        if leaves {
            plain.pop();
        } else {
            plain.push(part);
        }
    }
    plain
}

/// The path of a file from the current folder, where `source` is its path from the folder of a manifest.
///
/// ```
/// use std::path::Path;
///
/// assert_eq!(luthier_export::origin(Path::new("out"), "../m/gold.toml"), Path::new("m/gold.toml"));
/// ```
pub fn origin(folder: &Path, source: &str) -> PathBuf {
    plain(&folder.join(source))
}

/// The path from a folder to a file. A file on another drive has none, and `source` is returned.
pub(crate) fn from_folder(folder: &Path, source: &str) -> String {
    let (Ok(folder), Ok(file)) = (absolute(folder), absolute(source)) else { return source.to_owned() };
    let (folder, file) = (plain(&folder), plain(&file));
    let shared = folder.components().zip(file.components()).take_while(|(a, b)| a == b).count();
    if shared == 0 {
        return source.to_owned();
    }
    let [up, down] = [&folder, &file].map(|path| path.components().skip(shared));
    label(&up.map(|_| Component::ParentDir).chain(down).collect::<PathBuf>())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn paths_lead_from_a_folder_and_back() {
        for (folder, file, expected) in [
            ("out", "m/gold.toml", "../m/gold.toml"),
            ("build/luts", "m/gold.toml", "../../m/gold.toml"),
            ("m/out", "m/gold.toml", "../gold.toml"),
            ("m", "m/gold.toml", "gold.toml"),
            (".", "m/../n/gold.toml", "n/gold.toml"),
            ("../out", "gold.toml", "../HERE/gold.toml"),
            ("../out", "../m/gold.toml", "../m/gold.toml"),
        ] {
            let here = std::env::current_dir().unwrap();
            let expected = expected.replace("HERE", here.file_name().unwrap().to_str().unwrap());
            let absolute_file = here.join(file);
            for file in [file, absolute_file.to_str().unwrap()] {
                assert_eq!(from_folder(Path::new(folder), file), expected, "{folder} {file}");
                assert_eq!(from_folder(&here.join(folder), file), expected, "{folder} {file}");
            }
            assert_eq!(plain(&here.join(origin(Path::new(folder), &expected))), plain(&absolute_file));
        }
        assert_eq!(origin(Path::new("out"), "../m/gold.toml"), Path::new("m/gold.toml"));
    }
}
