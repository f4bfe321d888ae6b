//! Zstandard (RFC 8878), one frame with a checksum.

use ruzstd::decoding::{BlockDecodingStrategy, FrameDecoder};
use ruzstd::encoding::{CompressionLevel, compress_to_vec};

use crate::error::{Container, TextureError};

/// Decoded bytes that the decoder may run ahead of the reader.
const STEP_BYTES: usize = 1 << 20;
/// Least window that a frame may ask for. RFC 8878 asks every decoder for 8 MiB; a frame without a window has its
/// content as one.
const MIN_WINDOW_BYTES: u64 = 8 << 20;

/// Compresses at the encoder's only compressing level, and checks that the result decompresses.
pub(crate) fn compress(bytes: &[u8]) -> Result<Vec<u8>, TextureError> {
    let compressed = compress_to_vec(bytes, CompressionLevel::Fastest);
    if decompress(&compressed, bytes.len())? == bytes {
        Ok(compressed)
    } else {
        Err(TextureError::malformed(Container::Ktx2, "the zstd encoder made a frame that decodes differently"))
    }
}

/// Decompresses one frame of exactly `expected` bytes. Memory follows the decoded bytes, not the promised ones.
pub(crate) fn decompress(mut source: &[u8], expected: usize) -> Result<Vec<u8>, TextureError> {
    let mut decoder = FrameDecoder::new();
    decoder.set_max_window_size(MIN_WINDOW_BYTES.max(expected as u64));
    decoder.init(&mut source)?;
    let mut bytes = Vec::new();
    while !decoder.is_finished() && bytes.len() <= expected {
        decoder.decode_blocks(&mut source, BlockDecodingStrategy::UptoBytes(STEP_BYTES))?;
        if let Some(part) = decoder.collect() {
            bytes.extend_from_slice(&part);
        }
    }
    if bytes.len() != expected || !source.is_empty() {
        return Err(TextureError::malformed(Container::Ktx2, format!("zstd data is not {expected} bytes")));
    }
    match (decoder.get_checksum_from_data(), decoder.get_calculated_checksum()) {
        (Some(stored), Some(actual)) if stored != actual => {
            Err(TextureError::malformed(Container::Ktx2, "the zstd checksum does not match"))
        }
        _ => Ok(bytes),
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// `printf 'luthier luthier luthier luthier ' | zstd -19` by the reference implementation, 1.5.4.
    const REFERENCE_FRAME: [u8; 27] = [
        0x28, 0xb5, 0x2f, 0xfd, 0x04, 0x68, 0x75, 0x00, 0x00, 0x40, 0x6c, 0x75, 0x74, 0x68, 0x69, 0x65, 0x72, 0x20,
        0x01, 0x00, 0xc1, 0xcb, 0x05, 0x89, 0xfe, 0x2b, 0x49,
    ];

    #[test]
    fn reads_the_reference_implementation() {
        assert_eq!(decompress(&REFERENCE_FRAME, 32).unwrap(), b"luthier luthier luthier luthier ");
    }

    #[test]
    fn a_wrong_checksum_is_an_error() {
        let mut frame = REFERENCE_FRAME;
        frame[26] ^= 1;
        assert!(matches!(decompress(&frame, 32), Err(TextureError::Malformed { .. })));
    }

    #[test]
    fn another_length_is_an_error() {
        let frame = compress(&[7; 100]).unwrap();
        for expected in [0, 99, 101] {
            assert!(decompress(&frame, expected).is_err());
        }
        let trailing = [frame.as_slice(), &[0]].concat();
        assert!(decompress(&trailing, 100).is_err());
    }

    #[test]
    fn a_bomb_stops_at_the_promised_length() {
        let frame = compress(&vec![0; 64 << 20]).unwrap();
        assert!(frame.len() < 64 << 10, "{}", frame.len());
        assert!(decompress(&frame, 1000).is_err());
    }

    proptest! {
        #[test]
        fn round_trip(bytes in prop::collection::vec(any::<u8>(), 0..2000), repeat in 1..200usize) {
            let bytes = bytes.repeat(repeat);
            prop_assert_eq!(decompress(&compress(&bytes)?, bytes.len())?, bytes);
        }
    }
}
