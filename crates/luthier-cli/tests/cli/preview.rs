use image::RgbImage;

use crate::material_texts::{gold, lacquer, matte};
use crate::workshop::{Run, Workshop, lacks_adapter, root};

fn baked() -> Workshop {
    let workshop = Workshop::with(&[("lacquer.toml", &lacquer("lacquer")), ("matte.toml", &matte("matte"))]);
    workshop.run(&["bake", "lacquer.toml", "-q"]).exits(0);
    workshop
}

fn preview(workshop: &Workshop, material: &str, picture: &str, more: &[&str]) -> Option<RgbImage> {
    let size = ["preview", material, "-o", picture, "--size", "48", "--samples", "2"];
    let run: Run = workshop.run(&[&size[..], more].concat());
    if lacks_adapter(&run) {
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

#[test]
fn a_material_needs_no_bake() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold")), ("matte.toml", &matte("matte"))]);
    for material in ["gold.toml", "matte.toml"] {
        let Some(picture) = preview(&workshop, material, "ball.png", &[]) else { return };
        assert!(mean(&picture, [16, 16, 16, 16]) > 1.0, "{material} is black");
    }
    assert!(!workshop.path("out").exists());
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
    if lacks_adapter(&run) {
        return;
    }
    run.fails(3, &["no/folder.png"]);
    workshop.run(&["preview", "lacquer"]).fails(2, &["required"]);
    workshop.run(&["preview", "lacquer", "-o", "x.png", "--size", "0"]).fails(2, &["--size"]);
}
