//! Decoder of micro-surfaces; roughness and slope angles become slope parameters here.

use luthier_optics::ndf::{NdfError, Shape};
use luthier_optics::stack::{Distribution, Surface};

use crate::diagnostic::Sink;
use crate::section::Section;

/// Exponents of the lobes of the outer boundary and of the inner one, for the model `granier-heidrich`.
pub(super) fn exponents(at: &Section<'_>) -> Option<[f64; 2]> {
    at.two_numbers("exponents")
}

/// The micro-surface of a layer, in whichever way the file gives it.
pub(super) fn decode(at: &Section<'_>, sink: &mut Sink<'_>) -> Surface {
    let distribution = at.text("distribution").and_then(Distribution::from_name).unwrap_or_default();
    check(at, distribution, sink);
    if let Some(surface) = shaped(at, sink) {
        return surface;
    }
    if let (Some(alpha_x), Some(alpha_y)) = (at.number("alpha_x"), at.number("alpha_y")) {
        let rotation = at.number("rotation_deg").unwrap_or(0.0).to_radians();
        return Surface { distribution, alpha_x, alpha_y, rotation };
    }
    let alpha = if let Some([outer, _]) = exponents(at) {
        libm::sqrt(2.0 / (outer + 2.0))
    } else if let Some(roughness) = at.number("roughness") {
        roughness * roughness
    } else if let Some(slope_deg) = at.number("slope_deg") {
        // tan 45 degrees is 1 up to rounding.
        libm::tan(slope_deg.to_radians()).clamp(0.0, 1.0)
    } else if let Some(exponent) = at.number("exponent") {
        libm::sqrt(2.0 / (exponent + 2.0))
    } else {
        at.number("alpha").unwrap_or(0.0)
    };
    Surface::isotropic(distribution, alpha)
}

/// Reports keys that do not go together.
fn check(at: &Section<'_>, distribution: Distribution, sink: &mut Sink<'_>) {
    if at.has("rotation_deg") && !at.has("alpha_x") && !at.has("alpha_y") {
        let hint = "give `alpha_x` and `alpha_y`, or leave it out".to_owned();
        sink.error(at.key_span("rotation_deg"), "`rotation_deg` turns an anisotropic surface only", Some(hint));
    }
    if distribution == Distribution::Blinn && at.has("alpha_x") {
        let hint = "give `alpha` or `exponent`, or take the distribution `beckmann`".to_owned();
        sink.error(at.key_span("alpha_x"), "the distribution `blinn` is isotropic: a power of one cosine", Some(hint));
    }
    if distribution != Distribution::Blinn && at.has("exponent") {
        let hint = "write `distribution = \"blinn\"` beside it, or give `alpha`".to_owned();
        sink.error(at.key_span("exponent"), "`exponent` is a parameter of the distribution `blinn`", Some(hint));
    }
    if let Some(key) = ["abc", "sgd"].into_iter().find(|key| at.has(key) && at.has("distribution")) {
        let message = format!("`{key}` is a distribution by itself, and `distribution` names another");
        sink.error(at.key_span("distribution"), message, Some("leave it out".to_owned()));
    }
}

/// The surface of a distribution that has parameters of its own; alpha follows from these.
fn shaped(at: &Section<'_>, sink: &mut Sink<'_>) -> Option<Surface> {
    type Shaped = (&'static str, [&'static str; 2], fn(f64, f64) -> Result<Shape, NdfError>, fn(Shape) -> Distribution);
    let known: [Shaped; 2] =
        [("abc", ["b", "c"], Shape::abc, Distribution::Abc), ("sgd", ["alpha", "p"], Shape::sgd, Distribution::Sgd)];
    let (key, [first, second], shape, distribution) = known.into_iter().find(|(key, ..)| at.has(key))?;
    let parameters = at.section(key)?;
    match shape(parameters.number(first)?, parameters.number(second)?) {
        Ok(shape) => Some(Surface::isotropic(distribution(shape), shape.alpha())),
        // A parameter outside its range is reported already.
        Err(_) if sink.has_error_in(&at.value_span(key)) => None,
        Err(error) => {
            let hint = match error {
                NdfError::TooWide { .. } => format!("take a smaller `{first}` or a larger `{second}`"),
                _ => format!("take a larger `{first}` or a smaller `{second}`"),
            };
            sink.error(at.value_span(key), format!("`{key}`: {error}"), Some(hint));
            None
        }
    }
}
