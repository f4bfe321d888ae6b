//! The slider for roughness: a factor on slopes, against pictures of material files that have the multiplied slopes.

use serde_json::{Value, json};

use super::{Apart, SIZE, USE, apart, browser_or_skip, opened};
use crate::workshop::Workshop;

/// Names, models, and layers of materials with the slope parameters 0.1 and 0.2, times a factor.
fn materials(factor: f64) -> [(&'static str, String); 5] {
    let (first, second) = (0.1 * factor, 0.2 * factor);
    let coat = format!(
        "[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = {first}\nthickness_um = 20\nabsorption_per_um = [0.002, 0.01, 0.03]\n"
    );
    let gold = |alpha: f64| format!("[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = {alpha}\n");
    let paint = "[[layer]]\ntype = \"diffuse\"\nalbedo = [0.6, 0.2, 0.1]\n";
    let over_gold = format!("{coat}{}", gold(second));
    let text = |name, model, layers: &str| {
        (name, format!("schema = 1\nname = \"{name}\"\n{layers}[bake]\nmodel = \"{model}\"\n"))
    };
    [
        text("a-elek", "elek", &over_gold),
        text("b-weidlich", "weidlich-wilkie", &format!("{coat}{paint}")),
        text("c-belcour", "belcour", &over_gold),
        text("d-yamaguchi", "yamaguchi", &over_gold),
        text("e-microfacet", "microfacet", &gold(first)),
    ]
}

#[test]
fn a_factor_is_that_of_a_file_with_the_multiplied_slopes() {
    factors_are_those_of_files(&[1.0, 2.5], &["a-elek", "e-microfacet"]);
}

#[test]
#[ignore = "half a minute: scripts/nightly.sh tests"]
fn every_factor_of_every_model_is_that_of_a_file() {
    let names = materials(1.0).map(|(name, _)| name);
    factors_are_those_of_files(&[1.0, 0.5, 2.5], &names);
}

/// Pictures of the page with a factor, 1 before all, against those of the device, of files that have it.
fn factors_are_those_of_files(factors: &[f64], names: &[&str]) {
    let Some(browser) = browser_or_skip() else { return };
    let workshop = Workshop::new();
    let mut sheets = Vec::new();
    for (i, &factor) in factors.iter().enumerate() {
        for (name, text) in materials(factor).into_iter().filter(|(name, _)| names.contains(name)) {
            workshop.write(&format!("m{i}/{name}.toml"), text);
        }
        let (folder, sheet, size) = (format!("m{i}"), format!("{i}.png"), SIZE.to_string());
        let columns = names.len().to_string();
        let run = workshop.run(&[
            "gallery",
            &folder,
            "-o",
            &sheet,
            "--columns",
            &columns,
            "--samples",
            "4",
            "--size",
            &size,
            "--no-fit",
        ]);
        if run.lacks_adapter() {
            return;
        }
        run.exits(0);
        sheets.push(image::open(workshop.path(&sheet)).unwrap().into_rgb8());
    }
    workshop.run(&["gallery", "m0", "--html", "page.html", "--no-fit"]).exits(0);
    let script = format!(
        "found.pictures = [];\nfor (const slopes of {}) for (const name of {}) {{ found.pictures.push([...await luthierPicture(name, {{ size: {SIZE}, \
         slopes }})]); await tell({{ progress: name }}); }}",
        json!(factors),
        json!(names)
    );
    let found = opened(&browser, &workshop, "page.html", [1280, 900], "", &script);
    let pictures: Vec<&Value> = found["pictures"].as_array().unwrap().iter().collect();
    for (i, &factor) in factors.iter().enumerate() {
        for (column, name) in names.iter().enumerate() {
            let picture = pictures[i * names.len() + column];
            let Apart { mean, median, most_of } = apart(&sheets[i], column as u32, picture);
            let from_nominal = apart(&sheets[0], column as u32, picture).mean;
            eprintln!(
                "{name} x {factor}: mean {mean:.3}, median {median}, 99% {most_of}; from x 1 mean {from_nominal:.2}"
            );
            assert!(median <= 2 && most_of <= 8 && mean < 1.0, "{name} x {factor}: mean {mean}");
            assert!(factor == 1.0 || from_nominal > 3.0 * mean.max(0.2), "{name} x {factor}: {from_nominal}");
        }
    }
}

/// Layers of lobes: a coat of a slope parameter, with maps or without, over gold of half of it.
fn lobes(name: &str, alpha: f64, maps: &str) -> String {
    format!(
        "schema = 1\nname = \"{name}\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = {alpha}\nthickness_um = 1\n{maps}\
         [[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = {}\n[bake]\nmodel = \"lobes\"\n",
        0.5 * alpha
    )
}

/// A fit has one roughness, and the slider says so; with another model it is there. A fit for a roughness map follows down from 1.
#[test]
#[ignore = "a minute: scripts/nightly.sh tests"]
fn lobes_follow_where_they_were_fitted() {
    let Some(browser) = browser_or_skip() else { return };
    let maps = "maps = { roughness = \"white.png\" }\n";
    let workshop = Workshop::with(&[
        ("m/coat.toml", &lobes("coat", 0.2, "")),
        ("m/worn.toml", &lobes("worn", 0.2, maps)),
        ("half.toml", &lobes("worn", 0.1, "")),
    ]);
    image::GrayImage::from_pixel(4, 4, image::Luma([255])).save(workshop.path("m/white.png")).unwrap();
    let size = SIZE.to_string();
    let run = workshop.run(&["gallery", "half.toml", "-o", "half.png", "--samples", "4", "--size", &size]);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    workshop.run(&["gallery", "m", "--html", "page.html"]).exits(0);
    let script = [
        USE,
        r##"
const slopes = document.getElementById("page-slopes");
const tells = () => [slopes.disabled, slopes.title, document.getElementById("page-slopes-value").textContent, slopes.max];
await drawn(() => (location.hash = "#coat"));
found.choices = all("#page-a option").map(option => option.textContent);
found.fitted = tells();
await drawn(() => choose("a", 1));
found.closed = tells();
await drawn(() => (location.hash = "#worn"));
found.worn = tells();
found.half = [...await luthierPicture("worn", { size: $size, slopes: 0.5 })];
"##,
    ]
    .concat()
    .replace("$size", &size);
    let found = opened(&browser, &workshop, "page.html", [500, 400], "", &script);
    assert_eq!(found["choices"], json!(["lobes, tables", "belcour, tables", "belcour, no tables"]));
    assert_eq!([&found["fitted"][0], &found["fitted"][2]], [&json!(true), &json!("fixed")]);
    assert!(found["fitted"][1].as_str().unwrap().contains("fitted for one roughness"));
    assert_eq!(
        [&found["closed"][0], &found["closed"][2], &found["closed"][3]],
        [&json!(false), &json!("× 1.00"), &json!("2")]
    );
    assert_eq!(
        [&found["worn"][0], &found["worn"][2], &found["worn"][3]],
        [&json!(false), &json!("× 1.00"), &json!("0")]
    );
    let half = image::open(workshop.path("half.png")).unwrap().into_rgb8();
    let Apart { mean, median, most_of } = apart(&half, 0, &found["half"]);
    eprintln!("lobes x 0.5: mean {mean:.3}, median {median}, 99% {most_of}");
    assert!(median <= 2 && most_of <= 8 && mean < 1.0, "mean {mean}");
}
