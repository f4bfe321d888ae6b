//! Doubtful physics: values that are allowed, but rarely meant.

use std::f64::consts::PI;
use std::ops::Range as Span;

use luthier_optics::color::VISIBLE_NM;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Film, Layer, Slab, Stack};

use luthier_lut::Served;
use luthier_manifest::{ColorMode, DiffusePart, ShadingModel};

use crate::bake_settings::BakeSettings;
use crate::diagnostic::Sink;
use crate::material::Material;
use crate::places::Places;
use crate::suggest::short;

/// Smallest slope parameter that the real-time models tell from a smooth surface. Layer records have it in place of smaller ones.
pub const ALPHA_MIN: f64 = 1e-3;

/// Thickest film whose colour the 5 nm steps of the spectrum still resolve with margin: at n = 1.5 neighbouring fringes
/// are 13 nm apart at 450 nm.
const FILM_MAX_NM: f64 = 5000.0;

/// Two indices that differ by less than this reflect less than 1e-8 at normal incidence.
const SAME_INDEX: f64 = 2e-4;

/// Largest F0 of a clear medium: rutile, of index 2.6, has 0.2.
const DIELECTRIC_F0_MAX: f64 = 0.2;

/// A sampled spectrum that may be too short: name, range in nm, place.
pub(crate) type Spectrum = (String, (f64, f64), Span<usize>);

/// Places in the text that doubts point at.
#[derive(Default)]
pub(crate) struct Sources {
    /// Sampled spectra that may be too short.
    pub(crate) spectra: Vec<Spectrum>,
    /// Where values stand; only of a file without errors.
    pub(crate) places: Places,
}

/// Where the values of one layer stand.
struct At<'s> {
    places: &'s Places,
    layer: usize,
}

impl At<'_> {
    fn has(&self, key: &str) -> bool {
        self.places.has(&format!("layer.{}.{key}", self.layer))
    }

    fn span(&self, key: &str) -> Span<usize> {
        self.places.span(&format!("layer.{}.{key}", self.layer))
    }

    /// The key that gives the layer's surface.
    fn surface_key(&self) -> &'static str {
        let keys = ["roughness", "alpha", "slope_deg", "smooth", "alpha_x"];
        keys.into_iter().find(|key| self.has(key)).unwrap_or("alpha")
    }

    fn surface(&self) -> Span<usize> {
        self.span(self.surface_key())
    }

    /// An isotropic slope parameter in the terms of this layer's surface.
    fn in_its_terms(&self, alpha: f64) -> String {
        match self.surface_key() {
            "roughness" => format!("`roughness = {}`", short(alpha.sqrt())),
            "slope_deg" => format!("`slope_deg = {}`", short(libm::atan(alpha).to_degrees())),
            _ => format!("`alpha = {}`", short(alpha)),
        }
    }
}

/// Reports every doubt about a valid material.
pub(crate) fn report(material: &Material, spectra: &[Spectrum], sink: &mut Sink<'_>) {
    let Material { stack, bake, places, .. } = material;
    let model = material.model();
    clamped_spectra(bake, spectra, sink);
    empty_tables(stack, bake, places, sink);
    let mut above = &stack.exterior;
    let mut roughest: f64 = 0.0;
    for (i, layer) in stack.layers.iter().enumerate() {
        let at = &At { places, layer: i };
        let is_last = i + 1 == stack.layers.len();
        if bake.lower_alpha.is_none() {
            smoother_than_above(layer, roughest, model, at, sink);
        }
        films(layer, at, sink);
        match &layer.base {
            Base::Dielectric { ior, slab } => {
                dielectric(above, layer, ior, bake, at, sink);
                self::slab(ior, slab, is_last, bake, at, sink);
                above = ior;
                roughest = roughest.max(layer.surface.alpha_isotropic());
            }
            Base::Conductor { ior } if ior.f0().is_none() && ior.samples().iter().all(|s| s.k == 0.0) => {
                let hint = "metals have k above 1; was a dielectric meant?".to_owned();
                sink.warn(at.span("ior"), "this conductor has k = 0 at every wavelength", Some(hint));
            }
            _ => {}
        }
    }
}

/// Warns of spectra that do not cover the wavelengths of the bake.
fn clamped_spectra(bake: &BakeSettings, spectra: &[Spectrum], sink: &mut Sink<'_>) {
    let (low, high) = match bake.color {
        Some(ColorMode::ThreeWavelengths) => {
            let [r, _, b] = bake.wavelengths_nm();
            (b, r)
        }
        _ => VISIBLE_NM,
    };
    for (name, (first, last), span) in spectra {
        if *first > low || *last < high {
            let range = format!("{}-{} nm", short(*first), short(*last));
            let message = format!("`{name}` covers {range} only: outside, it is held constant");
            let hint = format!("the bake reads it over {}-{} nm", short(low), short(high));
            sink.warn(span.clone(), message, Some(hint));
        }
    }
}

/// Warns of kinds of tables that the file asks for and no layer fills.
fn empty_tables(stack: &Stack, bake: &BakeSettings, places: &Places, sink: &mut Sink<'_>) {
    if !places.has("bake.tables") {
        return;
    }
    let at = places.span("bake.tables");
    for kind in &bake.tables {
        let mut layers = stack.layers.iter();
        let (is_some, reason) = match kind.facts().served {
            Served::Interfaces => {
                (layers.any(|layer| !matches!(layer.base, Base::Diffuse(_))), "no layer is an interface")
            }
            Served::Transparent => {
                (layers.any(|layer| matches!(layer.base, Base::Dielectric { .. })), "no layer is transparent")
            }
            Served::Films => (layers.any(|layer| !layer.films.is_empty()), "no layer has a film"),
            Served::VaryingFilms => {
                (layers.any(|layer| layer.films.iter().any(Film::varies)), "no film varies in thickness")
            }
        };
        if !is_some {
            let name = kind.name();
            let hint = format!("leave `\"{name}\"` out");
            sink.warn(at.clone(), format!("`{name}` tables would be empty: {reason}"), Some(hint));
        }
    }
}

/// Warns of a layer below a rougher one, if the model blurs its reflection too much or not at all.
fn smoother_than_above(layer: &Layer, roughest: f64, model: ShadingModel, at: &At<'_>, sink: &mut Sink<'_>) {
    let alpha = layer.surface.alpha_isotropic();
    if matches!(layer.base, Base::Diffuse(_)) || alpha >= roughest {
        return;
    }
    let (effect, hint) = match model {
        ShadingModel::Elek => {
            ("the model `elek` raises it", format!("the model will use {}", at.in_its_terms(roughest)))
        }
        ShadingModel::WeidlichWilkie => (
            "the model `weidlich-wilkie` shows it as sharp as if it were bare",
            "`belcour` follows the light through the rougher layer: write `[bake] model = \"belcour\"`; `lower_alpha = \"at-least-above\"` makes it as \
             rough as that"
                .to_owned(),
        ),
        _ => return,
    };
    let (alpha, above) = (short(alpha), short(roughest));
    let message = format!("this layer (alpha {alpha}) is smoother than one above it (alpha {above}): {effect}");
    sink.warn(at.surface(), message, Some(hint));
}

fn films(layer: &Layer, at: &At<'_>, sink: &mut Sink<'_>) {
    for (i, film) in layer.films.iter().enumerate() {
        if film.thickness.max_nm > FILM_MAX_NM {
            let hint = "was a dielectric layer with `thickness_um` meant?".to_owned();
            let message = format!("a film of {} nm is too thick for coherent colours", short(film.thickness.max_nm));
            sink.warn(at.span(&format!("film.{i}.thickness_nm")), message, Some(hint));
        }
    }
}

fn dielectric(above: &Ior, layer: &Layer, ior: &Ior, bake: &BakeSettings, at: &At<'_>, sink: &mut Sink<'_>) {
    // Beside a diffuse base it stands for a metal. Engines scale the F0 of their surface as they like.
    let is_clear = bake.diffuse_part != Some(DiffusePart::Beside);
    if let Some(f0) = ior.f0().filter(|_| at.has("f0") && !at.has("base_color") && is_clear) {
        let most = f0.iter().fold(0.0, |a: f64, b| a.max(*b));
        if most > DIELECTRIC_F0_MAX {
            let message = format!("an F0 of {} is that of no clear medium: diamond has 0.17", short(most));
            let hint = "was a conductor meant, or `type = \"metallic-roughness\"`?".to_owned();
            sink.warn(at.span("f0"), message, Some(hint));
        }
    }
    // By Schlick's formula an interface reflects whatever its index.
    let differences = [450.0, 550.0, 650.0].map(|nm| (ior.at(nm) - above.at(nm)).norm_sqr());
    let is_same = ior.f0().is_none() && differences.into_iter().all(|squared| squared < SAME_INDEX * SAME_INDEX);
    if layer.films.is_empty() && is_same {
        let hint = "the index is relative to nothing: give it as tables do, against vacuum".to_owned();
        sink.warn(
            at.span("ior"),
            "this interface has the index of the medium above it: it reflects nothing",
            Some(hint),
        );
    }
}

fn slab(ior: &Ior, slab: &Slab, is_last: bool, bake: &BakeSettings, at: &At<'_>, sink: &mut Sink<'_>) {
    let absorbs = slab.absorption_per_um.iter().any(|&a| a > 0.0);
    for (map, message) in [
        ("maps.thickness", "the thickness of a slab that absorbs nothing is of no consequence, nor is this map of it"),
        ("maps.absorption", "this slab absorbs nothing, whatever the texels that multiply it"),
    ] {
        if at.has(map) && (is_last || slab.optical_depth() == [0.0; 3]) {
            let hint = "leave it out, or give `absorption_per_um`, `thickness_um` and a layer below".to_owned();
            sink.warn(at.span(map), message, Some(hint));
        }
    }
    if is_last {
        if slab.thickness_um > 0.0 {
            let hint = "add the layer below it, or leave `thickness_um` out".to_owned();
            let message = "the last dielectric has no bottom: its thickness is of no consequence";
            sink.warn(at.span("thickness_um"), message, Some(hint));
        }
        return;
    }
    if absorbs && slab.thickness_um == 0.0 {
        let hint = "add `thickness_um = ...`".to_owned();
        sink.warn(at.span("absorption_per_um"), "a slab without thickness absorbs nothing", Some(hint));
    }
    // k shapes the reflection only; what the slab absorbs is said by absorption_per_um.
    let per_um = bake.wavelengths_nm().map(|nm| 4e3 * PI * ior.at(nm).im / nm);
    if !absorbs && slab.thickness_um > 0.0 && per_um.iter().any(|a| a * slab.thickness_um > 0.01) {
        let [r, g, b] = per_um.map(short);
        let hint = format!("its k absorbs like `absorption_per_um = [{r}, {g}, {b}]`");
        sink.warn(at.span("ior"), "the index absorbs, but the slab has no `absorption_per_um`", Some(hint));
    }
}
