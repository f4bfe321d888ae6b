//! Tests of EXR: round trips, the file layout, a file of the reference library, damaged files.

use proptest::prelude::*;

use super::*;

/// A file by the reference library (OpenEXR 3.5.3 for Python): 8 x 40, ZIP, row + column / 8 + 10 * channel, the string attributes
/// `luthier` and `other`.
const OPENEXR: &[u8] = include_bytes!("openexr.exr");

const NAMES: [&str; 4] = ["R", "G", "B", "A"];

fn image(width: u32, height: u32, channels: u32) -> Image {
    let values = (0..width * height * channels).map(|i| match i % 11 {
        0 => 1e-42,
        1 => -0.0,
        2 => f32::INFINITY,
        _ => libm::sinf(i as f32) * libm::powf(10.0, (i as i32 % 30 - 15) as f32),
    });
    Image { width, height, channels, data: values.collect() }
}

fn entry(key: &str, value: &str) -> (String, String) {
    (key.to_owned(), value.to_owned())
}

fn metadata() -> Metadata {
    vec![entry("an-entry-of-32-bytes-or-more-name", ""), entry("axis", "cos_theta"), entry("model", "Fresnel α")]
}

#[test]
fn every_channel_count_survives() {
    for channels in 1..=4 {
        for (width, height) in [(1, 1), (128, 1), (7, 16), (5, 33), (64, 47)] {
            let image = image(width, height, channels);
            let (found, found_metadata) =
                decode(&encode(&image, &NAMES[..channels as usize], &metadata()).unwrap()).unwrap();
            assert_eq!(found, image);
            assert_eq!(found_metadata, metadata());
        }
    }
}

/// The part of the file after the offset table follows the file layout of openexr.org: row number, length, channels by name. A block so
/// small does not shrink, so it is stored as it is.
#[test]
fn the_file_is_by_the_book() {
    let image = Image { width: 1, height: 2, channels: 3, data: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
    let file = encode(&image, &RGB, &[("generator".to_owned(), "α".to_owned())].to_vec()).unwrap();
    assert_eq!(file[..8], [0x76, 0x2f, 0x31, 0x01, 2, 0, 0, 0]);
    for bytes in [
        "luthier\0string\0\x12\0\0\0{\"generator\":\"α\"}\0".as_bytes(),
        "software\0string\0\x02\0\0\0α".as_bytes(),
        b"compression\0compression\0\x01\0\0\0\x03",
    ] {
        assert!(file.windows(bytes.len()).any(|window| window == bytes), "{bytes:?}");
    }
    let block = file.len() - 32;
    assert_eq!(file[block - 8..block], (block as u64).to_le_bytes());
    assert_eq!(file[block..block + 8], [0, 0, 0, 0, 24, 0, 0, 0]);
    let values: Vec<f32> = file[block + 8..].as_chunks().0.iter().map(|&b| f32::from_le_bytes(b)).collect();
    assert_eq!(values, [3.0, 2.0, 1.0, 6.0, 5.0, 4.0]);
}

#[test]
fn what_the_reference_library_writes_is_read() {
    let (image, metadata) = decode(OPENEXR).unwrap();
    assert_eq!((image.width, image.height, image.channels), (8, 40, 4));
    for (i, texel) in image.texels().enumerate() {
        let first = (i / 8) as f32 + (i % 8) as f32 / 8.0;
        assert_eq!(texel, [first, first + 10.0, first + 20.0, first + 30.0], "{i}");
    }
    assert_eq!(metadata, [entry("axis", "cos_theta"), entry("model", "Fresnel α")]);
}

/// A fourth channel that is no alpha keeps its place: in the file channels are sorted by name, capitals first (openexr.org,
/// "the channel list").
#[test]
fn channels_are_called_what_they_hold() {
    let image = Image { width: 1, height: 1, channels: 4, data: vec![1.0, 2.0, 3.0, 4.0] };
    let file = encode(&image, &["R", "G", "B", "never_crossed.Y"], &Metadata::new()).unwrap();
    let list = b"channels\0chlist\0";
    let at = file.windows(list.len()).position(|w| w == list).unwrap() + list.len() + 4;
    // An entry is a name, NUL and 16 bytes: sample type, flags, sampling.
    let mut names = Vec::new();
    let mut rest = &file[at..];
    while rest[0] != 0 {
        let end = rest.iter().position(|&b| b == 0).unwrap();
        names.push(String::from_utf8_lossy(&rest[..end]).into_owned());
        rest = &rest[end + 17..];
    }
    assert_eq!(names, ["B", "G", "R", "never_crossed.Y"]);
    assert_eq!(decode(&file).unwrap().0, image);
    assert!(matches!(encode(&image, &RGB, &Metadata::new()), Err(TextureError::Channels(4))));
}

#[test]
fn order_of_metadata_does_not_matter_to_the_bytes() {
    let image = image(5, 33, 4);
    let reversed = metadata().into_iter().rev().collect();
    assert_eq!(encode(&image, &NAMES, &metadata()).unwrap(), encode(&image, &NAMES, &reversed).unwrap());
}

#[test]
fn not_a_number_keeps_its_bits() {
    let image = Image { width: 1, height: 1, channels: 1, data: vec![f32::from_bits(0x7fc1_2345)] };
    let (found, _) = decode(&encode(&image, &["Y"], &Metadata::new()).unwrap()).unwrap();
    assert_eq!(found.data[0].to_bits(), 0x7fc1_2345);
}

#[test]
fn smooth_tables_shrink() {
    let data = (0..512 * 512).map(|i| libm::expf(-(i as f32) / 1e5)).collect();
    let image = Image { width: 512, height: 512, channels: 1, data };
    let file = encode(&image, &["Y"], &Metadata::new()).unwrap();
    assert!(file.len() < 800_000, "{}", file.len());
}

/// A file with bytes put in place of others, found by a needle and an offset from it.
fn patched(file: &[u8], needle: &[u8], skip: usize, bytes: &[u8]) -> Vec<u8> {
    let at = file.windows(needle.len()).position(|window| window == needle).unwrap() + skip;
    let mut file = file.to_vec();
    file[at..at + bytes.len()].copy_from_slice(bytes);
    file
}

#[test]
fn refusals_name_the_cause() {
    let good = encode(&image(8, 20, 4), &NAMES, &metadata()).unwrap();
    for (needle, skip, bytes, message) in [
        (&b"\x76\x2f\x31\x01"[..], 0, &[0][..], "file identifier missing"),
        (b"\x76\x2f\x31\x01", 4, &[3], "versions other than 2"),
        (b"A\0\x02", 2, &[1], "not 32-bit float"),
        (b"A\0\x02", 10, &[2], "subsampled"),
        (b"compression\0compression\0", 28, &[4], "other than none and ZIP"),
        (b"dataWindow\0box2i\0", 21 + 10, &[1], "sides are 1 to"),
        (b"dataWindow\0box2i\0", 0, b"D", "missing or invalid data window"),
        (b"dataWindow\0box2i\0", 21 + 12, &[39], "offset table"),
        (b"dataWindow\0box2i\0", 21 + 12, &[15], "exceeds total size"),
        (b"{\"an-entry", 0, b"[", "not a JSON object of strings"),
        (b"luthier\0string\0", 8, b"strung", "is not a string"),
    ] {
        let Err(error) = decode(&patched(&good, needle, skip, bytes)) else { panic!("not refused: {message}") };
        let cause = std::error::Error::source(&error).map(ToString::to_string).unwrap_or_default();
        let found = format!("{error} {cause}");
        assert!(found.contains(message), "{found:?} should mention {message:?}");
    }
}

#[test]
fn blocks_out_of_order_are_refused() {
    // The second block, 16 rows of one stored float each, claims the rows of the first.
    let good = encode(&image(1, 32, 1), &["Y"], &Metadata::new()).unwrap();
    let error = decode(&patched(&good, &[16, 0, 0, 0, 64, 0, 0, 0], 0, &[0])).unwrap_err();
    assert!(error.to_string().contains("another order"), "{error}");
}

/// Sides near 2^31 in tiles of one texel, rip-mapped: the most chunks that a header can ask for.
#[test]
fn huge_tile_counts_are_refused() {
    let good = encode(&image(8, 20, 1), &["Y"], &Metadata::new()).unwrap();
    let (first, last) = ((2 - i32::MAX / 2).to_le_bytes(), (i32::MAX / 2 - 2).to_le_bytes());
    let window = [first, first, last, last].concat();
    let file = patched(&good, b"dataWindow\0box2i\0", 21, &window);
    let file = patched(&file, b"type\0string\0", 0, b"TYPE");
    let tiles = b"tiles\0tiledesc\0\x09\0\0\0\x01\0\0\0\x01\0\0\0\x12type\0string\0\x0a\0\0\0tiledimage";
    let file = [&file[..8], tiles, &file[8..]].concat();
    let error = decode(&file).unwrap_err();
    assert!(matches!(error, TextureError::Size { .. }), "{error:?}");
}

proptest! {
    #[test]
    fn truncated_files_are_errors(keep in 0.0..1.0f64) {
        let file = encode(&image(20, 50, 3), &RGB, &metadata()).unwrap();
        prop_assert!(decode(&file[..(keep * file.len() as f64) as usize]).is_err());
    }

    #[test]
    fn damaged_files_never_panic(damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut file = encode(&image(20, 50, 3), &RGB, &metadata()).unwrap();
        for (index, byte) in damage {
            let at = index.index(file.len());
            file[at] = byte;
        }
        if let Ok((image, _)) = decode(&file) {
            prop_assert_eq!(image.data.len() as u32, image.width * image.height * image.channels);
        }
    }

    #[test]
    fn damaged_headers_never_panic(at in 0..480usize, byte: u8) {
        let mut file = encode(&image(20, 50, 3), &RGB, &metadata()).unwrap();
        file[at] = byte;
        let _ = decode(&file);
    }
}
