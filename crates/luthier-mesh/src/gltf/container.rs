//! Text and bytes of a file: glTF text is JSON, binary glTF holds chunks of JSON and bytes.

use crate::MeshError;

/// The parts of a file.
#[derive(Debug)]
pub(super) struct Container<'a> {
    pub(super) json: &'a [u8],
    /// The bytes of the first buffer, in a binary file.
    pub(super) blob: Option<&'a [u8]>,
}

/// Splits a file. Chunks of other kinds are skipped, and so are bytes after the last chunk. The stated length of the
/// whole file does not count: the lengths of the chunks are enough.
///
/// # Errors
/// [`MeshError::Version`] and [`MeshError::Gltf`].
pub(super) fn split(bytes: &[u8]) -> Result<Container<'_>, MeshError> {
    let Some(rest) = bytes.strip_prefix(b"glTF") else {
        return Ok(Container { json: json(bytes)?, blob: None });
    };
    let version = word(rest, 0).ok_or_else(ends)?;
    if version != 2 {
        return Err(MeshError::Version(version.to_string()));
    }
    let chunks = rest.get(8..).ok_or_else(ends)?;
    let Some((b"JSON", text, mut rest)) = chunk(chunks)? else {
        return Err(MeshError::Gltf("its first chunk is not JSON".to_owned()));
    };
    let text = text.trim_ascii_end();
    let zeros = text.iter().rev().take_while(|&&byte| byte == 0).count();
    let json = json(&text[..text.len() - zeros])?;
    while !rest.is_empty() {
        match chunk(rest) {
            Ok(Some((b"BIN\0", blob, _))) => return Ok(Container { json, blob: Some(blob) }),
            Ok(Some((_, _, behind))) => rest = behind,
            Ok(None) => break,
            Err(error) if rest[4..8] == *b"BIN\0" => return Err(error),
            Err(_) => break,
        }
    }
    Ok(Container { json, blob: None })
}

fn ends() -> MeshError {
    MeshError::Gltf("it ends in its header".to_owned())
}

/// Checks that a text is UTF-8 and begins as an object does.
fn json(bytes: &[u8]) -> Result<&[u8], MeshError> {
    if bytes.starts_with(&[0xff, 0xfe]) || bytes.starts_with(&[0xfe, 0xff]) {
        return Err(MeshError::Gltf("its text is in UTF-16: save it as UTF-8".to_owned()));
    }
    let text = bytes.strip_prefix(b"\xef\xbb\xbf").unwrap_or(bytes);
    if text.trim_ascii_start().first() != Some(&b'{') {
        return Err(MeshError::Gltf(
            "it begins neither with `{`, as text does, nor with `glTF`, as binary files do".to_owned(),
        ));
    }
    Ok(text)
}

/// Kind and bytes of the first chunk, and the bytes after it. `None` if the bytes are too few for the head of a chunk.
#[expect(clippy::type_complexity, reason = "three parts of one slice")]
fn chunk(bytes: &[u8]) -> Result<Option<(&[u8; 4], &[u8], &[u8])>, MeshError> {
    let (Some(length), Some((head, body))) = (word(bytes, 0), bytes.split_at_checked(8)) else { return Ok(None) };
    let length = length as usize;
    let Some((data, rest)) = body.split_at_checked(length) else {
        return Err(MeshError::Gltf(format!("it is cut off: a chunk states {length} bytes, and has {}", body.len())));
    };
    // Lengths are multiples of four by the format. Some writers pad their chunks and state the length without.
    let padding = rest.len().min(length.next_multiple_of(4) - length);
    let padded = rest[..padding].iter().all(|byte| matches!(byte, 0 | b' '));
    Ok(head[4..].first_chunk().map(|kind| (kind, data, if padded { &rest[padding..] } else { rest })))
}

fn word(bytes: &[u8], at: usize) -> Option<u32> {
    bytes.get(at..)?.first_chunk().map(|word| u32::from_le_bytes(*word))
}
