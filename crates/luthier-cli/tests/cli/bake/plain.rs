//! Textures without supercompression.

use luthier_texture::ktx2;
use luthier_workshop::material_texts::lacquer;

use crate::workshop::Workshop;

/// Oracle: the bytes that the KTX2 specification names, read here.
#[test]
fn textures_without_zstd_hold_the_same_texels() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    workshop.run(&["bake", "lacquer.toml", "--out", "packed", "--quiet"]).exits(0);
    workshop.run(&["bake", "lacquer.toml", "--out", "plain", "--no-zstd", "--quiet"]).exits(0);
    let [packed, plain] = ["packed", "plain"].map(|folder| workshop.tree(folder));
    let tables = workshop.json("plain/manifest.json")["tables"].as_array().unwrap().clone();
    assert!(!tables.is_empty());
    for table in &tables {
        let path = table["texture"]["path"].as_str().unwrap();
        let (old, new) = (&packed[path], &plain[path]);
        let long = |at: usize| u64::from_le_bytes(new[at..at + 8].try_into().unwrap()) as usize;
        let [first, length] = [80, 88].map(long);
        assert_eq!((old[44], new[44]), (2, 0), "{path}");
        assert_eq!(length as u64, table["texel_bytes"].as_u64().unwrap());
        assert_eq!(new[first..first + length], ktx2::decode(old).unwrap().bytes, "{path}");
    }
    let others = |tree: &std::collections::BTreeMap<String, Vec<u8>>| {
        let is_other = |path: &String| !path.ends_with(".ktx2") && path != "manifest.json";
        tree.iter().filter(|(path, _)| is_other(path)).map(|(p, b)| (p.clone(), b.clone())).collect::<Vec<_>>()
    };
    assert_eq!(others(&packed), others(&plain));
    // It reads back: hashes fit, and so do the texels.
    workshop.run(&["report", "--out", "plain", "--no-device", "--pairs", "64", "--picture-size", "0"]).exits(0);
}
