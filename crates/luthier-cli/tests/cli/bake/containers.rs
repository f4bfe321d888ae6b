//! The files of tables by their bytes, as programs of others read them.

use luthier_workshop::material_texts::{NOISE, film, gold};

use crate::workshop::Workshop;

/// Keys of a KTX2 file (specification, section 3.11): length, key, NUL, value, padding to 4 bytes.
fn keys(file: &[u8]) -> Vec<String> {
    let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
    let (start, length) = (word(56), word(60));
    let (mut at, mut keys) = (start, Vec::new());
    while at < start + length {
        let entry = &file[at + 4..at + 4 + word(at)];
        let end = entry.iter().position(|&b| b == 0).unwrap();
        keys.push(String::from_utf8(entry[..end].to_vec()).unwrap());
        at += (4 + entry.len()).next_multiple_of(4);
    }
    keys
}

/// `ktx validate --warnings-as-errors` refuses every key that the specification does not list; viewers of EXR files blend by a channel A.
#[test]
fn tables_are_files_that_validators_and_viewers_take() {
    let workshop = Workshop::with(&[("m/gold.toml", &gold("gold")), ("m/film.toml", &film("film", NOISE))]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let mut files = workshop.tree("out/tables");
    // Its shader reads albedos and shares that escape.
    workshop.run(&["bake", "m/gold.toml", "-q", "--model", "yamaguchi"]).exits(0);
    files.append(&mut workshop.tree("out/tables"));
    assert!(files.contains_key("fgd.exr"));
    let with = |extension: &str| files.iter().filter(|(name, _)| name.ends_with(extension)).collect::<Vec<_>>();
    assert!(with(".ktx2").len() >= 3 && with(".ktx2").len() == with(".exr").len());
    for (name, file) in with(".ktx2") {
        assert_eq!(keys(file), ["KTXwriter"], "{name}");
    }
    for (name, file) in with(".exr") {
        let channels = match name.as_str() {
            "fgd.exr" => "EXR R G B never_crossed.Y, float",
            "thickness.exr" => "EXR R G B normalisation.Y, float",
            "distribution.exr" | "escape.exr" => "EXR Y, float",
            _ => "EXR RGB, float",
        };
        assert_eq!(luthier_texture::table::read(file).unwrap().format, channels, "{name}");
    }
    // Colour type of a PNG, behind its signature and the sizes in its first chunk: 2 is RGB without alpha.
    for (name, file) in with(".png") {
        assert_eq!(file[25], 2, "{name}");
    }
}
