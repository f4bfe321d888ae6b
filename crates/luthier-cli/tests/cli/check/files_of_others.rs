//! Files as spreadsheets, databases and asset libraries write them.

use luthier_workshop::material_texts::gold;

use crate::workshop::Workshop;

const PAGE: &str = "REFERENCES: \"by hand\"\nDATA:\n  - type: tabulated nk\n    data: |\n        0.30 1.70 1.90\n        0.55 0.40 2.60\n        0.90 0.17 5.70\n";

#[test]
fn indices_of_others_are_read() {
    let workshop = Workshop::new();
    for (file, text) in [
        ("bom.csv", "\u{feff}wavelength_nm,n,k\r\n360,1.7,1.9\r\n550,0.4,2.4\r\n830,0.2,5\r\n"),
        ("far.csv", "wavelength_nm,n,k\n41.33,0.77,0.21\n82.7,1.2,0.9\n360,1.7,1.9\n830,0.2,5\n"),
        ("page.yml", PAGE),
    ] {
        workshop.write(file, text);
        workshop.write("x.toml", gold("x").replace("\"au\"", &format!("\"{file}\"")));
        let run = workshop.run(&["check", "x.toml"]).exits(0);
        assert_eq!(run.stderr, "", "{file}");
    }
    workshop.write("page.yml", PAGE.replace("2.60", "x"));
    workshop
        .run(&["check", "x.toml"])
        .exits(1)
        .says(&["`page.yml`: line 6: column 3: `x` is not a number", "x.toml:6:7"]);
}

#[test]
fn texts_of_other_encodings_are_told() {
    let workshop = Workshop::new();
    workshop.write("x.toml", gold("x").replace("\"au\"", "\"x.csv\""));
    let utf16 = |text: &str| text.encode_utf16().flat_map(u16::to_le_bytes).collect::<Vec<u8>>();
    for (bytes, words) in [
        (utf16("\u{feff}nm,n\n"), "the file is UTF-16: save it as UTF-8"),
        (b"nm,n\n# \xb5m\n".to_vec(), "line 2 is not UTF-8: save the file as UTF-8"),
    ] {
        std::fs::write(workshop.path("x.csv"), bytes).unwrap();
        workshop.run(&["check", "x.toml"]).exits(1).says(&["cannot read `x.csv`", words]);
    }
}

/// One error for the file, whatever it holds.
#[test]
fn formats_that_import_reads_are_named() {
    let workshop = Workshop::new();
    for (file, bytes, words) in [
        (
            "x.gltf",
            b"{\n  \"asset\": { \"version\": \"2.0\" },\n  \"materials\": [ { } ]\n}\n".to_vec(),
            "this is JSON",
        ),
        ("x.mtlx", b"<?xml version=\"1.0\"?>\n<materialx version=\"1.39\"/>\n".to_vec(), "this is XML"),
        ("x.glb", b"glTF\x02\0\0\0\xff\xfe\0\n".to_vec(), "this is binary glTF"),
    ] {
        std::fs::write(workshop.path(file), bytes).unwrap();
        for verb in ["check", "bake"] {
            let run = workshop.run(&[verb, file]).exits(1).says(&[words, "luthier import"]);
            assert_eq!(run.stderr.matches("error: not TOML").count(), 1, "{}", run.stderr);
        }
    }
}

#[test]
fn directions_of_a_spreadsheet_are_read() {
    let workshop = Workshop::with(&[("x.toml", &gold("x"))]);
    let values = |text: &str| {
        workshop.write("pairs.csv", text);
        workshop.run(&["eval", "x.toml", "--model", "elek", "--directions", "pairs.csv"]).exits(0).stdout
    };
    let plain = values("30,0,30.5,180\n");
    assert_eq!(values("\u{feff}theta_i;phi_i;theta_o;phi_o\r\n30;0;30,5;180\r\n"), plain);
}
