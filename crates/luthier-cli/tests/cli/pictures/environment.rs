//! `environment`.

use serde_json::Value;

use crate::workshop::Workshop;

/// A Radiance HDR file of 64 x 32 texels, without run lengths: this mantissa and exponent everywhere.
fn hdr(texel: [u8; 4]) -> Vec<u8> {
    let mut file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 32 +X 64\n".to_vec();
    for _ in 0..64 * 32 {
        file.extend(texel);
    }
    file
}

fn manifest(workshop: &Workshop, folder: &str) -> Value {
    serde_json::from_slice(&std::fs::read(workshop.path(&format!("{folder}/environment.json"))).unwrap()).unwrap()
}

#[test]
fn levels_of_a_picture() {
    let workshop = Workshop::new();
    workshop.write("even.hdr", hdr([128, 64, 32, 129]));
    workshop.run(&["environment", "even.hdr", "--out", "baked"]).exits(0).says(&[]);
    let names = ["environment-cube", "environment-equirect", "irradiance-cube", "irradiance-equirect"];
    let mut files: Vec<String> = names.iter().map(|name| format!("{name}.ktx2")).collect();
    files.push("environment.json".into());
    files.sort();
    let mut found: Vec<String> = workshop.files("baked");
    found.sort();
    assert_eq!(found, files);
    let manifest = manifest(&workshop, "baked");
    assert_eq!((&manifest["source"]["width"], &manifest["clamped"]), (&Value::from(64), &Value::from(0)));
    let textures = manifest["textures"].as_array().unwrap();
    assert_eq!(textures.len(), 4);
    let levels = textures[0]["levels"].as_array().unwrap();
    assert_eq!(levels.len(), 5);
    assert_eq!((levels[0]["width"].as_f64(), levels[1]["width"].as_f64()), (Some(0.0), Some(0.125)));
    for level in levels {
        let mean = level["mean"][0].as_f64().unwrap();
        // Some readers add half a step of the mantissa.
        assert!(
            (mean / levels[0]["mean"][0].as_f64().unwrap() - 1.0).abs() < 1e-6 && (mean - 1.0).abs() < 0.02,
            "{mean}"
        );
    }
    let cube = std::fs::read(workshop.path("baked/environment-cube.ktx2")).unwrap();
    let number = |at: usize| u32::from_le_bytes(cube[at..at + 4].try_into().unwrap());
    // Width, height, faces and levels of the header.
    assert_eq!([20, 24, 36, 40].map(number), [64, 64, 6, 5]);

    // The same bytes once more, and without zstd others.
    workshop.run(&["environment", "even.hdr", "--out", "again", "--layout", "cube"]).exits(0);
    assert_eq!(std::fs::read(workshop.path("again/environment-cube.ktx2")).unwrap(), cube);
    assert!(!workshop.path("again/environment-equirect.ktx2").exists());
    let run = workshop
        .run(&["environment", "even.hdr", "--out", "plain", "--layout", "cube", "--no-zstd", "--json"])
        .exits(0);
    assert_eq!(serde_json::from_str::<Value>(&run.stdout).unwrap()["textures"][0]["format"], "rgba16float");
    let plain = std::fs::read(workshop.path("plain/environment-cube.ktx2")).unwrap();
    assert!(plain.len() > 6 * 8 * (32 * 32 + 16 * 16 + 8 * 8 + 4 * 4));
}

#[test]
fn bright_texels_are_counted() {
    let workshop = Workshop::new();
    // 2^18.
    workshop.write("bright.hdr", hdr([128, 128, 128, 147]));
    let run = workshop.run(&["environment", "bright.hdr", "--out", "baked", "--layout", "equirect"]).exits(0);
    assert!(run.stderr.contains("brighter than half floats"), "{}", run.stderr);
    assert!(manifest(&workshop, "baked")["clamped"].as_u64().unwrap() > 0);
}

#[test]
fn what_is_no_environment() {
    let workshop = Workshop::new();
    workshop.write("square.hdr", {
        let mut file = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 2 +X 2\n".to_vec();
        file.extend([128; 16]);
        file
    });
    workshop.write("text.hdr", "no picture");
    workshop.write("even.hdr", hdr([128, 128, 128, 129]));
    workshop.run(&["environment", "square.hdr", "--out", "no"]).fails(1, &["square.hdr", "twice as wide as high"]);
    workshop.run(&["environment", "text.hdr", "--out", "no"]).fails(1, &["text.hdr", "Radiance HDR"]);
    workshop.run(&["environment", "missing.hdr", "--out", "no"]).fails(3, &["missing.hdr"]);
    workshop.run(&["environment", "even.hdr", "--out", "no", "--size", "48"]).fails(1, &["48", "power of two"]);
    workshop.run(&["environment", "--sky", "noon", "--out", "no"]).fails(2, &["noon", "--sky"]);
    workshop.run(&["environment", "--out", "no"]).exits(2).says(&["FILE"]);
    assert!(!workshop.path("no").exists());
}

/// What a file asks for is honoured and told; the environment is that of the values that the file stands for.
#[test]
fn what_was_converted_is_told() {
    let workshop = Workshop::new();
    let mean = |file: &str, told: &[&str]| {
        let run = workshop.run(&["environment", file, "--out", "out", "--layout", "equirect"]).exits(0);
        assert_eq!(run.stderr.lines().count(), told.len(), "{}", run.stderr);
        assert!(told.iter().all(|part| run.stderr.contains(part) && run.stderr.contains(file)), "{}", run.stderr);
        manifest(&workshop, "out")["textures"][0]["levels"][0]["mean"].clone()
    };
    let lines = |more: &str, texel: [u8; 4]| {
        let file = hdr(texel);
        let text = b"#?RADIANCE\n";
        [&b"#?RGBE\n"[..], more.as_bytes(), &file[text.len()..]].concat()
    };
    workshop.write("even.hdr", hdr([128, 64, 32, 129]));
    workshop.write("exposed.hdr", lines("EXPOSURE=4\n", [128, 64, 32, 131]));
    workshop.write("wide.hdr", lines("PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290\n", [96, 96, 96, 129]));
    assert_eq!(mean("even.hdr", &[]), mean("exposed.hdr", &[]));
    let grey = mean("wide.hdr", &["Rec.709"]);
    assert!(grey.as_array().unwrap().iter().all(|v| (v.as_f64().unwrap() - 0.75).abs() < 1e-3), "{grey}");
}

#[test]
fn faults_of_pictures_have_a_place() {
    let workshop = Workshop::new();
    let refused = |name: &str, bytes: Vec<u8>, parts: &[&str]| {
        workshop.write(name, bytes);
        workshop.run(&["environment", name, "--out", "no"]).fails(1, parts);
    };
    let image = |values: Vec<f32>| luthier_lut::Image { width: 4, height: 2, channels: 3, data: values };
    let mut values = vec![1.0; 24];
    values[3 * 6 + 1] = f32::INFINITY;
    let exr = luthier_texture::exr::encode(&image(values), &luthier_texture::exr::RGB, &Vec::new()).unwrap();
    refused("inf.exr", exr, &["inf.exr", "column 2 of row 1", "clamp"]);
    let depth = luthier_texture::exr::encode(&image(vec![1.0; 24]), &["N.X", "N.Y", "N.Z"], &Vec::new()).unwrap();
    refused("normals.exr", depth, &["normals.exr", "`N.X`", "R, G and B"]);
    let file = hdr([128; 4]);
    refused("cut.hdr", file[..file.len() - 99].to_vec(), &["cut.hdr", "scanline 32 of 32"]);
    assert!(!workshop.path("no").exists());
    // Two texels are a sky.
    workshop.write("two.hdr", b"#?RADIANCE\n\n-Y 1 +X 2\n\x80\x80\x80\x81\x40\x40\x40\x81");
    workshop.run(&["environment", "two.hdr", "--out", "two", "--layout", "equirect"]).exits(0);
}
