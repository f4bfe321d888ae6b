//! Decoder of the re-radiation matrix of a fluorescent base.

use luthier_optics::Rgb;
use luthier_optics::reradiation::{Matrix, rgb};

use super::ior::{Read, named_text};
use crate::diagnostic::Sink;
use crate::section::Section;

/// Rows of the matrix of a base in linear Rec.709; `None` if it names no matrix, or a wrong one.
pub(super) fn decode(at: &Section<'_>, read: Read<'_>, sink: &mut Sink<'_>) -> Option<[Rgb; 3]> {
    let name = at.text("reradiation")?;
    let span = at.value_span("reradiation");
    if at.number("sigma").is_some_and(|sigma| sigma != 0.0) {
        let hint = "remove `sigma`: a fluorescent base is Lambert's".to_owned();
        sink.error(at.key_span("sigma"), "a base with `reradiation` has no slopes", Some(hint));
    }
    let text = named_text(name, &span, read, sink)?;
    match Matrix::parse(&text) {
        Ok(matrix) => Some(rgb(&matrix)),
        Err(error) => {
            let hint = "the first row has the wavelengths of the light, each row below a wavelength that comes out and its shares";
            sink.error(span, format!("`{name}`{error}"), Some(hint.to_owned()));
            None
        }
    }
}

/// The colour of a base under white light, clamped to the range of an albedo.
pub(super) fn albedo(rows: [Rgb; 3]) -> Rgb {
    rows.map(|row| row.iter().sum::<f64>().clamp(0.0, 1.0))
}
