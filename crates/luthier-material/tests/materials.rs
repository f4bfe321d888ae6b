//! Every file in `materials/` and `materials/papers/` is a material, cites its source, and explains what is doubtful about it.

use std::fs;
use std::path::{Path, PathBuf};

use luthier_material::{Material, Parsed, parse};
use luthier_optics::stack::Base;

fn folder() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../materials")
}

/// The folder inside it that has the models of papers.
const PAPERS: &str = "papers/";

fn read(name: &str) -> (String, Parsed) {
    let text = fs::read_to_string(folder().join(name)).unwrap();
    match parse(name, &text, &|path| fs::read_to_string(folder().join(path))) {
        Ok(parsed) => (text, parsed),
        Err(diagnostics) => panic!("{}", diagnostics.iter().map(|d| d.render(&text)).collect::<String>()),
    }
}

fn material(name: &str) -> Material {
    read(&format!("{name}.toml")).1.material
}

fn files() -> Vec<String> {
    let of = |inner: &str| {
        let entries = fs::read_dir(folder().join(inner)).unwrap();
        let names = entries.map(|entry| entry.unwrap().file_name().into_string().unwrap());
        names.filter(|name| name.ends_with(".toml")).map(|name| format!("{inner}{name}")).collect::<Vec<_>>()
    };
    let mut names = [of(""), of(PAPERS)].concat();
    names.sort();
    names
}

/// What a paper fixes is in `papers/`, and names the paper's model. All else has the model that luthier chooses: of stacks it is `lobes`.
#[test]
fn papers_name_models_and_others_do_not() {
    for file in files() {
        let material = read(&file).1.material;
        assert_eq!(material.bake.model.is_some(), file.starts_with(PAPERS), "{file}");
        if material.bake.model.is_none() && material.stack.layers.len() > 1 && !file.starts_with("soap-film") {
            assert_eq!(material.model().name(), "lobes", "{file}");
        }
    }
}

#[test]
fn all_parse_and_cite_their_source() {
    let files = files();
    assert!(files.len() >= 28, "{files:?}");
    for file in files {
        let (text, parsed) = read(&file);
        assert_eq!(format!("{}.toml", parsed.material.name), file.trim_start_matches(PAPERS));
        assert!(!parsed.material.references.is_empty() && !parsed.material.description.is_empty(), "{file}");
        assert!(text.contains("\n# Source: "), "{file}");
    }
}

#[test]
fn every_warning_is_explained_in_the_file() {
    for file in files() {
        let (text, parsed) = read(&file);
        let explained = text.lines().filter(|line| line.starts_with("# Warning: ")).count();
        let warnings: String = parsed.warnings.iter().map(|d| d.render(&text) + "\n").collect();
        assert_eq!(parsed.warnings.len(), explained, "{file}\n{warnings}");
    }
}

/// Oracle: the type that each parameter sheet of the course stands under; the last four have no coat, and are not in the course.
#[test]
fn the_classes_are_those_of_the_course() {
    for (name, class) in [
        ("red-lacquer", "b"),
        ("ceramic-glaze", "a"),
        ("acrylic-lacquer", "a"),
        ("frosted-acrylic", "c"),
        ("sugar", "c"),
        ("latex", "c"),
        ("brass-foil", "d"),
        ("car-paint", "e"),
        ("gold-metallic-paint", "e"),
        ("blue-metallic-paint", "f"),
        ("gold-paint", "f"),
        ("silver-paint", "g"),
        ("house-paint", "h"),
        ("polished-gold", "metal"),
        ("brushed-aluminium", "metal"),
        ("soap-film", "film"),
        ("anodised-titanium", "film"),
    ] {
        let name = if folder().join(PAPERS).join(format!("{name}.toml")).exists() {
            format!("{PAPERS}{name}")
        } else {
            name.to_owned()
        };
        assert_eq!(material(&name).class.symbol(), class, "{name}");
    }
}

/// The paints and the parts of stones that the course has in words: they cite it, and explain their warnings.
#[test]
fn parts_of_surfaces_explain_their_warnings() {
    let mut count = 0;
    for entry in fs::read_dir(folder().join("surfaces")).unwrap() {
        let inner = entry.unwrap().path();
        if !inner.is_dir() {
            continue;
        }
        for file in fs::read_dir(&inner).unwrap() {
            let path = file.unwrap().path();
            if path.extension().is_none_or(|ending| ending != "toml") {
                continue;
            }
            let name = path.display().to_string();
            let text = fs::read_to_string(&path).unwrap();
            let parsed = parse(&name, &text, &|other| fs::read_to_string(inner.join(other))).unwrap();
            let explained = text.lines().filter(|line| line.starts_with("# Warning: ")).count();
            assert_eq!(parsed.warnings.len(), explained, "{name}: {:?}", parsed.warnings);
            let material = parsed.material;
            assert!(!material.description.is_empty() && !material.references.is_empty(), "{name}");
            count += 1;
        }
    }
    assert!(count >= 55, "{count}");
}

/// Oracle: section 5.1.2 and 5.2.1 of the course, slopes in degrees.
#[test]
fn paints_and_stones_are_as_printed() {
    let slopes = |name: &str| {
        let layers = material(&format!("surfaces/{name}")).stack.layers;
        layers.iter().map(|layer| libm::atan(layer.surface.alpha_x).to_degrees()).collect::<Vec<f64>>()
    };
    let near = |found: f64, expected: f64| assert!((found - expected).abs() < 1e-9, "{found} {expected}");
    near(slopes("paints/garnet-red")[0], 12.0);
    let copper = ["pale-copper", "bright-copper", "copper", "dark-copper"];
    let flakes = ["flake-1", "flake-2", "flake-3"];
    for (stone, entries, metal) in
        [("sunstone", &copper[..], 3.0), ("pink-sunstone", &flakes[..], 5.0), ("patterned-sunstone", &flakes[..], 5.0)]
    {
        for entry in entries {
            let name = format!("{stone}/{entry}");
            let found = slopes(&name);
            near(found[0], 4.0);
            near(found[1], metal);
            let coat = &material(&format!("surfaces/{name}")).stack.layers[0].base;
            let Base::Dielectric { ior, .. } = coat else { panic!("{name}") };
            near(ior.at(550.0).re, 1.58);
        }
        let surface = fs::read_to_string(folder().join(format!("surfaces/{stone}.toml"))).unwrap();
        let glitter = surface.split("[glitter]").nth(1).unwrap();
        assert_eq!(glitter.matches(".toml\"").count(), entries.len(), "{stone}");
    }
}

/// Oracle: the sheet of the car paint, with its slopes converted on paper (tan 1 and tan 12 degrees).
#[test]
fn the_car_paint_is_as_printed() {
    let stack = material("papers/car-paint").stack;
    let [coat, base] = stack.layers.as_slice() else { panic!("{} layers", stack.layers.len()) };
    assert!((coat.surface.alpha_x - 0.017_455_065).abs() < 1e-9);
    assert!((base.surface.alpha_x - 0.212_556_562).abs() < 1e-9);
    let Base::Dielectric { ior, slab } = &coat.base else { panic!("{coat:?}") };
    assert_eq!((ior.at(550.0).re, ior.at(550.0).im), (1.5, 0.0));
    for (depth, expected) in slab.optical_depth().iter().zip([1.47, 0.6, 0.42]) {
        assert!((depth - expected).abs() < 1e-12);
    }
    let Base::Conductor { ior } = &base.base else { panic!("{base:?}") };
    assert_eq!((ior.at(450.0).re, ior.at(450.0).im), (0.6, 5.38));
    assert_eq!((ior.at(690.0).re, ior.at(690.0).im), (1.74, 8.21));
}

/// The film of Granier's figure lies on the dielectric below it, and only its thickness varies.
#[test]
fn a_film_joins_the_layer_that_it_coats() {
    let material = material("papers/granier-film");
    assert_eq!((material.stack.layers.len(), material.layers.len()), (2, 2));
    let film = &material.stack.layers[0].films[0];
    assert_eq!((film.thickness.min_nm, film.thickness.max_nm), (66.0, 76.0));
    assert_eq!([645.0, 525.0, 445.0].map(|nm| film.ior.at(nm).re), [1.4, 1.45, 1.6]);
    assert!(material.layers[0].film_variation.is_some() && material.layers[1].film_variation.is_none());
    // sqrt(2 / 92)
    assert!((material.stack.layers[0].surface.alpha_x - 0.147_442).abs() < 1e-5);
}

/// Of 0.7 of the light, a channel keeps exp(-absorption thickness): numbers by another calculator.
#[test]
fn a_patina_may_scatter_what_its_absorption_leaves() {
    let text = fs::read_to_string(folder().join("papers/copper-patina.toml")).unwrap();
    let tied = text.replace("diffuse_albedo = [0.25, 0.55, 0.42]", "diffuse_remainder = 0.7");
    assert_ne!(text, tied);
    let parsed = parse("tied.toml", &tied, &|path| fs::read_to_string(folder().join(path))).unwrap();
    let found = parsed.material.effects.patina.unwrap().diffuse_albedo;
    for (found, expected) in found.into_iter().zip([0.284_599, 0.545_161, 0.424_571]) {
        assert!((found - expected).abs() < 1e-6, "{found} {expected}");
    }
}
