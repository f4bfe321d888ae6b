//! Tests of KTX2: round trips, another reader, the specification byte by byte.

use proptest::prelude::*;

use super::*;

fn texture(format: TexelFormat, width: u32, height: u32) -> Texture {
    let length = width * height * format.texel_bytes();
    let bytes = (0..length).map(|i| (i.wrapping_mul(i) / 7 + i) as u8).collect();
    Texture { format, width, height, bytes }
}

#[test]
fn every_format_survives() {
    for format in TexelFormat::ALL {
        for (width, height) in [(1, 1), (128, 1), (5, 3), (300, 200)] {
            let side = format.block_side();
            let texture = texture(format, side * width, side * height);
            for file in [encode(&texture).unwrap(), encode_plain(&texture).unwrap()] {
                assert_eq!(decode(&file).unwrap(), texture, "{format} {width}x{height}");
            }
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
        // Halves and their steps are whole numbers of 32 bits to the file.
        let type_size = if format.has_steps() { 4 } else { format.channel_bytes() };
        assert_eq!(reader.header().type_size, type_size);
        let keys: Vec<_> = reader.key_value_data().map(|(key, _)| key).collect();
        assert_eq!(keys, ["KTXwriter"]);
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

/// Plain texels by the specification (3.2.2, 3.3): scheme 0, both lengths that of the texels, at a multiple of 4 and of a block.
#[test]
fn plain_texels_lie_as_they_are_where_the_book_wants_them() {
    for (format, block) in [
        (TexelFormat::R16Float, 2),
        (TexelFormat::Rgb10a2Unorm, 4),
        (TexelFormat::Rgba16Float, 8),
        (TexelFormat::Rgba32Float, 16),
        (TexelFormat::Bc6hRgbUfloat, 16),
    ] {
        let side = format.block_side();
        let texture = texture(format, 3 * side, side);
        let file = encode_plain(&texture).unwrap();
        let long = |i: usize| u64::from_le_bytes(file[i..i + 8].try_into().unwrap()) as usize;
        let (at, length) = (long(80), texture.bytes.len());
        assert_eq!((file[44], long(88), long(96), file.len()), (0, length, length, at + length));
        assert_eq!((at % 4, at % block), (0, 0), "{format}");
        let reader = ::ktx2::Reader::new(file.as_slice()).unwrap();
        assert_eq!(reader.levels().next().unwrap().data, texture.bytes);
    }
}

/// Keys of the specification, section 3.11.3 and the registry. The validator of KTX-Software warns about any other (issue 7010), with a
/// vendor's prefix or without, and takes warnings for errors under `-e`.
const KNOWN_KEYS: [&str; 11] = [
    "KTXanimData",
    "KTXastcDecodeMode",
    "KTXcubemapIncomplete",
    "KTXdxgiFormat__",
    "KTXglFormat",
    "KTXmapRange",
    "KTXmetalPixelFormat",
    "KTXorientation",
    "KTXswizzle",
    "KTXwriter",
    "KTXwriterScParams",
];

/// The rules of the specification that `ktx validate -e` holds a file against, read here byte by byte.
#[test]
fn a_strict_reader_has_nothing_to_say() {
    for format in TexelFormat::ALL {
        let (across, down) = (6 * format.block_side(), 2 * format.block_side());
        let texture = texture(format, across, down);
        let file = encode(&texture).unwrap();
        let word = |at: usize| u32::from_le_bytes(file[at..at + 4].try_into().unwrap()) as usize;
        let long = |at: usize| u64::from_le_bytes(file[at..at + 8].try_into().unwrap()) as usize;

        // Sections in their order, without gaps but for padding, and the level to the end of the file.
        let [(dfd, dfd_length), (kvd, kvd_length)] = [48, 56].map(|at| (word(at), word(at + 4)));
        assert_eq!((dfd, kvd, long(64), long(72)), (80 + 24, dfd + dfd_length, 0, 0), "{format}");
        assert!(dfd.is_multiple_of(4) && kvd.is_multiple_of(4), "{format}");
        assert_eq!((long(80), long(80) + long(88)), (kvd + kvd_length, file.len()), "{format}");
        assert_eq!(long(96), texture.bytes.len(), "{format}");

        // One basic descriptor block: Khronos, type 0, version 2, linear, straight alpha, planes sized (2.0.4), samples that fill the block.
        assert_eq!((word(dfd), word(dfd + 4)), (dfd_length, 0), "{format}");
        assert_eq!(word(dfd + 8), 2 | (dfd_length - 4) << 16, "{format}");
        assert_eq!((file[dfd + 14], file[dfd + 15] & 1), (1, 0), "{format}");
        let block_bytes = usize::from(file[dfd + 20]);
        let block = format.block_side() * format.block_side();
        assert_eq!(block_bytes as u32, block * format.texel_bytes(), "{format}");
        assert_eq!(file[dfd + 21..dfd + 28], [0; 7], "{format}");
        let samples = file[dfd + 28..dfd + dfd_length].chunks_exact(16);
        assert!(samples.remainder().is_empty() && samples.len() > 0, "{format}");
        let mut next_bit = 0;
        for sample in samples {
            assert_eq!(usize::from(u16::from_le_bytes([sample[0], sample[1]])), next_bit, "{format}");
            next_bit += usize::from(sample[2]) + 1;
            assert_eq!(sample[4..8], [0; 4], "one position: {format}");
        }
        assert_eq!(next_bit, 8 * block_bytes, "{format}");

        // Key and value end in NUL, padding is zero, lengths add up; keys are known, sorted, and name the writer.
        let (mut keys, mut at) = (Vec::new(), kvd);
        while at < kvd + kvd_length {
            let entry = &file[at + 4..at + 4 + word(at)];
            let end = entry.iter().position(|&b| b == 0).unwrap();
            keys.push(std::str::from_utf8(&entry[..end]).unwrap());
            assert_eq!(entry.last(), Some(&0), "{format}");
            std::str::from_utf8(&entry[end + 1..]).unwrap();
            let after = at + 4 + entry.len();
            at = after.next_multiple_of(4);
            assert!(file[after..at].iter().all(|&b| b == 0), "{format}");
        }
        assert_eq!(at, kvd + kvd_length, "{format}");
        assert!(keys.is_sorted() && keys.contains(&"KTXwriter"), "{keys:?}");
        assert!(keys.iter().all(|key| KNOWN_KEYS.contains(key)), "{keys:?}");
    }
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
    assert!(matches!(encode(&Texture { width: 0, ..good }), Err(TextureError::Size { .. })));
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

/// Levels and faces as another reader finds them.
#[test]
fn levels_of_a_cube() {
    let level =
        |side: u32, first: u8| (0..side * side * 6 * 8).map(|i| first.wrapping_add(i as u8)).collect::<Vec<u8>>();
    let levels = vec![level(4, 1).into(), level(2, 7).into(), level(1, 9).into()];
    let cube =
        Levels { format: TexelFormat::Rgba16Float, width: 4, height: 4, faces: 6, levels, metadata: Metadata::new() };
    for is_compressed in [true, false] {
        let file = encode_levels(&cube, is_compressed).unwrap();
        let reader = ::ktx2::Reader::new(&file).unwrap();
        assert_eq!((reader.header().face_count, reader.header().level_count), (6, 3));
        let mut ends = Vec::new();
        for (found, expected) in reader.levels().zip(&cube.levels) {
            let bytes = match is_compressed {
                true => zstd::decompress(found.data, expected.len()).unwrap(),
                false => found.data.to_vec(),
            };
            assert_eq!(bytes, expected.as_ref());
            ends.push(found.data.as_ptr() as usize);
        }
        assert!(ends[0] > ends[1] && ends[1] > ends[2], "the smallest level comes first");
        assert!(is_compressed || ends.iter().all(|at| (at - file.as_ptr() as usize).is_multiple_of(8)));
    }
    for wrong in [
        Levels { faces: 2, ..cube.clone() },
        Levels { width: 8, ..cube.clone() },
        Levels { levels: Vec::new(), ..cube },
    ] {
        assert!(encode_levels(&wrong, true).is_err());
    }
}

/// Statements of a file about itself are found by another reader; keys that the specification has for others are refused.
#[test]
fn metadata_are_entries_of_their_own() {
    let texture = texture(TexelFormat::Rg16Float, 3, 2);
    let with =
        |key: &str| Levels { metadata: vec![(key.to_owned(), "a, \u{3b1} = 0.5".to_owned())], ..Levels::one(&texture) };
    let file = encode_levels(&with("luthier.table"), true).unwrap();
    let reader = ::ktx2::Reader::new(&file).unwrap();
    let keys: Vec<_> = reader.key_value_data().collect();
    assert_eq!(keys[0].0, "KTXwriter");
    assert_eq!(keys[1], ("luthier.table", "a, \u{3b1} = 0.5\0".as_bytes()));
    assert_eq!(decode(&file).unwrap(), texture);
    assert!(encode_levels(&with("KTXorientation"), true).is_err());
}
