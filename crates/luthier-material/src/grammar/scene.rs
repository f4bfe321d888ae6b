//! Grammar of a scene file.

use super::table::{Key, Kind, LAYERS_MAX, PATH, POSITIVE, Range, SCENE_MATERIALS_MAX, Table, TextForm, UNIT};

/// Version of the grammar of scenes.
const SCENE_VERSION: i64 = 1;

/// Angle of the eye from the normal; at the horizon nothing is seen.
const VIEW_DEG: Range = Range { min: 0.0, max: 85.0, above: false };
/// Angle between eye and light.
const APART_DEG: Range = Range { min: 0.0, max: 170.0, above: false };
/// Beyond this the slopes of a pixel are no small addition to those of the surface.
const FOOTPRINT_DEG: Range = Range { min: 0.0, max: 20.0, above: false };

/// The whole file.
pub(crate) static SCENE: Table = Table {
    name: "scene",
    doc: "A luthier scene: which materials are seen, in what light and from where, and what their models may err and cost.",
    keys: &[
        Key::required("scene", Kind::Integer(SCENE_VERSION, SCENE_VERSION), "Version of this grammar."),
        Key::required("name", Kind::Text(TextForm::Name), "Name of the scene: letters, digits and hyphens."),
        Key::optional("description", Kind::Text(TextForm::Prose), "What it is, in a sentence or two."),
        Key::required(
            "material",
            Kind::List { item: &Kind::Table(&MATERIAL), min: 1, max: SCENE_MATERIALS_MAX },
            "The materials that are seen.",
        ),
        Key::required(
            "light",
            Kind::Tagged { tag: "type", variants: &[&DIRECTIONAL, &POINT, &ENVIRONMENT], max: LAYERS_MAX },
            "The lights.",
        ),
        Key::optional("view", Kind::Table(&VIEW), "From where surfaces are seen."),
        Key::optional("target", Kind::Table(&TARGET), "What the target has room and time for."),
        Key::required("budget", Kind::Table(&SCENE_BUDGET), "What the models may err."),
    ],
    exactly_one: None,
};

static MATERIAL: Table = Table {
    name: "scene-material",
    doc: "A material of the scene.",
    keys: &[
        Key::required("file", PATH, "The material file, relative to the scene's."),
        Key::optional("budget", Kind::Table(&SCENE_BUDGET), "Limits for this material, in place of the scene's."),
    ],
    exactly_one: None,
};

static DIRECTIONAL: Table = Table {
    name: "directional",
    doc: "Light from one direction, such as the sun.",
    keys: &[
        Key::required("type", Kind::Choice(&["directional"]), "What the light is."),
        Key::required("from_eye_deg", Kind::Number(APART_DEG), "Angle between the light and the eye."),
    ],
    exactly_one: None,
};

static POINT: Table = Table {
    name: "point",
    doc: "Light from nearby, which surfaces see under different angles.",
    keys: &[
        Key::required("type", Kind::Choice(&["point"]), "What the light is."),
        Key::required(
            "from_eye_deg",
            Kind::List { item: &Kind::Number(APART_DEG), min: 2, max: 2 },
            "Least and largest angle between the light and the eye.",
        ),
    ],
    exactly_one: None,
};

static ENVIRONMENT: Table = Table {
    name: "environment",
    doc: "Light of equal radiance from everywhere.",
    keys: &[Key::required("type", Kind::Choice(&["environment"]), "What the light is.")],
    exactly_one: None,
};

static VIEW: Table = Table {
    name: "view",
    doc: "From where surfaces are seen.",
    keys: &[
        Key::with_default(
            "angles_deg",
            Kind::List { item: &Kind::Number(VIEW_DEG), min: 2, max: 2 },
            "[0, 75]",
            "Least and largest angle between the normal and the eye.",
        ),
        Key::with_default(
            "footprint_deg",
            Kind::Number(FOOTPRINT_DEG),
            "0",
            "How far the normals within one pixel lean from their mean: added to the slopes of every interface.",
        ),
        Key::with_default(
            "neighbours_differ",
            Kind::Number(UNIT),
            "0",
            "Share of neighbouring pixels that differ in material: threads of a wave wait for each other's models.",
        ),
    ],
    exactly_one: None,
};

static TARGET: Table = Table {
    name: "target",
    doc: "What the target has room and time for.",
    keys: &[
        Key::optional("max_bytes", Kind::Integer(0, i64::MAX), "Bytes of the texels of all tables."),
        Key::optional(
            "max_cost",
            Kind::Number(POSITIVE),
            "Cost of one evaluation, in the unit of the device: picoseconds, or cycles per wave of 64 where a compiler counted (gcn5, rdna2, rdna3).",
        ),
        Key::optional(
            "device",
            Kind::Choice(DEVICES),
            "Device whose costs count. By default h100, an NVIDIA H100; rdna2 where `max_cost` stands without a device.",
        ),
        Key::optional(
            "formats",
            Kind::List { item: &Kind::Choice(FORMATS), min: 0, max: usize::MAX },
            "Texel formats that tables may have, by their WebGPU names; none for no tables at all.",
        ),
    ],
    exactly_one: None,
};

/// Devices whose costs ship: those of luthier-cost.
const DEVICES: &[&str] = &["h100", "gcn5", "rdna2", "rdna3", "llvmpipe"];

/// Formats that tables come in.
const FORMATS: &[&str] = &[
    "r16float",
    "rg16float",
    "r32float",
    "rgba8unorm",
    "rgb10a2unorm",
    "rg11b10ufloat",
    "rgba16unorm",
    "bc6h-rgb-ufloat",
    "rgba16float",
    "rgba32float",
];

static SCENE_BUDGET: Table = Table {
    name: "scene-budget",
    doc: "Limits on the error of a model against the reference.",
    keys: &[
        Key::optional(
            "max_rel",
            Kind::Number(POSITIVE),
            "Largest error over the brightest channel, or over 0.1/pi where that is darker.",
        ),
        Key::optional("max_abs", Kind::Number(POSITIVE), "Largest absolute error of f cos theta."),
        Key::optional("delta_e", Kind::Number(POSITIVE), "Largest CIEDE2000 difference of pi f cos theta under D65."),
    ],
    exactly_one: None,
};
