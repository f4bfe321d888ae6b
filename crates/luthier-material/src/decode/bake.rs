//! Bake settings and budgets of a file.

use luthier_lut::{TableKind, TexelFormat};
use luthier_manifest::{
    Budget, ColorMode, DiffusePart, DiffuseTerm, InternalReflection, LobeHeight, LowerAlpha, LowerCosine, LowerFacets,
    LowerReflectance, Masking, Reflectance, ShadingModel,
};

use crate::bake_settings::{
    AlphaMapping, BakeSettings, Beams, DistributionMapping, DistributionSettings, FresnelMapping, FresnelSettings,
    GridSettings, RowSettings,
};
use crate::diagnostic::Sink;
use crate::material::Material;
use crate::section::Section;

/// The settings that the file asks of its tables.
pub(super) fn decode(document: &Section<'_>, sink: &mut Sink<'_>) -> BakeSettings {
    let Some(at) = document.section("bake") else { return BakeSettings::default() };
    let wavelengths_nm = at.rgb("wavelengths_nm").filter(|w| distinct(w, &at, sink));
    BakeSettings {
        model: at.text("model").and_then(ShadingModel::from_name),
        masking: at.text("masking").and_then(Masking::from_name),
        reflectance: at.text("reflectance").and_then(Reflectance::from_name),
        internal_reflection: at.text("internal_reflection").and_then(InternalReflection::from_name),
        lower_reflectance: at.text("lower_reflectance").and_then(LowerReflectance::from_name),
        diffuse_term: at.text("diffuse_term").and_then(DiffuseTerm::from_name),
        lower_cosine: at.text("lower_cosine").and_then(LowerCosine::from_name),
        lower_facets: at.text("lower_facets").and_then(LowerFacets::from_name),
        lower_alpha: at.text("lower_alpha").and_then(LowerAlpha::from_name),
        diffuse_part: at.text("diffuse_part").and_then(DiffusePart::from_name),
        beams: at.section("granier-heidrich").map(|at| beams(&at, sink)),
        lobes: None,
        tables: at.texts("tables").iter().filter_map(|name| TableKind::from_name(name)).collect(),
        color: at.text("color").and_then(ColorMode::from_name),
        wavelengths_nm,
        fresnel: at.section("fresnel").map(|at| fresnel(&at)).unwrap_or_default(),
        distribution: at.section("distribution").map(|at| distribution(&at, sink)).unwrap_or_default(),
        fgd: at.section("fgd").map(|at| grid(&at)).unwrap_or_default(),
        phase: at.section("phase").map(|at| row(&at)).unwrap_or_default(),
        thickness: at.section("thickness").map(|at| row(&at)).unwrap_or_default(),
    }
}

/// The budget that the file allows its tables.
pub(super) fn budget(document: &Section<'_>) -> Budget {
    let Some(at) = document.section("budget") else { return Budget::default() };
    Budget {
        max_abs: at.number("max_abs"),
        max_rel: at.number("max_rel"),
        delta_e: at.number("delta_e"),
        max_bytes: at.number("max_bytes").map(|bytes| bytes as u64),
        max_cost: at.number("max_cost"),
        max_lobe_err: at.number("max_lobe_err"),
        max_albedo_err: at.number("max_albedo_err"),
    }
}

/// Limits on fitted lobes in a file whose model has none.
pub(super) fn check_limits(material: &Material, document: &Section<'_>, sink: &mut Sink<'_>) {
    let Some(at) = document.section("budget").filter(|_| !material.model().is_fitted()) else { return };
    for key in ["max_lobe_err", "max_albedo_err"].into_iter().filter(|key| at.number(key).is_some()) {
        let message =
            format!("`{key}` limits the model lobes, but the model of this material is {}", material.model().name());
        let hint = "leave the limit out, or name the model: `[bake] model = \"lobes\"`".to_owned();
        sink.error(at.value_span(key), message, Some(hint));
    }
}

fn distinct(wavelengths: &[f64; 3], at: &Section<'_>, sink: &mut Sink<'_>) -> bool {
    let [r, g, b] = *wavelengths;
    if r > g && g > b {
        return true;
    }
    let span = at.value_span("wavelengths_nm");
    if !sink.has_error_in(&span) {
        let hint = "write them as R, G, B: `wavelengths_nm = [645, 525, 445]`".to_owned();
        sink.error(span, "the wavelengths of R, G and B must descend", Some(hint));
    }
    false
}

fn beams(at: &Section<'_>, sink: &mut Sink<'_>) -> Beams {
    let plain = Beams::default();
    if at.has("inner_azimuth_deg") && !at.has("inner_tilt_deg") {
        let hint = "give `inner_tilt_deg`, or leave it out".to_owned();
        sink.error(at.key_span("inner_azimuth_deg"), "a boundary that does not lean has no azimuth", Some(hint));
    }
    Beams {
        specular_weight: at.number("specular_weight").unwrap_or(plain.specular_weight),
        diffuse_weight: at.number("diffuse_weight").unwrap_or(plain.diffuse_weight),
        inner_tilt: at.number("inner_tilt_deg").map_or(plain.inner_tilt, f64::to_radians),
        inner_azimuth: at.number("inner_azimuth_deg").map_or(plain.inner_azimuth, f64::to_radians),
        lobe_height: at.text("lobe_height").and_then(LobeHeight::from_name).unwrap_or_default(),
    }
}

fn format(at: &Section<'_>) -> Option<TexelFormat> {
    at.text("format").and_then(TexelFormat::from_name)
}

fn fresnel(at: &Section<'_>) -> FresnelSettings {
    FresnelSettings {
        size: at.integer("size"),
        format: format(at),
        mapping: at.text("mapping").and_then(FresnelMapping::from_name),
    }
}

fn distribution(at: &Section<'_>, sink: &mut Sink<'_>) -> DistributionSettings {
    let mapping = at.text("mapping").and_then(DistributionMapping::from_name);
    if mapping == Some(DistributionMapping::Linear) && at.has("exponent") {
        let hint = "leave it out, or write `mapping = \"power\"`".to_owned();
        sink.warn(at.key_span("exponent"), "a linear axis has no exponent", Some(hint));
    }
    DistributionSettings {
        size: at.pair("size"),
        format: format(at),
        mapping,
        exponent: at.number("exponent"),
        alpha_mapping: at.text("alpha_mapping").and_then(AlphaMapping::from_name),
    }
}

fn grid(at: &Section<'_>) -> GridSettings {
    GridSettings { size: at.pair("size"), format: format(at) }
}

fn row(at: &Section<'_>) -> RowSettings {
    RowSettings { size: at.integer("size"), format: format(at) }
}
