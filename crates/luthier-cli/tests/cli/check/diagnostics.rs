//! `check`.

use std::fs;
use std::path::PathBuf;

use luthier_workshop::material_texts::{doubtful, matte};
use luthier_workshop::{file_name, material_files, root};
use serde_json::Value;

use crate::workshop::Workshop;

fn broken() -> Vec<String> {
    material_files("tests/broken").iter().map(|path| file_name(path).to_owned()).collect()
}

fn expected(case: &str) -> String {
    fs::read_to_string(root().join("tests/broken").join(case).with_extension("expected")).unwrap()
}

/// Lines that are not empty: the command sets diagnostics apart by an empty line.
fn lines(text: &str) -> Vec<&str> {
    text.lines().filter(|line| !line.is_empty()).collect()
}

/// `1 error`, `2 errors`.
fn count(expected: &str) -> String {
    match expected.lines().filter(|line| line.starts_with("error: ")).count() {
        1 => "1 error".to_owned(),
        n => format!("{n} errors"),
    }
}

#[test]
fn broken_files_get_the_expected_words() {
    let cases = broken();
    assert!(cases.len() >= 10, "{} cases", cases.len());
    for case in &cases {
        let run = Workshop::run_in(&root().join("tests/broken"), &["check", case]).exits(1);
        assert_eq!(lines(&run.stderr), lines(&expected(case)), "{case}");
        assert_eq!(run.stdout, format!("{case}: {}\n", count(&expected(case))));
    }
}

#[test]
fn a_folder_of_broken_files_gets_them_all() {
    let run = Workshop::run_in(&root().join("tests"), &["check", "broken"]).exits(1);
    let all: String = broken().iter().map(|case| expected(case).replace(case, &format!("broken/{case}"))).collect();
    for (found, expected) in lines(&run.stderr).into_iter().zip(lines(&all)) {
        assert_eq!(found, expected);
    }
    assert_eq!(lines(&run.stderr).len(), lines(&all).len());
    let verdicts: String = broken().iter().map(|case| format!("broken/{case}: {}\n", count(&expected(case)))).collect();
    assert_eq!(run.stdout, verdicts);
}

/// Classes a to h of Weidlich and Wilkie 2009, chapter 4, by the names that they give.
#[test]
fn the_materials_are_materials() {
    let classes = [
        ("a", "Glossy Paint"),
        ("b", "Tinted Glazing"),
        ("c", "Frosted Paint"),
        ("d", "Metal Foil"),
        ("e", "Metallic Paint"),
        ("f", "Frosted Metal"),
        ("g", "Patina"),
        ("h", "Multi-Layer"),
        ("metal", "Bare Metal"),
        ("film", "Thin Film"),
        ("matte", "Matte"),
        ("glass", "Glass"),
    ];
    let run = Workshop::run_in(&root(), &["check"]).exits(0);
    let folders = ["materials", "materials/papers"];
    let files: Vec<(&str, PathBuf)> =
        folders.iter().flat_map(|folder| material_files(folder).into_iter().map(move |file| (*folder, file))).collect();
    assert!(files.len() >= 28, "{} materials", files.len());
    assert_eq!(run.stdout.lines().count(), files.len());
    for (line, (folder, file)) in run.stdout.lines().zip(&files) {
        let verdict = line.strip_prefix(&format!("{folder}/{}: ok, class ", file_name(file)));
        let class =
            verdict.and_then(|v| v.split_once(" (")).map(|(letter, rest)| (letter, rest.split(')').next().unwrap()));
        assert!(class.is_some_and(|class| classes.contains(&class)), "{line}");
    }
    assert_eq!(run.errors(), [""; 0]);
}

#[test]
fn doubts_do_not_fail() {
    let workshop = Workshop::with(&[("doubtful.toml", &doubtful("doubtful")), ("matte.toml", &matte("matte"))]);
    let run = workshop.run(&["check", "doubtful.toml", "matte.toml"]).exits(0);
    assert!(run.stderr.starts_with("warning: "), "{}", run.stderr);
    let mut lines = run.stdout.lines();
    assert!(lines.next().is_some_and(|l| l.starts_with("doubtful.toml: ok, class ") && l.ends_with(", 1 warning")));
    assert!(lines.next().is_some_and(|l| l.starts_with("matte.toml: ok, class ") && l.ends_with("), model elek")));
}

#[test]
fn json_for_programs() {
    let workshop = Workshop::with(&[("a.toml", &matte("matte")), ("b.toml", &matte("b").replace("albedo", "albeddo"))]);
    workshop.write("c.toml", b"# \xe9\n");
    let run = workshop.run(&["check", "a.toml", "b.toml", "c.toml", "--json"]).exits(1);
    assert_eq!(run.stderr, "", "everything is in the JSON");
    let json = run.json();
    let [good, bad, latin] = json.as_array().unwrap().as_slice() else { panic!("{json}") };

    assert_eq!((&good["file"], &good["material"]["name"]), (&Value::from("a.toml"), &Value::from("matte")));
    assert_eq!(good["diagnostics"], serde_json::json!([]));
    assert_eq!(good["material"]["class"], "matte");

    assert_eq!((&bad["file"], &bad["material"]), (&Value::from("b.toml"), &Value::Null));
    let text = workshop.text("b.toml");
    let typo = bad["diagnostics"].as_array().unwrap().iter().find(|d| d["line"] == 6).unwrap();
    assert_eq!((&typo["severity"], &typo["column"]), (&Value::from("error"), &Value::from(1)));
    let span = typo["span"][0].as_u64().unwrap() as usize..typo["span"][1].as_u64().unwrap() as usize;
    assert_eq!(&text[span], "albeddo", "{typo}");
    assert!(typo["message"].as_str().unwrap().contains("albeddo"), "{typo}");
    assert!(typo["hint"].as_str().unwrap().contains("`albedo`"), "{typo}");

    assert_eq!((&latin["diagnostics"][0]["line"], &latin["diagnostics"][0]["column"]), (&1.into(), &3.into()));
}

#[test]
fn files_that_cannot_be_read() {
    let workshop = Workshop::with(&[("a.toml", &matte("a"))]);
    workshop.run(&["check", "a.toml", "nowhere.toml"]).fails(3, &["cannot read nowhere.toml"]);
    workshop.run(&["check", "a.toml/b.toml"]).fails(3, &["a.toml/b.toml"]);
    workshop.run(&["check"]).fails(3, &["materials"]);
}

#[test]
fn line_ends_and_marks_of_other_systems() {
    let workshop = Workshop::with(&[("dos.toml", &matte("dos").replace('\n', "\r\n"))]);
    workshop.write("mark.toml", format!("\u{feff}{}", matte("mark")));
    workshop.run(&["check", "dos.toml", "mark.toml"]).exits(0);
    workshop.edit("dos.toml", |text| text.replace("albedo", "albeddo"));
    workshop.run(&["check", "dos.toml"]).exits(1).says(&["dos.toml:6:1"]);
}

/// Paths in a file are relative to the file, wherever the command runs.
#[test]
fn an_index_from_a_file_beside_the_material() {
    let metal =
        "schema = 1\nname = \"metal\"\n\n[[layer]]\ntype = \"conductor\"\nior = \"data/metal.csv\"\nalpha = 0.2\n";
    let workshop = Workshop::with(&[("m/metal.toml", metal)]);
    workshop.run(&["check", "m"]).exits(1).says(&["m/metal.toml:6:7", "data/metal.csv", "no such file"]);
    workshop.write("m/data/metal.csv", "wavelength_nm,n,k\n360,0.5,2.5\n830,0.3,4.5\n");
    workshop.run(&["check", "m"]).exits(0);
    workshop.write("m/data/metal.csv", "wavelength_nm,n,k\n360,0.5,two\n");
    workshop.run(&["check", "m"]).exits(1).says(&["m/metal.toml:6:7", "data/metal.csv"]);
}

fn coated(ior: f64, bake: &str) -> String {
    format!(
        "schema = 1\nname = \"coated\"\n\n[[layer]]\ntype = \"dielectric\"\nior = {ior:?}\nalpha = 0.1\n\n[[layer]]\ntype = \
         \"conductor\"\nior = \"au\"\nalpha = 0.2\n{bake}"
    )
}

/// The model of the file, or of the command line, has a domain; `luthier-lab stability` derives it.
#[test]
fn materials_outside_the_domain_of_their_model_are_told() {
    let granier = "\n[bake]\nmodel = \"granier-heidrich\"\n";
    let workshop = Workshop::with(&[
        ("diamond.toml", &coated(2.42, "\n[bake]\nmodel = \"elek\"\n")),
        ("default.toml", &coated(2.42, "")),
        ("glass.toml", &coated(1.5, "")),
        ("belcour.toml", &coated(2.42, "\n[bake]\nmodel = \"belcour\"\n")),
        ("granier.toml", &coated(1.5, granier)),
    ]);
    let words = |file: &str| workshop.run(&["check", file]).exits(0).stderr;
    let found = words("diamond.toml");
    for part in ["2.42 is outside the domain of `elek`", "diamond.toml:6:7", "write `[bake] model = \"belcour\"`"] {
        assert!(found.contains(part), "{part}: {found}");
    }
    assert_eq!(words("default.toml"), "");
    assert_eq!(words("glass.toml"), "");
    assert_eq!(words("belcour.toml"), "");
    assert!(words("granier.toml").contains("number of layers 2 is outside the domain of `granier-heidrich`"));

    let other = workshop.run(&["bake", "glass.toml", "--model", "granier-heidrich", "--out", "o"]).exits(0);
    assert!(other.stderr.contains("outside the domain of `granier-heidrich`"), "{}", other.stderr);
}

/// A film of a millimetre is refused, and nothing is written.
#[test]
fn what_would_be_wrong_beyond_use_is_refused() {
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.4\nthickness_nm = 2e6\n\n[[layer]]\ntype = \"dielectric\"";
    let text = coated(1.5, "").replace("[[layer]]\ntype = \"dielectric\"", film);
    let workshop = Workshop::with(&[("film.toml", &text)]);
    for verb in ["check", "bake"] {
        let run = workshop.run(&[verb, "film.toml"]).exits(1);
        assert!(run.stderr.contains("error: film thickness (nm) 2e6 is outside the domain"), "{}", run.stderr);
        assert!(run.stderr.contains("film.toml:7:16"), "{}", run.stderr);
    }
    assert!(!workshop.path("out").exists());
}

/// All materials of this repository are inside the domains of their models, but for the film of Granier and Heidrich over a diffuse body,
/// which is their figure; and every model shows what its material describes.
#[test]
fn the_materials_of_this_repository_are_inside_their_domains() {
    let run = Workshop::run_in(&root(), &["check", "materials"]).exits(0);
    let lines: Vec<&str> = run.stderr.lines().collect();
    let outside: Vec<&str> = lines
        .windows(2)
        .filter(|pair| pair[0].contains("outside the domain"))
        .map(|pair| pair[1].trim_start_matches([' ', '-', '>']).split(':').next().unwrap_or_default())
        .collect();
    assert_eq!(
        outside,
        ["granier-film", "granier-iridescent"].map(|name| format!("materials/papers/{name}.toml")),
        "{}",
        run.stderr
    );
    let left_out = lines.iter().find(|line| line.starts_with("warning: the model") && line.contains("` leaves out"));
    assert_eq!(left_out, None, "{}", run.stderr);
}

/// Brushed metal: Elek's model has one slope parameter, and says so wherever materials are read; Weidlich and Wilkie's has two.
#[test]
fn what_a_model_leaves_out_is_told() {
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha_x = 0.1\nalpha_y = 0.2\n";
    let bake = "\n[bake]\nmodel = \"elek\"\nfresnel = { size = 64 }\ndistribution = { size = [32, 32] }\nfgd = { size = [8, 8] }\n";
    let brushed = |name: &str, bake: &str| format!("schema = 1\nname = \"{name}\"\n\n{metal}{bake}");
    let modelled = bake.replace("elek", "weidlich-wilkie");
    let workshop =
        Workshop::with(&[("brushed.toml", &brushed("brushed", bake)), ("known.toml", &brushed("known", &modelled))]);
    let told = [
        "warning: the model `elek` leaves out anisotropy",
        "brushed.toml:7:11",
        "shown by `weidlich-wilkie`, `yamaguchi`, `microfacet`, `lobes`: write `[bake] model = ...`",
    ];
    workshop.run(&["check", "brushed.toml"]).exits(0).says(&told);
    workshop.run(&["bake", "brushed.toml"]).exits(0).says(&told);
    workshop.run(&["shader", "brushed.toml"]).exits(0).says(&told);
    assert_eq!(workshop.run(&["check", "known.toml"]).exits(0).stderr, "");
    let shown = workshop.run(&["check", "brushed.toml", "--model", "yamaguchi"]).exits(0).stderr;
    assert!(!shown.contains("leaves out"), "{shown}");
    let asked = workshop.run(&["check", "known.toml", "--model", "phong"]).exits(0).stderr;
    assert!(asked.contains("the model `phong` leaves out anisotropy"), "{asked}");
    for (arguments, path) in [
        (["check", "brushed.toml", "--json"], "/0/diagnostics/0"),
        (["bake", "brushed.toml", "--json"], "/diagnostics/0"),
    ] {
        let json = workshop.run(&arguments).exits(0).json();
        let told = json.pointer(path).unwrap();
        assert_eq!(
            (&told["severity"], &told["line"], &told["file"]),
            (&"warning".into(), &7.into(), &"brushed.toml".into())
        );
        assert_eq!(told["message"], "the model `elek` leaves out anisotropy");
    }
    // A scene chooses a model by what it leaves out.
    workshop.write(
        "scene.toml",
        "scene = 1\nname = \"s\"\n[[material]]\nfile = \"brushed.toml\"\n[[light]]\ntype = \"environment\"\n[budget]\nmax_rel = 1\n",
    );
    assert_eq!(workshop.run(&["check", "scene.toml"]).exits(0).stderr, "");
}

/// Perlin noise of four octaves never reaches .9; and a second switch on all tiles of the first is never seen.
#[test]
fn switches_without_places_are_doubted() {
    let tiles = "[[switch]]\ntiles = { share = 0.5 }\ncells = { materials = [\"matte.toml\"] }\n";
    let noise = "[[switch]]\nnoise = { between = [0.9, 1] }\ncells = { materials = [\"matte.toml\"] }\n";
    let stone = "surface = 1\nname = \"stone\"\n\n[cells]\nmaterials = [\"matte.toml\"]\n\n";
    let workshop = Workshop::with(&[
        ("matte.toml", &matte("matte")),
        ("stone.toml", &format!("{stone}{tiles}{noise}{tiles}")),
        ("veined.toml", &format!("{stone}{tiles}{}", noise.replace("0.9, 1", "-0.05, 0.05"))),
    ]);
    let run = workshop.run(&["check", "veined.toml"]).exits(0);
    assert!(run.stderr.is_empty() && run.stdout.starts_with("veined.toml: ok, surface of 1 material\n"), "{run:?}");
    let run = workshop.run(&["check", "stone.toml"]).exits(0);
    assert!(run.stdout.starts_with("stone.toml: ok, surface of 1 material, 2 warnings\n"), "{}", run.stdout);
    for part in [
        "these grains are on less than 0.1 % of the surface",
        "stone.toml:11:21",
        "this noise is from -0.",
        "stone.toml:14:9",
        "switches before it in the file have its places",
    ] {
        assert!(run.stderr.contains(part), "{part}: {}", run.stderr);
    }
    let json = workshop.run(&["check", "stone.toml", "--json"]).exits(0);
    let found: Value = serde_json::from_str(&json.stdout).unwrap();
    assert_eq!(found[0]["diagnostics"][0]["severity"], "warning");
    assert_eq!(found[0]["diagnostics"].as_array().unwrap().len(), 2);
}
