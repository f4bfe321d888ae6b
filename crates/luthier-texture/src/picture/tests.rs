//! Tests of pictures: formats, orientation, reasons.

use ::image::codecs::jpeg::JpegEncoder;
use ::image::codecs::webp::WebPEncoder;
use ::image::{ExtendedColorType, ImageEncoder};

use super::*;

/// A left half and a right half, eight by eight each: blocks of JPEG.
fn halves(left: [u8; 3], right: [u8; 3]) -> Vec<u8> {
    (0..8).flat_map(|_| [[left; 8], [right; 8]].concat().concat()).collect()
}

fn jpeg(rgb: &[u8], width: u32, height: u32) -> Vec<u8> {
    let mut file = Vec::new();
    JpegEncoder::new_with_quality(&mut file, 100).write_image(rgb, width, height, ExtendedColorType::Rgb8).unwrap();
    file
}

/// A JPEG with the tag of orientation of Exif (JEITA CP-3451, tag 0x0112) in front of its other segments.
fn turned(file: &[u8], orientation: u8) -> Vec<u8> {
    let mut exif = b"Exif\0\0MM\0*\0\0\0\x08\0\x01\x01\x12\0\x03\0\0\0\x01\0".to_vec();
    exif.extend([orientation, 0, 0, 0, 0, 0, 0]);
    let mut segment = vec![0xff, 0xe1];
    segment.extend((exif.len() as u16 + 2).to_be_bytes());
    segment.extend(exif);
    [&file[..2], &segment, &file[2..]].concat()
}

fn near(texel: [f32; 4], expected: [u8; 3]) -> bool {
    texel.iter().zip(expected).all(|(found, expected)| (255.0 * found - f32::from(expected)).abs() < 3.0)
}

#[test]
fn a_jpeg_is_a_picture() {
    let Decoded { picture, container, says_srgb } =
        decode(&jpeg(&halves([200, 40, 90], [20, 220, 60]), 16, 8)).unwrap();
    assert_eq!((picture.size(), picture.channels, container, says_srgb), ([16, 8], 3, Container::Jpeg, true));
    assert!(near(picture.texel(2, 3), [200, 40, 90]) && near(picture.texel(13, 3), [20, 220, 60]));
}

/// 8 says that the right side of the scene is on top of the stored picture, 3 that it is upside down.
#[test]
fn a_jpeg_is_turned_upright() {
    let file = jpeg(&halves([200, 40, 90], [20, 220, 60]), 16, 8);
    let picture = decode(&turned(&file, 3)).unwrap().picture;
    assert!(near(picture.texel(2, 3), [20, 220, 60]), "{:?}", picture.texel(2, 3));
    let picture = decode(&turned(&file, 8)).unwrap().picture;
    assert_eq!(picture.size(), [8, 16]);
    assert!(near(picture.texel(3, 2), [20, 220, 60]) && near(picture.texel(3, 13), [200, 40, 90]));
}

#[test]
fn a_webp_is_a_picture() {
    let rgba: Vec<u8> = (0..64).collect();
    let mut file = Vec::new();
    WebPEncoder::new_lossless(&mut file).write_image(&rgba, 4, 4, ExtendedColorType::Rgba8).unwrap();
    let Decoded { picture, container, .. } = decode(&file).unwrap();
    assert_eq!((picture.channels, container), (4, Container::WebP));
    assert_eq!(picture.samples, PictureSamples::Bits8(rgba));
}

/// The parts of `zune-jpeg` that use vector instructions, and those that do not, give the same bytes: bakes do not depend on the processor.
#[test]
fn jpegs_do_not_depend_on_the_processor() {
    let (width, height) = (123, 77);
    let noise: Vec<u8> = (0..width * height * 3u32).map(|i| (i.wrapping_mul(2_654_435_761) >> 24) as u8).collect();
    let file = jpeg(&noise, width, height);
    let options = zune_core::options::DecoderOptions::default().set_use_unsafe(false);
    let plain = zune_jpeg::JpegDecoder::new_with_options(Cursor::new(&file), options).decode().unwrap();
    assert_eq!(decode(&file).unwrap().picture.samples, PictureSamples::Bits8(plain));
}

#[test]
fn each_file_is_refused_for_its_own_reason() {
    let mut damaged = jpeg(&halves([1; 3], [2; 3]), 16, 8);
    damaged.truncate(40);
    let mut apple = b"\x89PNG\r\n\x1a\n\0\0\0\x04CgBI".to_vec();
    apple.extend([0x50, 0, 0x20, 0x02, 0, 0, 0, 0]);
    let mut sum = png::encode_rgb(2, 2, &[7; 12]).unwrap();
    // The last byte of the sum of the data, in front of the length of the last chunk.
    let end = sum.windows(4).position(|kind| kind == b"IEND").unwrap();
    sum[end - 5] ^= 1;
    for (file, reason) in [
        (&b""[..], "the file is empty"),
        (b"<!DOCTYPE html><title>404", "a page of HTML"),
        (b"\n  <html>", "a page of HTML"),
        (b"GIF89a", "it is a GIF"),
        (b"\0\0\0\x20ftypheic", "HEIC or AVIF"),
        (b"version https://git-lfs.github.com/spec/v1", "git lfs pull"),
        (b"some words", "does not begin as a picture does; PNG, JPEG and WebP are read"),
        (&damaged, "not a valid JPEG file: it ends early"),
        (&apple, "for iOS"),
        (&sum, "the checksum of a chunk does not fit"),
    ] {
        let error = decode(file).unwrap_err().to_string();
        assert!(error.contains(reason), "{reason}: {error}");
        assert!(error.chars().count() < 240 && !error.contains("Format error"), "{error}");
    }
}
