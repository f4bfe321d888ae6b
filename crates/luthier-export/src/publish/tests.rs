//! Publications that are complete, interrupted, in the way of something, or two at once.

use luthier_manifest::{FileEntry, Form, Manifest, ShaderEntry, Target};
use tempfile::TempDir;

use super::*;
use crate::{Folder, sha256};

/// A generation of files: a manifest that names one shader, whose text is given.
fn generation(path: &str, text: &str) -> Vec<(String, Vec<u8>)> {
    let file = FileEntry { path: path.to_owned(), sha256: sha256(text.as_bytes()) };
    let shaders = vec![ShaderEntry {
        target: Target::Wgsl,
        form: Form::Baked,
        file,
        materials: None,
        interface: None,
        checks: Vec::new(),
    }];
    let manifest = Manifest { shaders, ..Manifest::new("luthier test", Vec::new(), Vec::new()) };
    vec![(path.to_owned(), text.as_bytes().to_vec()), (MANIFEST.to_owned(), manifest.to_json().unwrap().into_bytes())]
}

fn put(folder: &Path, files: &[(String, Vec<u8>)]) -> Result<(), PackageError> {
    let files: Vec<(&str, &[u8])> = files.iter().map(|(path, bytes)| (path.as_str(), bytes.as_slice())).collect();
    publish(folder, &files)
}

/// The text of the one shader that the manifest names.
fn text(folder: &Path) -> String {
    let folder = Folder::open(folder).unwrap();
    folder.text(&folder.manifest().shaders[0].file).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let mut files = Vec::new();
    list(folder, &mut files).unwrap();
    let name = |path: &PathBuf| path.strip_prefix(folder).unwrap().to_string_lossy().replace('\\', "/");
    files.iter().map(name).filter(|name| name != LOCK).collect()
}

fn folder() -> TempDir {
    tempfile::tempdir().unwrap()
}

#[test]
fn a_generation_replaces_the_one_before_and_leaves_what_is_not_luthiers() {
    let folder = folder();
    std::fs::write(folder.path().join("note.txt"), "mine").unwrap();
    put(folder.path(), &generation("shaders/a.wgsl", "first")).unwrap();
    publish(folder.path(), &[(REPORT_FILES[0], b"{}")]).unwrap();
    put(folder.path(), &generation("shaders/b.wgsl", "second")).unwrap();
    assert_eq!(text(folder.path()), "second");
    // The report was on the bake before.
    assert_eq!(names(folder.path()), ["manifest.json", "note.txt", "shaders/b.wgsl"]);
}

/// Killed while files were written: the folder holds the generation before, and the next publication removes the rest.
#[test]
fn unfinished_files_are_swept() {
    let folder = folder();
    put(folder.path(), &generation("a.wgsl", "first")).unwrap();
    std::fs::create_dir(folder.path().join(NEW)).unwrap();
    std::fs::write(folder.path().join(NEW).join("a.wgsl"), "half").unwrap();
    assert_eq!(text(folder.path()), "first");
    put(folder.path(), &generation("a.wgsl", "third")).unwrap();
    assert_eq!(text(folder.path()), "third");
    assert_eq!(names(folder.path()), ["a.wgsl", "manifest.json"]);
}

/// Killed after it had made a folder for a file: the folder goes, unless something is in it.
#[test]
fn folders_for_unfinished_files_are_swept() {
    let folder = folder();
    for at in [NEW, ""] {
        std::fs::create_dir_all(folder.path().join(at).join("maps/deep")).unwrap();
        std::fs::create_dir_all(folder.path().join(at).join("mine")).unwrap();
    }
    std::fs::write(folder.path().join("mine/note.txt"), "mine").unwrap();
    put(folder.path(), &generation("a.wgsl", "first")).unwrap();
    assert_eq!(names(folder.path()), ["a.wgsl", "manifest.json", "mine/note.txt"]);
    assert!(!folder.path().join("maps").exists());
}

/// Files that were not on the disk yet when power was lost are empty, in place or on their way: the next bake writes them.
#[test]
fn files_that_a_power_loss_emptied_are_written_again() {
    for emptied in ["a.wgsl", MANIFEST] {
        for at in ["", READY] {
            let folder = folder();
            put(folder.path(), &generation("a.wgsl", "first")).unwrap();
            std::fs::create_dir_all(folder.path().join(at)).unwrap();
            std::fs::write(folder.path().join(at).join(emptied), "").unwrap();
            let read = Folder::open(folder.path()).and_then(|f| f.read(&f.manifest().shaders[0].file));
            assert!(read.is_err(), "{emptied} in {at:?} is noticed");
            put(folder.path(), &generation("a.wgsl", "first")).unwrap();
            assert_eq!(text(folder.path()), "first");
            assert_eq!(names(folder.path()), ["a.wgsl", "manifest.json"]);
        }
    }
}

/// Killed after every single move of a publication: readers see the new generation whole, and the next one finds its place.
#[test]
fn a_publication_that_was_interrupted_is_read_and_completed() {
    for moved in 0..=2 {
        let folder = folder();
        put(folder.path(), &generation("a.wgsl", "first")).unwrap();
        let next = generation("b.wgsl", "second");
        let ready = folder.path().join(READY);
        std::fs::create_dir(&ready).unwrap();
        next.iter().for_each(|(path, bytes)| std::fs::write(ready.join(path), bytes).unwrap());
        for (path, _) in next.iter().take(moved) {
            std::fs::rename(ready.join(path), folder.path().join(path)).unwrap();
        }
        assert_eq!(text(folder.path()), "second", "{moved} files moved");
        publish(folder.path(), &[(REPORT_FILES[1], b"judged")]).unwrap();
        assert_eq!(text(folder.path()), "second", "{moved} files moved");
        let stale = if moved == 2 { vec!["a.wgsl"] } else { Vec::new() };
        let expected: Vec<&str> = stale.into_iter().chain(["b.wgsl", "manifest.json", REPORT_FILES[1]]).collect();
        assert_eq!(names(folder.path()), expected, "{moved} files moved");
    }
}

/// Textures of an environment beside a bake: each list removes what it named before, and nothing of the other.
#[test]
fn lists_remove_what_they_named() {
    let folder = folder();
    put(folder.path(), &generation("a.wgsl", "first")).unwrap();
    let list = |name: &str| {
        format!(r#"{{"generator": "luthier 0", "textures": [{{"path": "{name}", "sha256": "0"}}]}}"#).into_bytes()
    };
    for name in ["cube.ktx2", "equirect.ktx2"] {
        publish(folder.path(), &[(name, b"texels"), (ENVIRONMENT, &list(name))]).unwrap();
    }
    publish(folder.path(), &[(REPORT_FILES[1], b"judged")]).unwrap();
    assert_eq!(names(folder.path()), ["a.wgsl", ENVIRONMENT, "equirect.ktx2", "manifest.json", REPORT_FILES[1]]);
    put(folder.path(), &generation("b.wgsl", "second")).unwrap();
    assert_eq!(names(folder.path()), ["b.wgsl", ENVIRONMENT, "equirect.ktx2", "manifest.json"]);
}

#[test]
fn a_folder_in_the_place_of_a_file_stops_a_publication_before_it_begins() {
    let folder = folder();
    put(folder.path(), &generation("a.wgsl", "first")).unwrap();
    std::fs::create_dir(folder.path().join("b.wgsl")).unwrap();
    let error = put(folder.path(), &generation("b.wgsl", "second")).unwrap_err();
    assert!(matches!(&error, PackageError::Write { path, .. } if path.ends_with("b.wgsl")), "{error}");
    assert_eq!(text(folder.path()), "first");
    assert_eq!(names(folder.path()), ["a.wgsl", "manifest.json"]);
}

#[test]
fn publications_side_by_side_take_turns() {
    let folder = folder();
    let texts: Vec<String> = (0..8).map(|i| format!("generation {i}")).collect();
    std::thread::scope(|scope| {
        for (i, text) in texts.iter().enumerate() {
            let path = folder.path();
            scope.spawn(move || put(path, &generation(&format!("{i}.wgsl"), text)).unwrap());
        }
    });
    assert!(texts.contains(&text(folder.path())));
    assert_eq!(names(folder.path()).len(), 2, "{:?}", names(folder.path()));
}

/// A manifest names files; what of these lies outside its folder is nobody's to remove.
#[test]
fn nothing_outside_the_folder_is_removed() {
    let around = folder();
    let folder = around.path().join("out");
    std::fs::write(around.path().join("secret"), "mine").unwrap();
    put(&folder, &generation("a.wgsl", "first")).unwrap();
    let manifest = std::fs::read_to_string(folder.join(MANIFEST)).unwrap().replace("a.wgsl", "../secret");
    std::fs::write(folder.join(MANIFEST), manifest).unwrap();
    put(&folder, &generation("b.wgsl", "second")).unwrap();
    assert_eq!(std::fs::read_to_string(around.path().join("secret")).unwrap(), "mine");
}

/// Files of a second publication that are there already keep their time, so that build systems do not build what reads them again.
#[test]
fn unchanged_files_keep_their_time() {
    let folder = folder();
    let long_ago = std::time::SystemTime::UNIX_EPOCH + std::time::Duration::from_secs(1);
    let time = |name: &str| folder.path().join(name).metadata().unwrap().modified().unwrap();
    let age = |name: &str| File::options().write(true).open(folder.path().join(name)).unwrap().set_modified(long_ago);
    let put = |texts: [&str; 2]| {
        let files = [("tables/a", texts[0].as_bytes()), ("b", texts[1].as_bytes())];
        publish(folder.path(), &files).unwrap();
    };
    put(["first", "first"]);
    ["tables/a", "b"].iter().for_each(|name| age(name).unwrap());
    put(["first", "first"]);
    assert_eq!([time("tables/a"), time("b")], [long_ago; 2]);
    // Of the same length.
    put(["first", "other"]);
    assert_eq!(time("tables/a"), long_ago);
    assert_ne!(time("b"), long_ago);
    assert_eq!(names(folder.path()), ["b", "tables/a"]);
    assert_eq!(std::fs::read(folder.path().join("b")).unwrap(), b"other");
}

/// A link to a file of the right bytes is not that file: readers refuse links that leave the folder.
#[cfg(unix)]
#[test]
fn links_are_replaced_by_files() {
    let (folder, elsewhere) = (folder(), folder());
    std::fs::write(elsewhere.path().join("a"), "bytes").unwrap();
    std::os::unix::fs::symlink(elsewhere.path().join("a"), folder.path().join("a")).unwrap();
    publish(folder.path(), &[("a", b"bytes")]).unwrap();
    assert!(folder.path().join("a").symlink_metadata().unwrap().is_file());
    assert!(elsewhere.path().join("a").exists());
}

#[test]
fn folders_that_a_generation_empties_go_and_others_stay() {
    let folder = folder();
    put(folder.path(), &generation("maps/deep/a.png", "first")).unwrap();
    std::fs::write(folder.path().join("maps/note.txt"), "mine").unwrap();
    put(folder.path(), &generation("b.wgsl", "second")).unwrap();
    assert!(folder.path().join("maps/note.txt").exists());
    assert!(!folder.path().join("maps/deep").exists());
    put(folder.path(), &generation("maps/deep/a.png", "first")).unwrap();
    std::fs::remove_file(folder.path().join("maps/note.txt")).unwrap();
    put(folder.path(), &generation("b.wgsl", "second")).unwrap();
    assert!(!folder.path().join("maps").exists());
}

/// A publication that fails leaves none of the folders that it made, and those that were there.
#[test]
fn a_failure_leaves_no_folder() {
    let around = folder();
    let out = around.path().join("build/out");
    // The second file wants a folder where the first one is.
    let files: [(&str, &[u8]); 3] = [("tables/a", b"1"), ("shaders", b"2"), ("shaders/b", b"3")];
    assert!(publish(&out, &files).is_err());
    assert!(names(around.path()).is_empty());
    assert!(!around.path().join("build").exists());
    std::fs::create_dir_all(&out).unwrap();
    assert!(publish(&out, &files).is_err());
    assert_eq!(std::fs::read_dir(&out).unwrap().count(), 0);
}

/// Someone removed folders after a publication was interrupted.
#[test]
fn an_interrupted_publication_makes_the_folders_that_it_needs() {
    let folder = folder();
    let ready = folder.path().join(READY);
    std::fs::create_dir_all(ready.join("tables")).unwrap();
    std::fs::write(ready.join("tables/a"), "ready").unwrap();
    publish(folder.path(), &[("b", b"next")]).unwrap();
    assert_eq!(names(folder.path()), ["b", "tables/a"]);
}

/// A report on a bake whose place another has taken is not written.
#[test]
fn a_report_lies_beside_its_bake_only() {
    let folder = folder();
    let report: [(&str, &[u8]); 1] = [(REPORT_FILES[0], b"{}")];
    put(folder.path(), &generation("a.wgsl", "first")).unwrap();
    let first = Folder::open(folder.path()).unwrap().sha256().to_owned();
    publish_beside(folder.path(), &first, &report).unwrap();
    put(folder.path(), &generation("a.wgsl", "second")).unwrap();
    let error = publish_beside(folder.path(), &first, &report).unwrap_err();
    assert!(matches!(error, PackageError::Rebaked { .. }), "{error}");
    assert_eq!(names(folder.path()), ["a.wgsl", "manifest.json"]);
}

/// The folder that a program waited for may be gone when it gets its lock.
#[cfg(unix)]
#[test]
fn a_folder_that_vanishes_while_it_is_waited_for_is_made_again() {
    let around = folder();
    let out = around.path().join("out");
    std::fs::create_dir(&out).unwrap();
    let held = handle(&out).unwrap();
    held.lock().unwrap();
    std::thread::scope(|scope| {
        let waiting = scope.spawn(|| put(&out, &generation("a.wgsl", "first")));
        // It waits, or will find no folder: the end is the same.
        std::thread::sleep(std::time::Duration::from_millis(50));
        std::fs::remove_dir(&out).unwrap();
        drop(held);
        waiting.join().unwrap().unwrap();
    });
    assert_eq!(text(&out), "first");
}

/// A generation under a name with a hash.
fn hashed_generation(text: &str) -> Vec<(String, Vec<u8>)> {
    generation(&hashed("shaders/a.wgsl", &sha256(text.as_bytes())), text)
}

/// The text of the one shader of a manifest, by a reader who knows nothing but paths; none where it is not whole.
fn read_naively(folder: &Path, manifest: &[u8]) -> Option<String> {
    let manifest: serde_json::Value = serde_json::from_slice(manifest).unwrap();
    let entry = &manifest["shaders"][0]["file"];
    let bytes = std::fs::read(folder.join(entry["path"].as_str().unwrap())).ok()?;
    (sha256(&bytes) == entry["sha256"].as_str().unwrap()).then(|| String::from_utf8(bytes).unwrap())
}

/// At every move of a publication the manifest in place is that of one whole generation, and the files of the one before are there.
#[test]
fn names_with_hashes_switch_by_their_manifest_alone() {
    let [first, second, third] = ["first", "second", "third"].map(hashed_generation);
    let manifest = |folder: &Path| std::fs::read(folder.join(MANIFEST)).unwrap();
    let ready = [second[0].clone(), (BEFORE.to_owned(), first[1].1.clone()), second[1].clone()];
    for moved in 0..=ready.len() {
        let folder = folder();
        let folder = folder.path();
        put(folder, &first).unwrap();
        assert_eq!(names(folder), ["manifest.json", &first[0].0]);
        std::fs::create_dir_all(folder.join(READY).join("shaders")).unwrap();
        for (i, (path, bytes)) in ready.iter().enumerate() {
            std::fs::write(if i < moved { folder.join(path) } else { folder.join(READY).join(path) }, bytes).unwrap();
        }
        let expected = if moved == ready.len() { "second" } else { "first" };
        assert_eq!(read_naively(folder, &manifest(folder)).as_deref(), Some(expected), "{moved} files moved");
        assert_eq!(read_naively(folder, &first[1].1).as_deref(), Some("first"), "{moved} files moved");
        assert_eq!(text(folder), "second");
        // The next one completes it. What neither it nor the one before names goes.
        put(folder, &third).unwrap();
        assert_eq!(read_naively(folder, &manifest(folder)).as_deref(), Some("third"));
        assert_eq!(read_naively(folder, &second[1].1).as_deref(), Some("second"), "{moved} files moved");
        assert_eq!(names(folder).len(), 4, "{moved} files moved: {:?}", names(folder));
        assert!(!folder.join(&first[0].0).exists(), "{moved} files moved");
    }
}

/// There and back, and over to plain names.
#[test]
fn generations_with_hashes_come_back_and_go() {
    let folder = folder();
    let folder = folder.path();
    let [first, second] = ["first", "second"].map(hashed_generation);
    for generation in [&first, &second, &first, &first] {
        put(folder, generation).unwrap();
        assert!(read_naively(folder, &generation[1].1).is_some());
    }
    assert_eq!(names(folder).len(), 4, "{:?}", names(folder));
    assert_eq!(std::fs::read(folder.join(BEFORE)).unwrap(), second[1].1);
    publish(folder, &[(REPORT_FILES[1], b"judged")]).unwrap();
    put(folder, &generation("a.wgsl", "plain")).unwrap();
    assert_eq!(names(folder), ["a.wgsl", "manifest.json"]);
    // A plain generation is one before as well.
    put(folder, &first).unwrap();
    assert_eq!(names(folder).len(), 4, "{:?}", names(folder));
    assert_eq!(std::fs::read(folder.join("a.wgsl")).unwrap(), b"plain");
}
