//! Grammar of the section `[effects]`.

use super::layers::VARIATION;
use super::picture::{CHANNEL, PICTURE, SCALE, SRGB, TRANSFORM};
use super::table::{ANY, Alternatives, Key, Kind, NOT_NEGATIVE, PATH, POSITIVE, Range, Table, UNIT, UNIT_RGB};

/// Slope angles of flakes that still lie face up.
const SPREAD_DEG: Range = Range { min: 0.0, max: 45.0, above: true };

pub(super) static EFFECTS: Table = Table {
    name: "effects",
    doc: "Effects on top of the layered model.",
    keys: &[
        Key::optional("flakes", Kind::Table(&FLAKES), "Glints of metal flakes below the first interface."),
        Key::optional("patina", Kind::Table(&PATINA), "Growth of the first layer over the rest."),
        Key::optional("glitter", Kind::Table(&GLITTER), "Particles of the surface that are tilted."),
    ],
    exactly_one: None,
};

/// Tilts of particles that still face the eye.
const TILT_DEG: Range = Range { min: 0.0, max: 45.0, above: true };

static GLITTER: Table = Table {
    name: "glitter",
    doc: "A share of the Voronoi cells of the surface, each tilted its own way (Weidlich and Wilkie 2009, section 5.2.1).",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default("frequency", Kind::Number(POSITIVE), "200", "Cells per unit of texture coordinate."),
        Key::with_default("filled", Kind::Number(UNIT), "0.1", "Share of the cells that glitter."),
        Key::with_default("tilt_deg", Kind::Number(TILT_DEG), "15", "Largest tilt of a glittering cell in degrees."),
    ],
    exactly_one: None,
};

static FLAKES: Table = Table {
    name: "flakes",
    doc: "Metal flakes: normals that are perturbed below the first interface (Elek 2010, section 4.1).",
    keys: &[
        Key::optional("normal_map", PICTURE, "A tangent-space normal map; it is sampled without filtering."),
        Key::optional("height_map", Kind::Table(&FLAKE_HEIGHTS), "Heights of flakes, of which normals are made."),
        Key::optional("cells", Kind::Table(&FLAKE_CELLS), "A grid of cells, each with a random normal."),
        Key::with_default("tiling", Kind::Number(POSITIVE), "1000", "Repeats per unit of texture coordinate."),
        Key::with_default("scale", Kind::Number(NOT_NEGATIVE), "1", "Weight of the flakes' normal."),
        Key::with_default(
            "fade_start",
            Kind::Number(POSITIVE),
            "1",
            "Distance from the eye, in scene units, up to which the flakes keep their full weight.",
        ),
    ],
    exactly_one: Some(Alternatives {
        what: "source of flakes",
        forms: &[&["normal_map"], &["height_map"], &["cells"]],
        examples: "`cells = {}`, `normal_map = \"flakes.png\"` or `height_map = { image = \"heights.png\", height = 0.01 }`",
        together: false,
        and: None,
    }),
};

static FLAKE_HEIGHTS: Table = Table {
    name: "flake-heights",
    doc: "Heights of flakes; a texel has the normal of the differences of its neighbours' heights.",
    keys: &[
        Key::required("image", PATH, "Path of a picture of heights, PNG, JPEG or WebP; it repeats."),
        Key::required(
            "height",
            Kind::Number(POSITIVE),
            "Height of white above black, as a share of the width of the picture.",
        ),
        CHANNEL,
        SRGB,
        SCALE,
        TRANSFORM,
    ],
    exactly_one: None,
};

static FLAKE_CELLS: Table = Table {
    name: "flake-cells",
    doc: "A grid of cells, each with a random normal.",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default("count", Kind::Integer(1, 4096), "64", "Cells along one repeat."),
        Key::with_default(
            "spread_deg",
            Kind::Number(SPREAD_DEG),
            "15",
            "Standard deviation of the flakes' slope angle in degrees.",
        ),
    ],
    exactly_one: None,
};

static PATINA: Table = Table {
    name: "patina",
    doc: "The first layer covers the others only where a map says so (Elek 2010, section 4.2).",
    keys: &[
        Key::required("extent", Kind::Number(ANY), "How far it has developed, from -transition to 1 + transition."),
        Key::required("transition", Kind::Number(UNIT), "Softness of its boundary; 0 is a step."),
        Key::required("map", VARIATION, "Order of development: dark places come first."),
        Key::with_default(
            "diffuse_albedo",
            UNIT_RGB,
            "0",
            "Diffuse reflectance that stands for scattering in the patina.",
        ),
        Key::optional(
            "diffuse_remainder",
            Kind::Number(UNIT),
            "In place of `diffuse_albedo`: this part of what the first layer's absorption leaves over, exp(-absorption_per_um thickness_um).",
        ),
        Key::optional("base_alpha", Kind::Number(UNIT), "Slope parameter of the layer below, where patina has grown."),
        Key::with_default(
            "tarnish",
            UNIT_RGB,
            "1",
            "Factor on the reflection of the layer below, where patina has grown.",
        ),
    ],
    exactly_one: None,
};
