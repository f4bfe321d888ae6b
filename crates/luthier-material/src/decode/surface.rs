//! Decoder of micro-surfaces; roughness and slope angles become slope parameters here.

use luthier_optics::stack::{Distribution, Surface};

use crate::diagnostic::Sink;
use crate::section::{Numbers, Section};

/// Exponents of the lobes of the outer boundary and of the inner one, for the model `granier-heidrich`.
pub(super) fn exponents(at: &Section<'_>) -> Option<[f64; 2]> {
    match at.numbers("exponents")? {
        Numbers::Many(list) => <[f64; 2]>::try_from(list).ok(),
        Numbers::One(_) => None,
    }
}

/// The micro-surface of a layer, in whichever way the file gives it.
pub(super) fn decode(at: &Section<'_>, sink: &mut Sink<'_>) -> Surface {
    let distribution = at.text("distribution").and_then(Distribution::from_name).unwrap_or_default();
    if let (Some(alpha_x), Some(alpha_y)) = (at.number("alpha_x"), at.number("alpha_y")) {
        let rotation = at.number("rotation_deg").unwrap_or(0.0).to_radians();
        return Surface { distribution, alpha_x, alpha_y, rotation };
    }
    if at.has("rotation_deg") && !at.has("alpha_x") && !at.has("alpha_y") {
        let hint = "give `alpha_x` and `alpha_y`, or leave it out".to_owned();
        sink.error(at.key_span("rotation_deg"), "`rotation_deg` turns an anisotropic surface only", Some(hint));
    }
    let alpha = if let Some([outer, _]) = exponents(at) {
        libm::sqrt(2.0 / (outer + 2.0))
    } else if let Some(roughness) = at.number("roughness") {
        roughness * roughness
    } else if let Some(slope_deg) = at.number("slope_deg") {
        // tan 45 degrees is 1 up to rounding.
        libm::tan(slope_deg.to_radians()).clamp(0.0, 1.0)
    } else {
        at.number("alpha").unwrap_or(0.0)
    };
    Surface::isotropic(distribution, alpha)
}
