//! Grammar of pictures: one spelling wherever a file names one.

use super::table::{ANY, Key, Kind, NOT_NEGATIVE, PATH, Table};

/// A path alone, or a table with the path as `image`.
pub(crate) const PICTURE: Kind = Kind::OneOf(&[PATH, Kind::Table(&PICTURE_TABLE)]);

const CHANNELS: &[&str] = &["r", "g", "b", "a"];

pub(crate) const CHANNEL: Key = Key::optional(
    "channel",
    Kind::Choice(CHANNELS),
    "The channel that is taken alone; of a coloured picture one number is its red, with a warning.",
);

pub(crate) const SRGB: Key = Key::with_default(
    "srgb",
    Kind::Flag,
    "false",
    "Whether colours are stored by the sRGB curve; textures of colour usually are, those of numbers are not.",
);

pub(crate) const SCALE: Key = Key::with_default(
    "scale",
    Kind::Number(NOT_NEGATIVE),
    "1",
    "Factor on the linear texels, at most 1; on the slope of a normal any number.",
);

pub(crate) const TRANSFORM: Key =
    Key::optional("transform", Kind::Table(&UV_TRANSFORM), "Where the picture lies on the surface.");

static PICTURE_TABLE: Table = Table {
    name: "picture",
    doc: "A picture, PNG, JPEG or WebP, and how it is read. A string alone is its path.",
    keys: &[
        Key::required("image", PATH, "Path of the picture, relative to the file that names it."),
        CHANNEL,
        SRGB,
        SCALE,
        TRANSFORM,
    ],
    exactly_one: None,
};

const PAIR: Kind = Kind::List { item: &Kind::Number(ANY), min: 2, max: 2 };

static UV_TRANSFORM: Table = Table {
    name: "uv-transform",
    doc: "Texture coordinates of a picture: those of the surface, scaled, then turned, then moved.",
    keys: &[
        Key::with_default("offset", PAIR, "[0, 0]", "Added to u and v."),
        Key::with_default("rotation_deg", Kind::Number(ANY), "0", "Turn from u towards v in degrees."),
        Key::with_default("scale", PAIR, "[1, 1]", "Factors on u and v: 2 repeats the picture twice as often."),
    ],
    exactly_one: None,
};
