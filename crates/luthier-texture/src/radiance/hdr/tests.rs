//! Tests of Radiance pictures: against another reader, and by hand.

use std::io::Cursor;

use ::image::ImageDecoder;
use ::image::codecs::hdr::{HdrDecoder, HdrEncoder};

use super::super::{Picture, decode};

fn read(file: &[u8]) -> Picture {
    decode(file).unwrap_or_else(|error| panic!("{error}"))
}

fn refused(file: &[u8]) -> String {
    decode(file).unwrap_err().to_string()
}

/// A file with these lines behind the signature, and texels of the exponent 129: mantissas are values times 128.
fn with(lines: &str, size: &str, mantissas: &[[u8; 3]]) -> Vec<u8> {
    let mut file = format!("#?RADIANCE\n{lines}FORMAT=32-bit_rle_rgbe\n\n{size}\n").into_bytes();
    file.extend(mantissas.iter().flat_map(|[r, g, b]| [*r, *g, *b, 129]));
    file
}

/// The values that the `image` crate reads.
fn by_another_reader(file: &[u8]) -> Vec<u32> {
    let decoder = HdrDecoder::new(Cursor::new(file)).unwrap();
    let mut bytes = vec![0; decoder.total_bytes() as usize];
    decoder.read_image(&mut bytes).unwrap();
    bytes.as_chunks().0.iter().map(|word| u32::from_ne_bytes(*word)).collect()
}

#[test]
fn values_are_those_of_another_reader() {
    // Every exponent and mantissa, flat: five is a width without runs of bytes.
    let mut flat = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 256 +X 5\n".to_vec();
    for exponent in 0..=255u8 {
        flat.extend((0..5u8).flat_map(|x| [exponent.wrapping_mul(7 + x), 255 - x, exponent ^ x, exponent]));
    }
    // Runs of texels: 2 times, then 3 + 256 times; and one of nothing.
    let mut old = b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 264\n".to_vec();
    old.extend([9, 8, 7, 130, 1, 1, 1, 2, 4, 5, 6, 128, 1, 1, 1, 3, 1, 1, 1, 1, 200, 100, 50, 120]);
    let pixels: Vec<_> = (0..40 * 6).map(|i| ::image::Rgb([(i / 9) as f32, 0.25, i as f32 * 1e-3])).collect();
    let mut planes = Vec::new();
    HdrEncoder::new(&mut planes).encode(&pixels, 40, 6).unwrap();
    for file in [flat, old, planes] {
        let Picture { image, notes } = read(&file);
        let bits: Vec<u32> = image.data.iter().map(|value| value.to_bits()).collect();
        assert!(bits == by_another_reader(&file) && notes.is_empty(), "{} x {}", image.width, image.height);
    }
}

#[test]
fn headers_of_other_programs() {
    let plain = with("", "-Y 1 +X 2", &[[128, 64, 32], [1, 2, 3]]);
    let expected = [1.0, 0.5, 0.25, 1.0 / 128.0, 2.0 / 128.0, 3.0 / 128.0];
    assert_eq!(read(&plain).image.data, expected);
    let text = String::from_utf8(plain[..plain.len() - 8].to_vec()).unwrap();
    let texels = &plain[plain.len() - 8..];
    let but = |from: &str, to: &str| [text.replace(from, to).as_bytes(), texels].concat();
    for file in [
        but("RADIANCE", "RGBE"),
        but("RADIANCE", "ANY"),
        but("\n", "\r\n"),
        but("FORMAT", "# a comment\nrpict -vp 1 2 3 view.oct\nVIEW= -vtv\nSOFTWARE=any\nFORMAT"),
        // Lines of the pictures that this one was made of.
        but("FORMAT", "first.hdr:\n\tEXPOSURE=7\n\tFORMAT=32-bit_rle_xyze\nFORMAT"),
        but("FORMAT=32-bit_rle_rgbe\n", ""),
        but("-Y 1 +X 2", "-Y  1   +X 2 "),
    ] {
        let picture = read(&file);
        assert!(picture.image.data == expected && picture.notes.is_empty(), "{}", String::from_utf8_lossy(&file));
    }
}

/// Ward: all exposures of a header multiply, and radiance is what is stored over them.
#[test]
fn exposures_are_taken_out() {
    let lines = "EXPOSURE=4.0\nCOLORCORR= 1 2 0.5\nEXPOSURE= 5e-1\n";
    let picture = read(&with(lines, "-Y 1 +X 1", &[[128; 3]]));
    assert_eq!((picture.image.data.as_slice(), picture.notes.len()), (&[0.5, 0.25, 1.0][..], 0));
    for wrong in ["EXPOSURE=0", "EXPOSURE=bright", "EXPOSURE=-1", "COLORCORR=1 2", "EXPOSURE=nan", "PRIMARIES=1 2 3"] {
        let message = refused(&with(&format!("{wrong}\n"), "-Y 1 +X 1", &[[128; 3]]));
        assert!(message.contains(wrong), "{message}");
    }
    assert!(refused(&with(&"EXPOSURE=1e-300\n".repeat(2), "-Y 1 +X 1", &[[128; 3]])).contains("exposures"));
}

/// A picture of two rows, 1 2 3 above 4 5 6, in the order that each line of a size asks for.
#[test]
fn eight_orders() {
    for (size, stored) in [
        ("-Y 2 +X 3", [1, 2, 3, 4, 5, 6]),
        ("+Y 2 +X 3", [4, 5, 6, 1, 2, 3]),
        ("-Y 2 -X 3", [3, 2, 1, 6, 5, 4]),
        ("+Y 2 -X 3", [6, 5, 4, 3, 2, 1]),
        ("+X 3 -Y 2", [1, 4, 2, 5, 3, 6]),
        ("+X 3 +Y 2", [4, 1, 5, 2, 6, 3]),
        ("-X 3 -Y 2", [3, 6, 2, 5, 1, 4]),
        ("-X 3 +Y 2", [6, 3, 5, 2, 4, 1]),
    ] {
        let image = read(&with("", size, &stored.map(|v| [v * 16; 3]))).image;
        let found: Vec<u8> = image.texels().map(|texel| (texel[0] * 8.0) as u8).collect();
        assert_eq!((image.width, image.height, found), (3, 2, vec![1, 2, 3, 4, 5, 6]), "{size}");
    }
    for wrong in ["-Y 2 +Y 3", "-Y two +X 3", "2 3", "-Y 2 +X 3 +Z 4", "-Z 2 +X 3"] {
        assert!(refused(&with("", wrong, &[[1; 3]; 6])).contains(&format!("`{wrong}`")), "{wrong}");
    }
}

/// Oracles: ITU-R BT.2087 for red of BT.2020; equal energy, which is the white of XYZE, is grey.
#[test]
fn colours_are_brought_to_rec709() {
    let wide = "PRIMARIES= .708 .292 .170 .797 .131 .046 .3127 .3290\n";
    let picture = read(&with(wide, "-Y 1 +X 1", &[[128, 0, 0]]));
    for (found, expected) in picture.image.data.iter().zip([1.6605, -0.1246, -0.0182]) {
        assert!((found - expected).abs() < 2e-4, "{:?}", picture.image.data);
    }
    assert!(picture.notes[0].contains("0.7080, 0.2920"), "{:?}", picture.notes);
    let usual = "PRIMARIES= .64 .33 .3 .6 .15 .06 .3127 .329\n";
    let picture = read(&with(usual, "-Y 1 +X 1", &[[128, 0, 0]]));
    assert!(picture.image.data == [1.0, 0.0, 0.0] && picture.notes.is_empty());
    assert!(refused(&with("PRIMARIES=0 0 0 0 0 0 0 0\n", "-Y 1 +X 1", &[[5; 3]])).contains("PRIMARIES"));

    let xyz = String::from_utf8(with("", "-Y 1 +X 1", &[])).unwrap().replace("rgbe", "xyze");
    let picture = read(&[xyz.as_bytes(), &[96, 96, 96, 129]].concat());
    assert!(picture.image.data.iter().all(|v| (v - 0.75).abs() < 1e-6), "{:?}", picture.image.data);
    assert!(picture.notes[0].contains("XYZ"));
    assert!(refused(xyz.replace("xyze", "luv").as_bytes()).contains("`32-bit_rle_luv`"));
}

#[test]
fn aspects_are_told() {
    let notes = |aspect: &str| read(&with(&format!("PIXASPECT={aspect}\n"), "-Y 1 +X 1", &[[5; 3]])).notes;
    assert!(notes("1").is_empty() && notes("2").is_empty() && notes("1.5")[0].contains("1.5"));
}

#[test]
fn damaged_files_say_where() {
    let pixels: Vec<_> = (0..16 * 4).map(|i| ::image::Rgb([i as f32, 1.0, 2.0])).collect();
    let mut file = Vec::new();
    HdrEncoder::new(&mut file).encode(&pixels, 16, 4).unwrap();
    let cut = refused(&file[..file.len() - 20]);
    assert!(cut.contains("scanline 4 of 4 is cut off"), "{cut}");
    let first = file.windows(4).position(|bytes| bytes == [2, 2, 0, 16]).unwrap();
    file[first + 3] = 17;
    assert!(refused(&file).contains("scanline 1 of 4 states 17 texels, and has 16"));
    file[first + 3] = 16;
    file[first + 4] = 255;
    assert!(refused(&file).contains("scanline 1 of 4 has a run beyond its 16 texels"));
    assert!(refused(&with("", "-Y 1 +X 2", &[[1; 3], [5; 3]])).contains("begins with a run"));
    assert!(refused(&with("", "-Y 100 +X 9", &[[5; 3]])).contains("cannot hold 100 scanlines"));
    assert!(refused(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n").contains("an empty line is missing"));
    assert!(refused(b"#?RADIANCE\n\n").contains("size"));
    for file in [&b""[..], b"#?", b"GIF89a", b"\x76\x2f\x31\x01"] {
        assert!(decode(file).is_err(), "{file:?}");
    }
}
