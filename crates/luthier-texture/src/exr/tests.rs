//! The `exr` crate is the oracle, in both directions.

use std::io::Cursor;

use ::exr::meta::attribute::AttributeValue;
use ::exr::prelude::{
    AnyChannel, AnyChannels, Compression as Theirs, Encoding, FlatSamples, Image as TheirImage, Layer, LayerAttributes,
    ReadChannels, ReadLayers, Text, WritableImage, read,
};
use proptest::prelude::*;

use super::*;

fn image(width: u32, height: u32, channels: u32) -> Image {
    let count = width * height * channels;
    let value = |i: u32| match i % 11 {
        0 => 1e-42,
        1 => -0.0,
        2 => f32::INFINITY,
        _ => (i as f32).sin() * 10f32.powi(i as i32 % 30 - 15),
    };
    Image { width, height, channels, data: (0..count).map(value).collect() }
}

fn metadata() -> Metadata {
    let entry = |key: &str, value: &str| (key.to_owned(), value.to_owned());
    vec![entry("model", "Fresnel α"), entry("axis", "cos_theta"), entry("an-attribute-with-a-long-name", "")]
}

#[test]
fn every_channel_count_survives() {
    for channels in 1..=4 {
        for (width, height) in [(1, 1), (128, 1), (7, 16), (5, 33), (64, 47)] {
            let image = image(width, height, channels);
            let (found, found_metadata) = decode(&encode(&image, &metadata()).unwrap()).unwrap();
            assert_eq!(found, image);
            assert_eq!(found_metadata, metadata());
        }
    }
}

#[test]
fn the_exr_crate_reads_what_is_written() {
    for channels in 1..=4 {
        let image = image(37, 35, channels);
        let file = encode(&image, &metadata()).unwrap();
        let theirs = read()
            .no_deep_data()
            .largest_resolution_level()
            .all_channels()
            .first_valid_layer()
            .all_attributes()
            .pedantic()
            .from_buffered(Cursor::new(&file))
            .unwrap();
        let layer = &theirs.layer_data;
        let names = ["Y", "YA", "RGB", "RGBA"][channels as usize - 1];
        assert_eq!(layer.channel_data.list.len(), names.len());
        for (c, name) in names.chars().enumerate() {
            let name = name.to_string();
            let plane = layer.channel_data.list.iter().find(|channel| channel.name.eq(&name)).unwrap();
            let FlatSamples::F32(values) = &plane.sample_data else { panic!("not f32") };
            let ours = image.data.iter().skip(c).step_by(channels as usize);
            assert!(values.iter().map(|v| v.to_bits()).eq(ours.map(|v| v.to_bits())), "{name} of {names}");
        }
        for (key, value) in metadata() {
            let name = Text::new_or_panic(format!("{PREFIX}{key}"));
            let Some(AttributeValue::Text(found)) = layer.attributes.other.get(&name) else {
                panic!("{key} is missing")
            };
            assert_eq!(found.bytes(), value.as_bytes());
        }
    }
}

#[test]
fn what_the_exr_crate_writes_is_read() {
    let image = image(19, 40, 3);
    for compression in [Theirs::Uncompressed, Theirs::ZIP1, Theirs::ZIP16] {
        let plane = |c: usize| FlatSamples::F32(image.data.iter().skip(c).step_by(3).copied().collect());
        let channels = ["B", "G", "R"].iter().zip([2, 1, 0]).map(|(&name, c)| AnyChannel::new(name, plane(c)));
        let mut attributes = LayerAttributes::default();
        attributes.layer_position.1 = -7;
        attributes.other.insert(Text::from("luthier.key"), AttributeValue::Text(Text::from("value")));
        attributes.other.insert(Text::from("someone.else"), AttributeValue::Text(Text::from("ignored")));
        let encoding = Encoding { compression, ..Encoding::UNCOMPRESSED };
        let layer = Layer::new((19, 40), attributes, encoding, AnyChannels::sort(channels.collect()));
        let mut file = Cursor::new(Vec::new());
        TheirImage::from_layer(layer).write().to_buffered(&mut file).unwrap();
        let (found, found_metadata) = decode(file.get_ref()).unwrap();
        assert_eq!(found, image, "{compression:?}");
        assert_eq!(found_metadata, [("key".to_owned(), "value".to_owned())]);
    }
}

#[test]
fn not_a_number_keeps_its_bits() {
    let image = Image { width: 1, height: 1, channels: 1, data: vec![f32::from_bits(0x7fc1_2345)] };
    let (found, _) = decode(&encode(&image, &Metadata::new()).unwrap()).unwrap();
    assert_eq!(found.data[0].to_bits(), 0x7fc1_2345);
}

#[test]
fn smooth_tables_shrink() {
    let data = (0..512 * 512).map(|i| (-(i as f32) / 1e5).exp()).collect();
    let image = Image { width: 512, height: 512, channels: 1, data };
    let file = encode(&image, &Metadata::new()).unwrap();
    assert!(file.len() < 800_000, "{}", file.len());
}

#[test]
fn refusals_name_the_cause() {
    let good = encode(&image(8, 20, 4), &Metadata::new()).unwrap();
    // A needle in the file, an offset from it, the bytes to put there, what the message says.
    for (needle, skip, bytes, message) in [
        (&b"\x76\x2f\x31\x01"[..], 0, &[0][..], "magic number"),
        (b"\x76\x2f\x31\x01", 4, &[3], "version other than 2"),
        (b"\x76\x2f\x31\x01", 5, &[2], "tiles"),
        (b"A\0\x02", 2, &[1], "not 32-bit float"),
        (b"A\0\x02", 0, b"Z", "other than Y, YA, RGB or RGBA"),
        (b"A\0\x02", 10, &[2], "subsampled"),
        (b"compression\0compression\0", 28, &[4], "other than none and ZIP"),
        (b"dataWindow\0box2i\0", 21 + 10, &[255; 2], "sides are 1 to"),
        (b"dataWindow\0box2i\0", 0, b"D", "no data window"),
        (b"dataWindow\0box2i\0", 21 + 12, &[9], "more than its rows"),
    ] {
        let at = good.windows(needle.len()).position(|w| w == needle).unwrap() + skip;
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        let found = decode(&file).unwrap_err().to_string();
        assert!(found.contains(message), "{found:?} should mention {message:?}");
    }
}

proptest! {
    #[test]
    fn truncated_files_are_errors(keep in 0.0..1.0f64) {
        let file = encode(&image(20, 50, 3), &metadata()).unwrap();
        prop_assert!(decode(&file[..(keep * file.len() as f64) as usize]).is_err());
    }

    #[test]
    fn damaged_files_never_panic(damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut file = encode(&image(20, 50, 3), &metadata()).unwrap();
        for (index, byte) in damage {
            let at = index.index(file.len());
            file[at] = byte;
        }
        if let Ok((image, _)) = decode(&file) {
            prop_assert_eq!(image.data.len() as u32, image.width * image.height * image.channels);
        }
    }

    #[test]
    fn damaged_headers_never_panic(at in 0..360usize, byte: u8) {
        let mut file = encode(&image(20, 50, 3), &metadata()).unwrap();
        file[at] = byte;
        let _ = decode(&file);
    }
}
