//! Images and textures.

use luthier_lut::Image;
use luthier_texture::{
    MAX_BYTES, Samples, TextureError, exr as openexr, ktx2 as khronos, picture as pictures, png as portable,
    radiance as light, table as tables,
};

/// First bytes of a PNG file.
const SIGNATURE: &[u8] = b"\x89PNG\r\n\x1a\n";

/// Values of the largest image that is written again. Larger ones would take the time of the others.
const WRITTEN_MAX: usize = 1 << 16;

/// A texture of a bake.
pub(super) fn ktx2(bytes: &[u8]) {
    let Some(texture) = read(khronos::decode(bytes)) else { return };
    if let Some(image) = read(texture.image()) {
        is_whole(&image);
    }
    if texture.bytes.len() <= WRITTEN_MAX {
        for encode in [khronos::encode, khronos::encode_plain] {
            let written = encode(&texture).unwrap_or_else(|error| panic!("read, but not written: {error}"));
            assert_eq!(khronos::decode(&written).ok().as_ref(), Some(&texture));
        }
    }
}

/// An image of a bake.
pub(super) fn exr(bytes: &[u8]) {
    let Some((image, _)) = read(openexr::decode(bytes)) else { return };
    is_whole(&image);
    if image.data.len() > WRITTEN_MAX {
        return;
    }
    let names = ["R", "G", "B", "A"];
    let written = openexr::encode(&image, &names[..image.channels as usize], &Vec::new())
        .unwrap_or_else(|error| panic!("read, but not written: {error}"));
    let Ok((again, _)) = openexr::decode(&written) else { panic!("written, but not read") };
    assert_eq!(bits(&again), bits(&image));
}

/// A map. Its checksums are corrected first: nearly every change breaks one, and the parser would stop there.
pub(super) fn png(bytes: &[u8]) {
    assert!(bytes.starts_with(SIGNATURE) || portable::decode(bytes).is_err());
    let bytes = &with_sums(bytes);
    if let Some(image) = read(portable::decode(bytes)) {
        is_whole(&image);
        assert!(image.channels == 4 && image.data.iter().all(|value| (0.0..=1.0).contains(value)));
    }
    round_trip(bytes);
}

/// A map of any of its formats.
pub(super) fn picture(bytes: &[u8]) {
    round_trip(bytes);
}

/// Checks that a picture is written as PNG with equal samples.
fn round_trip(bytes: &[u8]) {
    let Some(pictures::Decoded { picture, .. }) = read(pictures::decode(bytes)) else { return };
    let values = picture.texel_count() * picture.channels as usize;
    assert!((1..=4).contains(&picture.channels) && (values == 0 || picture.stored(values - 1).is_finite()));
    if values <= WRITTEN_MAX {
        let written =
            portable::encode_picture(&picture).unwrap_or_else(|error| panic!("read, but not written: {error}"));
        let Ok(again) = pictures::decode(&written) else { panic!("written, but not read") };
        assert!(again.picture == picture);
    }
}

/// A picture of an environment.
pub(super) fn radiance(bytes: &[u8]) {
    if let Some(picture) = read(light::decode(bytes)) {
        is_whole(&picture.image);
        assert!(picture.image.channels == 3 && picture.notes.iter().all(|note| !note.is_empty()));
    }
}

/// A table of another maker.
pub(super) fn table(bytes: &[u8]) {
    if let Some(table) = read(tables::read(&with_sums(bytes))) {
        is_whole(&table.image);
        assert!(!table.format.is_empty() && table.samples.step() > 0.0);
    }
}

/// Values without a header. Five bytes state width, height, channels and kind, and the file follows.
pub(super) fn raw(bytes: &[u8]) {
    let Some((&[width, height, channels, kind, shift], file)) = bytes.split_first_chunk() else { return };
    let kinds = [Samples::Unorm8, Samples::Unorm10, Samples::Unorm16, Samples::Half, Samples::Float];
    let [width, height] =
        [width, height].map(|side| u32::from(side).checked_shl((shift % 40).into()).unwrap_or(u32::MAX));
    let samples = kinds[usize::from(kind) % kinds.len()];
    if let Some(table) = read(tables::raw(file, width, height, (channels % 8).into(), samples)) {
        is_whole(&table.image);
    }
}

/// The value as read; `None` if it was refused with a message.
fn read<T>(result: Result<T, TextureError>) -> Option<T> {
    result.inspect_err(|error| assert!(!error.to_string().is_empty())).ok()
}

fn is_whole(image: &Image) {
    let texels = u64::from(image.width) * u64::from(image.height) * u64::from(image.channels);
    assert!(
        (1..=4).contains(&image.channels) && image.data.len() as u64 == texels,
        "{} x {}",
        image.width,
        image.height
    );
    assert!(4 * texels <= 4 * MAX_BYTES);
}

fn bits(image: &Image) -> Vec<u32> {
    image.data.iter().map(|value| value.to_bits()).collect()
}

/// A PNG file with correct checksums of its chunks; other bytes as they are.
///
/// ```
/// let whole = luthier_texture::png::encode_rgb(1, 1, &[0; 3]).unwrap();
/// let mut broken = whole.clone();
/// broken[29] ^= 1; // the checksum of the header
/// assert_eq!(luthier_fuzz::with_sums(&broken), whole);
/// ```
pub fn with_sums(bytes: &[u8]) -> Vec<u8> {
    let mut bytes = bytes.to_vec();
    let mut at = SIGNATURE.len();
    while let Some(length) =
        bytes.get(at..).filter(|_| bytes.starts_with(SIGNATURE)).and_then(|rest| rest.first_chunk())
    {
        let end = (u32::from_be_bytes(*length) as usize).saturating_add(at + 8);
        let Some(body) = bytes.get(at + 4..end) else { break };
        let sum = crc32(body).to_be_bytes();
        let Some(place) = bytes.get_mut(end..end + 4) else { break };
        place.copy_from_slice(&sum);
        at = end + 4;
    }
    bytes
}

/// CRC-32 of ISO 3309, bit by bit.
fn crc32(bytes: &[u8]) -> u32 {
    !bytes.iter().fold(!0, |sum, byte| {
        (0..8).fold(sum ^ u32::from(*byte), |sum, _| if sum & 1 == 1 { sum >> 1 ^ 0xedb8_8320 } else { sum >> 1 })
    })
}
