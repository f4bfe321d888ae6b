//! Decoder of pictures, with checks of the keys that fit their use.

use crate::diagnostic::Sink;
use crate::picture::{Channel, PictureRef, TexelUse, UvTransform};
use crate::section::{Numbers, Section};
use crate::suggest::short;

/// The picture under a key: a path alone, or a table.
pub(super) fn under(at: &Section<'_>, key: &str) -> Option<PictureRef> {
    match at.path(key) {
        Some(path) => Some(PictureRef::plain(path)),
        None => of(&at.section(key)?),
    }
}

/// The picture of a table.
pub(super) fn of(at: &Section<'_>) -> Option<PictureRef> {
    let channel = at.text("channel").and_then(|name| Channel::ALL.into_iter().find(|channel| channel.name() == name));
    let transform = at.section("transform").map(|at| UvTransform {
        offset: at.two_numbers("offset").unwrap_or([0.0; 2]),
        rotation: at.number("rotation_deg").unwrap_or(0.0).to_radians(),
        scale: at.two_numbers("scale").unwrap_or([1.0; 2]),
    });
    Some(PictureRef {
        path: at.path("image")?,
        channel,
        srgb: at.flag("srgb"),
        scale: at.number("scale").unwrap_or(1.0),
        transform,
    })
}

/// Refuses keys that do not fit the use of the texels. `at` is the table of the picture.
pub(super) fn check(at: &Section<'_>, texels: TexelUse, sink: &mut Sink<'_>) {
    let mut refuse = |key: &str, message: String, hint: &str| {
        if at.has(key) {
            sink.error(at.key_span(key), message, Some(hint.to_owned()));
        }
    };
    let vector = match texels {
        TexelUse::Normal => Some("a normal"),
        TexelUse::Direction => Some("a direction"),
        TexelUse::Number | TexelUse::Color => None,
    };
    if let Some(vector) = vector {
        refuse("channel", format!("{vector} takes more than one channel"), "leave `channel` out");
        if at.flag("srgb") == Some(true) {
            let hint = "store the texels as they are, and leave `srgb` out";
            refuse("srgb", format!("{vector} is no colour: its texels have no sRGB curve"), hint);
        }
    }
    match (texels, at.number("scale")) {
        (TexelUse::Direction, Some(_)) => {
            refuse("scale", "a direction has no scale".to_owned(), "leave `scale` out");
        }
        (TexelUse::Number | TexelUse::Color, Some(scale)) if scale > 1.0 => {
            let message = format!("`scale` must be at most 1, found {}: texels are from 0 to 1", short(scale));
            refuse("scale", message, "make the number that the texels multiply larger instead");
        }
        _ => {}
    }
    if let Some(transform) = at.section("transform")
        && let Some(Numbers::Many(scale)) = transform.numbers("scale")
        && scale.contains(&0.0)
    {
        let hint = "write 1 for a side that repeats as the texture coordinates do".to_owned();
        sink.error(transform.value_span("scale"), "a factor of 0 leaves one texel of the picture", Some(hint));
    }
}

/// Refuses keys that say how a picture is read where there is none.
pub(super) fn check_absent(at: &Section<'_>, sink: &mut Sink<'_>) {
    for key in ["channel", "srgb", "scale", "transform"].into_iter().filter(|key| at.has(key)) {
        let message = format!("`{key}` says how a picture is read, and there is none");
        sink.error(at.key_span(key), message, Some("leave it out, or give an `image`".to_owned()));
    }
}
