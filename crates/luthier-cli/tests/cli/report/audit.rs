//! `luthier audit` on tables with a mistake each, in every container, and on what `bake` makes.

use luthier_lut::{Image, TexelFormat};
use luthier_optics::split_sum::{Masking, split_sums};
use luthier_optics::stack::Distribution;
use luthier_texture::{Metadata, Texture, exr, ktx2, png};
use luthier_workshop::material_texts::gold;

use crate::workshop::Workshop;

const SIZE: u32 = 32;

/// Scale and bias over coordinates of texel centres that `place` makes a cosine and an alpha of.
fn table(masking: Masking, channels: u32, place: impl Fn(f64, f64) -> (f64, f64)) -> Image {
    let which = Masking::ALL.iter().position(|m| *m == masking).unwrap();
    let mut image = Image::zeros(SIZE, SIZE, channels);
    for y in 0..SIZE {
        for x in 0..SIZE {
            let [u, v] = [x, y].map(|i| (f64::from(i) + 0.5) / f64::from(SIZE));
            let (cos, alpha) = place(u, v);
            let sum = split_sums(Distribution::Ggx, alpha, cos)[which];
            image.texel_mut(x, y)[..2].copy_from_slice(&[sum.scale as f32, sum.bias as f32]);
        }
    }
    image
}

fn dds(dxgi: u32, texels: &[u8]) -> Vec<u8> {
    let mut words = [0u32; 36];
    (words[0], words[2], words[3], words[18], words[19]) = (124, SIZE, SIZE, 32, 4);
    words[20] = u32::from_le_bytes(*b"DX10");
    (words[31], words[32], words[34]) = (dxgi, 3, 1);
    [b"DDS ".as_slice(), &words.iter().flat_map(|w| w.to_le_bytes()).collect::<Vec<_>>(), texels].concat()
}

/// One mistake per container, each named in the first line of the verdict; a right one is held.
#[test]
fn each_container_and_its_mistake() {
    use Masking::{SmithCorrelated, SmithSeparable};
    let workshop = Workshop::new();
    let flipped = table(SmithCorrelated, 2, |u, v| (u, (1.0 - v) * (1.0 - v)));
    workshop.write("flipped.dds", dds(34, &TexelFormat::Rg16Float.encode(&flipped)));
    let alpha = table(SmithCorrelated, 2, |u, v| (u, v));
    let texture = Texture {
        format: TexelFormat::Rg16Float,
        width: SIZE,
        height: SIZE,
        bytes: TexelFormat::Rg16Float.encode(&alpha),
    };
    workshop.write("alpha.ktx2", ktx2::encode(&texture).unwrap());
    let separable = table(SmithSeparable, 3, |u, v| (u, v * v));
    workshop.write("separable.exr", exr::encode(&separable, &exr::RGB, &Metadata::new()).unwrap());
    // PNG of sRGB pixels: what an image library makes of a table that it takes for a picture.
    workshop.write("picture.png", png::encode_image(&table(SmithCorrelated, 3, |u, v| (u, v * v))).unwrap());
    let swapped = table(SmithCorrelated, 3, |u, v| (v, u * u));
    let words: Vec<u16> = swapped.data.iter().map(|v| (v.clamp(0.0, 1.0) * 65535.0 + 0.5) as u16).collect();
    let buffer = image::ImageBuffer::<image::Rgb<u16>, _>::from_raw(SIZE, SIZE, words).unwrap();
    buffer.save(workshop.path("swapped.png")).unwrap();
    let right = table(SmithCorrelated, 2, |u, v| (u, v * v));
    workshop.write("right.bin", TexelFormat::Rg16Float.encode(&right));
    workshop.write(
        "right.dds",
        dds(35, &right.data.iter().flat_map(|v| ((v * 65535.0 + 0.5) as u16).to_le_bytes()).collect::<Vec<_>>()),
    );

    for (file, verdict) in [
        ("flipped.dds", "fits better as: flipped in y"),
        ("alpha.ktx2", "fits better as: alpha where roughness was stated"),
        ("separable.exr", "fits better as: masking separable"),
        ("picture.png", "fits better as: sRGB-encoded"),
        ("swapped.png", "fits better as: axes swapped"),
    ] {
        let run = workshop.run(&["audit", file]).exits(1);
        assert!(run.stdout.lines().any(|line| line == verdict), "{file}: {}", run.stdout);
    }
    let run = workshop.run(&["audit", "right.dds"]).exits(0);
    assert!(run.stdout.lines().any(|line| line == "as stated"), "{}", run.stdout);
    let args = ["audit", "right.bin", "--size", "32x32", "--samples", "half", "--json"];
    let json = workshop.run(&args).exits(0).json();
    assert_eq!((json["audit"]["verdict"].as_str(), json["held"].as_bool()), (Some("as_stated"), Some(true)));
    // A budget below what 32 x 32 texels can do.
    workshop.run(&["audit", "right.dds", "--max-error", "1e-4"]).exits(1);
}

#[test]
fn tables_of_a_bake_are_as_stated() {
    let workshop = Workshop::with(&[("gold.toml", &gold("gold"))]);
    workshop.run(&["bake", "gold.toml", "--no-search", "-q"]).exits(0);
    let manifest = workshop.json("out/manifest.json");
    let exponent = |kind: &str, axis: &str| {
        let tables = manifest["tables"].as_array().unwrap();
        let table = tables.iter().find(|t| t["kind"] == kind).unwrap();
        table["layout"][axis]["mapping"]["exponent"].as_f64().unwrap_or(1.0)
    };
    let fgd = format!("cos_theta^{},alpha^{}", exponent("fgd", "x"), exponent("fgd", "y"));
    let ior = ["--ior", "au"];
    let theta = "theta_h=0..1.5707963267948966^8,alpha=0.001..1@log";
    for (file, options) in [
        ("fresnel.ktx2", [&["--model", "fresnel", "--axes", "cos_theta"][..], &ior].concat()),
        ("fresnel.exr", [&["--model", "fresnel", "--axes", "cos_theta"][..], &ior].concat()),
        ("fgd.ktx2", [&["--model", "ggx-all-bounces", "--axes", &fgd][..], &ior].concat()),
        ("distribution.exr", vec!["--model", "ggx-ndf", "--axes", theta]),
    ] {
        let path = format!("out/tables/{file}");
        // Small tables: what is sampled may be far off, what the texels hold may not.
        let args = [&["audit", &path, "--nodes", "ends", "--max-error", "1"][..], &options].concat();
        let run = workshop.run(&args).exits(0);
        assert!(run.stdout.lines().any(|line| line == "as stated"), "{file}: {}", run.stdout);
    }
}

#[test]
fn bad_input_is_refused_with_a_hint() {
    let workshop = Workshop::new();
    workshop.write("noise.bin", [7u8; 99]);
    workshop.write("cut.dds", b"DDS |\0\0\0");
    workshop.run(&["audit", "nowhere.dds"]).fails(3, &["nowhere.dds"]);
    workshop.run(&["audit", "noise.bin"]).fails(1, &["--size WxH"]);
    workshop.run(&["audit", "noise.bin", "--size", "4x4"]).fails(1, &["24 values where 32", "--samples"]);
    workshop.run(&["audit", "noise.bin", "--size", "4"]).fails(2, &["64x64"]);
    workshop.run(&["audit", "cut.dds"]).fails(1, &["DDS", "damaged"]);
    workshop.write("row.bin", [0u8; 64]);
    let row = |more: &[&'static str]| [&["audit", "row.bin", "--size", "8x1"][..], more].concat();
    workshop.run(&row(&["--model", "ggx-corelated"])).fails(2, &["did you mean `ggx-correlated`?"]);
    workshop.run(&row(&["--model", "fresnel"])).fails(2, &["--ior au"]);
    workshop.run(&row(&["--axes", "cosine,roughness"])).fails(2, &["cos_theta, theta"]);
    workshop.run(&row(&[])).fails(1, &["two texels along both"]);
    workshop.run(&row(&["--crop", "4,0,8,1"])).fails(2, &["--crop is X,Y,W,H"]);
    workshop.run(&row(&["--channel", "b"])).fails(1, &["no channel 2"]);
}
