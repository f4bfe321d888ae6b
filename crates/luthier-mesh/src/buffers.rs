//! Buffers of a glTF file: in the file, in its text, or in files beside it.

use std::io;

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};
use gltf::buffer::Source;

use crate::MeshError;

/// The bytes of all buffers. `files` reads a file beside the glTF file by its relative path.
pub(crate) fn buffers(
    document: &gltf::Document,
    blob: Option<&[u8]>,
    files: &dyn Fn(&str) -> io::Result<Vec<u8>>,
) -> Result<Vec<Vec<u8>>, MeshError> {
    let mut all = Vec::new();
    for buffer in document.buffers() {
        let (name, bytes) = match buffer.source() {
            Source::Bin => ("(binary chunk)", blob.map(<[u8]>::to_vec).ok_or("the file has none".to_owned())),
            Source::Uri(uri) => (uri, of_uri(uri, files)),
        };
        let short = |bytes: Vec<u8>| {
            let (has, wants) = (bytes.len(), buffer.length());
            if has < wants { Err(format!("it has {has} bytes of {wants}")) } else { Ok(bytes) }
        };
        let refused = |reason| MeshError::Buffer { uri: shortened(name), reason };
        all.push(bytes.and_then(short).map_err(refused)?);
    }
    Ok(all)
}

/// Padding may be there or not.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

fn of_uri(uri: &str, files: &dyn Fn(&str) -> io::Result<Vec<u8>>) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (_, text) = data.split_once(";base64,").ok_or("data that are not in base 64")?;
        return BASE64.decode(text).map_err(|_| "broken base 64".to_owned());
    }
    let path = percent_decoded(uri).ok_or("broken percent signs")?;
    let is_elsewhere =
        path.contains(':') || path.contains('\\') || path.starts_with('/') || path.split('/').any(|part| part == "..");
    if is_elsewhere {
        return Err("only files beside the glTF file, or below, are read".to_owned());
    }
    files(&path).map_err(|error| error.to_string())
}

/// A name that may be megabytes of data.
fn shortened(uri: &str) -> String {
    if uri.chars().count() <= 64 { uri.to_owned() } else { uri.chars().take(61).chain("...".chars()).collect() }
}

fn percent_decoded(uri: &str) -> Option<String> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, tail)) = rest.split_first() {
        rest = tail;
        if byte == b'%' {
            let digits = std::str::from_utf8(tail.get(..2)?).ok()?;
            bytes.push(u8::from_str_radix(digits, 16).ok()?);
            rest = &tail[2..];
        } else {
            bytes.push(byte);
        }
    }
    String::from_utf8(bytes).ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_beside_are_read() {
        let seen = |path: &str| Ok(path.as_bytes().to_vec());
        assert_eq!(of_uri("a%20b/c.bin", &seen).unwrap(), b"a b/c.bin");
        for uri in ["/etc/passwd", "../x.bin", "a/../../x", "http://x/y.bin", "%2Fetc", "c:\\x", "%zz", "data:,x"] {
            assert!(of_uri(uri, &seen).is_err(), "{uri}");
        }
    }
}
