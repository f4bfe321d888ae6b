//! Refusals of `bake`, which leave everything as it was.

use std::fs;

use luthier_workshop::material_texts::{NOISE, film, lacquer, matte};
use luthier_workshop::{file_name, material_files};

use crate::workshop::Workshop;

/// A finished bake of a matte material, and the folder as it then is.
fn baked() -> Workshop {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    workshop.run(&["bake", "matte.toml", "-q"]).exits(0);
    workshop
}

/// The place that an expectation under `tests/broken` names first: `file.toml:7:9`.
fn place(expected: &str) -> &str {
    expected.lines().find_map(|line| line.trim_start().strip_prefix("--> ")).unwrap()
}

#[test]
fn a_broken_material_changes_nothing() {
    let workshop = baked();
    for case in material_files("tests/broken") {
        workshop.write(file_name(&case), fs::read(&case).unwrap());
    }
    let before = workshop.tree("");
    for case in material_files("tests/broken") {
        let place = place(&fs::read_to_string(case.with_extension("expected")).unwrap()).to_owned();
        let run = workshop.run(&["bake", "matte.toml", file_name(&case)]).exits(1);
        assert_eq!(run.stdout, "");
        run.says(&[&place, "error: 1 of 2 material files cannot be used; nothing was written"]);
        assert!(workshop.tree("") == before, "{}", case.display());
    }
}

#[test]
fn a_failed_first_bake_leaves_no_folder() {
    let workshop = Workshop::with(&[("x.toml", "schema = 1\n")]);
    workshop.run(&["bake", "x.toml"]).exits(1);
    assert!(!workshop.path("out").exists());
}

#[test]
fn names_are_unique() {
    let workshop = baked();
    workshop.write("other.toml", matte("matte"));
    let before = workshop.tree("");
    let run = workshop.run(&["bake", "matte.toml", "other.toml"]).exits(1);
    run.says(&["`matte`: matte.toml:2 and other.toml:2", "other.toml:2:8"]);
    assert!(workshop.tree("") == before);
}

#[test]
fn settings_of_one_table_agree() {
    let workshop = baked();
    workshop.write("a.toml", lacquer("a"));
    workshop.write("b.toml", lacquer("b").replace("[8, 8]", "[8, 16]"));
    let before = workshop.tree("");
    let run = workshop.run(&["bake", "a.toml", "b.toml"]).exits(1);
    run.says(&["bake.fgd.size is [8, 8] in a.toml:18 but [8, 16] in b.toml:18", "b.toml:18:16"]);
    assert!(workshop.tree("") == before);
}

#[test]
fn inputs_that_are_not_there() {
    let workshop = Workshop::new();
    workshop.run(&["bake", "nowhere.toml"]).fails(3, &["nowhere.toml"]);
    workshop.run(&["bake"]).fails(3, &["materials"]);
    fs::create_dir(workshop.path("empty")).unwrap();
    workshop.run(&["bake", "empty"]).fails(1, &["no *.toml", "empty"]);
    assert!(!workshop.path("out").exists());
}

#[test]
fn text_in_another_encoding() {
    let workshop = Workshop::new();
    workshop.write("latin1.toml", b"schema = 1\nname = \"caf\xe9\"\n");
    workshop.run(&["bake", "latin1.toml"]).exits(1).says(&["not UTF-8", "latin1.toml:2:12", "save it as UTF-8"]);
}

#[test]
fn outputs_that_cannot_be() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte")), ("file", "mine")]);
    workshop.run(&["bake", "matte.toml", "--out", "file"]).fails(3, &["file"]);
    workshop
        .run(&["bake", "matte.toml", "--out", "file/deeper"])
        .fails(3, &["cannot make the folder file", "a file is in its place"]);
    assert_eq!(workshop.text("file"), "mine");
    // Where the folder of the shaders should be there is a file: found out before anything is moved.
    workshop.write("half/shaders", "mine");
    workshop.run(&["bake", "matte.toml", "--out", "half"]).fails(3, &["shaders"]);
    assert_eq!(workshop.files("half"), ["shaders"]);
}

#[cfg(unix)]
#[test]
fn folders_and_files_without_permission() {
    use std::os::unix::fs::PermissionsExt;

    let workshop = Workshop::with(&[("matte.toml", &matte("matte")), ("secret.toml", &matte("secret"))]);
    fs::create_dir(workshop.path("locked")).unwrap();
    fs::set_permissions(workshop.path("locked"), fs::Permissions::from_mode(0o555)).unwrap();
    fs::set_permissions(workshop.path("secret.toml"), fs::Permissions::from_mode(0o000)).unwrap();
    if fs::read(workshop.path("secret.toml")).is_ok() {
        eprintln!("skipped: permissions do not stop this user");
        return;
    }
    workshop.run(&["bake", "matte.toml", "--out", "locked"]).fails(3, &["locked"]);
    workshop.run(&["bake", "matte.toml", "secret.toml"]).fails(3, &["secret.toml"]);
}

#[test]
fn thread_counts() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    for bad in ["0", "-1", "1025", "99999999999999999999", "many"] {
        workshop.run(&["bake", "matte.toml", &format!("--threads={bad}")]).fails(2, &["--threads", bad]);
    }
    workshop.run(&["bake", "matte.toml", "--threads", "1", "-q"]).exits(0);
}

#[test]
fn maps_that_cannot_be_read() {
    let workshop = Workshop::new();
    workshop.write("m/a.toml", film("a", "{ image = \"maps/none.png\" }"));
    let place = "m/a.toml:12:17";
    workshop.run(&["bake", "m"]).exits(1).says(&[place, "maps/none.png", "no such file"]);
    workshop.write("m/maps/none.png", "this is not a picture");
    workshop.run(&["bake", "m"]).exits(1).says(&[place, "maps/none.png"]);
    assert!(!workshop.path("out").exists());
    workshop.write("m/a.toml", film("a", NOISE).replace("seed = 3", "seed = -3"));
    workshop.run(&["bake", "m"]).exits(1).says(&["m/a.toml:12:", "seed"]);
}
