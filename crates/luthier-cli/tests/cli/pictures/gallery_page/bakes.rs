//! `gallery --html` of a bake on disk: what its manifest says, and options that are for material files.

use luthier_workshop::material_texts::lacquer;
use serde_json::json;

use super::{browser_or_skip, opened};
use crate::workshop::Workshop;

/// A folder of a bake is shown without material files, and nothing is lost in silence.
#[test]
fn a_page_of_a_bake() {
    let Some(browser) = browser_or_skip() else { return };
    // Without a table of albedos.
    let plain = "schema = 1\nname = \"gold\"\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nroughness = 0.5\n[bake]\nmodel = \"elek\"\n";
    let workshop = Workshop::with(&[("m/b.toml", plain), ("m/c.toml", &lacquer("lacquer"))]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    workshop.run(&["gallery", "--html", "page.html", "out"]).exits(0);
    let script = r##"found.ways = JSON.parse(document.getElementById("page-data").textContent).materials.map(m => m.looks[0].is_blurred);
found.texts = document.querySelectorAll("pre").length;
found.from = [...document.querySelectorAll(".words code")].map(code => code.textContent);
found.parts = [...document.querySelectorAll("#lacquer figure.section b")].map(part => part.textContent);
found.numbers = document.querySelector("#lacquer figure.section ol").textContent;"##;
    let found = opened(&browser, &workshop, "page.html", [1280, 900], "", script);
    assert_eq!((&found["ways"], &found["texts"]), (&json!([false, true]), &json!(0)));
    assert_eq!(found["from"], json!(["m/b.toml", "m/c.toml"]), "names of the files");
    assert_eq!(found["parts"], json!(["exterior", "dielectric", "diffuse"]));
    let numbers = found["numbers"].as_str().unwrap();
    for number in ["relative n1.5", "optical depth0.1, 0.5, 0.9", "alpha0.16", "albedo0.8, 0.2, 0.2"] {
        assert!(numbers.contains(number), "{number} in {numbers}");
    }
    workshop.run(&["gallery", "--html", "twice.html", "out", "m/b.toml"]).fails(1, &["gold", "rename"]);
    workshop.run(&["gallery", "--html", "no.html", "m", "--compare", "nothing"]).exits(2);
    let without_effect: [&[&str]; 5] =
        [&["--compare", "phong"], &["--model", "elek"], &["--no-fit"], &["--fresnel", "exact"], &["--tables", "fgd"]];
    for words in without_effect {
        let run = workshop.run(&[&["gallery", "--html", "no.html", "out"], words].concat());
        run.exits(2).says(&[words[0], "`out` is a bake", "material files in place"]);
    }
    let both = ["gallery", "--html", "no.html", "out", "m/b.toml", "--model", "elek", "--tables", "fgd"];
    workshop.run(&both).exits(2).says(&["--model and --tables are"]);
    workshop.run(&["gallery", "m"]).exits(2);
    workshop.run(&["gallery", "m", "--html", "missing/no.html", "--no-fit"]).fails(3, &["missing/no.html"]);
    #[cfg(feature = "gpu")]
    for words in [["--size", "64"], ["-o", "a.png"], ["--exposure", "1"], ["--light", "0,1,0"], ["--adapter", "x"]] {
        let run = workshop.run(&[&["gallery", "m", "--html", "no.html", "--no-fit"], words.as_slice()].concat());
        run.exits(2);
    }
    assert!(!workshop.path("no.html").exists() && !workshop.path("twice.html").exists());
}
