//! Tests of the reader of a folder: hashes, paths, links, sizes.

use luthier_manifest::{ManifestError, MapSlot};
use tempfile::TempDir;

use super::*;

/// A bake of nothing but its manifest, in a folder beside a file that is none of it.
fn bake() -> (TempDir, PathBuf) {
    let around = tempfile::tempdir().unwrap();
    let folder = around.path().join("out");
    std::fs::create_dir(&folder).unwrap();
    let manifest = Manifest::new("luthier test", Vec::new(), Vec::new()).to_json().unwrap();
    std::fs::write(folder.join(MANIFEST), manifest).unwrap();
    std::fs::write(around.path().join("secret"), b"abc").unwrap();
    (around, folder)
}

/// SHA-256 of `abc`: FIPS 180-2, appendix B.1.
const ABC: &str = "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad";

fn entry(path: &str) -> FileEntry {
    FileEntry { path: path.to_owned(), sha256: ABC.to_owned() }
}

#[test]
fn files_are_known_by_their_hash() {
    let (_around, folder) = bake();
    std::fs::create_dir(folder.join("tables")).unwrap();
    let path = folder.join("tables/a");
    std::fs::write(&path, b"abc").unwrap();
    let bake = Folder::open(&folder).unwrap();
    assert_eq!(bake.read(&entry("tables/a")).unwrap(), b"abc");
    assert_eq!(bake.text(&FileEntry { sha256: ABC.to_uppercase(), ..entry("tables/a") }).unwrap(), "abc");
    std::fs::write(&path, b"abd").unwrap();
    let error = bake.read(&entry("tables/a")).unwrap_err();
    assert!(matches!(&error, PackageError::Hash { path: named, expected, .. } if *named == path && expected == ABC));
    std::fs::remove_file(&path).unwrap();
    assert!(matches!(bake.read(&entry("tables/a")), Err(PackageError::Read { path: named, .. }) if named == path));
}

/// The hash is right every time: it is the way that is refused.
#[test]
fn paths_stay_within_the_folder() {
    let (around, folder) = bake();
    let absolute = around.path().join("secret");
    let bake = Folder::open(&folder).unwrap();
    for path in ["../secret", "", ".", "./a", "tables/../../secret", "/", absolute.to_str().unwrap()] {
        let error = bake.read(&entry(path)).unwrap_err();
        assert!(matches!(&error, PackageError::Outside { path: named } if named == path), "{path}: {error}");
    }
}

#[cfg(unix)]
#[test]
fn links_do_not_lead_out_of_the_folder() {
    use std::os::unix::fs::symlink;

    let (around, folder) = bake();
    symlink("../secret", folder.join("file")).unwrap();
    symlink("..", folder.join("folder")).unwrap();
    std::fs::write(folder.join("real"), b"abc").unwrap();
    symlink("real", folder.join("within")).unwrap();
    // The folder itself may be a link: builds keep their outputs elsewhere.
    let linked = around.path().join("linked");
    symlink("out", &linked).unwrap();
    for folder in [&folder, &linked] {
        let bake = Folder::open(folder).unwrap();
        for path in ["file", "folder/secret"] {
            assert!(matches!(bake.read(&entry(path)), Err(PackageError::Outside { .. })), "{path}");
        }
        assert_eq!(bake.read(&entry("within")).unwrap(), b"abc");
    }
    std::fs::rename(folder.join(MANIFEST), around.path().join(MANIFEST)).unwrap();
    symlink(Path::new("..").join(MANIFEST), folder.join(MANIFEST)).unwrap();
    assert!(matches!(Folder::open(&folder), Err(PackageError::Outside { .. })));
}

/// A socket stands for all that is no file and would be waited for.
#[cfg(unix)]
#[test]
fn only_regular_files_are_read() {
    let (_around, folder) = bake();
    std::fs::create_dir(folder.join("folder")).unwrap();
    let _socket = std::os::unix::net::UnixListener::bind(folder.join("socket")).unwrap();
    let bake = Folder::open(&folder).unwrap();
    for path in ["folder", "socket"] {
        assert!(matches!(bake.read(&entry(path)), Err(PackageError::NotAFile { .. })), "{path}");
    }
}

#[test]
fn large_files_are_refused() {
    let (_around, folder) = bake();
    // No more than its name on the disk.
    File::create(folder.join("large")).unwrap().set_len(MAX_FILE_BYTES + 1).unwrap();
    let bake = Folder::open(&folder).unwrap();
    assert!(matches!(bake.read(&entry("large")), Err(PackageError::TooLarge { .. })));
}

#[test]
fn manifests_of_another_schema_are_refused() {
    let (around, folder) = bake();
    let error = Folder::open(around.path()).unwrap_err();
    assert!(matches!(error, PackageError::NoBake { .. }), "{error}");
    std::fs::write(folder.join(MANIFEST), "{\"schema\": 99}").unwrap();
    let error = Folder::open(&folder).unwrap_err();
    assert!(matches!(error, PackageError::Manifest { source: ManifestError::Schema { found: 99, .. }, .. }));
    std::fs::write(folder.join(MANIFEST), [0xff, 0xfe]).unwrap();
    assert!(matches!(Folder::open(&folder), Err(PackageError::Text { .. })));
}

#[test]
fn maps_have_the_size_that_the_manifest_states() {
    let (_around, folder) = bake();
    let png =
        luthier_texture::png::encode_gray(&Image { width: 2, height: 1, channels: 1, data: vec![0.0, 1.0] }).unwrap();
    std::fs::write(folder.join("map.png"), &png).unwrap();
    let map = |width| MapEntry {
        slot: MapSlot::Roughness,
        layer: None,
        source: String::new(),
        file: FileEntry { path: "map.png".to_owned(), sha256: hex(&png) },
        width,
        height: 1,
        factor: None,
        srgb: false,
        transform: None,
    };
    let bake = Folder::open(&folder).unwrap();
    assert_eq!(bake.map(&map(2)).unwrap().1.width, 2);
    let error = bake.map(&map(3)).unwrap_err();
    assert!(matches!(error, PackageError::MapSize { found: [2, 1], expected: [3, 1], .. }), "{error}");
}
