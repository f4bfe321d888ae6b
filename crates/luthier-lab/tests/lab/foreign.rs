//! `foreign`: tiny files of each kind, good, odd and bad.

use crate::workshop::Workshop;

const GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],"meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}],
    "buffers":[{"uri":"three.bin","byteLength":36}],"bufferViews":[{"buffer":0,"byteLength":36}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}]}"#;
const HEAD: &str = "wavelength_nm,n,k\n";

fn workshop() -> Workshop {
    let workshop = Workshop::new();
    let corners = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    workshop.write("c/a/three.bin", corners.iter().flat_map(|v| v.to_le_bytes()).collect::<Vec<u8>>());
    workshop.write("c/a/good.gltf", GLTF);
    workshop.write("c/a/lost.gltf", GLTF.replace("three.bin", "lost.bin"));
    let constant = |row: &str| format!("{HEAD}400,{row}\n700,{row}\n");
    workshop.write("c/good.csv", constant("1.5,0"));
    workshop.write("c/b/BAD.CSV", constant("x,0"));
    workshop.write("c/b/worse.csv", format!("{HEAD}400,1.5,0\n700,x,0\n"));
    workshop.write("c/cut.hdr", "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 4\n");
    image::GrayImage::from_pixel(2, 2, image::Luma([7])).save(workshop.path("c/grey.png")).unwrap();
    workshop.write("c/notes.txt", "");
    workshop
}

const NEW: [&str; 6] = ["foreign", "--collection", "tiny", "--from", "here|there", "--licence"];

#[test]
fn files_are_counted_by_kind_and_reason() {
    let workshop = workshop();
    let words = [&NEW[..], &["CC0", "--data", "data.json", "--page", "page.md", "c"]].concat();
    workshop.run(&words).exits(0);
    let data = workshop.json("data.json");
    let kinds = &data["collections"][0]["kinds"];
    for (kind, files, read) in [("mesh", 2, 1), ("sky", 1, 0), ("picture", 1, 1), ("index", 3, 1)] {
        assert_eq!((&kinds[kind]["files"], &kinds[kind]["read"]), (&files.into(), &read.into()), "{kind}");
    }
    let refused = kinds["index"]["refused"].as_object().unwrap();
    assert_eq!(refused.values().collect::<Vec<_>>(), [&serde_json::json!(["b/BAD.CSV", "b/worse.csv"])]);
    assert!(refused.keys().all(|reason| reason.contains("line N")), "{refused:?}");
    let page = workshop.text("page.md");
    for row in ["| tiny | here\\|there | CC0 |", "| tiny | index | 3 | 1 | 0 | 2 | 0 |", "`a/lost.gltf`", "`cut.hdr`"] {
        assert!(page.contains(row), "{row}: {page}");
    }

    // The page is made of the data alone; a kind that is tried again takes its place; another collection is added.
    assert_eq!(workshop.run(&["foreign", "--data", "data.json"]).exits(0).stdout, page);
    workshop.write("c/b/BAD.CSV", format!("{HEAD}400,1.5,0\n700,1.5,0\n"));
    workshop.run(&["foreign", "--collection", "tiny", "--kind", "index", "--data", "data.json", "c"]).exits(0);
    let mut other = words.clone();
    other[2] = "also";
    workshop.run(&other).exits(0);
    let data = workshop.json("data.json");
    assert_eq!((&data["collections"][0]["name"], &data["collections"][1]["name"]), (&"also".into(), &"tiny".into()));
    assert_eq!(data["collections"][1]["kinds"]["index"]["read"], 2);
    assert_eq!(data["collections"][1]["kinds"]["mesh"]["files"], 2);
}

#[test]
fn a_collection_says_where_it_is() {
    let workshop = workshop();
    workshop.run(&["foreign", "--collection", "tiny", "c"]).fails(2, &["--from", "--licence"]);
    workshop.run(&["foreign", "c"]).exits(2).says(&["--collection"]);
    workshop.run(&[&NEW[..], &["CC0", "nowhere"]].concat()).fails(3, &["nowhere"]);
}
