//! `preview`.

use image::RgbImage;
use luthier_workshop::material_texts::{gold, lacquer, matte};
use luthier_workshop::{Run, root};

use crate::workshop::Workshop;

fn baked() -> Workshop {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer")), ("matte.toml", &matte("matte"))]);
    workshop.run(&["bake", "lacquer.toml", "-q"]).exits(0);
    workshop
}

fn preview(workshop: &Workshop, material: &str, picture: &str, more: &[&str]) -> Option<RgbImage> {
    let size = ["preview", material, "-o", picture, "--size", "48", "--samples", "2"];
    // Most look at places of a ball.
    let chosen = more.iter().any(|option| ["--shape", "--mesh"].contains(option)) || material.ends_with(".gltf");
    let shape: &[&str] = if chosen { &[] } else { &["--shape", "sphere"] };
    let run: Run = workshop.run(&[&size[..], shape, more].concat());
    if run.lacks_adapter() {
        return None;
    }
    assert_eq!(run.exits(0).stdout, "");
    Some(image::open(workshop.path(picture)).unwrap().into_rgb8())
}

/// Mean of all channels of a rectangle, 0 to 255.
fn mean(picture: &RgbImage, [x, y, width, height]: [u32; 4]) -> f64 {
    let pixels = image::imageops::crop_imm(picture, x, y, width, height).to_image();
    let bytes = pixels.as_raw();
    bytes.iter().map(|&b| f64::from(b)).sum::<f64>() / bytes.len() as f64
}

#[test]
fn a_ball_by_name_and_by_file() {
    let workshop = baked();
    let Some(by_name) = preview(&workshop, "lacquer", "name.png", &[]) else { return };
    assert_eq!(by_name.dimensions(), (48, 48));
    let colours: std::collections::BTreeSet<[u8; 3]> = by_name.pixels().map(|p| p.0).collect();
    assert!(colours.len() > 100, "a lit ball is not flat: {} colours", colours.len());
    let [red, green, _] = by_name.get_pixel(24, 30).0;
    assert!(red > green, "the lacquer is red: {:?}", by_name.get_pixel(24, 30));

    // The same bake, in memory.
    let by_file = preview(&workshop, "lacquer.toml", "file.png", &[]).unwrap();
    assert!(by_name == by_file);
    assert_eq!(workshop.files("out"), baked().files("out"), "a preview leaves the bake alone");
}

/// A bake has no albedos that its shaders do not read; its pictures ask the shader for the environment then.
#[test]
fn a_bake_without_albedos_is_sampled() {
    let workshop = Workshop::new();
    let text = lacquer("lean");
    workshop.write("lean.toml", text.split_once("[bake]").unwrap().0);
    workshop.run(&["bake", "lean.toml", "--no-fit", "-q"]).exits(0);
    assert!(!workshop.path("out/tables/fgd.ktx2").exists());
    let Some(by_name) = preview(&workshop, "lean", "name.png", &[]) else { return };
    let sampled = preview(&workshop, "lean", "sampled.png", &["--environment-samples", "64"]).unwrap();
    assert!(by_name == sampled);
    // By file, tables of albedos are baked in memory: the same ball but for what the two ways leave out.
    let by_file = preview(&workshop, "lean.toml", "file.png", &["--no-fit"]).unwrap();
    let middle = [16, 16, 16, 16];
    let [sampled, split] = [&sampled, &by_file].map(|picture| mean(picture, middle));
    assert!((sampled / split - 1.0).abs() < 0.1, "{sampled} {split}");

    // Where not even reflectances are there, blurred maps are refused.
    workshop.run(&["bake", "lean.toml", "--model", "phong", "-q"]).exits(0);
    let blurred = ["preview", "lean", "-o", "ball.png", "--size", "8", "--environment-samples", "0"];
    let run = workshop.run(&blurred);
    assert!(run.code != Some(0) && run.stderr.contains("fresnel"), "{}", run.stderr);
}

#[test]
fn a_material_needs_no_bake() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold")), ("matte.toml", &matte("matte"))]);
    for material in ["gold.toml", "matte.toml"] {
        let Some(picture) = preview(&workshop, material, "ball.png", &[]) else { return };
        assert!(mean(&picture, [16, 16, 16, 16]) > 1.0, "{material} is black");
    }
    assert!(!workshop.path("out").exists());
}

/// A film on a metal, which the simulation on the device does not take.
const FILMED: &str = "schema = 1
name = \"filmed\"
[[layer]]
type = \"thin-film\"
ior = 1.4
thickness_nm = 300
[[layer]]
type = \"conductor\"
alpha = 0.2
ior = { n = 0.2, k = 3.4 }
";

/// Oracle: a matte ball has no layers to simulate, and is what its model shows.
#[test]
fn a_simulated_ball() {
    let workshop = baked();
    let sampled = ["--environment-samples", "64"];
    let Some(model) = preview(&workshop, "matte.toml", "model.png", &sampled) else { return };
    let simulated = preview(&workshop, "matte.toml", "simulated.png", &["--simulated", "64"]).unwrap();
    let middle = [12, 12, 24, 24];
    let share = mean(&simulated, middle) / mean(&model, middle);
    assert!((share - 1.0).abs() < 0.01 && simulated != model, "{share}");

    let by_file = preview(&workshop, "lacquer.toml", "file.png", &["--simulated", "16"]).unwrap();
    let by_name = preview(&workshop, "lacquer", "name.png", &["--simulated", "16"]).unwrap();
    assert!(by_file == by_name, "models play no part");
    let [red, green, _] = by_file.get_pixel(24, 30).0;
    assert!(red > green, "the lacquer is red: {:?}", by_file.get_pixel(24, 30));

    workshop.write("filmed.toml", FILMED);
    let refused = ["preview", "filmed.toml", "-o", "no.png", "--simulated", "4"];
    workshop.run(&refused).exits(1).says(&["filmed.toml:4", "does not take films", "leave out `--simulated`"]);
    let blinn = FILMED.replace("type = \"thin-film\"\nior = 1.4\nthickness_nm = 300\n[[layer]]\n", "");
    workshop.write("blinn.toml", format!("{blinn}distribution = \"blinn\"\n"));
    workshop.write("bumps.toml", format!("{blinn}maps = {{ bumps = \"n.png\" }}\n"));
    image::RgbImage::from_pixel(4, 4, image::Rgb([128, 128, 255])).save(workshop.path("n.png")).unwrap();
    for (file, part) in [("blinn.toml", "distribution"), ("bumps.toml", "bumps")] {
        let run = workshop.run(&["preview", file, "-o", "no.png", "--simulated", "4"]).exits(1);
        run.says(&[&format!("{file}:"), "the simulation on the device does not take", part]);
    }
    let surface = root().join("materials/surfaces/sunstone.toml");
    let surface = ["preview", surface.to_str().unwrap(), "-o", "no.png", "--simulated", "4"];
    workshop.run(&surface).fails(1, &["sunstone.toml is a surface"]);
    for bad in [&["--simulated", "0"][..], &["--simulated", "4", "--model", "elek"]] {
        workshop.run(&[&["preview", "lacquer", "-o", "no.png"], bad].concat()).fails(2, &["--simulated"]);
    }
    assert!(!workshop.path("no.png").exists());
}

#[test]
fn exposure_is_in_stops() {
    let workshop = baked();
    let Some(normal) = preview(&workshop, "matte.toml", "ball.png", &[]) else { return };
    let whole = [0, 0, 48, 48];
    let darker = preview(&workshop, "matte.toml", "ball.png", &["--exposure", "-2"]).unwrap();
    let black = preview(&workshop, "matte.toml", "ball.png", &["--exposure", "-20"]).unwrap();
    assert!(mean(&normal, whole) > 1.3 * mean(&darker, whole));
    assert!(mean(&black, whole) < 1.0);
    for bad in ["nan", "inf", "-inf", "21", "bright"] {
        workshop.run(&["preview", "lacquer", "-o", "no.png", "--exposure", bad]).fails(2, &["--exposure", bad]);
    }
}

#[test]
fn names_that_no_material_has() {
    let workshop = Workshop::with(&[("a.toml", &matte("ash")), ("b.toml", &matte("birch"))]);
    workshop.run(&["bake", "a.toml", "b.toml", "-q"]).exits(0);
    workshop.run(&["preview", "cherry", "-o", "no.png"]).fails(1, &["`cherry`", "ash, birch", ".toml"]);
    workshop.run(&["preview", "cherry.toml", "-o", "no.png"]).fails(3, &["cherry.toml"]);
    assert!(!workshop.path("no.png").exists());
}

#[test]
fn a_broken_material() {
    let workshop = Workshop::new();
    let case = root().join("tests/broken/negative-k.toml");
    workshop.write("negative-k.toml", std::fs::read(case).unwrap());
    workshop.run(&["preview", "negative-k.toml", "-o", "no.png"]).exits(1).says(&["negative-k.toml:"]);
    assert!(!workshop.path("no.png").exists());
}

#[test]
fn pictures_that_cannot_be_written() {
    let workshop = baked();
    let run = workshop.run(&["preview", "lacquer", "-o", "no/folder.png", "--size", "8"]);
    if run.lacks_adapter() {
        return;
    }
    run.fails(3, &["no/folder.png"]);
    workshop.run(&["preview", "lacquer", "-o", "ball.gif"]).fails(1, &["ball.gif", ".png or .exr"]);
    workshop.run(&["preview", "lacquer"]).fails(2, &["required"]);
    workshop.run(&["preview", "lacquer", "-o", "x.png", "--size", "0"]).fails(2, &["--size"]);
}

#[test]
fn every_shape() {
    let workshop = baked();
    let Some(sphere) = preview(&workshop, "matte.toml", "sphere.png", &[]) else { return };
    for shape in ["torus", "plane"] {
        let picture = preview(&workshop, "matte.toml", "shape.png", &["--shape", shape]).unwrap();
        assert!(picture != sphere && mean(&picture, [0, 0, 48, 48]) > 1.0, "{shape}");
    }
}

/// 25 materials that no file has: metals at the top are copper, dielectrics at the bottom have a copper-coloured base, and
/// highlights spread to the right.
#[test]
fn the_grid() {
    let workshop = Workshop::new();
    let run = workshop.run(&["preview", "--shape", "grid", "-o", "grid.png", "--size", "110", "--samples", "2"]);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    let picture = image::open(workshop.path("grid.png")).unwrap().into_rgb8();
    for cell in 0..25 {
        let [x, y] = [cell % 5, cell / 5].map(|i: u32| 13 + i * 21 - 6);
        let [r, _, b] = [0, 1, 2].map(|c| {
            let pixels = image::imageops::crop_imm(&picture, x, y, 12, 12).to_image();
            pixels.pixels().map(|p| f64::from(p.0[c])).sum::<f64>()
        });
        assert!(r > 1.05 * b && b > 0.0, "{cell}: {r} {b}");
    }
    workshop.run(&["preview", "a.toml", "--shape", "grid", "-o", "no.png"]).fails(1, &["grid"]);
    workshop.run(&["preview", "-o", "no.png"]).fails(1, &["--shape grid"]);
}

/// Light on the left of a map lights the left of the ball; EXR pictures are linear and not clipped.
#[test]
fn an_environment_by_file() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    let (width, height) = (64, 32);
    let left = |x: u32| if x < width / 2 { 8.0 } else { 0.5 };
    let map = image::Rgb32FImage::from_fn(width, height, |x, _| image::Rgb([left(x); 3]));
    let mut file = Vec::new();
    image::codecs::hdr::HdrEncoder::new(&mut file).encode(&map.pixels().copied().collect::<Vec<_>>(), 64, 32).unwrap();
    workshop.write("studio.hdr", file);
    let dim = ["--environment", "studio.hdr", "--exposure", "-4"];
    let Some(picture) = preview(&workshop, "matte.toml", "ball.png", &dim) else { return };
    assert!(mean(&picture, [12, 16, 8, 16]) > 1.2 * mean(&picture, [28, 16, 8, 16]));

    let more = ["--environment", "studio.hdr", "--background", "--tone", "none"];
    let args = ["preview", "matte.toml", "-o", "ball.exr", "--size", "48", "--samples", "1", "--shape", "sphere"];
    workshop.run(&[&args[..], &more[..]].concat()).exits(0);
    let (exr, _) = luthier_texture::exr::decode(&std::fs::read(workshop.path("ball.exr")).unwrap()).unwrap();
    assert!((exr.texel(0, 0)[0] / 8.0 - 1.0).abs() < 0.02 && (exr.texel(47, 0)[0] / 0.5 - 1.0).abs() < 0.02);

    workshop.write("broken.hdr", "#?RADIANCE\n");
    let bad = |file: &str, code, parts: &[&str]| {
        workshop.run(&["preview", "matte.toml", "-o", "no.png", "--environment", file]).fails(code, parts);
    };
    bad("broken.hdr", 1, &["broken.hdr"]);
    bad("matte.toml", 1, &["matte.toml", "neither OpenEXR nor Radiance"]);
    bad("missing.hdr", 3, &["missing.hdr"]);
}

/// The model is what is shown by default: its floor is in the picture, and the stand's shadow on it to the right of the ball.
#[test]
fn the_model_stands_on_its_floor() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    let run = workshop.run(&["preview", "matte.toml", "-o", "default.png", "--size", "48", "--samples", "2"]);
    if run.lacks_adapter() {
        return;
    }
    run.exits(0);
    let named = preview(&workshop, "matte.toml", "model.png", &["--shape", "model"]).unwrap();
    assert!(image::open(workshop.path("default.png")).unwrap().into_rgb8() == named);
    let [left, right] = [mean(&named, [1, 31, 6, 4]), mean(&named, [41, 31, 4, 4])];
    assert!(left > 1.3 * right, "{left} {right}");
    // The same triangles by their file; a sky has no default light, and so the floor no sharp shadow.
    workshop.write("model.glb", luthier_mesh_file());
    assert!(preview(&workshop, "matte.toml", "file.png", &["--mesh", "model.glb"]).unwrap() == named);
    let room = preview(&workshop, "matte.toml", "room.png", &["--shape", "model", "--sky", "evening-room"]).unwrap();
    let [red, _, blue] = room.get_pixel(20, 20).0;
    assert!(red > blue, "lamps are warm: {:?}", room.get_pixel(20, 20));
}

fn luthier_mesh_file() -> Vec<u8> {
    std::fs::read(root().join("crates/luthier-mesh/assets/model.glb")).unwrap()
}

/// Files that are no meshes, and meshes that lack what a material needs.
#[test]
fn meshes_are_refused_with_a_reason() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte")), ("brushed.toml", BRUSHED)]);
    let corpus = root().join("crates/luthier-fuzz/corpus/gltf");
    workshop.write("square.gltf", std::fs::read(corpus.join("square.gltf")).unwrap());
    workshop.write("beside.gltf", std::fs::read(corpus.join("beside.gltf")).unwrap());
    let bad = |material: &str, mesh: &str, code, parts: &[&str]| {
        let run = workshop.run(&["preview", material, "-o", "no.png", "--size", "8", "--mesh", mesh]);
        if !run.lacks_adapter() {
            run.fails(code, parts);
        }
    };
    bad("matte.toml", "missing.glb", 3, &["missing.glb"]);
    bad("matte.toml", "matte.toml", 1, &["matte.toml", "no glTF"]);
    bad("matte.toml", "beside.gltf", 1, &["beside.gltf", "beside.bin"]);
    bad("brushed.toml", "square.gltf", 1, &["no texture coordinates", "`brushed`", "anisotropic"]);
    workshop
        .run(&["preview", "matte.toml", "-o", "no.png", "--mesh", "a.glb", "--shape", "torus"])
        .fails(2, &["--mesh"]);
    workshop.run(&["preview", "matte.toml", "-o", "no.png", "--sky", "moon"]).fails(2, &["moon"]).says(&["clear-day"]);
}

/// A mesh with a byte order mark and an animation, and one with sparse accessors and no scene, make a picture; what is left out is told.
#[test]
fn meshes_of_other_programs_are_shown() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    let corpus = root().join("crates/luthier-fuzz/corpus/gltf");
    let text = std::fs::read_to_string(corpus.join("square.gltf")).unwrap();
    let odd = text.replacen('{', r#"{"animations":[{"channels":[{"sampler":0,"target":{"path":"scale"}}]}],"#, 1);
    workshop.write("odd.gltf", [b"\xef\xbb\xbf", odd.as_bytes()].concat());
    workshop.write("sparse.gltf", std::fs::read(corpus.join("sparse.gltf")).unwrap());
    for (mesh, told) in [("odd.gltf", "animations"), ("sparse.gltf", "no scene")] {
        let run =
            workshop.run(&["preview", "matte.toml", "-o", "mesh.png", "--size", "8", "--samples", "1", "--mesh", mesh]);
        if run.lacks_adapter() {
            return;
        }
        run.exits(0).says(&[mesh, told]);
    }
}

const BRUSHED: &str = "schema = 1\nname = \"brushed\"\n[[layer]]\ntype = \"conductor\"\nior = \"ag\"\nalpha_x = 0.1\nalpha_y = 0.3\n\
    [bake]\nmodel = \"elek\"\n";

/// Oracle: irradiance is linear in the colour of the light, and a light from the eye of a camera lights what that sees.
#[test]
fn cameras_and_colours_of_lights() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    let dark: RgbImage = RgbImage::new(64, 32);
    image::codecs::hdr::HdrEncoder::new(std::fs::File::create(workshop.path("dark.hdr")).unwrap())
        .encode(&vec![image::Rgb([0.0_f32; 3]); dark.pixels().count()], 64, 32)
        .unwrap();
    let seen = |more: &[&str]| -> Option<Vec<f64>> {
        let args = ["preview", "matte.toml", "-o", "ball.exr", "--size", "24", "--samples", "1", "--shape", "sphere"];
        let run = workshop.run(&[&args[..], &["--environment", "dark.hdr"], more].concat());
        if run.lacks_adapter() {
            return None;
        }
        run.exits(0);
        let (image, _) = luthier_texture::exr::decode(&std::fs::read(workshop.path("ball.exr")).unwrap()).unwrap();
        let inner = (8..16).flat_map(|y| (8..16).map(move |x| (x, y)));
        Some((0..3).map(|c| inner.clone().map(|(x, y)| f64::from(image.texel(x, y)[c])).sum()).collect())
    };
    let Some(plain) = seen(&["--light", "0,0,1"]) else { return };
    let colored = seen(&["--light", "0,0,1", "--light-color", "0.875,3.4,0"]).unwrap();
    for (found, expected) in colored.iter().zip([0.5 * plain[0], 2.0 * plain[1], 0.0]) {
        assert!((found - expected).abs() <= 1e-3 * expected, "{colored:?} {plain:?}");
    }
    let from_behind = seen(&["--light", "0,0,-1", "--camera", "0,0,-7"]).unwrap();
    let unlit = seen(&["--light", "0,0,1", "--camera", "0,0,-7"]).unwrap();
    assert!(from_behind.iter().zip(&plain).all(|(a, b)| (a / b - 1.0).abs() < 1e-3), "{from_behind:?} {plain:?}");
    assert!(unlit.iter().all(|v| *v == 0.0), "{unlit:?}");
    for (option, bad) in
        [("--camera", "0,3,0"), ("--camera", "1,2"), ("--light-color", "1,-1,1"), ("--light-color", "red")]
    {
        workshop.run(&["preview", "matte.toml", "-o", "no.png", option, bad]).fails(2, &[option, bad]);
    }
}

/// A library of a driver misses a display, which pictures do not need.
#[test]
fn a_good_run_is_silent_without_a_display() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    let run = workshop.run(&["preview", "matte.toml", "-o", "ball.png", "--size", "8"]);
    if run.lacks_adapter() {
        return;
    }
    assert_eq!(run.exits(0).stderr, "");
}

#[test]
fn lights_and_tone_curves() {
    let workshop = Workshop::with(&[("matte.toml", &matte("matte"))]);
    let from_right = ["--light", "1,0,0.2"];
    let Some(right) = preview(&workshop, "matte.toml", "right.png", &from_right) else { return };
    let left = preview(&workshop, "matte.toml", "left.png", &["--point-light", "-5,0,1"]).unwrap();
    let halves = |p: &RgbImage| [mean(p, [6, 16, 12, 16]), mean(p, [30, 16, 12, 16])];
    assert!(halves(&right)[1] > halves(&right)[0] && halves(&left)[0] > halves(&left)[1]);
    let reinhard = preview(&workshop, "matte.toml", "tone.png", &[&from_right[..], &["--tone", "reinhard"]].concat());
    assert!(mean(&reinhard.unwrap(), [0, 0, 48, 48]) < mean(&right, [0, 0, 48, 48]));
    for bad in ["1,2", "0,0,0", "a,b,c", "inf,0,0"] {
        workshop.run(&["preview", "matte.toml", "-o", "no.png", "--light", bad]).fails(2, &["--light", bad]);
    }
}

/// A glTF file shows each part in its own material; parts without one in that of glTF.
#[test]
fn a_scene_in_its_own_materials() {
    let page = std::fs::read_to_string(root().join("docs/tutorial.md")).unwrap();
    let tiles = page
        .split("```json\n")
        .find_map(|block| block.split_once("```").map(|(text, _)| text).filter(|text| text.contains("Gilded")));
    let workshop = Workshop::with(&[("tiles.gltf", tiles.unwrap())]);
    let Some(picture) = preview(&workshop, "tiles.gltf", "tiles.png", &["--no-fit"]) else { return };
    let at = |x: u32| picture.get_pixel(x, 24).0.map(i32::from);
    let ([_, _, blue], [red, _, dim]) = (at(14), at(34));
    assert!(blue > at(14)[0] && red > dim + 20, "{:?} {:?}", at(14), at(34));
    workshop.write("bare.gltf", tiles.unwrap().replace(", \"material\": 1}", "}"));
    let bare = preview(&workshop, "bare.gltf", "bare.png", &["--no-fit"]).unwrap();
    let [red, green, blue] = bare.get_pixel(34, 24).0.map(i32::from);
    assert!((red - green).abs() < 8 && (green - blue).abs() < 8, "{red} {green} {blue}");
    workshop
        .run(&["preview", "tiles.gltf", "-o", "x.png", "--shape", "sphere"])
        .fails(2, &["its own shape and materials"]);
}
