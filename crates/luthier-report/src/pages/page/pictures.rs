//! Pictures of a material, inside the page.

use std::fmt::Write;

use crate::Exhibit;
use crate::judge::report::MaterialReport;
use crate::pages::format::{error, escape};

pub(super) fn write(out: &mut String, material: &MaterialReport, exhibits: &[Exhibit]) {
    if exhibits.is_empty() {
        return;
    }
    out.push_str("<div class=\"pictures\">");
    for exhibit in exhibits {
        let caption = escape(&exhibit.caption);
        let _ = write!(
            out,
            "<figure><img alt=\"{}: {caption}\" src=\"data:image/png;base64,{}\"/><figcaption>{caption}</figcaption></figure>",
            escape(&material.name),
            base64(&exhibit.png)
        );
    }
    out.push_str("</div>");
    if let Some(p) = &material.picture {
        let _ = write!(
            out,
            "<p class=\"note\">Baked against full: FLIP {} mean, {} largest; CIEDE2000 {} mean, {} largest; linear radiance {} RMS, {} \
             largest. The full form computes at three wavelengths and takes films at their nominal thickness. The differences therefore include the colour \
             error of three wavelengths, and the thickness maps of films.</p>",
            error(p.flip_mean),
            error(p.flip_max),
            error(p.delta_e_mean),
            error(p.delta_e_max),
            error(p.rms_err),
            error(p.max_abs_err)
        );
    }
}

/// RFC 4648, with padding.
pub(super) fn base64(bytes: &[u8]) -> String {
    const DIGITS: &[u8; 64] = b"ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    let mut out = String::with_capacity(bytes.len().div_ceil(3) * 4);
    for chunk in bytes.chunks(3) {
        let at = |i: usize| u32::from(chunk.get(i).copied().unwrap_or(0));
        let bits = at(0) << 16 | at(1) << 8 | at(2);
        for digit in 0..4 {
            let index = (bits >> (18 - 6 * digit)) & 63;
            out.push(if digit <= chunk.len() { char::from(DIGITS[index as usize]) } else { '=' });
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::base64;

    /// The test vectors of RFC 4648, section 10, and bytes that use the last digits.
    #[test]
    fn base64_of_the_standard() {
        let cases = ["", "", "f", "Zg==", "fo", "Zm8=", "foo", "Zm9v", "foob", "Zm9vYg==", "foobar", "Zm9vYmFy"];
        for pair in cases.chunks(2) {
            assert_eq!(base64(pair[0].as_bytes()), pair[1]);
        }
        assert_eq!(base64(&[0xfb, 0xff, 0xbf]), "+/+/");
    }
}
