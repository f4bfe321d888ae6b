//! Grammar of layers: types, indices, micro-surfaces, slabs, maps.

use luthier_optics::f0_table::F0_NAMES;

use super::picture::{CHANNEL, PICTURE, SCALE, SRGB, TRANSFORM};
use super::table::{
    ANY, Alternatives, Key, Kind, NOT_NEGATIVE, NOT_NEGATIVE_RGB, PATH, POSITIVE, Range, Table, TextForm, UNIT,
    UNIT_ABOVE_ZERO, UNIT_RGB,
};

/// Wavelengths that samples of an index may have: far wider than what is seen, narrow enough to notice micrometres.
const SAMPLED_NM: Range = Range { min: 100.0, max: 30_000.0, above: false };

/// Mean slopes whose tangent, the slope parameter, is at most 1.
const SLOPE_DEG: Range = Range { min: 0.0, max: 45.0, above: false };

/// Real part and extinction coefficient of an index: those of real media stay below 10, in the far infrared below 1000.
pub(crate) const INDEX: Range = Range { min: 0.0, max: 1e6, above: true };
/// Either part of a complex index.
const PART: Range = Range { above: false, ..INDEX };

/// Cells along one repeat, of the first of up to twelve octaves: the finest still has coordinates of whole numbers.
const NOISE_FREQUENCY: Range = Range { min: 0.0, max: 65536.0, above: true };

/// A slope parameter of 1, to one above the least that shaders have.
const LOBE_EXPONENT: Range = Range { min: 0.0, max: 1e6, above: false };

const SIGMA: Range = Range { min: 0.0, max: std::f64::consts::FRAC_PI_2, above: false };

/// Enough for any table of samples that is still written by hand.
const SAMPLES_MAX: usize = 1024;

pub(super) const IOR: Kind = Kind::OneOf(&[
    Kind::Number(INDEX),
    Kind::Table(&IOR_TABLE),
    // The name of a data set or the path of a file; the decoder looks it up.
    Kind::Text(TextForm::Path),
]);

static IOR_TABLE: Table = Table {
    name: "ior",
    doc: "A complex index n + ik: constant, or sampled at wavelengths (for instance those of red, green and blue).",
    keys: &[
        Key::required(
            "n",
            Kind::OneOf(&[Kind::Number(PART), Kind::List { item: &Kind::Number(PART), min: 1, max: SAMPLES_MAX }]),
            "Real part: a number, or one for each wavelength. It is 0 in tables of some metals, whose k is not.",
        ),
        Key::with_default(
            "k",
            Kind::OneOf(&[Kind::Number(PART), Kind::List { item: &Kind::Number(PART), min: 1, max: SAMPLES_MAX }]),
            "0",
            "Extinction coefficient: a number, or one for each wavelength.",
        ),
        Key::optional(
            "wavelengths_nm",
            Kind::List { item: &Kind::Number(SAMPLED_NM), min: 1, max: SAMPLES_MAX },
            "Vacuum wavelengths of the samples in nm, in any order. Needed when n or k is a list.",
        ),
    ],
    exactly_one: None,
};

const IOR_DOC: &str = "Index of refraction: a number, a table { n, k, wavelengths_nm }, the name of a built-in data set, \
                       or the path of a file: CSV with the columns wavelength_nm, n, k, or a page of refractiveindex.info (.yml).";

const SURFACE: Alternatives = Alternatives {
    what: "surface",
    forms: &[
        &["roughness"],
        &["alpha"],
        &["slope_deg"],
        &["smooth"],
        &["alpha_x", "alpha_y"],
        &["exponent"],
        &["exponents"],
        &["abc"],
        &["sgd"],
    ],
    examples: "`smooth = true`, `roughness`, `alpha`, `slope_deg`, `alpha_x` with `alpha_y`, `exponent`, `exponents`, `abc` or `sgd`",
    together: false,
    and: None,
};

/// An index gives the reflectance of an interface; an F0 does, by Schlick's formula.
const REFLECTANCE: Alternatives = Alternatives {
    what: "reflectance",
    forms: &[&["ior"], &["f0"]],
    examples: "`ior` and `f0`",
    together: false,
    and: None,
};
static OPAQUE: Alternatives = REFLECTANCE;
/// The index of a medium that light enters bends directions beside an F0, too.
static TRANSPARENT: Alternatives = Alternatives { together: true, ..REFLECTANCE };

const F0_DOC: &str = "Reflectance at normal incidence, for Schlick's formula in place of an index: a number, one for each of R, G, B \
                      (linear Rec.709), or a substance of the lecture's tables.";
const F0: Key = Key::optional(
    "f0",
    Kind::OneOf(&[
        Kind::Number(UNIT),
        Kind::Choice(&F0_NAMES),
        Kind::List { item: &Kind::Number(UNIT), min: 3, max: 3 },
    ]),
    F0_DOC,
);

const DIELECTRIC_F0: Key = Key::with_default(
    "f0",
    Kind::OneOf(&[
        Kind::Number(UNIT),
        Kind::Choice(&F0_NAMES),
        Kind::List { item: &Kind::Number(UNIT), min: 3, max: 3 },
    ]),
    "0.04",
    "Reflectance at normal incidence without metal: a number, one for each of R, G, B (linear Rec.709), or a substance of the lecture's tables.",
);

const F82_TINT: Key = Key::with_default(
    "f82_tint",
    UNIT_RGB,
    "1",
    "Edge tint of the metal: its reflectance at 82 degrees from the normal over that of Schlick's formula there, a number or one for each of R, G, B \
     (linear Rec.709).",
);

const TYPE_DOC: &str = "What the layer is.";
const ROUGHNESS: Key =
    Key::optional("roughness", Kind::Number(UNIT), "Artist's roughness, 0 to 1: alpha is its square.");
const ALPHA: Key = Key::optional("alpha", Kind::Number(UNIT), "Slope parameter of the distribution, 0 to 1.");
const SLOPE: Key =
    Key::optional("slope_deg", Kind::Number(SLOPE_DEG), "Mean slope in degrees, 0 to 45: alpha is its tangent.");
const SMOOTH: Key = Key::optional("smooth", Kind::True, "A perfectly smooth surface.");
const EXPONENTS: Key = Key::optional(
    "exponents",
    Kind::List { item: &Kind::Number(LOBE_EXPONENT), min: 2, max: 2 },
    "Exponents of the lobes of the outer boundary and of the inner one, for the model granier-heidrich.",
);
const ALPHA_X: Key =
    Key::optional("alpha_x", Kind::Number(UNIT_ABOVE_ZERO), "Slope parameter along the tangent; with alpha_y.");
const ALPHA_Y: Key =
    Key::optional("alpha_y", Kind::Number(UNIT_ABOVE_ZERO), "Slope parameter along the bitangent; with alpha_x.");
const ROTATION: Key = Key::with_default(
    "rotation_deg",
    Kind::Number(ANY),
    "0",
    "Angle from the surface's tangent to this layer's in degrees, counter-clockwise; with alpha_x and alpha_y.",
);
const DISTRIBUTION: Key = Key::with_default(
    "distribution",
    Kind::Choice(&["ggx", "beckmann", "blinn"]),
    "\"ggx\"",
    "Distribution of the slopes. Of blinn, a power of the cosine, the exponent is 2/alpha^2 - 2. Beside abc and sgd there is none.",
);
const EXPONENT: Key = Key::optional(
    "exponent",
    Kind::Number(Range { min: 0.0, max: 2e6, above: false }),
    "Exponent n of the distribution blinn, in place of alpha, which is sqrt(2/(n + 2)).",
);
const ABC: Key = Key::optional(
    "abc",
    Kind::Table(&ABC_TABLE),
    "The distribution 1/(1 + b (1 - cos))^c of slopes, normalised (Low et al. 2012), in place of alpha.",
);
const SGD: Key = Key::optional(
    "sgd",
    Kind::Table(&SGD_TABLE),
    "The shifted gamma distribution of slopes (Bagher et al. 2012), in place of alpha.",
);

static ABC_TABLE: Table = Table {
    name: "abc",
    doc: "The distribution ABC, D = K / (1 + b (1 - cos))^c, whose K follows from the projected area.",
    keys: &[
        Key::required(
            "b",
            Kind::Number(Range { min: 0.0, max: 1e9, above: true }),
            "Width: the larger, the narrower. Where it is large and c above 1, alpha is near sqrt(2/(b (c - 1))).",
        ),
        Key::required(
            "c",
            Kind::Number(Range { min: 0.0, max: 32.0, above: true }),
            "Fall-off: GGX falls as c = 2 around the normal.",
        ),
    ],
    exactly_one: None,
};

static SGD_TABLE: Table = Table {
    name: "sgd",
    doc: "The shifted gamma distribution: slopes of density exp(-t) / t^p with t = alpha + tan^2 / alpha, normalised.",
    keys: &[
        Key::required(
            "alpha",
            Kind::Number(Range { min: 1e-6, max: 10.0, above: false }),
            "The paper's alpha, not the slope parameter of other distributions: slopes fall as exp(-tan^2 / alpha).",
        ),
        Key::required(
            "p",
            Kind::Number(Range { min: 0.0, max: 8.0, above: true }),
            "The paper's p: the larger, the sharper the peak.",
        ),
    ],
    exactly_one: None,
};

const WEIGHT: Key = Key::with_default(
    "weight",
    Kind::Number(UNIT),
    "1",
    "Share of the surface that the first layer covers, 0 to 1; the layers below are bare elsewhere.",
);

const DARKENING: Key = Key::with_default(
    "darkening",
    Kind::Flag,
    "true",
    "Whether this coat, the first layer, darkens the base below it; with false the base is brighter, and looks through the coat as its colour says.",
);

const MAPS_DOC: &str = "Textures that modulate the layer.";
const NORMAL_MAP: Key = Key::optional("normal", PICTURE, "A tangent-space normal map.");
const ROUGHNESS_MAP: Key = Key::optional("roughness", PICTURE, "A map that multiplies the roughness.");
const THICKNESS_MAP: Key = Key::optional("thickness", PICTURE, "A map that multiplies the slab's thickness.");
const ABSORPTION_MAP: Key =
    Key::optional("absorption", PICTURE, "A picture whose colours multiply what the slab absorbs.");

const WEIGHT_MAP: Key = Key::optional("weight", PICTURE, "A map that multiplies `weight`, of the first layer.");

const BUMPS: Key = Key::optional("bumps", PICTURE, "A tangent-space normal map that tilts this layer alone.");
const ALPHA_MAP: Key =
    Key::optional("alpha", PICTURE, "A map that multiplies the slope parameters of this layer alone.");
const ALPHA_X_MAP: Key = Key::optional("alpha_x", PICTURE, "A map that multiplies alpha_x.");
const ALPHA_Y_MAP: Key = Key::optional("alpha_y", PICTURE, "A map that multiplies alpha_y.");
const TANGENT_MAP: Key = Key::optional(
    "tangent",
    PICTURE,
    "A map of directions that turns the tangent of this layer: 2 RG - 1 is the cosine and the sine of twice the angle.",
);

const F0_MAP: Key = Key::optional("f0", PICTURE, "A picture whose colours multiply the `f0` of the layer.");

const LEAN_MAP: Key = Key::optional(
    "lean",
    PICTURE,
    "A tangent-space normal map of the inner boundary of the film or slab, for the model granier-heidrich.",
);

static DIELECTRIC_MAPS: Table = Table {
    name: "dielectric-maps",
    doc: MAPS_DOC,
    keys: &[
        NORMAL_MAP,
        ROUGHNESS_MAP,
        THICKNESS_MAP,
        ABSORPTION_MAP,
        WEIGHT_MAP,
        BUMPS,
        ALPHA_MAP,
        ALPHA_X_MAP,
        ALPHA_Y_MAP,
        TANGENT_MAP,
        F0_MAP,
        LEAN_MAP,
    ],
    exactly_one: None,
};
static CONDUCTOR_MAPS: Table = Table {
    name: "conductor-maps",
    doc: MAPS_DOC,
    keys: &[NORMAL_MAP, ROUGHNESS_MAP, BUMPS, ALPHA_MAP, ALPHA_X_MAP, ALPHA_Y_MAP, TANGENT_MAP, F0_MAP, LEAN_MAP],
    exactly_one: None,
};
static DIFFUSE_MAPS: Table = Table {
    name: "diffuse-maps",
    doc: MAPS_DOC,
    keys: &[NORMAL_MAP, BUMPS, Key::optional("albedo", PICTURE, "A picture whose colours multiply the albedo.")],
    exactly_one: None,
};
static METALLIC_MAPS: Table = Table {
    name: "metallic-maps",
    doc: MAPS_DOC,
    keys: &[
        NORMAL_MAP,
        ROUGHNESS_MAP,
        BUMPS,
        ALPHA_MAP,
        ALPHA_X_MAP,
        ALPHA_Y_MAP,
        TANGENT_MAP,
        Key::optional("base_color", PICTURE, "A picture whose colours multiply the base colour."),
        Key::optional("metallic", PICTURE, "A map that multiplies `metallic`."),
        F0_MAP,
    ],
    exactly_one: None,
};

const LIVE_DOC: &str = "Numbers that a program sets at run time, without a bake; that of the file holds until it does.";

const fn live(name: &'static str, doc: &'static str) -> Key {
    Key::optional(name, Kind::True, doc)
}

const fn live_slope(name: &'static str, doc: &'static str) -> Key {
    Key::optional(name, Kind::List { item: &Kind::Number(UNIT_ABOVE_ZERO), min: 2, max: 2 }, doc)
}

const LIVE_NORMAL: Key = live("normal", "The normal of the whole surface.");
const LIVE_ROUGHNESS: Key = live("roughness", "A factor on the slope parameters of all layers, at most 1.");
const LIVE_BUMPS: Key = live("bumps", "The normal of this layer alone.");
const LIVE_ALPHA: Key =
    live_slope("alpha", "The slope parameter of this layer alone: its least and its greatest value.");
const LIVE_ALPHA_X: Key = live_slope("alpha_x", "The least and the greatest value of alpha_x.");
const LIVE_ALPHA_Y: Key = live_slope("alpha_y", "The least and the greatest value of alpha_y.");
const LIVE_TANGENT: Key = live("tangent", "The direction of the tangent of this layer.");

static DIELECTRIC_LIVE: Table = Table {
    name: "dielectric-live",
    doc: LIVE_DOC,
    keys: &[
        LIVE_NORMAL,
        LIVE_ROUGHNESS,
        live("thickness", "The thickness of the slab, as a factor on that of the file."),
        live("absorption", "What the slab absorbs, as factors on the numbers of the file."),
        live("weight", "The share of the surface that the first layer covers, as a factor on that of the file."),
        LIVE_BUMPS,
        LIVE_ALPHA,
        LIVE_ALPHA_X,
        LIVE_ALPHA_Y,
        LIVE_TANGENT,
    ],
    exactly_one: None,
};
static CONDUCTOR_LIVE: Table = Table {
    name: "conductor-live",
    doc: LIVE_DOC,
    keys: &[LIVE_NORMAL, LIVE_ROUGHNESS, LIVE_BUMPS, LIVE_ALPHA, LIVE_ALPHA_X, LIVE_ALPHA_Y, LIVE_TANGENT],
    exactly_one: None,
};
static DIFFUSE_LIVE: Table = Table {
    name: "diffuse-live",
    doc: LIVE_DOC,
    keys: &[LIVE_NORMAL, LIVE_BUMPS, live("albedo", "The albedo.")],
    exactly_one: None,
};
static METALLIC_LIVE: Table = Table {
    name: "metallic-live",
    doc: LIVE_DOC,
    keys: &[
        LIVE_NORMAL,
        LIVE_ROUGHNESS,
        LIVE_BUMPS,
        LIVE_ALPHA,
        LIVE_ALPHA_X,
        LIVE_ALPHA_Y,
        LIVE_TANGENT,
        live("base_color", "The base colour."),
        live("metallic", "How metallic the surface is."),
    ],
    exactly_one: None,
};

pub(super) static DIELECTRIC: Table = Table {
    name: "dielectric",
    doc: "A transparent interface and the slab below it, down to the next layer.",
    keys: &[
        Key::required("type", Kind::Choice(&["dielectric"]), TYPE_DOC),
        Key::optional("ior", IOR, IOR_DOC),
        F0,
        ROUGHNESS,
        ALPHA,
        SLOPE,
        SMOOTH,
        EXPONENTS,
        ALPHA_X,
        ALPHA_Y,
        ROTATION,
        DISTRIBUTION,
        EXPONENT,
        ABC,
        SGD,
        Key::with_default("thickness_um", Kind::Number(NOT_NEGATIVE), "0", "Thickness of the slab in um."),
        Key::with_default(
            "absorption_per_um",
            NOT_NEGATIVE_RGB,
            "0",
            "Absorption coefficient of the slab in 1/um: a number, or one for each of R, G, B. It takes the colour away.",
        ),
        WEIGHT,
        DARKENING,
        Key::optional("maps", Kind::Table(&DIELECTRIC_MAPS), MAPS_DOC),
        Key::optional("live", Kind::Table(&DIELECTRIC_LIVE), LIVE_DOC),
    ],
    exactly_one: Some(Alternatives { and: Some(&TRANSPARENT), ..SURFACE }),
};

pub(super) static CONDUCTOR: Table = Table {
    name: "conductor",
    doc: "An opaque metal or semiconductor; the last layer.",
    keys: &[
        Key::required("type", Kind::Choice(&["conductor"]), TYPE_DOC),
        Key::optional("ior", IOR, IOR_DOC),
        F0,
        F82_TINT,
        ROUGHNESS,
        ALPHA,
        SLOPE,
        SMOOTH,
        EXPONENTS,
        ALPHA_X,
        ALPHA_Y,
        ROTATION,
        DISTRIBUTION,
        EXPONENT,
        ABC,
        SGD,
        Key::optional("maps", Kind::Table(&CONDUCTOR_MAPS), MAPS_DOC),
        Key::optional("live", Kind::Table(&CONDUCTOR_LIVE), LIVE_DOC),
    ],
    exactly_one: Some(Alternatives { and: Some(&OPAQUE), ..SURFACE }),
};

const DIFFUSE_REFLECTANCE: Alternatives = Alternatives {
    what: "reflectance",
    forms: &[&["albedo"], &["reradiation"]],
    examples: "`albedo` and `reradiation`",
    together: false,
    and: None,
};

pub(super) static DIFFUSE: Table = Table {
    name: "diffuse",
    doc: "An opaque diffuse base (Lambert, or Oren and Nayar); the last layer. It has no interface.",
    keys: &[
        Key::required("type", Kind::Choice(&["diffuse"]), TYPE_DOC),
        Key::optional(
            "albedo",
            UNIT_RGB,
            "Diffuse reflectance: a number, or one for each of R, G, B (linear Rec.709).",
        ),
        Key::optional(
            "reradiation",
            PATH,
            "In place of albedo, path of a CSV file with the re-radiation matrix of a fluorescent base: the first row has the wavelengths of the \
             light in nm, each row below a wavelength that comes out and the share of the power of each light that does.",
        ),
        Key::with_default(
            "sigma",
            Kind::Number(SIGMA),
            "0",
            "Standard deviation of the facets' slope angle in radians; 0 is Lambert.",
        ),
        Key::optional("maps", Kind::Table(&DIFFUSE_MAPS), MAPS_DOC),
        Key::optional("live", Kind::Table(&DIFFUSE_LIVE), LIVE_DOC),
    ],
    exactly_one: Some(DIFFUSE_REFLECTANCE),
};

pub(super) static METALLIC_ROUGHNESS: Table = Table {
    name: "metallic-roughness",
    doc: "The usual surface of engines (glTF 2.0): a conductor, a dielectric over a diffuse base, or a mixture; the last layer.",
    keys: &[
        Key::required("type", Kind::Choice(&["metallic-roughness"]), TYPE_DOC),
        Key::required(
            "base_color",
            UNIT_RGB,
            "F0 of the metal and diffuse colour of the dielectric: a number, or one for each of R, G, B (linear Rec.709).",
        ),
        Key::with_default(
            "metallic",
            Kind::Number(UNIT),
            "0",
            "0 is a dielectric over a diffuse base, 1 a metal; in between F0 and diffuse colour are mixed.",
        ),
        DIELECTRIC_F0,
        F82_TINT,
        ROUGHNESS,
        ALPHA,
        SLOPE,
        SMOOTH,
        EXPONENTS,
        ALPHA_X,
        ALPHA_Y,
        ROTATION,
        DISTRIBUTION,
        EXPONENT,
        ABC,
        SGD,
        Key::with_default(
            "sigma",
            Kind::Number(SIGMA),
            "0",
            "Standard deviation of the slope angle of the diffuse base's facets in radians; 0 is Lambert.",
        ),
        Key::optional("maps", Kind::Table(&METALLIC_MAPS), MAPS_DOC),
        Key::optional("live", Kind::Table(&METALLIC_LIVE), LIVE_DOC),
    ],
    exactly_one: Some(SURFACE),
};

pub(super) static THIN_FILM: Table = Table {
    name: "thin-film",
    doc: "A coherent film on the interface of the next dielectric or conductor, whose surface it shares.",
    keys: &[
        Key::required("type", Kind::Choice(&["thin-film"]), TYPE_DOC),
        Key::required("ior", IOR, IOR_DOC),
        Key::required(
            "thickness_nm",
            Kind::OneOf(&[Kind::Number(POSITIVE), Kind::Table(&FILM_THICKNESS)]),
            "Thickness in nm: a number, or a table { min, max, extent_um, map }.",
        ),
        Key::with_default(
            "weight",
            Kind::Number(UNIT),
            "1",
            "Share of the surface that the film covers, 0 to 1; of a film alone on the first layer.",
        ),
        Key::optional("maps", Kind::Table(&FILM_MAPS), MAPS_DOC),
    ],
    exactly_one: None,
};

static FILM_MAPS: Table = Table {
    name: "film-maps",
    doc: MAPS_DOC,
    keys: &[Key::optional("weight", PICTURE, "A map that multiplies `weight`.")],
    exactly_one: None,
};

static FILM_THICKNESS: Table = Table {
    name: "film-thickness",
    doc: "A thickness that varies over the surface between two extremes.",
    keys: &[
        Key::required("min", Kind::Number(NOT_NEGATIVE), "Thinnest, in nm."),
        Key::required("max", Kind::Number(POSITIVE), "Thickest, in nm."),
        Key::required("extent_um", Kind::Number(POSITIVE), "Width of one repeat of the map on the surface, in um."),
        Key::required("map", VARIATION, "How it varies: 0 is the thinnest, 1 the thickest."),
    ],
    exactly_one: None,
};

/// A map of one number: the path of a picture, or a table.
pub(super) const VARIATION: Kind = Kind::OneOf(&[PATH, Kind::Table(&VARIATION_TABLE)]);

static VARIATION_TABLE: Table = Table {
    name: "map",
    doc: "A map of one number: noise, or a picture and how it is read. A string alone is the path of a picture.",
    keys: &[
        Key::optional("noise", Kind::Table(&NOISE), "Fractal gradient noise."),
        Key::optional("image", PATH, "Path of a picture, PNG, JPEG or WebP."),
        CHANNEL,
        SRGB,
        SCALE,
        TRANSFORM,
    ],
    exactly_one: Some(Alternatives {
        what: "map",
        forms: &[&["noise"], &["image"]],
        examples: "`noise = {}` or `image = \"map.png\"`",
        together: false,
        and: None,
    }),
};

static NOISE: Table = Table {
    name: "noise",
    doc: "Fractal gradient noise that repeats.",
    keys: &[
        Key::with_default("seed", Kind::Integer(0, u32::MAX as i64), "0", "Seed."),
        Key::with_default(
            "frequency",
            Kind::Number(NOISE_FREQUENCY),
            "4",
            "Lattice cells of the first octave along one repeat.",
        ),
        Key::with_default(
            "octaves",
            Kind::Integer(1, 12),
            "4",
            "Octaves, each of twice the frequency and half the weight.",
        ),
    ],
    exactly_one: None,
};
