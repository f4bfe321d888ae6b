//! Headers that promise more texels than there are limits for: refused before memory is taken.
//!
//! One test in a program of its own, because the limit on memory counts all threads.

use luthier_fuzz::{corpus, holding, target, with_sums};
use luthier_texture::{exr, ktx2, png, radiance, table};

/// Sides that are promised: around 2^31 and 2^32, the side limit, and what fits it but not the limit on bytes.
const SIDES: [[u32; 2]; 8] = [
    [1 << 31, 1 << 31],
    [(1 << 31) - 1, (1 << 31) - 1],
    [u32::MAX, u32::MAX],
    [u32::MAX, 1],
    [1, 1 << 31],
    [1 << 16, 1 << 16],
    [16_385, 1],
    [16_384, 16_384],
];

/// Bytes that a refusal may take: buffers of decoders, and the message.
const REFUSAL_MAX: usize = 1 << 20;

fn input(name: &str, file: &str) -> Vec<u8> {
    let inputs = corpus(target(name).unwrap()).unwrap();
    inputs.into_iter().find(|input| input.path.ends_with(file)).unwrap().bytes
}

fn put(file: &mut [u8], at: usize, bytes: &[u8]) {
    file[at..at + bytes.len()].copy_from_slice(bytes);
}

/// A file with a header that promises another size.
fn promising([width, height]: [u32; 2], file: &[u8]) -> Vec<u8> {
    let mut out = file.to_vec();
    if file.starts_with(b"DDS ") {
        put(&mut out, 12, &height.to_le_bytes());
        put(&mut out, 16, &width.to_le_bytes());
    } else if file.starts_with(b"\xabKTX") {
        put(&mut out, 20, &width.to_le_bytes());
        put(&mut out, 24, &height.to_le_bytes());
        // The length of the texels agrees with it.
        let bytes = u64::from(width).wrapping_mul(height.into()).wrapping_mul(8);
        put(&mut out, 96, &bytes.to_le_bytes());
    } else if file.starts_with(b"\x89PNG") {
        put(&mut out, 16, &width.to_be_bytes());
        put(&mut out, 20, &height.to_be_bytes());
        out = with_sums(&out);
    } else if file.starts_with(b"#?") {
        out = format!("#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n").into_bytes();
        out.extend([128; 64]);
    } else {
        for name in [&b"dataWindow\0box2i\0"[..], b"displayWindow\0box2i\0"] {
            let at = file.windows(name.len()).position(|part| part == name).unwrap() + name.len() + 4;
            let last = |side: u32| side.wrapping_sub(1).to_le_bytes();
            put(&mut out, at, &[0; 8]);
            put(&mut out, at + 8, &[last(width), last(height)].concat());
        }
    }
    out
}

type Refuses = fn(&[u8]) -> bool;

#[test]
fn promises_beyond_the_limits_take_no_memory() {
    let refuses: [(&str, &str, Refuses); 12] = [
        ("ktx2", "b-fresnel.ktx2", |file| ktx2::decode(file).is_err()),
        ("png", "c6-8.png", |file| png::decode(file).is_err()),
        ("png", "c0-16.png", |file| png::decode(file).is_err()),
        ("png", "palette-1.png", |file| png::decode(file).is_err()),
        ("exr", "zip-float.exr", |file| exr::decode(file).is_err()),
        ("radiance", "zip-half.exr", |file| radiance::decode(file).is_err()),
        ("radiance", "tiled.exr", |file| radiance::decode(file).is_err()),
        ("radiance", "flat.hdr", |file| radiance::decode(file).is_err()),
        ("table", "dxgi-34.dds", |file| table::read(file).is_err()),
        ("ktx2", "b-fresnel.ktx2", |file| table::read(file).is_err()),
        ("png", "c6-8.png", |file| table::read(file).is_err()),
        ("table", "zip-half.exr", |file| table::read(file).is_err()),
    ];
    for (folder, name, is_refused) in refuses {
        let file = input(folder, name);
        assert!(!is_refused(&file), "{name} is not read as it is");
        for sides in SIDES {
            let promising = promising(sides, &file);
            eprintln!("{name} with {sides:?}");
            assert!(holding(REFUSAL_MAX, || is_refused(&promising)), "{name} with {sides:?}");
        }
    }
}
