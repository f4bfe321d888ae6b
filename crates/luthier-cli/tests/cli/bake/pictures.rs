//! Pictures of other programs: formats, channels, curves, places, sizes, and what is told of them.

use std::fs;

use image::{DynamicImage, ImageBuffer, Luma, Rgb, RgbImage};
use serde_json::json;

use crate::workshop::Workshop;

/// A matte base with maps.
fn matte(maps: &str) -> String {
    format!("schema = 1\nname = \"matte\"\n\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.9\nmaps = {{ {maps} }}\n")
}

/// A coat over gold with maps of the whole surface.
fn coated(maps: &str) -> String {
    let coat = format!("[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\nmaps = {{ {maps} }}\n");
    format!("schema = 1\nname = \"coated\"\n\n{coat}\n[[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.2\n")
}

/// Four by four: red rises to the right, green downwards, blue is 7.
fn packed() -> RgbImage {
    RgbImage::from_fn(4, 4, |x, y| Rgb([60 * x as u8, 50 * y as u8, 7]))
}

/// A JPEG under the name of a PNG is a picture: its texels ship as PNG, and its curve is stated.
#[test]
fn a_jpeg_ships_as_png_with_its_curve() {
    let workshop = Workshop::with(&[("m.toml", &matte("albedo = { image = 'wood.png', srgb = true }"))]);
    let wood = RgbImage::from_fn(16, 16, |x, _| if x < 8 { Rgb([180, 120, 60]) } else { Rgb([90, 50, 20]) });
    DynamicImage::from(wood).save_with_format(workshop.path("wood.png"), image::ImageFormat::Jpeg).unwrap();
    workshop.run(&["bake", "m.toml", "-q", "--no-fit"]).exits(0);
    let map = &workshop.json("out/manifest.json")["materials"][0]["maps"][0];
    assert_eq!((&map["srgb"], &map["width"], &map["factor"][0]), (&json!(true), &json!(16), &json!(0.9)));
    let shipped = image::open(workshop.path("out/maps/matte-albedo-0.png")).unwrap().into_rgb8();
    let near = |at: [u32; 2], rgb: [u8; 3]| shipped[(at[0], at[1])].0.iter().zip(rgb).all(|(a, b)| a.abs_diff(b) < 9);
    assert!(near([2, 5], [180, 120, 60]) && near([13, 5], [90, 50, 20]));
}

/// The albedo of a place is that of the light: code 188 of sRGB is .5029, and of a linear picture .7373 (IEC 61966-2-1).
#[test]
fn a_curve_counts_where_a_place_is_evaluated() {
    let workshop = Workshop::new();
    RgbImage::from_pixel(1, 1, Rgb([188; 3])).save(workshop.path("grey.png")).unwrap();
    for (srgb, expected) in [("true", 0.502_886), ("false", 188.0 / 255.0)] {
        workshop.write("m.toml", matte(&format!("albedo = {{ image = 'grey.png', srgb = {srgb} }}")));
        let run = workshop.run(&[
            "eval",
            "m.toml",
            "--model",
            "microfacet",
            "--uv",
            "0.5,0.5",
            "--wi",
            "0,0",
            "--wo",
            "0,0",
            "--json",
        ]);
        let value = run.exits(0).json()["values"][0]["value"][1].as_f64().unwrap() * std::f64::consts::PI / 0.9;
        assert!((value - expected).abs() < 1e-4, "{srgb}: {value}");
    }
}

#[test]
fn one_number_says_which_channel_it_takes() {
    let workshop = Workshop::with(&[("m.toml", &coated("roughness = 'packed.png'"))]);
    packed().save(workshop.path("packed.png")).unwrap();
    let warned = workshop.run(&["check", "m.toml"]).exits(0);
    warned.says(&["m.toml:8:22", "its red channel is taken", "channel = \"g\""]);
    workshop.write("m.toml", coated("roughness = { image = 'packed.png', channel = 'g' }"));
    let run = workshop.run(&["bake", "m.toml", "--no-fit"]).exits(0);
    assert!(!run.stderr.contains("channel is taken"), "{}", run.stderr);
    let shipped = image::open(workshop.path("out/maps/coated-roughness-0.png")).unwrap();
    let DynamicImage::ImageLuma8(grey) = shipped else { panic!("one channel ships as grey") };
    assert!(grey.enumerate_pixels().all(|(_, y, code)| code.0 == [50 * y as u8]));
    let source = &workshop.json("out/manifest.json")["materials"][0]["maps"][0]["source"];
    assert_eq!(source, "packed.png, channel g");
    workshop.write("m.toml", coated("roughness = { image = 'packed.png', channel = 'a' }"));
    workshop.run(&["check", "m.toml"]).exits(1).says(&["m.toml:8:22", "`a`", "no alpha"]);
}

/// Half of the scale is half of the texel; a transformation is two rows of the manifest.
#[test]
fn scale_and_place_are_honoured() {
    let transform = "transform = { offset = [0.25, 0], rotation_deg = 90, scale = [2, 3] }";
    let text = coated(&format!("roughness = {{ image = 'packed.png', channel = 'r', scale = 0.5, {transform} }}"));
    let workshop = Workshop::with(&[("m.toml", &text)]);
    packed().save(workshop.path("packed.png")).unwrap();
    workshop.run(&["bake", "m.toml", "-q", "--no-fit"]).exits(0);
    let grey = image::open(workshop.path("out/maps/coated-roughness-0.png")).unwrap().into_luma8();
    assert!(grey.enumerate_pixels().all(|(x, _, code)| code.0 == [30 * x as u8]));
    let rows = workshop.json("out/manifest.json")["materials"][0]["maps"][0]["transform"].clone();
    for (found, expected) in rows.as_array().unwrap().iter().zip([[0.0, -3.0, 0.25], [2.0, 0.0, 0.0]]) {
        for (found, expected) in found.as_array().unwrap().iter().zip(expected) {
            assert!((found.as_f64().unwrap() - expected).abs() < 1e-12, "{rows}");
        }
    }
}

#[test]
fn what_no_texel_can_be_is_refused() {
    let workshop = Workshop::new();
    packed().save(workshop.path("p.png")).unwrap();
    for (text, parts) in [
        (coated("roughness = { image = 'p.png', scale = 2 }"), ["`scale` must be at most 1", "larger instead"]),
        (coated("normal = { image = 'p.png', srgb = true }"), ["a normal is no colour", "leave `srgb` out"]),
        (
            coated("normal = { image = 'p.png', channel = 'r' }"),
            ["a normal takes more than one", "leave `channel` out"],
        ),
        (coated("roughness = { image = 'p.png', transform = { scale = [0, 1] } }"), ["a factor of 0", "write 1"]),
        (coated("roughness = { image = 'p.png', chanel = 'r' }"), ["unknown key `chanel`", "did you mean `channel`?"]),
        (coated("roughness = { channel = 'r' }"), ["`image` is missing from this picture", "add `image"]),
    ] {
        workshop.write("m.toml", text);
        workshop.run(&["check", "m.toml"]).exits(1).says(&parts);
    }
}

/// Colours that a file stores by the sRGB curve are told where the material does not say so; that a picture is linear can be said.
#[test]
fn colours_without_a_word_on_their_curve_are_told() {
    let workshop = Workshop::new();
    packed().save(workshop.path("p.jpg")).unwrap();
    let check = |maps: &str| {
        workshop.write("m.toml", matte(maps));
        workshop.run(&["check", "m.toml"]).exits(0).stderr
    };
    assert!(check("albedo = 'p.jpg'").contains("stored by the sRGB curve"));
    assert!(!check("albedo = { image = 'p.jpg', srgb = false }").contains("sRGB"));
    assert!(!check("albedo = { image = 'p.jpg', srgb = true }").contains("sRGB"));
}

#[test]
fn normals_that_are_none_are_told() {
    let workshop = Workshop::with(&[("m.toml", &coated("normal = 'n.png'"))]);
    for (rgb, told) in [
        ([128, 128, 255], ""),
        ([120, 140, 0], "100 % of its normals point into the surface"),
        ([90, 90, 90], "grey"),
        ([0, 0, 0], "grey"),
    ] {
        RgbImage::from_pixel(4, 4, Rgb(rgb)).save(workshop.path("n.png")).unwrap();
        let stderr = workshop.run(&["check", "m.toml"]).exits(0).stderr;
        assert_eq!(stderr.contains("the map `n.png`"), !told.is_empty(), "{rgb:?}: {stderr}");
        assert!(stderr.contains(told), "{rgb:?}: {stderr}");
    }
}

/// A map as asset libraries sell it: 32 MiB as it is stored, 512 as floats of four channels.
#[test]
fn a_large_map_is_taken() {
    let workshop = Workshop::with(&[("m.toml", &coated("roughness = 'large.png'"))]);
    ImageBuffer::from_fn(8192, 4096, |x, _| Luma([(x >> 5) as u8])).save(workshop.path("large.png")).unwrap();
    workshop.run(&["bake", "m.toml", "-q", "--no-fit"]).exits(0);
    let shipped = fs::read(workshop.path("out/maps/coated-roughness-0.png")).unwrap();
    assert_eq!(shipped, fs::read(workshop.path("large.png")).unwrap());
}

/// A film's map has the same spelling; its place is `extent_um`.
#[test]
fn the_map_of_a_film_is_a_picture_as_others_are() {
    let film = |map: &str| {
        let thickness = format!("thickness_nm = {{ min = 100, max = 400, extent_um = 100, map = {map} }}");
        let film = format!("[[layer]]\ntype = \"thin-film\"\nior = 1.4\n{thickness}\n");
        format!("schema = 1\nname = \"film\"\n\n{film}\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n")
    };
    let workshop = Workshop::new();
    packed().save(workshop.path("p.png")).unwrap();
    RgbImage::from_fn(4, 4, |_, y| Rgb([50 * y as u8; 3])).save(workshop.path("g.png")).unwrap();
    let table = |map: &str| {
        workshop.write("m.toml", film(map));
        workshop.run(&["bake", "m.toml", "-q", "--no-fit"]).exits(0);
        workshop.tree("out/tables")["thickness.ktx2"].clone()
    };
    let plain = table("'g.png'");
    assert_eq!(plain, table("{ image = 'g.png' }"));
    assert_eq!(plain, table("{ image = 'p.png', channel = 'g' }"));
    assert_ne!(plain, table("{ image = 'p.png', channel = 'r' }"));
    workshop.write("m.toml", film("{ image = 'p.png', transform = { offset = [0.5, 0] } }"));
    workshop.run(&["check", "m.toml"]).exits(1).says(&["map of a film", "extent_um"]);
}
