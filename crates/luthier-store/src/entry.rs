//! An entry as bytes: address, and a hash that finds damage.

use luthier_bake::Key;

/// First bytes of every entry, with the version of its form.
const MAGIC: &[u8; 8] = b"LUTHST01";

/// Bytes before the result: the magic, the address, and the hash of the result.
const HEADER: usize = MAGIC.len() + 32 + 32;

/// The bytes of an entry.
pub(crate) fn pack(address: Key, result: &[u8]) -> Vec<u8> {
    let mut bytes = Vec::with_capacity(HEADER + result.len());
    bytes.extend_from_slice(MAGIC);
    bytes.extend_from_slice(address.bytes());
    bytes.extend_from_slice(Key::of(result).bytes());
    bytes.extend_from_slice(result);
    bytes
}

/// The result in an entry; `None` if the entry is damaged, of another address, or of another form.
pub(crate) fn unpack(address: Key, bytes: &[u8]) -> Option<&[u8]> {
    let (header, result) = bytes.split_at_checked(HEADER)?;
    let expected = [MAGIC.as_slice(), address.bytes(), Key::of(result).bytes()].concat();
    (header == expected).then_some(result)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_damaged_byte_is_found() {
        let address = Key::of(b"job");
        let whole = pack(address, b"result");
        assert_eq!(unpack(address, &whole), Some(&b"result"[..]));
        assert_eq!(unpack(Key::of(b"another job"), &whole), None);
        for i in 0..whole.len() {
            let mut damaged = whole.clone();
            damaged[i] ^= 1;
            assert_eq!(unpack(address, &damaged), None, "byte {i}");
            assert_eq!(unpack(address, &whole[..i]), None, "{i} bytes");
        }
    }
}
