//! Buffers of a glTF file: in the file, in its text, or in files beside it. A buffer is read when its numbers are first
//! needed.

use std::borrow::Cow;
use std::cell::{Cell, OnceCell};
use std::io::{self, ErrorKind};

use base64::Engine;
use base64::alphabet::STANDARD;
use base64::engine::{DecodePaddingMode, GeneralPurpose, GeneralPurposeConfig};

use super::document::{Buffer, Document};
use super::extensions::COMPRESSIONS;
use crate::MeshError;

/// Most bytes of all buffers together.
const BYTES_MAX: usize = 512 << 20;

/// Reads a file beside the glTF file by its relative path.
pub(super) type Files<'a> = &'a dyn Fn(&str) -> io::Result<Vec<u8>>;

/// The buffers of a document.
pub(super) struct Buffers<'a> {
    document: &'a Document,
    blob: Option<&'a [u8]>,
    files: Files<'a>,
    read: Vec<OnceCell<Cow<'a, [u8]>>>,
    held: Cell<usize>,
}

impl<'a> Buffers<'a> {
    pub(super) fn new(document: &'a Document, blob: Option<&'a [u8]>, files: Files<'a>) -> Self {
        let read = document.buffers.iter().map(|_| OnceCell::new()).collect();
        Self { document, blob, files, read, held: Cell::new(0) }
    }

    /// The bytes of a buffer; `None` for a missing number.
    pub(super) fn get(&self, index: usize) -> Result<Option<&[u8]>, MeshError> {
        let (Some(cell), Some(buffer)) = (self.read.get(index), self.document.buffers.get(index)) else {
            return Ok(None);
        };
        if cell.get().is_none() {
            let bytes = self.load(index, buffer)?;
            cell.get_or_init(|| bytes);
        }
        Ok(cell.get().map(|bytes| &bytes[..]))
    }

    fn load(&self, index: usize, buffer: &Buffer) -> Result<Cow<'a, [u8]>, MeshError> {
        let (name, bytes) = match (&buffer.uri, self.blob) {
            (Some(uri), _) => (shortened(uri), of_uri(uri, self.files).map(Cow::Owned)),
            (None, Some(blob)) if index == 0 => ("(binary chunk)".to_owned(), Ok(Cow::Borrowed(blob))),
            (None, _) => {
                if let Some(name) = COMPRESSIONS.iter().find(|name| buffer.extensions.contains_key(**name)) {
                    return Err(MeshError::Compressed((*name).to_owned()));
                }
                (format!("number {index}"), Err("the file does not say where its bytes are".to_owned()))
            }
        };
        let checked = bytes.and_then(|bytes| {
            let (has, wants) = (bytes.len(), buffer.byte_length);
            if has < wants {
                return Err(format!("it has {has} bytes of {wants}"));
            }
            self.held.set(self.held.get() + has);
            if self.held.get() > BYTES_MAX {
                return Err(format!("with it the buffers take more than {} MiB", BYTES_MAX >> 20));
            }
            Ok(bytes)
        });
        checked.map_err(|reason| MeshError::Buffer { uri: name, reason })
    }
}

/// Base 64 with or without padding.
const BASE64: GeneralPurpose = GeneralPurpose::new(
    &STANDARD,
    GeneralPurposeConfig::new().with_decode_padding_mode(DecodePaddingMode::Indifferent),
);

pub(super) fn of_uri(uri: &str, files: Files<'_>) -> Result<Vec<u8>, String> {
    if let Some(data) = uri.strip_prefix("data:") {
        let (kind, text) = data.split_once(',').ok_or("data without a comma")?;
        let bytes = percent_decoded(text);
        if !kind.ends_with(";base64") {
            return Ok(bytes);
        }
        let digits: Vec<u8> = bytes.into_iter().filter(|byte| !byte.is_ascii_whitespace()).collect();
        return BASE64.decode(digits).map_err(|_| "broken base 64".to_owned());
    }
    // Exporters forget to write the percent sign of a name as %25.
    let plain = String::from_utf8(percent_decoded(uri)).unwrap_or_else(|_| uri.to_owned());
    let mut result = beside(&plain, files)?;
    if plain != uri && result.as_ref().is_err_and(|error| error.kind() == ErrorKind::NotFound) {
        result = beside(uri, files)?;
    }
    result.map_err(|error| error.to_string())
}

fn beside(path: &str, files: Files<'_>) -> Result<io::Result<Vec<u8>>, String> {
    let is_elsewhere =
        path.contains(':') || path.contains('\\') || path.starts_with('/') || path.split('/').any(|part| part == "..");
    if is_elsewhere {
        return Err("only files beside the glTF file, or below, are read".to_owned());
    }
    Ok(files(path))
}

/// A name for messages: a `data:` name may have megabytes.
pub(super) fn shortened(uri: &str) -> String {
    if uri.chars().count() <= 64 { uri.to_owned() } else { uri.chars().take(61).chain("...".chars()).collect() }
}

/// Decodes percent signs with two digits; others stay.
fn percent_decoded(uri: &str) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(uri.len());
    let mut rest = uri.as_bytes();
    while let Some((&byte, tail)) = rest.split_first() {
        let digits = tail.get(..2).filter(|pair| byte == b'%' && pair.iter().all(u8::is_ascii_hexdigit));
        let decoded = digits.and_then(|pair| u8::from_str_radix(std::str::from_utf8(pair).ok()?, 16).ok());
        bytes.push(decoded.unwrap_or(byte));
        rest = if decoded.is_some() { &tail[2..] } else { tail };
    }
    bytes
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_files_beside_are_read() {
        let seen = |path: &str| Ok(path.as_bytes().to_vec());
        for (uri, expected) in
            [("a%20b/c.bin", "a b/c.bin"), ("a b.bin", "a b.bin"), ("100%.bin", "100%.bin"), ("%zz", "%zz")]
        {
            assert_eq!(of_uri(uri, &seen).unwrap(), expected.as_bytes());
        }
        for uri in ["/etc/passwd", "../x.bin", "a/../../x", "http://x/y.bin", "%2Fetc", "c:\\x", "%2e%2e/x"] {
            assert!(of_uri(uri, &seen).is_err(), "{uri}");
        }
    }

    /// A name that has a percent sign on the disk, too.
    #[test]
    fn names_that_are_no_codes() {
        let disk = |path: &str| if path == "a%20b.bin" { Ok(vec![7]) } else { Err(ErrorKind::NotFound.into()) };
        assert_eq!(of_uri("a%20b.bin", &disk).unwrap(), [7]);
    }

    /// RFC 2397: any type, any parameters, base 64 or percent signs.
    #[test]
    fn data_in_the_text() {
        let none = |_: &str| Err(ErrorKind::NotFound.into());
        for data in [
            "data:application/octet-stream;base64,AQID",
            "data:model/x;charset=a;base64,AQ ID",
            "data:;base64,AQ%49D",
            "data:,%01%02%03",
        ] {
            assert_eq!(of_uri(data, &none).unwrap(), [1, 2, 3], "{data}");
        }
        assert!(of_uri("data:;base64,*", &none).is_err() && of_uri("data:", &none).is_err());
    }
}
