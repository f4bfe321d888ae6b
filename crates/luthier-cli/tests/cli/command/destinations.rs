//! Places that a command line names for what is written.

use luthier_workshop::material_texts::matte;

use crate::workshop::Workshop;

const DFG: [&str; 3] = ["table", "dfg", "--preset"];

#[test]
fn the_ending_of_a_table_is_that_of_its_engine() {
    let workshop = Workshop::new();
    for (preset, wrong, ending) in [
        ("bevy", "dfg.png", ".ktx2"),
        ("gltf", "lut.ktx2", ".png"),
        ("babylon", "lut.jpg", ".png"),
        ("filament", "dfg", ".bin"),
        ("hdrp", "fgd.bin", ".exr"),
        ("three", "dfg.mjs", ".js"),
    ] {
        let words = [&DFG[..], &[preset, "--size", "8x8", "-o", wrong]].concat();
        workshop.run(&words).fails(2, &[wrong, "the ending tells the format", ending]);
        assert!(!workshop.path(wrong).exists());
    }
}

#[test]
fn the_ending_of_a_shader_is_that_of_its_language() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    for (words, language) in [
        (&["-o", "m.hlsl"][..], "hlsl"),
        (&["--target", "hlsl", "-o", "m.wgsl"], "wgsl"),
        (&["--target", "glsl450", "-o", "m.es300.glsl"], "glsl-es300"),
        (&["-o", "m.glsl"], "glsl450"),
    ] {
        let words = [&["shader", "m.toml"], words].concat();
        workshop.run(&words).fails(2, &["--target", language]);
    }
    workshop.run(&["shader", "m.toml", "--target", "glsl450", "-o", "m.glsl"]).exits(0);
    workshop.run(&["shader", "m.toml", "-o", "m.txt"]).exits(0);
    assert_eq!(workshop.files(""), ["m.glsl", "m.toml", "m.txt"]);
}

#[test]
fn a_hyphen_is_standard_output_or_refused() {
    let workshop = Workshop::with(&[("m.toml", &matte("m"))]);
    let shader = workshop.run(&["shader", "m.toml"]).exits(0).stdout;
    assert_eq!(workshop.run(&["shader", "m.toml", "-o", "-"]).exits(0).stdout, shader);
    let page = workshop.run(&["gallery", "m.toml", "--html", "-"]).exits(0).stdout;
    assert!(page.trim_end().ends_with("</html>"));
    for words in [
        &["table", "dfg", "--preset", "bevy", "-o", "-"][..],
        &["table", "ltc", "-o", "-"],
        &["bake", "m.toml", "--out", "-"],
        &["bake", "m.toml", "--depfile", "-"],
        &["environment", "--sky", "clear-day", "--out", "-"],
        &["export", "m.toml", "--to", "gltf", "-o", "-"],
        &["man", "--out", "-"],
    ] {
        workshop.run(words).fails(2, &["`-`"]).says(&["./-"]);
    }
    if cfg!(feature = "gpu") {
        workshop.run(&["preview", "m.toml", "-o", "-"]).fails(2, &["`-`"]);
        workshop.run(&["compare", "m.toml", "-o", "-"]).fails(2, &["`-`"]);
    }
    assert_eq!(workshop.files(""), ["m.toml"]);
}

/// Nothing is computed before: the fits of `ltc` take minutes.
#[test]
fn files_and_folders_are_told_apart() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("file", ""), ("folder/x", "")]);
    for words in [
        &["table", "ltc", "-o", "file"][..],
        &["table", "energy", "--preset", "cycles", "-o", "file"],
        &["bake", "m.toml", "--out", "file"],
        &["environment", "--sky", "clear-day", "--out", "file"],
        &["export", "m.toml", "--to", "gltf", "-o", "file"],
        &["man", "--out", "file"],
    ] {
        workshop
            .run(words)
            .fails(3, &["cannot make the folder file: a file is in its place"])
            .says(&["names a folder"]);
    }
    for words in [
        &["table", "dfg", "--preset", "bevy", "-o", "folder"][..],
        &["table", "dfg", "--preset", "bevy", "-o", "x.ktx2", "--report", "folder"],
        &["shader", "m.toml", "-o", "folder"],
        &["new", "x", "-o", "folder"],
        &["gallery", "m.toml", "--html", "folder"],
        &["bake", "m.toml", "--depfile", "folder"],
    ] {
        workshop.run(words).fails(3, &["cannot write folder: it is a folder"]).says(&["names a file"]);
    }
    workshop
        .run(&["report", "--out", "file"])
        .fails(3, &["cannot read file: it is a file"])
        .says(&["folder of a bake"]);
    assert_eq!(workshop.files(""), ["file", "folder/x", "m.toml"]);
}
