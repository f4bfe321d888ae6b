//! Bakes that are damaged, incomplete, or no longer those of their materials: `report` and `preview` say so and write
//! nothing.

use std::fs;

use luthier_workshop::material_texts::lacquer;

use crate::workshop::Workshop;

/// One way to spoil a bake, and the answer.
struct Case {
    spoil: fn(&Workshop),
    code: i32,
    parts: &'static [&'static str],
}

/// Damage to a bake that `report` and `preview` notice.
const ARTEFACTS: [Case; 7] = [
    Case { spoil: |w| fs::remove_dir_all(w.path("out")).unwrap(), code: 3, parts: &["no bake in out", "luthier bake"] },
    Case {
        spoil: |w| fs::remove_file(w.path("out/manifest.json")).unwrap(),
        code: 3,
        parts: &["no bake in out", "luthier bake"],
    },
    Case {
        spoil: |w| w.edit("out/manifest.json", |text| text.replacen("\"schema\": 4", "\"schema\": 0", 1)),
        code: 1,
        parts: &["out/manifest.json", "manifest schema 0", "bake again"],
    },
    Case {
        spoil: |w| w.write("out/manifest.json", "{"),
        code: 1,
        parts: &["out/manifest.json", "not a luthier manifest"],
    },
    Case { spoil: |w| w.write("out/manifest.json", b"\xff"), code: 1, parts: &["out/manifest.json", "UTF-8"] },
    Case {
        spoil: |w| {
            let mut bytes = fs::read(w.path("out/tables/fgd.ktx2")).unwrap();
            let middle = bytes.len() / 2;
            bytes[middle] ^= 1;
            w.write("out/tables/fgd.ktx2", bytes);
        },
        code: 1,
        parts: &["out/tables/fgd.ktx2", "bake again"],
    },
    Case {
        spoil: |w| fs::remove_file(w.path("out/tables/fresnel.ktx2")).unwrap(),
        code: 3,
        parts: &["out/tables/fresnel.ktx2"],
    },
];

/// Changes of the materials that the judge notices, which reads them again.
const MATERIALS: [Case; 3] = [
    Case {
        spoil: |w| w.edit("m/lacquer.toml", |text| text.replace("ior = 1.5", "ior = 1.6")),
        code: 1,
        parts: &["m/lacquer.toml has changed", "bake again"],
    },
    Case { spoil: |w| w.write("m/lacquer.toml", b"\xff\xfe"), code: 1, parts: &["m/lacquer.toml has changed"] },
    Case {
        spoil: |w| fs::remove_file(w.path("m/lacquer.toml")).unwrap(),
        code: 3,
        parts: &["m/lacquer.toml", "run the report where the bake ran"],
    },
];

fn try_all(cases: &[Case], args: &[&str]) {
    let workshop = Workshop::with(&[("m/lacquer.toml", &lacquer("lacquer"))]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let good = workshop.tree("");
    for Case { spoil, code, parts } in cases {
        spoil(&workshop);
        let spoilt = workshop.tree("");
        assert!(spoilt != good, "{parts:?}: nothing is spoilt");
        let run = workshop.run(args).fails(*code, parts);
        let error = run.errors()[0];
        let halves: Vec<&str> = error.split(": ").collect();
        let repeated = halves.windows(2).any(|pair| pair[0] == pair[1]);
        assert!(!repeated, "says it twice: {error}");
        assert!(workshop.tree("") == spoilt, "{parts:?}: something was written");
        for (path, bytes) in good.iter().filter(|(path, _)| !path.ends_with('/')) {
            workshop.write(path, bytes);
        }
        assert!(workshop.tree("") == good);
    }
}

#[test]
fn the_judge_takes_nothing_on_trust() {
    let args = ["report", "--no-device", "--pairs", "8"];
    try_all(&ARTEFACTS, &args);
    try_all(&MATERIALS, &args);
}

#[cfg(feature = "gpu")]
#[test]
fn the_judge_checks_before_it_looks_for_a_device() {
    try_all(&ARTEFACTS, &["report"]);
    try_all(&[SHADER], &["report"]);
}

#[cfg(feature = "gpu")]
#[test]
fn a_preview_is_of_a_sound_bake() {
    let args = ["preview", "lacquer", "-o", "ball.png"];
    try_all(&ARTEFACTS, &args);
    try_all(&[SHADER], &args);
}

/// A shader that someone edited.
#[cfg(feature = "gpu")]
const SHADER: Case = Case {
    spoil: |w| w.edit("out/shaders/baked.wgsl", |text| text + "\n"),
    code: 1,
    parts: &["out/shaders/baked.wgsl", "bake again"],
};
