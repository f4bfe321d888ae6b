//! Grammar of a surface file.

use super::table::{Alternatives, Key, Kind, LAYERS_MAX, PATH, POSITIVE, Range, Table, TextForm, UNIT};

/// Version of the grammar of surfaces.
const SURFACE_VERSION: i64 = 1;

/// Tilts of particles that still face the eye.
const TILT_DEG: Range = Range { min: 0.0, max: 45.0, above: false };

/// Values of noise.
const NOISE_VALUE: Range = Range { min: -1.0, max: 1.0, above: false };

/// Switches of a surface; each is code in the shader.
const SWITCHES_MAX: usize = 16;

/// Material files, each as likely as the others.
const MATERIALS: Kind = Kind::List { item: &PATH, min: 1, max: LAYERS_MAX };

/// The whole file.
pub(crate) static SURFACE: Table = Table {
    name: "surface",
    doc: "A luthier surface: which material is at each place of it.",
    keys: &[
        Key::required("surface", Kind::Integer(SURFACE_VERSION, SURFACE_VERSION), "Version of this grammar."),
        Key::required("name", Kind::Text(TextForm::Name), "Name of the surface: letters, digits and hyphens."),
        Key::optional("description", Kind::Text(TextForm::Prose), "What it is, in a sentence or two."),
        Key::required("cells", Kind::Table(&CELLS), "Grains that cover the surface."),
        Key::optional(
            "switch",
            Kind::List { item: &Kind::Table(&SWITCH), min: 1, max: SWITCHES_MAX },
            "Other grains at some places; where several are, the first of the file is seen.",
        ),
        Key::optional("glitter", Kind::Table(&GLITTER), "Tilted particles on top of them."),
    ],
    exactly_one: None,
};

static CELLS: Table = Table {
    name: "surface-cells",
    doc: "Voronoi cells, each of one of some materials (Weidlich and Wilkie 2009, section 5.2.1).",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default("frequency", Kind::Number(POSITIVE), "20", "Cells per unit of texture coordinate."),
        Key::required(
            "materials",
            MATERIALS,
            "Material files, relative to the surface's, all as likely; one that is named twice is twice as likely.",
        ),
    ],
    exactly_one: None,
};

static SWITCH: Table = Table {
    name: "surface-switch",
    doc: "Grains in place of others where noise or a larger cell says so.",
    keys: &[
        Key::optional("noise", Kind::Table(&NOISE), "Where noise is within a range: patches, or veins."),
        Key::optional("tiles", Kind::Table(&TILES), "A share of larger Voronoi cells."),
        Key::required("cells", Kind::Table(&CELLS), "The grains there."),
    ],
    exactly_one: Some(Alternatives {
        what: "place",
        forms: &[&["noise"], &["tiles"]],
        examples: "`noise = { between = [-0.05, 0.05] }` or `tiles = { share = 0.5 }`",
        together: false,
        and: None,
    }),
};

static NOISE: Table = Table {
    name: "surface-noise",
    doc: "Perlin's noise, from -1 to 1, and the range of its values that is inside (Weidlich and Wilkie 2009, section 5.2.1).",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default(
            "frequency",
            Kind::Number(POSITIVE),
            "4",
            "Lattice cells of the first octave per unit of texture coordinate.",
        ),
        Key::with_default(
            "octaves",
            Kind::Integer(1, 12),
            "4",
            "Octaves, each of twice the frequency and half the weight.",
        ),
        Key::required(
            "between",
            Kind::List { item: &Kind::Number(NOISE_VALUE), min: 2, max: 2 },
            "The least value of the noise inside, and the largest. The noise is 0 on average; a narrow range around 0 is a net of veins.",
        ),
    ],
    exactly_one: None,
};

static TILES: Table = Table {
    name: "surface-tiles",
    doc: "Voronoi cells of which a share is inside.",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default("frequency", Kind::Number(POSITIVE), "5", "Cells per unit of texture coordinate."),
        Key::with_default("share", Kind::Number(UNIT), "0.5", "Share of the cells that is inside."),
    ],
    exactly_one: None,
};

static GLITTER: Table = Table {
    name: "surface-glitter",
    doc: "A share of the Voronoi cells of a map of its own, each of one of some materials and tilted its own way.",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default("frequency", Kind::Number(POSITIVE), "60", "Cells per unit of texture coordinate."),
        Key::with_default("filled", Kind::Number(UNIT), "0.1", "Share of the cells that glitter."),
        Key::with_default("tilt_deg", Kind::Number(TILT_DEG), "15", "Largest tilt of a glittering cell in degrees."),
        Key::required("materials", MATERIALS, "Material files of the particles, as in `cells`."),
    ],
    exactly_one: None,
};
