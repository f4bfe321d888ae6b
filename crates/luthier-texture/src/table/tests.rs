//! Tests of tables of other makers: DDS, KTX2, EXR, PNG, raw and damaged files.

use proptest::prelude::*;

use super::*;
use crate::Metadata;

/// A DDS header by hand: size, pixel format, and the DX10 extension where there is a format for it.
fn dds(width: u32, height: u32, pixel_format: [u32; 8], dxgi: Option<u32>) -> Vec<u8> {
    let mut words = [0u32; 31];
    words[0] = 124;
    words[2] = height;
    words[3] = width;
    words[18..26].copy_from_slice(&pixel_format);
    let mut file = b"DDS ".to_vec();
    file.extend(words.iter().flat_map(|w| w.to_le_bytes()));
    if let Some(format) = dxgi {
        file.extend([format, 3, 0, 1, 0].iter().flat_map(|w| w.to_le_bytes()));
    }
    file
}

fn dx10(width: u32, height: u32, format: u32) -> Vec<u8> {
    dds(width, height, [32, 4, u32::from_le_bytes(*b"DX10"), 0, 0, 0, 0, 0], Some(format))
}

/// Values by hand: halves 1 (0x3c00) and 0.5 (0x3800), words 65535 and 0, bytes 255 and 51.
#[test]
fn dds_formats() {
    let halves = [0x00, 0x3c, 0x00, 0x38];
    let cases: [(u32, &[u8], &[f32], &str); 7] = [
        (34, &halves, &[1.0, 0.5], "DDS rg16float"),
        (10, &[0x00, 0x3c, 0x00, 0x38, 0, 0, 0, 0x3c], &[1.0, 0.5, 0.0, 1.0], "DDS rgba16float"),
        (35, &[255, 255, 0, 0], &[1.0, 0.0], "DDS rg16unorm"),
        (49, &[255, 51], &[1.0, 0.2], "DDS rg8unorm"),
        (41, &[0, 0, 0, 0x40], &[2.0], "DDS r32float"),
        (87, &[255, 51, 0, 255], &[0.0, 0.2, 1.0, 1.0], "DDS bgra8unorm"),
        (24, &[0xff, 0x03, 0x00, 0xc0], &[1.0, 0.0, 0.0, 1.0], "DDS rgba10-2unorm"),
    ];
    for (format, texel, expected, name) in cases {
        let file = [dx10(1, 1, format), texel.to_vec()].concat();
        let table = read(&file).unwrap();
        assert_eq!((table.image.data.as_slice(), table.format.as_str()), (expected, name));
        assert!(read(&file[..file.len() - 1]).is_err(), "cut off: {name}");
    }
    // Mid grey in sRGB: code 188 is 0.5029 (IEC 61966-2-1).
    let table = read(&[dx10(1, 1, 29), vec![188, 0, 255, 128]].concat()).unwrap();
    assert!((table.image.data[0] - 0.5029).abs() < 1e-4 && table.image.data[3] == 128.0 / 255.0, "{table:?}");
    let old = [dds(2, 1, [32, 4, 112, 0, 0, 0, 0, 0], None), halves.to_vec(), halves.to_vec()].concat();
    assert_eq!(read(&old).unwrap().image.data, [1.0, 0.5, 1.0, 0.5], "D3DFMT_G16R16F");
    let masks =
        [dds(1, 1, [32, 0x41, 0, 32, 0xff_0000, 0xff00, 0xff, 0xff00_0000], None), vec![0, 51, 255, 255]].concat();
    assert_eq!(read(&masks).unwrap().image.data, [1.0, 0.2, 0.0, 1.0]);
    assert!(matches!(read(&dx10(1, 1, 71)), Err(TextureError::Unsupported { .. })), "BC1");
    assert!(matches!(read(&dx10(0, 1, 34)), Err(TextureError::Size { .. })));
}

#[test]
fn ktx2_of_other_makers() {
    // Two halves per texel, no supercompression, no descriptor, two levels promised.
    let mut file = b"\xabKTX 20\xbb\r\n\x1a\n".to_vec();
    for word in [83u32, 2, 2, 1, 0, 0, 1, 2, 0, 0, 0, 0, 0] {
        file.extend(word.to_le_bytes());
    }
    file.extend([0u8; 16]);
    for word in [128u64, 8, 8, 120, 4, 4] {
        file.extend(word.to_le_bytes());
    }
    let texels_at = file.len() as u64;
    file[80..88].copy_from_slice(&texels_at.to_le_bytes());
    file.extend([0, 0x3c, 0, 0x38, 0, 0x38, 0, 0x3c]);
    let table = read(&file).unwrap();
    assert_eq!((table.format.as_str(), table.samples), ("KTX2 rg16float", Samples::Half));
    assert_eq!(table.image.data, [1.0, 0.5, 0.5, 1.0]);
}

#[test]
fn exr_of_two_channels_png_and_raw() {
    let image = Image { width: 2, height: 2, channels: 3, data: (0..12).map(|i| i as f32 / 16.0).collect() };
    let table = read(&crate::exr::encode(&image, &crate::exr::RGB, &Metadata::new()).unwrap()).unwrap();
    assert_eq!((table.image, table.format.as_str(), table.samples), (image, "EXR RGB, float", Samples::Float));
    let grey = Image { width: 3, height: 1, channels: 1, data: vec![0.0, 0.2, 1.0] };
    let table = read(&png::encode_gray(&grey).unwrap()).unwrap();
    assert_eq!((table.image, table.format.as_str()), (grey, "PNG, 8 bits"));
    let bytes: Vec<u8> = [0.25f32, 4.0].iter().flat_map(|v| v.to_le_bytes()).collect();
    assert_eq!(raw(&bytes, 1, 1, 2, Samples::Float).unwrap().image.data, [0.25, 4.0]);
    assert!(matches!(raw(&bytes, 2, 1, 2, Samples::Float), Err(TextureError::Length { found: 2, expected: 4 })));
    assert!(matches!(raw(&bytes, 1, 1, 5, Samples::Float), Err(TextureError::Channels(5))));
    assert!(
        matches!(raw(&bytes[..2], 2, 1, 1, Samples::Unorm10), Err(TextureError::Channels(1))),
        "words of four values"
    );
    assert!(matches!(read(b"GIF89a"), Err(TextureError::UnknownContainer)));
}

proptest! {
    /// Random bytes behind each magic, and real files with bytes changed: an error or a table, never a panic.
    #[test]
    fn damaged_files_do_not_panic(
        bytes in prop::collection::vec(any::<u8>(), 0..600),
        changes in prop::collection::vec((0..4000usize, any::<u8>()), 1..6),
        cut in 0..4000usize,
    ) {
        for magic in [&b"DDS "[..], b"\xabKTX 20\xbb\r\n\x1a\n", b"\x89PNG\r\n\x1a\n", &[0x76, 0x2f, 0x31, 0x01], b"#?RADIANCE\n", b""] {
            let _ = read(&[magic, &bytes].concat());
        }
        let image = Image { width: 9, height: 5, channels: 3, data: (0..135).map(|i| i as f32 / 135.0).collect() };
        let texture = crate::Texture {
            format: luthier_lut::TexelFormat::Rgba16Float,
            width: 9,
            height: 5,
            bytes: luthier_lut::TexelFormat::Rgba16Float.encode(&image),
        };
        let files = [
            [dx10(9, 5, 34), vec![1; 180]].concat(),
            crate::ktx2::encode(&texture).unwrap(),
            crate::exr::encode(&image, &crate::exr::RGB, &Metadata::new()).unwrap(),
            png::encode_image(&image).unwrap(),
        ];
        for mut file in files {
            for &(at, value) in &changes {
                let length = file.len();
                file[at % length] = value;
            }
            let _ = read(&file);
            let _ = read(&file[..cut % file.len()]);
        }
    }
}
