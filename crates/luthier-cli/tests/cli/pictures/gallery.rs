//! `gallery`.

use luthier_lut::Image;
use luthier_workshop::material_texts::{gold, lacquer, matte};
use serde_json::json;

use crate::report::scene::scene;
use crate::workshop::Workshop;

#[test]
fn a_sheet_of_a_folder() {
    let workshop = Workshop::with(&[
        ("shelf/a.toml", &matte("ash")),
        ("shelf/b.toml", &gold("gold")),
        ("shelf/c.toml", &lacquer("lacquer")),
    ]);
    let run =
        workshop.run(&["gallery", "shelf", "-o", "sheet.png", "--size", "32", "--samples", "1", "--columns", "3"]);
    if run.lacks_adapter() {
        return;
    }
    assert_eq!(run.exits(0).stdout, "");
    let sheet = image::open(workshop.path("sheet.png")).unwrap().into_rgb8();
    // Three cells of 32 and their gaps of 8; 16 for the names.
    assert_eq!(sheet.dimensions(), (3 * 40 + 8, 32 + 16 + 8 + 8));
    let middles = [24, 64, 104].map(|x| sheet.get_pixel(x, 24).0);
    assert!(middles[0] != middles[1] && middles[1] != middles[2], "{middles:?}");
    let paper = sheet.get_pixel(0, 0).0;
    let inked = |x: u32| (40..56).any(|y| (x..x + 32).any(|x| sheet.get_pixel(x, y).0 != paper));
    assert!([8, 48, 88].into_iter().all(inked));
    assert_eq!(workshop.files("."), ["sheet.png", "shelf/a.toml", "shelf/b.toml", "shelf/c.toml"]);
}

#[test]
fn what_a_gallery_cannot_show() {
    let workshop = Workshop::with(&[("a.toml", &matte("ash")), ("broken.toml", "schema = 1\n")]);
    workshop.run(&["gallery", "a.toml", "-o", "no.png", "--shape", "grid"]).fails(1, &["grid"]);
    workshop.run(&["gallery", "a.toml", "-o", "no.jpeg"]).fails(1, &["no.jpeg"]);
    workshop.run(&["gallery", "a.toml", "broken.toml", "-o", "no.png"]).exits(1).says(&["broken.toml"]);
    workshop.run(&["gallery", "missing.toml", "-o", "no.png"]).fails(3, &["missing.toml"]);
    assert!(!workshop.path("no.png").exists());
}

/// Rows of a grid differ in the second key, its columns in the first.
#[test]
fn a_grid_of_one_file() {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer"))]);
    let before = std::fs::read_to_string(workshop.path("lacquer.toml")).unwrap();
    let run = workshop.run(&[
        "gallery",
        "lacquer.toml",
        "-o",
        "grid.png",
        "--size",
        "32",
        "--samples",
        "1",
        "--no-fit",
        "--steps",
        "2",
        "--grid",
        "ior=1.1..2.5",
        "layer.1.albedo.0=0.0..0.9",
    ]);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    let grid = image::open(workshop.path("grid.png")).unwrap().into_rgb8();
    assert_eq!(grid.dimensions(), (2 * 40 + 8, 2 * (32 + 16 + 8) + 8));
    let red = |column: u32, row: u32| grid.get_pixel(24 + 40 * column, 24 + 56 * row)[0];
    for column in 0..2 {
        assert!(red(column, 1) > red(column, 0) + 40, "{} {}", red(column, 0), red(column, 1));
    }
    let row = |row: u32| [0, 1].map(|column| *grid.get_pixel(24 + 40 * column, 24 + 56 * row));
    assert!(row(0)[0] != row(0)[1] && row(1)[0] != row(1)[1]);
    assert_eq!(std::fs::read_to_string(workshop.path("lacquer.toml")).unwrap(), before);
}

#[test]
fn grids_that_cannot_be() {
    let workshop = Workshop::with(&[("a.toml", &lacquer("a")), ("b.toml", &lacquer("b"))]);
    let grid = |file: &str, ranges: [&str; 2]| {
        workshop.run(&["gallery", file, "-o", "no.png", "--grid", ranges[0], ranges[1]])
    };
    grid(".", ["ior=1.1..2", "ior=1.1..2"]).fails(1, &["2", "name one"]);
    grid("a.toml", ["ior=1.1..2", "layer.7.ior=1..2"]).fails(1, &["a.toml", "layer.7.ior"]);
    grid("a.toml", ["ior=1.1..2", "shine=0..1"]).exits(1).says(&["a.toml", "shine"]);
    grid("a.toml", ["ior=1.1..2", "ior"]).exits(2).says(&["KEY=FROM..TO"]);
    assert!(!workshop.path("no.png").exists());
}

/// Warnings are of what the page leaves out. Oracle: the textures that are in the page.
#[test]
fn a_page_warns_of_the_maps_that_it_does_not_show() {
    let material = |name: &str, bumps: &str| {
        format!(
            "schema = 1\nname = \"{name}\"\n[bake]\nmodel = \"elek\"\nfgd = {{ size = [8, 8] }}\n\
             [[layer]]\ntype = \"dielectric\"\nior = 1.5\nroughness = 0.4\n{bumps}\
             [[layer]]\ntype = \"diffuse\"\nalbedo = [0.8, 0.6, 0.4]\nmaps = {{ albedo = \"map.png\" }}\n"
        )
    };
    let workshop = Workshop::with(&[
        ("plain.toml", &material("plain", "")),
        (
            "bumpy.toml",
            &material("bumpy", "maps = { bumps = \"map.png\", alpha = { image = \"map.png\", channel = \"r\" } }\n"),
        ),
    ]);
    image::RgbImage::from_pixel(2, 2, image::Rgb([128, 128, 255])).save(workshop.path("map.png")).unwrap();
    let page = |file: &str| {
        let run = workshop.run(&["gallery", file, "--html", "page.html", "--compare", "elek"]).exits(0);
        let text = workshop.text("page.html");
        let slots = text.split("\"maps\":{\"slots\":").nth(1).and_then(|rest| rest.split(',').next());
        assert_eq!(slots, Some("[5]"), "the albedo is the texture number 5 of a page");
        run.stderr
    };
    assert_eq!(page("plain.toml"), "");
    let bumps = "warning: bumpy: the page does not show the maps `bumps` of layer 0, `alpha` of layer 0\n";
    assert_eq!(page("bumpy.toml"), bumps);
}

/// Oracles by hand, under surroundings of radiance 1: a white mirror returns all of it in all ways, by paths and by directions, and the formula of lacquer
/// returns the share of its smooth coat and the rest of its colour. Nothing is simulated on an adapter.
#[test]
fn a_scene_is_shown_in_four_ways() {
    let mirror = json!({ "roughnessFactor": 0 });
    let workshop = Workshop::with(&[("mirror.gltf", &scene(&mirror, &[0])), ("lacquer.gltf", &scene(&mirror, &[1]))]);
    let white = Image { data: vec![1.0; 3 * 16 * 8], ..Image::zeros(16, 8, 3) };
    workshop.write("white.exr", luthier_texture::exr::encode(&white, &luthier_texture::exr::RGB, &Vec::new()).unwrap());
    let middles = |file: &str| {
        let args = ["gallery", file, "-o", "ways.exr", "--size", "16", "--samples", "1", "--environment", "white.exr"];
        let said = workshop.run(&[&args[..], &["--simulated", "4096"]].concat()).exits(0).stdout;
        assert!(said.contains("about grey") && said.contains("4096 paths"), "{said}");
        let (image, _) = luthier_texture::exr::decode(&std::fs::read(workshop.path("ways.exr")).unwrap()).unwrap();
        assert_eq!((image.width, image.height), (4 * 24 + 8, 16 + 16 + 16));
        [0, 1, 2, 3].map(|way: u32| [0, 1, 2].map(|c: usize| image.texel(24 * way + 16, 16)[c]))
    };
    for value in middles("mirror.gltf")[..3].iter().flatten() {
        assert!((value - 1.0).abs() < 0.02, "{value}");
    }
    // The eye is 0.3 above the level of the square.
    let share = 0.04 + 0.96 * libm::powf(1.0 - libm::cosf(0.3), 5.0);
    let [formula, model, simulated, difference] = middles("lacquer.gltf");
    for (found, color) in formula.iter().zip([0.5, 0.0, 1.0]) {
        assert!((found - (share + (1.0 - share) * color)).abs() < 0.02, "{formula:?}");
    }
    assert!(
        model.iter().zip(&simulated).all(|(model, simulated)| (model - simulated).abs() < 0.03),
        "{model:?} {simulated:?}"
    );
    assert!(difference.iter().all(|value| (0.0..=1.0).contains(value)), "{difference:?}");
}

#[test]
fn scenes_stand_alone() {
    let workshop = Workshop::with(&[("m.toml", &matte("m")), ("car.gltf", &scene(&json!({}), &[0]))]);
    let bad = |args: &[&str], code, parts: &[&str]| {
        workshop.run(&[&["gallery"], args].concat()).fails(code, parts);
    };
    bad(&["car.gltf", "--html", "x.html"], 2, &["car.gltf", "import"]);
    bad(&["car.gltf", "m.toml", "-o", "x.png"], 2, &["car.gltf", "import"]);
    bad(&["car.gltf", "-o", "x.png", "--light", "1,1,1"], 2, &["--light"]);
    bad(&["car.gltf", "-o", "x.gif"], 1, &["x.gif", ".png"]);
    bad(&["none.glb", "-o", "x.png"], 3, &["none.glb"]);
    bad(&["m.toml", "-o", "x.png", "--simulated", "8"], 2, &["--simulated", "--html"]);
    workshop.write("no.glb", "schema = 1");
    bad(&["no.glb", "-o", "x.png"], 1, &["no.glb", "no glTF"]);
    assert!(!workshop.path("x.png").exists());
}
