use proptest::prelude::*;

use super::*;

fn texture(format: TexelFormat, width: u32, height: u32) -> Texture {
    let length = width * height * format.texel_bytes();
    let bytes = (0..length).map(|i| (i.wrapping_mul(i) / 7 + i) as u8).collect();
    let metadata = vec![("axis.x".into(), "cos_theta".into()), ("model".into(), "Fresnel, n = 1.5 (größer)".into())];
    Texture { format, width, height, bytes, metadata }
}

#[test]
fn every_format_survives() {
    for format in TexelFormat::ALL {
        for (width, height) in [(1, 1), (128, 1), (5, 3), (300, 200)] {
            let side = format.block_side();
            let texture = texture(format, side * width, side * height);
            assert_eq!(decode(&encode(&texture).unwrap()).unwrap(), texture, "{format} {width}x{height}");
        }
    }
}

/// The ktx2 crate's own reader as oracle: it walks header, descriptor and key/value data by itself.
#[test]
fn another_reader_finds_everything() {
    for format in TexelFormat::ALL {
        let side = format.block_side();
        let texture = texture(format, 6 * side, 2 * side);
        let file = encode(&texture).unwrap();
        let reader = ::ktx2::Reader::new(file.as_slice()).unwrap();
        assert_eq!(reader.writer().unwrap().trim_end_matches('\0'), WRITER);
        assert_eq!(reader.transfer_function(), Some(::ktx2::TransferFunction::Linear));
        let basic = reader.basic_dfd().unwrap();
        // A block is one sample of the descriptor, whose model says what is in it; its dimensions are stored less 1.
        let (model, samples) = match side {
            1 => (::ktx2::ColorModel::RGBSDA, format.channels() as usize),
            _ => (::ktx2::ColorModel::BC6H, 1),
        };
        assert_eq!((reader.color_model(), basic.sample_information.len()), (Some(model), samples));
        assert_eq!(u32::from(basic.bytes_planes[0]), side * format.row_bytes(1));
        assert_eq!(file[120..122], [side as u8 - 1; 2], "{format}");
        assert_eq!(reader.header().type_size, format.channel_bytes());
        let keys: Vec<_> = reader.key_value_data().map(|(key, _)| key).collect();
        assert_eq!(keys, ["KTXwriter", "axis.x", "model"]);
        assert!(reader.key_value_data().all(|(_, value)| value.last() == Some(&0)));
        let level = reader.levels().next().unwrap();
        assert_eq!(level.uncompressed_byte_length, texture.bytes.len() as u64);
        assert_eq!(zstd::decompress(level.data, texture.bytes.len()).unwrap(), texture.bytes);
    }
}

/// Bytes by the specification: identifier, VkFormat 97, type size 2, 2 x 1 x 0, 0 layers, 1 face, 1 level, scheme 2.
#[test]
fn the_header_is_by_the_book() {
    let file = encode(&texture(TexelFormat::Rgba16Float, 2, 1)).unwrap();
    assert_eq!(file[..12], *b"\xABKTX 20\xBB\r\n\x1A\n");
    let word = |i: usize| u32::from_le_bytes(file[i..i + 4].try_into().unwrap());
    let words: Vec<u32> = (12..48).step_by(4).map(word).collect();
    assert_eq!(words, [97, 2, 2, 1, 0, 0, 1, 1, 2]);
    // The descriptor follows the level index; its first word is its own length, 4 + 24 + 16 per channel.
    assert_eq!((word(48), word(52), word(104)), (104, 92, 92));
}

#[test]
fn order_of_metadata_does_not_matter_to_the_bytes() {
    let texture = texture(TexelFormat::R32Float, 4, 4);
    let mut reversed = texture.clone();
    reversed.metadata.reverse();
    assert_eq!(encode(&texture).unwrap(), encode(&reversed).unwrap());
}

#[test]
fn uncompressed_files_are_read() {
    let texture = texture(TexelFormat::R16Float, 3, 2);
    let mut file = encode(&texture).unwrap();
    let texels_at = u64::from_le_bytes(file[80..88].try_into().unwrap()) as usize;
    file.truncate(texels_at);
    file.extend_from_slice(&texture.bytes);
    file[44..48].fill(0);
    file[88..96].copy_from_slice(&12u64.to_le_bytes());
    assert_eq!(decode(&file).unwrap(), texture);
}

#[test]
fn refusals_name_the_cause() {
    let good = encode(&texture(TexelFormat::Rgba8Unorm, 4, 4)).unwrap();
    let patched = |at: usize, bytes: &[u8]| {
        let mut file = good.clone();
        file[at..at + bytes.len()].copy_from_slice(bytes);
        decode(&file).unwrap_err().to_string()
    };
    for (at, bytes, message) in [
        (0, &[0][..], "identifier"),
        (12, &[43], "R8G8B8A8_SRGB texels"),
        (24, &[0], "two-dimensional"),
        (36, &[6], "layers, faces or levels"),
        (44, &[1], "BasisLZ"),
        (22, &[1], "sides are 1 to"),
        (104 + 14, &[2], "descriptor contradicts"),
        (80, &[255; 8], "outside the file"),
        (96, &[65], "another length"),
    ] {
        let found = patched(at, bytes);
        assert!(found.contains(message), "{found:?} should mention {message:?}");
    }
    assert!(matches!(decode(&[]), Err(TextureError::Malformed { .. })));
}

#[test]
fn unusable_textures_are_refused() {
    let good = texture(TexelFormat::R16Float, 4, 4);
    assert!(matches!(encode(&Texture { width: 5, ..good.clone() }), Err(TextureError::Length { .. })));
    assert!(matches!(encode(&Texture { width: 0, ..good.clone() }), Err(TextureError::Size { .. })));
    let metadata = vec![("KTXwriter".into(), "x".into())];
    assert!(matches!(encode(&Texture { metadata, ..good }), Err(TextureError::Metadata { .. })));
}

proptest! {
    #[test]
    fn truncated_files_are_errors(keep in 0.0..1.0f64) {
        let file = encode(&texture(TexelFormat::Rgba16Float, 40, 9)).unwrap();
        prop_assert!(decode(&file[..(keep * file.len() as f64) as usize]).is_err());
    }

    #[test]
    fn damaged_files_never_panic(damage in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8)) {
        let mut file = encode(&texture(TexelFormat::Rgba16Float, 40, 9)).unwrap();
        for (index, byte) in damage {
            let at = index.index(file.len());
            file[at] = byte;
        }
        if let Ok(texture) = decode(&file) {
            prop_assert_eq!(texture.bytes.len() as u32, texture.width * texture.height * texture.format.texel_bytes());
        }
    }
}
