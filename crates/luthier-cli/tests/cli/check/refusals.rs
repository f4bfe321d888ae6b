//! `check` refuses what `bake` refuses, in the same words, and `bake` leaves everything as it was.

use std::fs;

use luthier_workshop::material_texts::{NOISE, film, gold, lacquer, matte};
use luthier_workshop::{Run, file_name, material_files};

use crate::workshop::Workshop;

/// A folder with a finished bake, and pictures: one that is grey, one in colour, one cut short, one that is none.
fn workshop() -> Workshop {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    workshop.run(&["bake", "matte.toml", "-q"]).exits(0);
    workshop.write("maps/text.png", "no picture");
    let grey = image::ImageBuffer::from_fn(64, 64, |x, y| image::Luma([(x * y) as u8]));
    grey.save(workshop.path("maps/grey.png")).unwrap();
    let whole = fs::read(workshop.path("maps/grey.png")).unwrap();
    workshop.write("maps/cut.png", &whole[..whole.len() / 2]);
    workshop
}

/// Errors with their places; what `bake` adds about its files is left out.
fn errors(run: &Run) -> Vec<String> {
    let mut lines = run.stderr.lines();
    let mut found = Vec::new();
    while let Some(line) = lines.next() {
        if line.starts_with("error: ") && !line.ends_with("nothing was written") {
            found.push(format!("{line}{}", lines.next().unwrap_or_default()));
        }
    }
    found
}

/// Bakes and checks, and compares; the words of each error contain these.
#[track_caller]
fn refused(workshop: &Workshop, paths: &[&str], words: &[&str]) {
    let before = workshop.tree("");
    let both = ["check", "bake"].map(|verb| {
        let arguments: Vec<&str> = [verb].into_iter().chain(paths.iter().copied()).collect();
        errors(&workshop.run(&arguments).exits(1))
    });
    assert!(workshop.tree("") == before, "{paths:?}");
    assert!(!both[0].is_empty(), "{paths:?}");
    assert_eq!(both[0], both[1], "{paths:?}");
    for word in words {
        assert!(both[0].iter().any(|error| error.contains(word)), "{word} not in {:?}", both[0]);
    }
}

#[test]
fn broken_files() {
    let workshop = workshop();
    for case in material_files("tests/broken") {
        workshop.write(file_name(&case), fs::read(&case).unwrap());
        refused(&workshop, &[file_name(&case)], &[file_name(&case)]);
        refused(&workshop, &["matte.toml", file_name(&case)], &[]);
    }
}

#[test]
fn files_that_do_not_go_together() {
    let workshop = workshop();
    workshop.write("again.toml", matte("matte"));
    workshop.write("shout.toml", matte("MATTE"));
    workshop.write("a.toml", lacquer("a"));
    workshop.write("b.toml", lacquer("b").replace("[8, 8]", "[8, 16]"));
    workshop.write(
        "c.toml",
        lacquer("c").replace("fresnel = { size = 64 }", "fresnel = { size = 64, format = \"rgba32float\" }"),
    );
    workshop.write(
        "d.toml",
        lacquer("d").replace("fresnel = { size = 64 }", "fresnel = { size = 64, format = \"rgba8unorm\" }"),
    );
    workshop.write("odd.toml", lacquer("odd").replace("[8, 8]", "[8, 9], format = \"bc6h-rgb-ufloat\""));
    for (paths, words) in [
        (["matte.toml", "again.toml"], ["two materials are named `matte`", "again.toml:2:8"]),
        (["matte.toml", "shout.toml"], ["are both `LUTHIER_MATERIAL_MATTE` in a shader", "shout.toml:2:8"]),
        (["a.toml", "b.toml"], ["bake.fgd.size is [8, 8] in a.toml:", "b.toml:18:"]),
        (["c.toml", "d.toml"], ["bake.fresnel.format is Rgba32Float in c.toml:", "d.toml:16:"]),
        (["a.toml", "odd.toml"], ["bake.fgd.size is", "odd.toml:18:"]),
    ] {
        refused(&workshop, &paths, &words);
    }
    refused(&workshop, &["odd.toml"], &["write a multiple of 4", "odd.toml:18:"]);
}

#[test]
fn files_that_materials_name() {
    let workshop = workshop();
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n";
    let effect = |text: &str| format!("schema = 1\nname = \"x\"\n{coat}{metal}{text}\n");
    let coated = |rest: &str| effect("").replacen(coat, &format!("{coat}{rest}\n"), 1);
    for (picture, why) in [("none", "no such file"), ("text", ""), ("cut", ""), ("folder", "it is a folder")] {
        fs::create_dir_all(workshop.path("maps/folder.png")).unwrap();
        let path = format!("maps/{picture}.png");
        for (text, line) in [
            (film("x", &format!("{{ image = \"{path}\" }}")), 12),
            (coated(&format!("maps = {{ normal = \"{path}\" }}")), 7),
            (coated(&format!("maps = {{ roughness = \"{path}\" }}")), 7),
            (coated(&format!("thickness_um = 1\nabsorption_per_um = 1\nmaps = {{ thickness = \"{path}\" }}")), 9),
            (effect(&format!("[effects.flakes]\nnormal_map = \"{path}\"")), 12),
            (effect(&format!("[effects.patina]\nextent = 0\ntransition = 0.5\nmap = {{ image = \"{path}\" }}")), 14),
        ] {
            workshop.write("x.toml", text);
            refused(&workshop, &["x.toml"], &[&format!("`{path}`: {why}"), &format!("x.toml:{line}:")]);
        }
    }
    // What else is wrong with the file is said with it.
    let both = coated("maps = { normal = \"maps/none.png\" }").replace("alpha = 0.2", "alpha = 7");
    workshop.write("x.toml", both);
    refused(&workshop, &["x.toml"], &["`maps/none.png`: no such file", "x.toml:6:", "x.toml:7:"]);
    workshop.write("maps/far.csv", "wavelength_nm,n,k\n400,1.5,0\n700,1e300,0\n");
    workshop.write("maps/infrared.csv", "wavelength_nm,n,k\n1400,1.5,0\n1700,1.4,0\n");
    for (path, words) in [
        ("maps/none.csv", "no such file"),
        ("maps/far.csv", "that of no medium"),
        ("maps/infrared.csv", "no sample of this index is visible"),
    ] {
        workshop.write("x.toml", gold("x").replace("\"au\"", &format!("\"{path}\"")));
        refused(&workshop, &["x.toml"], &[words, "x.toml:6:7"]);
    }
    workshop.write("x.toml", film("x", &NOISE.replace("frequency = 2", "frequency = 1e19")));
    refused(&workshop, &["x.toml"], &["must be above 0 and at most 65536", "x.toml:12:"]);
    workshop.write("x.toml", film("x", "{ image = \"maps/grey.png\" }"));
    workshop.run(&["check", "x.toml"]).exits(0);
}

const SCENE: &str = "scene = 1\nname = \"shelf\"\n\n[[material]]\nfile = \"matte.toml\"\n\n[[material]]\nfile = \"b.toml\"\n\n\
                     [[light]]\ntype = \"directional\"\nfrom_eye_deg = 40\n\n[budget]\nmax_rel = 0.5\n";

#[test]
fn scenes() {
    let workshop = workshop();
    workshop.write("shelf.toml", SCENE);
    refused(&workshop, &["shelf.toml"], &["b.toml", "no such file", "shelf.toml:8:8"]);
    workshop.write("b.toml", matte("matte"));
    refused(&workshop, &["shelf.toml"], &["two materials are named `matte`", "b.toml:2:8"]);
    workshop.write("b.toml", film("b", "{ image = \"maps/none.png\" }"));
    refused(&workshop, &["shelf.toml"], &["maps/none.png", "b.toml:12:"]);
    workshop.write("b.toml", lacquer("b"));
    let run = workshop.run(&["check", "shelf.toml"]).exits(0);
    assert!(run.stdout.starts_with("shelf.toml: ok, scene of 2 materials\n"), "{}", run.stdout);
    for (from, to, words) in [
        ("[budget]\nmax_rel = 0.5", "[budget]", "limits nothing"),
        ("from_eye_deg = 40", "from_eye_deg = 400", "must be from 0 to 170"),
        ("[budget]", "[target]\nformats = [\"rgba7unorm\"]\n[budget]", "`rgba7unorm` is no value"),
        ("b.toml", "matte.toml", "is in the scene already"),
    ] {
        workshop.write("shelf.toml", SCENE.replace(from, to));
        refused(&workshop, &["shelf.toml"], &[words, "shelf.toml:"]);
    }
    let json = workshop.run(&["check", "shelf.toml", "--json"]).exits(1).json();
    assert_eq!((&json[0]["file"], &json[0]["diagnostics"][0]["line"]), (&"shelf.toml".into(), &8.into()));
}

/// A material that chooses parts of a model.
fn choosing(layers: &str, bake: &str) -> String {
    format!("schema = 1\nname = \"x\"\n\n{layers}\n[bake]\n{bake}\n")
}

#[test]
fn parts_that_a_model_does_not_have() {
    let workshop = workshop();
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n";
    let film = "[[layer]]\ntype = \"thin-film\"\nior = 1.3\nthickness_nm = 300\n";
    let chalk = "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
    for (layers, bake, words) in [
        (metal.to_owned(), "masking = \"kelemen\"", ["the masking `kelemen`", "has `lobes`", "x.toml:10:11"]),
        (format!("{coat}{metal}"), "masking = \"smith\"", ["the masking `smith`", "has `lobes`", "x.toml:14:11"]),
        (metal.to_owned(), "masking = \"smiht\"", ["`smiht`", "is no value of `masking`", "x.toml:10:11"]),
        (
            format!("{coat}{metal}"),
            "reflectance = \"lazanyi\"",
            ["model `lobes` of this material has", "no reflectance `lazanyi`", "x.toml:14:15"],
        ),
        (
            format!("{film}{metal}"),
            "model = \"elek\"\nreflectance = \"approximate\"",
            ["`approximate`", "knows of no films", "x.toml:5:8"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"belcour\"\ninternal_reflection = \"none\"",
            ["model `belcour` of this material has", "no internal reflection `none`", "x.toml:15:23"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"microfacet\"\nlower_reflectance = \"in-air\"",
            ["model `microfacet` of this material has", "no lower reflectance `in-air`", "x.toml:15:21"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"weidlich-wilkie\"\nlower_cosine = \"inside\"",
            ["model `weidlich-wilkie` of this material has", "no lower cosine `inside`", "x.toml:15:16"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"belcour\"\nlower_facets = \"phong\"",
            ["model `belcour` of this material has", "no lower facets `phong`", "x.toml:15:16"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"elek\"\nlower_alpha = \"own\"",
            ["model `elek` of this material has", "no lower alpha `own`", "x.toml:15:15"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"microfacet\"\ndiffuse_part = \"beside\"",
            ["model `microfacet` of this material has", "no diffuse part `beside`", "x.toml:15:16"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"elek\"\nmasking = \"smith\"",
            ["model `elek` of this material has", "no masking `smith`", "x.toml:15:11"],
        ),
        (
            format!("{coat}maps = {{ lean = \"maps/grey.png\" }}\n{metal}"),
            "model = \"elek\"",
            ["`lean` gives a lean of the model `granier-heidrich`", "this material has `elek`", "x.toml:8:17"],
        ),
        (
            format!("{metal}maps = {{ lean = \"maps/grey.png\" }}\n"),
            "model = \"granier-heidrich\"",
            ["neither film nor slab", "no inner boundary could lean", "x.toml:8:17"],
        ),
        (
            format!("{coat}{metal}maps = {{ lean = \"maps/grey.png\" }}\n"),
            "model = \"granier-heidrich\"",
            ["a lean is that of the inner boundary", "the first interface's film or slab", "x.toml:12:17"],
        ),
        (
            format!("{coat}{metal}"),
            "model = \"elek\"\ndiffuse_term = \"added\"",
            ["model `elek` of this material has", "no diffuse term `added`", "x.toml:15:16"],
        ),
        (
            metal.replace("alpha = 0.2", "exponents = [90, 170]"),
            "model = \"elek\"",
            ["`exponents` gives lobes of the model `granier-heidrich`", "has `elek`", "x.toml:7:13"],
        ),
        (
            metal.to_owned(),
            "model = \"elek\"\n[bake.granier-heidrich]\nspecular_weight = 0.5",
            ["gives numbers of the model", "has `elek`", "x.toml:11:1"],
        ),
        (
            metal.to_owned(),
            "model = \"granier-heidrich\"\n[bake.granier-heidrich]\ndiffuse_weight = 0.5",
            ["no diffuse base", "this weight", "x.toml:12:18"],
        ),
        (
            metal.to_owned(),
            "model = \"granier-heidrich\"\n[bake.granier-heidrich]\ninner_tilt_deg = 5",
            ["neither film nor slab", "could lean", "x.toml:12:18"],
        ),
        (
            metal.to_owned(),
            "model = \"granier-heidrich\"\n[bake.granier-heidrich]\ninner_azimuth_deg = 5",
            ["does not lean", "azimuth", "x.toml:12:1"],
        ),
        (
            metal.replace("alpha = 0.2", "exponents = [90, 170]"),
            "model = \"granier-heidrich\"",
            ["neither film nor slab", "no inner boundary has a lobe of exponent 170", "x.toml:7:13"],
        ),
        (
            format!("{coat}{}", metal.replace("alpha = 0.2", "exponents = [90, 170]")),
            "model = \"granier-heidrich\"",
            ["exponents belong to the first layer", "lobes of no other", "x.toml:11:13"],
        ),
    ] {
        workshop.write("x.toml", choosing(&layers, bake));
        refused(&workshop, &["x.toml"], &words);
    }
    // Films below what a model reads do not count, and `table` is what every model has.
    for (layers, bake, warnings) in [
        (format!("{coat}{film}{metal}"), "model = \"microfacet\"\nreflectance = \"lazanyi\"", 2),
        (format!("{film}{metal}"), "model = \"elek\"\nreflectance = \"exact\"", 0),
        (metal.to_owned(), "model = \"phong\"\nreflectance = \"table\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\ninternal_reflection = \"facets\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\ninternal_reflection = \"none\"", 1),
        (metal.to_owned(), "model = \"weidlich-wilkie\"\ninternal_reflection = \"none\"", 1),
        (format!("{coat}{metal}"), "model = \"elek\"\ninternal_reflection = \"directions\"", 1),
        (format!("{coat}{metal}"), "model = \"elek\"\nlower_reflectance = \"in-place\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\nlower_reflectance = \"in-air\"", 1),
        (metal.to_owned(), "model = \"elek\"\nlower_reflectance = \"in-air\"", 1),
        (format!("{coat}{metal}"), "model = \"elek\"\nlower_cosine = \"outside\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\nlower_cosine = \"inside\"", 1),
        (format!("{coat}{metal}"), "model = \"elek\"\nlower_facets = \"torrance-sparrow\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\nlower_facets = \"blinn-phong\"", 1),
        (metal.to_owned(), "model = \"weidlich-wilkie\"\nlower_facets = \"phong\"", 1),
        (format!("{coat}{metal}"), "model = \"weidlich-wilkie\"\nlower_alpha = \"own\"", 0),
        (
            format!("{}{metal}", coat.replace("0.2", "0.4")),
            "model = \"weidlich-wilkie\"\nlower_alpha = \"at-least-above\"",
            0,
        ),
        (metal.to_owned(), "model = \"weidlich-wilkie\"\nlower_alpha = \"at-least-above\"", 1),
        (format!("{coat}{metal}"), "model = \"elek\"\ndiffuse_part = \"below\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\ndiffuse_part = \"beside\"", 1),
        (format!("{coat}{metal}"), "model = \"elek\"\nmasking = \"v-cavity\"", 0),
        (format!("{coat}{metal}"), "model = \"elek\"\nmasking = \"kelemen\"", 1),
        (format!("{coat}{chalk}"), "model = \"microfacet\"\ndiffuse_term = \"added\"", 1),
        (metal.to_owned(), "model = \"microfacet\"\ndiffuse_term = \"none\"", 0),
        (metal.to_owned(), "model = \"microfacet\"\ndiffuse_term = \"added\"", 1),
        (metal.to_owned(), "model = \"granier-heidrich\"\ngranier-heidrich = { lobe_height = \"scaled\" }", 0),
        (metal.to_owned(), "model = \"granier-heidrich\"\ngranier-heidrich = { lobe_height = \"one\" }", 1),
        (metal.to_owned(), "model = \"microfacet\"\nmasking = \"smith\"", 0),
        (metal.to_owned(), "model = \"microfacet\"\nmasking = \"implicit\"", 1),
        (metal.to_owned(), "model = \"microfacet\"\nmasking = \"v-cavity\"\nreflectance = \"approximate\"", 2),
    ] {
        workshop.write("x.toml", choosing(&layers, bake));
        let json = workshop.run(&["check", "x.toml", "--json"]).exits(0).json();
        // What models do to energy is told apart.
        let of_parts = |told: &&serde_json::Value| {
            let message = told["message"].as_str().unwrap();
            !["times the light that falls in", "the albedo of the model"].iter().any(|words| message.contains(words))
        };
        let told = json[0]["diagnostics"].as_array().unwrap().iter().filter(of_parts).count();
        assert_eq!(told, warnings, "{json}");
    }
    // Options of the command have their refusals, too.
    workshop.write("x.toml", choosing(metal, "model = \"microfacet\"\nmasking = \"implicit\""));
    workshop.run(&["check", "x.toml", "--model", "elek"]).exits(1);
    workshop.write("x.toml", choosing(&format!("{coat}{metal}"), ""));
    workshop.run(&["check", "x.toml", "--fresnel", "approximate"]).exits(1);
    workshop.run(&["check", "x.toml", "--fresnel", "approximate", "--model", "elek"]).exits(0);
    workshop.run(&["check", "x.toml", "--fresnel", "table"]).exits(0);
    // A scene chooses models, and would drop what some of them have.
    workshop.write("b.toml", choosing(&format!("{coat}{metal}"), "model = \"elek\"\nreflectance = \"exact\""));
    workshop.write("matte.toml", matte("matte"));
    workshop.write("shelf.toml", SCENE);
    refused(&workshop, &["shelf.toml"], &["a scene chooses the models", "`reflectance`", "b.toml:15:15"]);
    workshop.write("b.toml", choosing(&coat.replace("alpha = 0.2", "exponents = [90, 170]"), ""));
    refused(&workshop, &["shelf.toml"], &["a scene chooses the models", "`exponents`", "b.toml:7:13"]);
}

/// The chosen parts are in the bake: no rows without the table, the numbers of a curve, and a note at the top of shaders.
#[test]
fn parts_are_written_down() {
    let workshop = workshop();
    let metal = "[[layer]]\ntype = \"conductor\"\nior = { n = 0.2, k = 3.4 }\nalpha = 0.2\n";
    workshop.write("x.toml", choosing(metal, "model = \"microfacet\"\nmasking = \"kelemen\""));
    workshop.run(&["bake", "x.toml", "--fresnel", "approximate", "--out", "out"]).exits(0);
    let manifest: serde_json::Value =
        serde_json::from_str(&fs::read_to_string(workshop.path("out/manifest.json")).unwrap()).unwrap();
    let layer = &manifest["materials"][0]["layers"][0];
    assert_eq!((&layer["masking"], &layer["reflectance"]), (&"kelemen".into(), &"approximate".into()));
    // |(n - 1) / (n + 1)|^2, by hand.
    let f0 = (0.8 * 0.8 + 3.4 * 3.4) / (1.2 * 1.2 + 3.4 * 3.4);
    assert!((layer["curve"]["f0"][1].as_f64().unwrap() - f0).abs() < 1e-12, "{layer}");
    assert!(manifest["tables"].as_array().unwrap().iter().all(|table| table["kind"] != "fresnel"));
    for form in ["baked", "full"] {
        let text = fs::read_to_string(workshop.path(&format!("out/shaders/{form}.wgsl"))).unwrap();
        assert!(text.contains("// Masking of x: ") && text.contains("FresnelTermNP"), "{text}");
        assert!(!text.contains("luthier_normal_index") && !text.contains("luthier_lambda"), "{text}");
    }
}

/// Stacks whose fits would take minutes are refused by `check`, and by `bake` before any job; the limit is in the message.
#[test]
fn stacks_that_are_too_deep_to_be_fitted() {
    let stack = |layers: usize, more: &str| {
        let coat = |i: usize| {
            let ior = if i.is_multiple_of(2) { 1.5 } else { 1.3 };
            format!("\n[[layer]]\ntype = \"dielectric\"\nior = {ior}\nalpha = 0.2\n{}", if i == 0 { more } else { "" })
        };
        let base = "\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
        format!("schema = 1\nname = \"deep\"\n{}{base}", (1..layers).map(|i| coat(i - 1)).collect::<String>())
    };
    let workshop = Workshop::new();
    image::GrayImage::from_pixel(1, 1, image::Luma([128])).save(workshop.path("r.png")).unwrap();
    let mapped = "maps = { roughness = \"r.png\" }\n";
    for (layers, more, is_fitted) in [(16, mapped, true), (17, mapped, false), (50, mapped, false), (50, "", true)] {
        workshop.write("deep.toml", stack(layers, more));
        let check = workshop.run(&["check", "deep.toml"]).exits(i32::from(!is_fitted));
        if is_fitted {
            continue;
        }
        let words = ["at most 16 layers", &format!("this one has {layers}"), "[bake] model = \"elek\""];
        check.says(&words);
        workshop.run(&["bake", "deep.toml", "--cache", "store"]).exits(1).says(&words);
        assert!(!workshop.path("store/objects").exists(), "nothing was computed");
        workshop.write("deep.toml", stack(layers, more) + "\n[bake]\nmodel = \"elek\"\n");
        workshop.run(&["check", "deep.toml"]).exits(0);
    }
}
