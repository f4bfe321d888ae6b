//! Bakes with the model `lobes`.

use luthier_workshop::material_texts::lacquer;

use crate::workshop::Workshop;

#[test]
fn lobes_have_a_tile_a_record_and_one_form() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a"))]);
    workshop.run(&["bake", "a.toml", "-q", "--model", "lobes", "--target", "wgsl"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let material = &manifest["materials"][0];
    assert_eq!(material["layers"][0]["lobes_tile"], 0);
    assert!(material["layers"][1].get("lobes_tile").is_none(), "{material}");
    assert!(material["constants"]["lobes"]["index"].as_f64().unwrap() >= 1.0, "{material}");
    let forms: Vec<&str> = manifest["shaders"].as_array().unwrap().iter().filter_map(|s| s["form"].as_str()).collect();
    assert_eq!(forms, ["baked"]);
    let constant = workshop.run(&["shader", "a.toml", "--model", "lobes", "--constant"]).exits(0).stdout;
    for number in material["constants"]["lobes"]["falloff"].as_array().unwrap() {
        let number = format!("{:?}", number.as_f64().unwrap() as f32);
        assert!(constant.contains(&number), "the shader has the numbers of the fit: {number} {constant}");
    }
    let before = workshop.text("out/manifest.json");
    let refused = ["bake", "a.toml", "--model", "lobes", "--form", "full"];
    workshop.run(&refused).fails(1, &["`a` has no `full` shader", "ask for the `baked` form"]);
    assert_eq!(workshop.text("out/manifest.json"), before);
}

/// A layout that is asked for holds; else a language without buffers, functions that prepare a view, a limit on bytes, or a device decide. Both layouts are
/// the same rows: a judgement on the device and in f64 holds the same limit.
#[test]
fn rows_have_the_layout_of_their_target() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a"))]);
    let format = |options: &[&str]| {
        let bake = ["bake", "a.toml", "-q", "--model", "lobes"];
        workshop.run(&[&bake, options].concat()).exits(0);
        let manifest = workshop.json("out/manifest.json");
        let table = manifest["tables"].as_array().unwrap().iter().find(|table| table["kind"] == "lobes").unwrap();
        let binding = manifest["bindings"].as_array().unwrap().iter().find(|entry| entry["binding"] == 9).unwrap();
        let (format, resource) = (table["format"].as_str().unwrap(), binding["resource"].as_str().unwrap());
        assert_eq!(format == "rgba16float-steps", resource == "buffer<vec4<u32>>", "{format} {resource}");
        format.to_owned()
    };
    let [steps, filtered] = ["rgba16float-steps", "rgba16float"];
    assert_eq!(format(&["--target", "wgsl", "--layout", "filtered"]), filtered);
    assert_eq!(format(&["--target", "wgsl,glsl450,hlsl,msl,spirv"]), steps);
    assert_eq!(format(&[]), filtered);
    assert_eq!(format(&["--target", "wgsl", "--functions", "light"]), filtered);
    assert_eq!(format(&["--target", "wgsl", "--max-bytes", "100000"]), filtered);
    assert_eq!(format(&["--target", "wgsl", "--device", "rdna2"]), filtered);
    assert_eq!(format(&["--target", "wgsl", "--device", "h100"]), steps);
    // The default languages, GLSL ES 3.00 with a texture of whole numbers among them.
    assert_eq!(format(&["--layout", "steps"]), steps);
    let report = workshop.run(&["report", "--pairs", "64", "--max-error", "2e-2"]).exits(0).stdout;
    assert!(report.contains("held"), "{report}");
    let shader = |options: &[&str]| {
        workshop.run(&[&["shader", "a.toml", "--model", "lobes", "--form", "baked"], options].concat()).exits(0).stdout
    };
    assert!(shader(&[]).contains("var<storage, read> luthier_lobes: array<vec4<u32>>;"));
    assert!(shader(&["--layout", "filtered"]).contains("var luthier_lobes: texture_2d<f32>;"));
    assert!(shader(&["--target", "glsl-es300"]).contains("sampler2D luthier_lobes;"));
    assert!(shader(&["--target", "glsl-es300", "--layout", "steps"]).contains("usampler2D luthier_lobes;"));
}

/// The fewest bytes that hold the limit are baked, tighter limits cost no less, and what none holds is refused with the limit that would do: which
/// does.
#[test]
fn lobes_are_as_small_as_their_budget_allows() {
    let plain = lacquer("a").replace("\"elek\"", "\"lobes\"");
    let limited = |limit: &str| plain.replace("schema = 1\n", &format!("schema = 1\nbudget = {{ {limit} }}\n"));
    let workshop = Workshop::with(&[("a.toml", &plain)]);
    let mut bytes = Vec::new();
    for limit in [0.6, 0.1, 0.04] {
        workshop.write("a.toml", limited(&format!("max_lobe_err = {limit}")));
        let run = workshop.run(&["bake", "a.toml", "--target", "wgsl"]).exits(0);
        assert!(run.stdout.contains("lobes against the simulated stack"), "{}", run.stdout);
        let manifest = workshop.json("out/manifest.json");
        let error = &manifest["materials"][0]["constants"]["lobes"]["error"];
        let search = manifest["searches"].as_array().unwrap().iter().find(|search| search["kind"] == "lobes").unwrap();
        let chosen = &search["front"][search["chosen"].as_u64().unwrap() as usize];
        assert!(
            error["lobe"].as_f64().unwrap() <= limit && error["lobe"] == chosen["error"]["lobe"],
            "{error} {chosen}"
        );
        let table = manifest["tables"].as_array().unwrap().iter().find(|table| table["kind"] == "lobes").unwrap();
        assert_eq!(table["texel_bytes"], chosen["bytes"]);
        bytes.push(chosen["bytes"].as_u64().unwrap());
        let report = workshop.run(&["report", "--no-device", "--pairs", "8", "--json"]).exits(0).json();
        let limits = report["limits"].as_array().unwrap();
        assert!(
            limits.iter().any(|l| l["quantity"] == "lobes: largest lobe error" && l["found"] == error["lobe"]),
            "{limits:?}"
        );
        // A fit without limits has other lobes and the same albedo.
        let tables = report["tables"].as_array().unwrap();
        let rows = tables.iter().find(|table| table["kind"] == "lobes").unwrap();
        let found = rows["tiles"][0]["judge"]["max_abs_err"].as_f64().unwrap();
        assert!(found <= 1.5 * error["albedo"].as_f64().unwrap() + 2e-3, "{rows} {error}");
    }
    assert!(bytes[0] <= bytes[1] && bytes[1] < bytes[2], "{bytes:?}");
    workshop.write("a.toml", plain.clone());
    let before = workshop.text("out/manifest.json");
    let refused = ["bake", "a.toml", "--target", "wgsl", "--max-lobe-err", "1e-4"];
    let message = workshop.run(&refused).fails(1, &["no lobes table is good enough", "lobe error"]).stderr;
    assert_eq!(workshop.text("out/manifest.json"), before);
    let would = message.rsplit("max_lobe_err = ").next().unwrap().split('`').next().unwrap();
    workshop.run(&["bake", "a.toml", "--target", "wgsl", "-q", "--max-lobe-err", would]).exits(0);
    let albedo = ["bake", "a.toml", "--target", "wgsl", "-q", "--max-albedo-err", "0.02"];
    workshop.run(&albedo).exits(0);
}

/// Rows over slope parameters of single layers have as few nodes and views as hold the limit, and all of them without one.
#[test]
fn families_are_as_small_as_their_budget_allows() {
    let layer = |text: &str| format!("\n[[layer]]\n{text}\n");
    let base = "type = \"metallic-roughness\"\nbase_color = 0.8\nmetallic = 1\nalpha = 1\nmaps = { alpha = \"r.png\" }";
    let text =
        format!("schema = 1\nname = \"a\"\n{}{}", layer("type = \"dielectric\"\nior = 1.5\nalpha = 0.1"), layer(base));
    let workshop = Workshop::with(&[("a.toml", &text)]);
    let map = image::ImageBuffer::from_fn(2, 1, |x, _| image::Luma([40 + 160 * x as u8]));
    map.save(workshop.path("r.png")).unwrap();
    let tiles: Vec<u64> = ([Some("0.5"), Some("0.06"), None].iter())
        .map(|limit| {
            let limit = limit.map_or(vec![], |limit| vec!["--max-lobe-err", limit]);
            workshop
                .run(&[&["bake", "a.toml", "--target", "wgsl", "-q", "--model", "lobes"], &limit[..]].concat())
                .exits(0);
            let manifest = workshop.json("out/manifest.json");
            let lobes = &manifest["materials"][0]["constants"]["lobes"];
            let (family, tiles) = (&lobes["varying"]["family"], lobes["varying"]["tiles"].as_u64().unwrap());
            assert_eq!(family["base"]["nodes"].as_u64().unwrap() * family["coat"]["nodes"].as_u64().unwrap(), tiles);
            if let [_, limit] = limit[..] {
                assert!(lobes["error"]["lobe"].as_f64().unwrap() <= limit.parse().unwrap(), "{lobes}");
            }
            tiles
        })
        .collect();
    assert!(tiles[0] == 2 && tiles[0] <= tiles[1] && tiles[1] <= tiles[2] && tiles[2] > 2, "{tiles:?}");
}

/// Limits on lobes where there are none are refused: in a file with its line, as an option.
#[test]
fn limits_on_lobes_need_lobes() {
    let text = lacquer("a").replace("schema = 1\n", "schema = 1\nbudget = { max_albedo_err = 0.01 }\n");
    let workshop = Workshop::with(&[("a.toml", &text), ("b.toml", &lacquer("b"))]);
    let stderr = workshop.run(&["check", "a.toml"]).exits(1).stderr;
    let words = ["a.toml:2:29", "`max_albedo_err` limits the model lobes", "is elek", "leave the limit out"];
    assert!(words.iter().all(|word| stderr.contains(word)), "{stderr}");
    let option = ["bake", "b.toml", "--model", "elek", "--max-lobe-err", "0.1"];
    workshop.run(&option).fails(1, &["`max_lobe_err` limits the model lobes", "--model lobes"]);
}

/// Oracle: paths of the reference with other random numbers, four standard errors and what the model itself is off.
#[test]
fn the_albedo_of_lobes_is_that_of_the_reference() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a"))]);
    let albedo = |model: &[&str]| {
        let args = ["eval", "a.toml", "--albedo", "--angles", "20,65", "--wavelength", "645", "--json", "--model"];
        let json = workshop.run(&[&args[..], model].concat()).exits(0).json();
        [0, 1].map(|i: usize| [&json["albedo"][i]["albedo"], &json["albedo"][i]["error"]].map(|v| v.as_f64().unwrap()))
    };
    let found = albedo(&["lobes"]);
    let expected = albedo(&["layered-mc", "--samples", "60000"]);
    for ([found, _], [expected, sigma]) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 4.0 * sigma + 2e-3 && sigma < 2e-3, "{found} {expected} {sigma}");
    }
}

/// A roughness map makes rows over its factor, and the model remains `lobes`. Oracle of the albedo at a place: paths of the reference for a
/// material whose roughness is written as that.
#[test]
fn a_roughness_map_makes_rows_over_its_factor() {
    let coat =
        |alpha: f64, maps: &str| format!("[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = {alpha:?}\n{maps}");
    let metal = |alpha: f64| format!("[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = {alpha:?}\n");
    let head = "schema = 1\nname = \"worn\"\n";
    let worn = format!("{head}{}{}", coat(0.4, "maps = { roughness = \"r.png\" }\n"), metal(0.3));
    let factor = 0.36;
    let plain = format!("{head}{}{}", coat(0.4 * factor, ""), metal(0.3 * factor));
    let workshop = Workshop::with(&[("worn.toml", &worn), ("plain.toml", &plain)]);
    let map = image::ImageBuffer::from_fn(4, 4, |x, y| image::Luma([(20 * (x + y)) as u8]));
    map.save(workshop.path("r.png")).unwrap();
    workshop.run(&["bake", "worn.toml", "-q", "--target", "wgsl"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let material = &manifest["materials"][0];
    assert_eq!((&material["model"], &material["layers"][0]["lobes_tile"]), (&"lobes".into(), &0.into()));
    let varying = &material["constants"]["lobes"]["varying"];
    assert_eq!((&varying["factor"], &varying["tiles"]), (&"alpha_factor".into(), &8.into()), "{material}");
    // The slope parameter that may be least over the greatest.
    assert!((varying["least_spread"].as_f64().unwrap() - 1e-3 / 0.4).abs() < 1e-12, "{varying}");
    let tables = manifest["tables"].as_array().unwrap();
    let lobes = tables.iter().find(|table| table["kind"] == "lobes").unwrap();
    let layout = &lobes["layout"];
    assert_eq!((&layout["tiles"], &layout["columns"]), (&8.into(), &1.into()), "{layout}");
    let bytes = std::fs::metadata(workshop.path("out/tables/lobes.ktx2")).unwrap().len();
    assert!(bytes < 16 * 1024, "{bytes}");

    let albedo = |file: &str, model: &[&str]| {
        let args = [file, "--albedo", "--angles", "20,65", "--wavelength", "645", "--json", "--model"];
        let json = workshop.run(&[&["eval"], &args[..], model].concat()).exits(0).json();
        [0, 1].map(|i: usize| json["albedo"][i]["albedo"].as_f64().unwrap())
    };
    let found = albedo("worn.toml", &["lobes", "--alpha-factor", "0.36"]);
    let expected = albedo("plain.toml", &["layered-mc", "--samples", "60000"]);
    for (found, expected) in found.into_iter().zip(expected) {
        assert!((found - expected).abs() < 0.01, "{found} {expected}");
    }
}
