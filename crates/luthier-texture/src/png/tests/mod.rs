//! Tests of PNG: round trips, bit depths, damaged files.

mod fixtures;

use proptest::prelude::*;

use super::*;
use fixtures::{GREY_2, GREY_16, GREY_ALPHA, PALETTE};

fn colours(width: u32, height: u32) -> Vec<u8> {
    (0..width * height * 3).map(|i| (i * 37 + i * i / 5) as u8).collect()
}

#[test]
fn rgb_survives() {
    for (width, height) in [(1, 1), (128, 1), (33, 20)] {
        let rgb8 = colours(width, height);
        let image = decode(&encode_rgb(width, height, &rgb8).unwrap()).unwrap();
        assert_eq!((image.width, image.height, image.channels), (width, height, 4));
        for (texel, rgb) in image.texels().zip(rgb8.chunks_exact(3)) {
            assert_eq!([texel[0], texel[1], texel[2]], [rgb[0], rgb[1], rgb[2]].map(|v| f32::from(v) / 255.0));
            assert_eq!(texel[3], 1.0);
        }
    }
}

#[test]
fn linear_images_are_encoded_and_clipped() {
    let rgba = Image { width: 2, height: 1, channels: 4, data: vec![0.5, 2.0, -1.0, 0.1, 0.0, 1.0, 0.215_860_5, 0.0] };
    let found = decode(&encode_image(&rgba).unwrap()).unwrap();
    let codes: Vec<f32> = found.data.iter().map(|v| v * 255.0).collect();
    assert_eq!(codes, [188.0, 255.0, 0.0, 255.0, 0.0, 255.0, 128.0, 255.0]);

    let grey = Image { width: 1, height: 1, channels: 1, data: vec![0.5] };
    let found = read(&encode_image(&grey).unwrap()).unwrap();
    assert_eq!(found.samples, PictureSamples::Bits8(vec![188; 3]));
}

#[test]
fn maps_of_every_depth_are_read() {
    let grey_16 = read(GREY_16).unwrap();
    assert_eq!((grey_16.size(), grey_16.channels), ([2, 2], 1));
    assert_eq!(grey_16.samples, PictureSamples::Bits16(vec![0, 1, 32768, 65535]));
    assert_eq!(read(GREY_2).unwrap().samples, PictureSamples::Bits8(vec![0, 85, 170, 255]));
    assert_eq!(read(GREY_ALPHA).unwrap().samples, PictureSamples::Bits8(vec![51, 204]));
    assert_eq!(decode(PALETTE).unwrap().data, [0.4, 0.4, 0.4, 1.0, 1.0, 0.0, 0.2, 1.0]);
    assert_eq!(decode(GREY_ALPHA).unwrap().data, [0.2, 0.2, 0.2, 0.8]);
}

#[test]
fn unusable_input_is_refused() {
    assert!(matches!(encode_rgb(2, 2, &[0; 11]), Err(TextureError::Length { found: 11, expected: 12 })));
    assert!(matches!(encode_rgb(0, 2, &[]), Err(TextureError::Size { .. })));
    assert!(matches!(decode(b"GIF89a"), Err(TextureError::PngDecode(_))));
}

#[test]
fn a_promise_that_the_file_cannot_keep_is_refused() {
    // GREY_16 with 8192 x 8192 in its header, checksum by Python's zlib.crc32.
    let mut file = GREY_16.to_vec();
    file[16..24].copy_from_slice(&[0, 0, 32, 0, 0, 0, 32, 0]);
    file[29..33].copy_from_slice(&[0x7, 0x51, 0x49, 0xc6]);
    assert!(matches!(read(&file), Err(TextureError::Malformed { .. })));
    assert!(matches!(decode(&file), Err(TextureError::Malformed { .. })));
}

/// PALETTE with seven bytes of colours, checksum by Python's zlib.crc32: the decoder looks for the third byte of the third colour.
#[test]
fn a_palette_of_parts_of_colours_is_refused() {
    let mut file = PALETTE[..33].to_vec();
    file.extend([0, 0, 0, 7, 80, 76, 84, 69, 255, 0, 51, 102, 102, 102, 9]);
    file.extend([181, 167, 180, 187]);
    file.extend(&PALETTE[51..]);
    assert_eq!(
        decode(&file).unwrap_err().to_string(),
        "not a valid PNG file: the palette does not consist of 1 to 256 colours"
    );
}

proptest! {
    #[test]
    fn truncated_files_are_errors(keep in 0.0..1.0f64) {
        let file = encode_rgb(20, 30, &colours(20, 30)).unwrap();
        // The IEND chunk, the last 12 bytes, adds no pixels.
        prop_assert!(decode(&file[..(keep * (file.len() - 12) as f64) as usize]).is_err());
    }

    #[test]
    fn damaged_files_never_panic(damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        for source in [encode_rgb(20, 30, &colours(20, 30)).unwrap(), GREY_2.to_vec(), PALETTE.to_vec()] {
            let mut file = source;
            for (index, byte) in &damage {
                let at = index.index(file.len());
                file[at] = *byte;
            }
            if let Ok(image) = decode(&file) {
                prop_assert_eq!(image.data.len() as u32, image.width * image.height * 4);
            }
        }
    }
}

/// Values of a table are not encoded as colours, and its statements are text that the reader of the `png` crate finds.
#[test]
fn tables_are_linear_and_say_what_they_are() {
    for channels in 1..=4 {
        let data: Vec<f32> = (0..6 * channels).map(|i| (i * 11 % 256) as f32 / 255.0).collect();
        let table = Image { width: 3, height: 2, channels, data };
        let metadata = vec![("luthier.table".to_owned(), "max 5e-4, \u{3b1} from 0.01".to_owned())];
        let file = encode_table(&table, &metadata).unwrap();
        assert_eq!(decode_table(&file).unwrap(), (table.clone(), 8));
        let reader = ::png::Decoder::new(Cursor::new(&file)).read_info().unwrap();
        let text = &reader.info().utf8_text[0];
        assert_eq!((text.keyword.as_str(), text.get_text().unwrap()), ("luthier.table", metadata[0].1.clone()));
        assert!(reader.info().srgb.is_none() && reader.info().gama_chunk.is_none());
        assert!(encode_table(&table, &vec![("two words".to_owned(), String::new())]).is_err());
    }
}
