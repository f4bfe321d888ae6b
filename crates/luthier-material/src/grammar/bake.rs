//! Keys of `[bake]` and `[budget]`.

use luthier_lut::TableKind;
use luthier_manifest::{
    ColorMode, DiffusePart, DiffuseTerm, InternalReflection, LobeHeight, LowerAlpha, LowerCosine, LowerFacets,
    LowerReflectance, Masking, Reflectance, ShadingModel,
};

use super::table::{ANY, Key, Kind, NOT_NEGATIVE, POSITIVE, Range, Table};
use crate::bake_settings::{AlphaMapping, DistributionMapping, FresnelMapping};

/// Wavelengths that the colour matching functions cover.
const VISIBLE_NM: Range = Range { min: 360.0, max: 830.0, above: false };

/// Range of exponents, from no mapping at all to far steeper than any lobe needs.
const EXPONENT: Range = Range { min: 1.0, max: 64.0, above: false };

/// Texels along a side: interpolation needs two; beyond 8192 devices need not follow.
const SIDE: Kind = Kind::Integer(2, 8192);
const SIDES: Kind = Kind::List { item: &SIDE, min: 2, max: 2 };

const COLOR_FORMATS: Kind = Kind::Choice(&["rgba8unorm", "rgba16unorm", "rgba16float", "rgba32float"]);
const ALBEDO_FORMATS: Kind = Kind::Choice(&["bc6h-rgb-ufloat", "rgba16float", "rgba32float"]);
const FLOAT_FORMATS: Kind = Kind::Choice(&["rgba16float", "rgba32float"]);
const SCALAR_FORMATS: Kind = Kind::Choice(&["r16float", "rg16float", "r32float"]);

const FORMAT_DOC: &str = "Texel format, by its WebGPU name.";
const SIDE_DOC: &str = "Texels along a side.";

pub(super) static BAKE: Table = Table {
    name: "bake",
    doc: "How the tables of this material are to be baked; what is left out is the baker's choice.",
    keys: &[
        Key::optional(
            "model",
            Kind::Choice(ShadingModel::NAMES),
            "The reflectance model that the shader evaluates; if absent, the first of a list that shows all that the file asks for.",
        ),
        Key::with_default(
            "masking",
            Kind::Choice(Masking::NAMES),
            "\"smith\"",
            "Masking and shadowing of the model microfacet; of elek and weidlich-wilkie v-cavity, their default, or kelemen.",
        ),
        Key::with_default(
            "diffuse_term",
            Kind::Choice(DiffuseTerm::NAMES),
            "\"none\"",
            "Light of the diffuse base in the model microfacet: none, or added to that of the first interface as if none lay above.",
        ),
        Key::with_default(
            "reflectance",
            Kind::Choice(Reflectance::NAMES),
            "\"table\"",
            "How the models elek, weidlich-wilkie and microfacet come by the reflectance of an interface: rows of a table, Fresnel's equations, \
             Schlick's form with the F0 of n and k, or Lazanyi's correction of it. In belcour and yamaguchi the table is that of the energies of rough \
             interfaces, and the others take facets as level.",
        ),
        Key::with_default(
            "internal_reflection",
            Kind::Choice(InternalReflection::NAMES),
            "\"facets\"",
            "Light from below that interfaces let out, in the models elek and weidlich-wilkie: less what facets reflect back, all of it, or by the \
             transmission at the directions' own angles.",
        ),
        Key::with_default(
            "lower_reflectance",
            Kind::Choice(LowerReflectance::NAMES),
            "\"in-place\"",
            "Reflectance of the interfaces below the first, in the models elek and weidlich-wilkie: below the medium that lies above them, or as in air, \
             the F2 of Elek's Algorithm 1.",
        ),
        Key::with_default(
            "lower_cosine",
            Kind::Choice(LowerCosine::NAMES),
            "\"outside\"",
            "Cosine of the light on the interfaces below the first, in the model elek: outside, or of the refracted direction, as in the code of \
             Elek's Algorithm 1.",
        ),
        Key::with_default(
            "lower_facets",
            Kind::Choice(LowerFacets::NAMES),
            "\"torrance-sparrow\"",
            "Reflection of the interfaces below the first, in the models elek and weidlich-wilkie: by facets, or by a lobe of Blinn and Phong or of \
             Phong, times the reflectance.",
        ),
        Key::with_default(
            "lower_alpha",
            Kind::Choice(LowerAlpha::NAMES),
            "\"own\"",
            "Slope parameters of the interfaces below the first, in the model weidlich-wilkie: their own, or at least the greatest above, for the blur \
             by refraction.",
        ),
        Key::with_default(
            "diffuse_part",
            Kind::Choice(DiffusePart::NAMES),
            "\"below\"",
            "Place of the diffuse base under the last interface, in the models elek and weidlich-wilkie: below it, or of the same layer, as in line 22 of \
             Elek's Algorithm 1.",
        ),
        Key::optional(
            "tables",
            Kind::List { item: &Kind::Choice(TableKind::NAMES), min: 1, max: TableKind::NAMES.len() },
            "Kinds of tables to bake beside those that the shader reads; settings of a kind ask for it too.",
        ),
        Key::with_default(
            "color",
            Kind::Choice(ColorMode::NAMES),
            "\"spectral\"",
            "Integrate spectra, or take the function at three wavelengths as R, G, B.",
        ),
        Key::with_default(
            "wavelengths_nm",
            Kind::List { item: &Kind::Number(VISIBLE_NM), min: 3, max: 3 },
            "[645, 525, 445]",
            "The wavelengths taken as R, G and B, in nm.",
        ),
        Key::optional("granier-heidrich", Kind::Table(&BEAMS), "Numbers of the model granier-heidrich."),
        Key::optional("fresnel", Kind::Table(&FRESNEL), "Fresnel rows."),
        Key::optional("distribution", Kind::Table(&DISTRIBUTION), "Table of the slope distribution."),
        Key::optional("fgd", Kind::Table(&FGD), "Energy of the rough interface, all bounces."),
        Key::optional("phase", Kind::Table(&PHASE), "Phase rows of films."),
        Key::optional("thickness", Kind::Table(&THICKNESS), "Thickness textures of films."),
    ],
    exactly_one: None,
};

pub(super) static BUDGET: Table = Table {
    name: "budget",
    doc: "Limits on the tables: the baker takes the cheapest that hold them, and refuses what none holds.",
    keys: &[
        Key::optional("max_abs", Kind::Number(POSITIVE), "Largest absolute error of a sampled table."),
        Key::optional(
            "max_rel",
            Kind::Number(POSITIVE),
            "Largest error relative to the value, or to 0.01 where it is less.",
        ),
        Key::optional(
            "delta_e",
            Kind::Number(POSITIVE),
            "Largest CIEDE2000 difference of tabulated reflectances under D65.",
        ),
        Key::optional("max_bytes", Kind::Integer(1, i64::MAX), "Bytes of the texels of all tables of a bake."),
        Key::optional(
            "max_cost",
            Kind::Number(POSITIVE),
            "Estimated cost of one read of every table, in operations of no device.",
        ),
        Key::optional(
            "max_lobe_err",
            Kind::Number(POSITIVE),
            "Largest lobe error of fitted lobes against the simulated stack.",
        ),
        Key::optional(
            "max_albedo_err",
            Kind::Number(POSITIVE),
            "Largest error of the directional albedo of fitted lobes.",
        ),
    ],
    exactly_one: None,
};

/// Lean of a boundary: at 90 degrees it would stand upright.
const TILT_DEG: Range = Range { min: 0.0, max: 80.0, above: false };

static BEAMS: Table = Table {
    name: "beams",
    doc: "Numbers of the model granier-heidrich.",
    keys: &[
        Key::with_default("specular_weight", Kind::Number(NOT_NEGATIVE), "1", "Weight of the two beams."),
        Key::with_default(
            "diffuse_weight",
            Kind::Number(NOT_NEGATIVE),
            "1",
            "Weight of the diffuse part, beside the albedo of the base.",
        ),
        Key::with_default(
            "inner_tilt_deg",
            Kind::Number(TILT_DEG),
            "0",
            "Lean of the inner boundary against the outer one in degrees.",
        ),
        Key::with_default(
            "inner_azimuth_deg",
            Kind::Number(ANY),
            "0",
            "Azimuth to which the normal of the inner boundary leans, in degrees from the tangent; with inner_tilt_deg.",
        ),
        Key::with_default(
            "lobe_height",
            Kind::Choice(LobeHeight::NAMES),
            "\"scaled\"",
            "Height of both lobes: such that each carries its coefficient, or one, as printed in eq. 6 and 10.",
        ),
    ],
    exactly_one: None,
};

static FRESNEL: Table = Table {
    name: "fresnel-table",
    doc: "Fresnel rows.",
    keys: &[
        Key::optional("size", SIDE, "Texels of a row."),
        Key::optional("format", COLOR_FORMATS, FORMAT_DOC),
        Key::optional("mapping", Kind::Choice(FresnelMapping::NAMES), "What the axis is linear in."),
    ],
    exactly_one: None,
};

static DISTRIBUTION: Table = Table {
    name: "distribution-table",
    doc: "Table of the slope distribution over angle and alpha.",
    keys: &[
        Key::optional("size", SIDES, "Texels along the angle and along alpha."),
        Key::optional("format", SCALAR_FORMATS, FORMAT_DOC),
        Key::optional("mapping", Kind::Choice(DistributionMapping::NAMES), "Mapping of the angle axis."),
        Key::optional("exponent", Kind::Number(EXPONENT), "Exponent of the angle axis."),
        Key::optional("alpha_mapping", Kind::Choice(AlphaMapping::NAMES), "Mapping of the alpha axis."),
    ],
    exactly_one: None,
};

static FGD: Table = Table {
    name: "fgd-table",
    doc: "Energy reflected by the rough interface, over cosine and alpha.",
    keys: &[
        Key::optional("size", SIDES, "Texels along the cosine and along alpha."),
        Key::optional("format", ALBEDO_FORMATS, FORMAT_DOC),
    ],
    exactly_one: None,
};

static PHASE: Table = Table {
    name: "phase-table",
    doc: "Phase rows of films, over normalised thickness.",
    keys: &[Key::optional("size", SIDE, "Texels of a row."), Key::optional("format", FLOAT_FORMATS, FORMAT_DOC)],
    exactly_one: None,
};

static THICKNESS: Table = Table {
    name: "thickness-table",
    doc: "Thickness textures of films; square.",
    keys: &[Key::optional("size", SIDE, SIDE_DOC), Key::optional("format", FLOAT_FORMATS, FORMAT_DOC)],
    exactly_one: None,
};
