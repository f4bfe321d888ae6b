//! `report`: numbers, limits and exit codes.

use std::fs;

use luthier_workshop::material_texts::{NOISE, film, gold, lacquer};
use luthier_workshop::root;
use serde_json::Value;

use crate::workshop::Workshop;

const TABLES_ONLY: [&str; 4] = ["report", "--no-device", "--pairs", "64"];

fn baked() -> Workshop {
    let workshop = Workshop::new();
    workshop.write("m/lacquer.toml", lacquer("lacquer"));
    workshop.write("m/gold.toml", gold("gold"));
    workshop.write("m/film.toml", film("film", NOISE));
    workshop.run(&["bake", "m", "-q"]).exits(0);
    workshop
}

#[test]
fn tables_are_judged_without_a_device() {
    let workshop = baked();
    let run = workshop.run(&TABLES_ONLY).exits(0);
    assert_eq!(run.stderr, "");
    assert!(run.stdout.contains("3 materials judged, tables only"), "{}", run.stdout);
    assert_eq!(workshop.files("out/report"), ["index.html", "report.json", "report.md"]);

    let report = workshop.json("out/report/report.json");
    assert_eq!(report["device"], Value::Null);
    assert_eq!(report["pairs_per_set"], 64);
    let kinds: Vec<&str> = report["tables"].as_array().unwrap().iter().map(|t| t["kind"].as_str().unwrap()).collect();
    assert_eq!(kinds, ["fresnel", "distribution", "fgd", "phase", "thickness", "film"]);
    for table in report["tables"].as_array().unwrap() {
        for tile in table["tiles"].as_array().unwrap() {
            assert!(tile["baker"]["max_abs_err"].as_f64().is_some_and(f64::is_finite), "{tile}");
        }
    }
    let page = workshop.text("out/report/index.html");
    for name in ["lacquer", "gold", "film"] {
        assert!(page.contains(name), "{name}");
    }
    assert!(page.contains("<svg"));
    for external in ["<link", "src=\"http", "@import", "url(", "fetch("] {
        assert!(!page.contains(external), "the page is self-contained: {external}");
    }
}

/// Statistical models are judged as any other: their tables have references of their own.
#[test]
fn bakes_of_statistical_models_are_judged() {
    let workshop = Workshop::with(&[("m/lacquer.toml", &lacquer("lacquer")), ("m/gold.toml", &gold("gold"))]);
    for model in ["belcour", "yamaguchi"] {
        workshop.run(&["bake", "m", "-q", "--model", model]).exits(0);
        workshop.run(&TABLES_ONLY).exits(0);
        let report = workshop.json("out/report/report.json");
        assert_eq!(report["model"], model);
        let error = report["max_error"].as_f64().unwrap();
        assert!(error > 1e-6 && error < 1.0, "{model}: {error}");
    }
}

/// The tables of a patina's bare surface belong to no layer, and are read all the same.
#[test]
fn bare_surfaces_have_readers() {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\n\n[[layer]]";
    let effects = format!("\n[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = {NOISE}\n\n[bake]");
    let patina = gold("weathered").replacen("[[layer]]", coat, 1).replacen("\n[bake]", &effects, 1);
    let workshop = Workshop::with(&[("m/weathered.toml", &patina)]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    workshop.run(&TABLES_ONLY).exits(0);
    let report = workshop.json("out/report/report.json");
    let tiles = report["tables"].as_array().unwrap().iter().flat_map(|table| table["tiles"].as_array().unwrap());
    assert!(tiles.clone().any(|tile| tile["users"].to_string().contains("bare")));
    let findings = report["findings"].as_array().unwrap();
    assert!(!findings.iter().any(|finding| finding.to_string().contains("no layer reads it")), "{findings:?}");
}

/// Rows of one atlas: of a coat over a base without a lobe, and of two lobes at the ends of a patina. Each is measured against a fit of its own stack, and those
/// that only places read have readers.
#[test]
fn rows_of_several_stacks_in_one_atlas_have_no_findings() {
    let copy = |name: &str| fs::read_to_string(root().join(format!("materials/{name}.toml"))).unwrap();
    let names = ["house-paint", "copper-patina"];
    let texts = names.map(copy);
    let workshop = Workshop::with(&[("m/a.toml", &texts[0]), ("m/b.toml", &texts[1])]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    workshop.run(&TABLES_ONLY).exits(0);
    let report = workshop.json("out/report/report.json");
    let lobes = report["tables"].as_array().unwrap().iter().find(|table| table["kind"] == "lobes").unwrap();
    let tiles = lobes["tiles"].as_array().unwrap();
    let users = |tile: &Value| tile["users"].as_array().unwrap().len();
    assert_eq!(tiles.iter().map(users).collect::<Vec<_>>(), [1; 4], "{tiles:?}");
    assert_eq!(report["findings"], serde_json::json!([]));
}

/// Rows under patina are fitted together with the bare ones, and so is their reference.
#[test]
fn lobes_under_patina_are_judged_by_their_own_fit() {
    let layers = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.05\n\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.05";
    let effects = format!("[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = {NOISE}");
    let patina = format!("schema = 1\nname = \"weathered\"\n\n{layers}\n\n{effects}\n");
    let workshop = Workshop::with(&[("m/weathered.toml", &patina)]);
    workshop.run(&["bake", "m", "-q", "--model", "lobes"]).exits(0);
    workshop.run(&TABLES_ONLY).exits(0);
    // A fit without patina is a tenth off.
    let error = workshop.json("out/report/report.json")["max_error"].as_f64().unwrap();
    assert!(error > 1e-6 && error < 0.01, "{error}");
}

#[test]
fn json_goes_to_both_places() {
    let workshop = baked();
    let run = workshop.run(&["report", "--no-device", "--pairs", "8", "--json"]).exits(0);
    assert_eq!(run.stdout, workshop.text("out/report/report.json"));
}

#[test]
fn judging_twice_gives_the_same() {
    let workshop = baked();
    workshop.run(&TABLES_ONLY).exits(0);
    let first = workshop.tree("out");
    workshop.run(&TABLES_ONLY).exits(0);
    assert!(first == workshop.tree("out"));
}

#[test]
fn the_budget_is_the_printed_error() {
    let workshop = baked();
    workshop.run(&TABLES_ONLY).exits(0);
    let worst = workshop.json("out/report/report.json")["max_error"].as_f64().unwrap();
    assert!(worst > 1e-6 && worst < 1.0, "{worst}");
    for (factor, code, verdict) in [(1e-3, 1, "exceeded"), (0.999, 1, "exceeded"), (1.001, 0, "held"), (1e3, 0, "held")]
    {
        let budget = format!("{:e}", worst * factor);
        let run = workshop.run(&[&TABLES_ONLY[..], &["--max-error", &budget]].concat()).exits(code);
        assert!(run.stdout.contains(verdict), "{}", run.stdout);
        assert_eq!(run.stderr, "", "the verdict is no error of the command");
        assert_eq!(workshop.json("out/report/report.json")["within_budget"], code == 0);
    }
}

/// Limits of the command line and of material files; what was not measured breaks its limit.
#[test]
fn limits_decide_the_exit_code() {
    let workshop = baked();
    let run = |more: &[&str]| workshop.run(&[&TABLES_ONLY[..], more].concat());
    run(&["--max-abs", "1", "--max-bytes", "100000000"]).exits(0);
    let broken = run(&["--max-abs", "1", "--max-bytes", "1"]).exits(1);
    assert!(broken.stdout.contains("bytes of all tables, limit 1e0 of command line"), "{}", broken.stdout);
    assert!(workshop.text("out/report/report.md").contains("**A limit is broken.**"));
    let limits = workshop.json("out/report/report.json")["limits"].as_array().unwrap().clone();
    assert_eq!(limits.iter().map(|l| l["is_held"] == true).collect::<Vec<_>>(), [true, false]);
    run(&["--max-delta-e", "1e-9"]).exits(1);
    assert!(run(&["--max-lobe", "1"]).exits(2).stderr.contains("--reference"));

    // A file's budget: what the bake held with its own figures, the judge holds with his.
    let text = format!("{}\n[budget]\nmax_abs = 0.08\n", lacquer("lacquer"));
    let workshop = Workshop::with(&[("m/lacquer.toml", &text)]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let held = workshop.run(&TABLES_ONLY).exits(0);
    assert!(held.stdout.contains("limit 8e-2 of m/lacquer.toml"), "{}", held.stdout);
    assert_eq!(workshop.json("out/report/report.json")["within_budget"], true);
}

/// Models against the reference come with the option only, with all that shaders evaluate.
#[test]
fn models_are_compared_with_paths_when_asked() {
    let workshop = Workshop::with(&[("m/gold.toml", &gold("gold"))]);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let material = || workshop.json("out/report/report.json")["materials"][0].clone();
    workshop.run(&TABLES_ONLY).exits(0);
    assert_eq!(material()["against_reference"], Value::Array(Vec::new()));
    workshop.run(&[&TABLES_ONLY[..], &["--reference=200"]].concat()).exits(0);
    assert_eq!(material()["against_reference"].as_array().unwrap().len(), 8);
    assert_eq!(workshop.json("out/report/report.json")["reference"]["paths"], 200);
}

/// Files that are not what they should be.
#[test]
fn foreign_evidence_is_refused() {
    let workshop = baked();
    workshop.write("wrong.json", "{}");
    for option in ["--cost", "--stability"] {
        let words = [&TABLES_ONLY[..], &[option, "wrong.json"]].concat();
        workshop.run(&words).fails(1, &["wrong.json", "--json` prints"]);
        workshop.run(&[&TABLES_ONLY[..], &[option, "none.json"]].concat()).fails(3, &["none.json"]);
    }
}

/// Whether reports have to do without a device here.
#[cfg(feature = "gpu")]
pub(crate) fn has_no_adapter(workshop: &Workshop) -> bool {
    workshop.run(&["report", "--pairs", "1", "--picture-size", "0"]).lacks_adapter()
}

/// Whether reports have to do without a device: always, as this build has no code for one.
#[cfg(not(feature = "gpu"))]
pub(crate) fn has_no_adapter(_: &Workshop) -> bool {
    true
}

#[test]
fn nonsense_on_the_command_line() {
    let workshop = Workshop::new();
    for bad in ["0", "-1", "nan", "inf", "much"] {
        workshop.run(&["report", "--max-error", bad]).fails(2, &["--max-error", bad]);
    }
    for bad in ["0", "1000001", "-5", "few"] {
        workshop.run(&["report", &format!("--pairs={bad}")]).fails(2, &["--pairs", bad]);
    }
}

/// Choices of lower layers where patina grows and where it leaves them bare: both shaders against the twin, which takes the choices from the file.
#[cfg(feature = "gpu")]
#[test]
fn lower_layers_below_a_patina_are_those_of_the_twin() {
    const LAYERS: &str = "schema = 1\nname = \"N\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n[[layer]]\ntype = \"dielectric\"\n\
        f0 = 0.5\nalpha = 0.1\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n[effects.patina]\nextent = 0.5\ntransition = 0.5\nmap = { noise = {} }\n\
        [bake]\nmodel = \"N\"\nlower_facets = \"phong\"\ndiffuse_part = \"beside\"\nmasking = \"kelemen\"\n";
    let workshop = Workshop::new();
    workshop.write("m/elek.toml", LAYERS.replace('N', "elek"));
    let rougher = "lower_alpha = \"at-least-above\"\n";
    workshop.write("m/course.toml", LAYERS.replace('N', "weidlich-wilkie") + rougher);
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let run = workshop.run(&["report", "--pairs", "1024", "--max-error", "2e-2"]);
    if !run.lacks_adapter() {
        run.exits(0);
    }
}

/// Coats with weights, of every model that shows them, with choices of lower layers and with maps: shaders against the twin, which has the weight of the
/// file, without a place and at places. Rows of both ends are judged by their own fit.
#[test]
fn coats_with_weights_are_those_of_the_twin() {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\nthickness_um = 10\nabsorption_per_um = [0.01, 0.02, 0.04]\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nalpha = 0.3\n";
    let paint = "[[layer]]\ntype = \"dielectric\"\nior = 1.3\nalpha = 0.1\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.3, 0.1]\n";
    let engine =
        "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.6, 0.3, 0.1]\nmetallic = 0.5\nroughness = 0.5\n";
    let textured = format!("{engine}maps = {{ base_color = \"mask.png\", metallic = \"mask.png\" }}\n");
    let chosen = "lower_facets = \"phong\"\ndiffuse_part = \"beside\"\nmasking = \"kelemen\"\n";
    let mapped = "maps = { weight = \"mask.png\", bumps = \"mask.png\" }\n";
    let workshop = Workshop::new();
    let mask = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([(30 * x) as u8, (200 - 20 * y) as u8, 255]));
    std::fs::create_dir_all(workshop.path("m")).unwrap();
    mask.save(workshop.path("m/mask.png")).unwrap();
    for (name, model, weight, below, more) in [
        ("elek", "elek", "weight = 0.3\n", paint, chosen),
        ("course", "weidlich-wilkie", "weight = 0.7\n", paint, "lower_alpha = \"at-least-above\"\n"),
        ("bumpy", "weidlich-wilkie", mapped, metal, ""),
        ("engine", "elek", "weight = 0.4\n", engine, ""),
        ("undarkened", "elek", "darkening = false\nmaps = { weight = \"mask.png\" }\n", &textured, ""),
        ("metal", "lobes", "weight = 0.6\n", metal, ""),
        ("paint", "lobes", "weight = 0.6\nmaps = { weight = \"mask.png\" }\n", paint, ""),
    ] {
        let text = format!("schema = 1\nname = \"{name}\"\n{coat}{weight}{below}[bake]\nmodel = \"{model}\"\n{more}");
        workshop.write(&format!("m/{name}.toml"), text);
    }
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let run = workshop.run(&["report", "--pairs", "512", "--picture-size", "0", "--max-error", "2e-2"]);
    if run.lacks_adapter() {
        workshop.run(&TABLES_ONLY).exits(0);
    } else {
        run.exits(0);
    }
    shaders_are_their_twins(&workshop.json("out/report/report.json"));
}

/// Weights of coats beside textures, which make two surfaces of them: shaders against the twin at places, and what the report finds.
#[test]
fn coats_with_weights_beside_textures_are_those_of_the_twin() {
    let coat = "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.2\nthickness_um = 10\nabsorption_per_um = [0.01, 0.02, 0.04]\n";
    let metal = "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nalpha = 0.3\n";
    let paint = "[[layer]]\ntype = \"dielectric\"\nior = 1.3\nalpha = 0.1\n[[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.3, 0.1]\n";
    let textured = "[[layer]]\ntype = \"metallic-roughness\"\nbase_color = [0.6, 0.3, 0.1]\nmetallic = 0.5\nroughness = 0.5\nmaps = { base_color = \"mask.png\", metallic = \"mask.png\" }\n";
    let slopes = format!("{metal}maps = {{ alpha = \"mask.png\" }}\n");
    let workshop = Workshop::new();
    let mask = image::RgbImage::from_fn(8, 8, |x, y| image::Rgb([(30 * x) as u8, (200 - 20 * y) as u8, 255]));
    std::fs::create_dir_all(workshop.path("m")).unwrap();
    mask.save(workshop.path("m/mask.png")).unwrap();
    for (name, weight, below, more) in [
        ("slopes", "weight = 0.6\n", slopes.as_str(), ""),
        ("colors", "darkening = false\nmaps = { weight = \"mask.png\", alpha = \"mask.png\" }\n", textured, ""),
        ("worn", "weight = 0.6\nmaps = { roughness = \"mask.png\" }\n", paint, ""),
        ("slab", "weight = 0.6\nmaps = { thickness = \"mask.png\", normal = \"mask.png\" }\n", metal, ""),
        (
            "wood",
            "weight = 0.6\n",
            "[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\nsigma = 0.3\nmaps = { albedo = \"mask.png\" }\n",
            "",
        ),
        (
            "brushed",
            "weight = 0.6\n",
            "[[layer]]\ntype = \"conductor\"\nior = \"cu\"\nalpha_x = 0.3\nalpha_y = 0.1\n",
            "",
        ),
        (
            "flaked",
            "weight = 0.6\n",
            paint,
            "[effects.flakes]\ncells = { seed = 1, count = 64, spread_deg = 5 }\ntiling = 100\n",
        ),
    ] {
        let text = format!("schema = 1\nname = \"{name}\"\n{coat}{weight}{below}[bake]\nmodel = \"lobes\"\n{more}");
        workshop.write(&format!("m/{name}.toml"), text);
    }
    // Films, too.
    let film =
        "[[layer]]\ntype = \"thin-film\"\nior = 1.8\nweight = 0.7\nmaps = { weight = \"mask.png\" }\nthickness_nm = ";
    let varying = "{ min = 300, max = 500, extent_um = 1000, map = \"mask.png\" }\n";
    for (name, thickness, layers) in
        [("iridescent", "400\n", slopes.clone()), ("soapy", varying, format!("{coat}{paint}"))]
    {
        let text = format!("schema = 1\nname = \"{name}\"\n{film}{thickness}{layers}");
        workshop.write(&format!("m/{name}.toml"), text);
    }
    let run = workshop.run(&["bake", "m"]).exits(0);
    let has = |words: &str| run.stdout.contains(words);
    assert!(has("brushed, below the coat") && has("soapy, without its film"), "{}", run.stdout);
    let run = workshop.run(&["report", "--pairs", "512", "--picture-size", "0"]);
    if run.lacks_adapter() {
        workshop.run(&TABLES_ONLY).exits(0);
        return;
    }
    run.exits(0);
    shaders_are_their_twins(&workshop.json("out/report/report.json"));
}

/// Every tile is read, and shaders at places are those of the twin.
fn shaders_are_their_twins(report: &serde_json::Value) {
    let findings = report["findings"].as_array().unwrap();
    assert!(!findings.iter().any(|finding| finding.to_string().contains("no layer reads it")), "{findings:?}");
    assert!(report["max_error"].as_f64().unwrap() < 2e-2);
    for material in report["materials"].as_array().unwrap() {
        let errors = &material["at_places"]["shader"]["relative"];
        assert!(errors["max"].as_f64().unwrap() < 1e-4, "{}: {errors}", material["name"]);
    }
}

/// The whole path on a device: tables of the default size, both shaders, all materials.
#[cfg(feature = "gpu")]
#[test]
fn shaders_on_the_device_are_what_they_should_be() {
    use luthier_workshop::material_texts::fine_lacquer;

    /// f32 arithmetic against f64, no table in it.
    const FULL: f64 = 1e-4;
    /// Interpolation and quantisation of the default tables, relative with the floor that the report states.
    const BAKED: f64 = 2e-2;

    let workshop = Workshop::with(&[("m/lacquer.toml", &fine_lacquer("lacquer"))]);
    let metal = gold("gold");
    // A rough metal's default are lobes, which have no form without tables.
    workshop.write("m/gold.toml", format!("{}\n[bake]\nmodel = \"elek\"\n", metal.split("\n[bake]").next().unwrap()));
    workshop.run(&["bake", "m", "-q"]).exits(0);
    let run = workshop.run(&["report", "--pairs", "1024", "--max-error", "2e-2"]);
    if run.lacks_adapter() {
        return;
    }
    let run = run.exits(0);
    let report = workshop.json("out/report/report.json");
    let device = report["device"].as_str().unwrap();
    assert!(run.stdout.contains(device), "{}", run.stdout);
    assert!(report["max_arithmetic_error"].as_f64().unwrap() < FULL);
    for material in report["materials"].as_array().unwrap() {
        for (compared, limit) in [("full-device", FULL), ("baked-device", BAKED)] {
            let comparisons = material["comparisons"].as_array().unwrap();
            let comparison = comparisons.iter().find(|c| c["compared"] == compared).unwrap();
            let sets = comparison["sets"].as_array().unwrap();
            assert!(sets.len() >= 2, "random and grazing directions at least");
            for set in sets {
                let (name, statistics) = (&set[0], &set[1]);
                let error = statistics["relative"]["max"].as_f64().unwrap();
                assert_eq!(statistics["not_finite"], 0);
                assert!(statistics["peak"].as_f64().unwrap() > 0.0, "{compared} {name}: all black");
                assert!(error > 0.0 && error < limit, "{} {compared} {name}: {error}", material["name"]);
            }
        }
    }
}

#[cfg(feature = "gpu")]
#[test]
fn adapters_are_asked_for_by_name() {
    let workshop = baked();
    workshop.run(&["report", "--no-device", "--adapter", "x"]).fails(2, &["--no-device", "--adapter"]);
    let run = workshop.run(&["report", "--adapter", "no such adapter"]);
    if !run.lacks_adapter() {
        run.fails(4, &["no such adapter", "found: "]);
        assert!(!workshop.path("out/report").exists());
    }
}
