//! Doubtful physics: what a material may say, but rarely means.

use std::f64::consts::PI;
use std::ops::Range as Span;

use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Layer, Slab, Stack};

use crate::bake_settings::{BakeSettings, ColorSetting};
use crate::diagnostic::Sink;
use crate::section::Section;
use crate::suggest::short;

/// The line at which a single index is usually quoted.
pub(crate) const SODIUM_D_NM: f64 = 589.3;

/// What the colour integral needs.
const VISIBLE_NM: (f64, f64) = (360.0, 830.0);

/// Smallest slope parameter that the real-time models tell from a smooth surface.
const ALPHA_MIN: f64 = 1e-3;

/// Thickest film whose colour the 5 nm steps of the spectrum still resolve with margin: at n = 1.5 neighbouring fringes
/// are 13 nm apart at 450 nm.
const FILM_MAX_NM: f64 = 5000.0;

/// Two indices that differ by less than this reflect less than 1e-8 at normal incidence.
const SAME_INDEX: f64 = 2e-4;

/// Places in the text that doubts point at.
#[derive(Default)]
pub(crate) struct Sources {
    /// Sampled spectra from data sets and files: name, range in nm, place.
    pub(crate) spectra: Vec<(String, (f64, f64), Span<usize>)>,
    /// Parallel to the layers of the stack.
    pub(crate) layers: Vec<LayerSource>,
}

/// A part of a layer that a diagnostic can point at.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LayerPart {
    /// Its slope parameters.
    Surface,
    /// Its index.
    Index,
    /// What its slab absorbs.
    Slab,
    /// The thickness of its first film.
    Film,
}

/// Places in one layer.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct LayerSource {
    surface_key: &'static str,
    surface: Span<usize>,
    ior: Span<usize>,
    thickness: Span<usize>,
    absorption: Span<usize>,
    films: Vec<Span<usize>>,
}

impl LayerSource {
    pub(crate) fn of(at: &Section<'_>, films: Vec<Span<usize>>) -> Self {
        let keys = ["roughness", "alpha", "slope_deg", "smooth", "alpha_x"];
        let surface_key = keys.into_iter().find(|k| at.has(k)).unwrap_or("alpha");
        Self {
            surface_key,
            surface: at.value_span(surface_key),
            ior: at.value_span("ior"),
            thickness: at.value_span("thickness_um"),
            absorption: at.value_span("absorption_per_um"),
            films,
        }
    }

    /// Where a part of the layer is described.
    pub(crate) fn span(&self, part: LayerPart) -> Span<usize> {
        match part {
            LayerPart::Surface => self.surface.clone(),
            LayerPart::Index => self.ior.clone(),
            LayerPart::Slab => self.absorption.clone(),
            LayerPart::Film => self.films.first().unwrap_or(&self.ior).clone(),
        }
    }

    /// An isotropic slope parameter in the terms of this layer's surface.
    fn in_its_terms(&self, alpha: f64) -> String {
        match self.surface_key {
            "roughness" => format!("`roughness = {}`", short(alpha.sqrt())),
            "slope_deg" => format!("`slope_deg = {}`", short(libm::atan(alpha).to_degrees())),
            _ => format!("`alpha = {}`", short(alpha)),
        }
    }
}

/// Reports every doubt about a valid stack.
pub(crate) fn report(stack: &Stack, bake: &BakeSettings, sources: &Sources, sink: &mut Sink<'_>) {
    clamped_spectra(bake, sources, sink);
    let mut above = &stack.exterior;
    let mut roughest: f64 = 0.0;
    for (i, (layer, at)) in stack.layers.iter().zip(&sources.layers).enumerate() {
        let is_last = i + 1 == stack.layers.len();
        surface(layer, roughest, at, sink);
        films(layer, at, sink);
        match &layer.base {
            Base::Dielectric { ior, slab } => {
                dielectric(above, layer, ior, at, sink);
                self::slab(ior, slab, is_last, bake, at, sink);
                above = ior;
                roughest = roughest.max(layer.surface.alpha_isotropic());
            }
            Base::Conductor { ior } if ior.samples().iter().all(|s| s.k == 0.0) => {
                let hint = "metals have k above 1; was a dielectric meant?".to_owned();
                sink.warn(at.ior.clone(), "this conductor has k = 0 at every wavelength", Some(hint));
            }
            _ => {}
        }
    }
}

/// Spectra that do not reach as far as the bake asks for them.
fn clamped_spectra(bake: &BakeSettings, sources: &Sources, sink: &mut Sink<'_>) {
    let (low, high) = match bake.color {
        Some(ColorSetting::ThreeWavelengths) => {
            let [r, _, b] = bake.wavelengths_nm();
            (b, r)
        }
        _ => VISIBLE_NM,
    };
    for (name, (first, last), span) in &sources.spectra {
        if *first > low || *last < high {
            let range = format!("{}-{} nm", short(*first), short(*last));
            let message = format!("`{name}` covers {range} only: outside, it is held constant");
            let hint = format!("the bake reads it over {}-{} nm", short(low), short(high));
            sink.warn(span.clone(), message, Some(hint));
        }
    }
}

fn surface(layer: &Layer, roughest: f64, at: &LayerSource, sink: &mut Sink<'_>) {
    if matches!(layer.base, Base::Diffuse(_)) {
        return;
    }
    let alpha = layer.surface.alpha_isotropic();
    if alpha > 0.0 && alpha < ALPHA_MIN {
        let message = format!("alpha = {} is below {ALPHA_MIN}, which the real-time models use instead", short(alpha));
        let hint = format!("write `smooth = true`, or {}", at.in_its_terms(ALPHA_MIN));
        sink.warn(at.surface.clone(), message, Some(hint));
    }
    if alpha < roughest {
        let message = format!(
            "this layer (alpha {}) is smoother than one above it (alpha {}): the real-time model raises it",
            short(alpha),
            short(roughest)
        );
        let hint = format!("what it will use is {}", at.in_its_terms(roughest));
        sink.warn(at.surface.clone(), message, Some(hint));
    }
}

fn films(layer: &Layer, at: &LayerSource, sink: &mut Sink<'_>) {
    for (film, span) in layer.films.iter().zip(&at.films) {
        if film.thickness.max_nm > FILM_MAX_NM {
            let hint = "was a dielectric layer with `thickness_um` meant?".to_owned();
            let message = format!("a film of {} nm is too thick for coherent colours", short(film.thickness.max_nm));
            sink.warn(span.clone(), message, Some(hint));
        }
    }
}

fn dielectric(above: &Ior, layer: &Layer, ior: &Ior, at: &LayerSource, sink: &mut Sink<'_>) {
    let same = |nm: f64| (ior.at(nm) - above.at(nm)).norm_sqr() < SAME_INDEX * SAME_INDEX;
    if layer.films.is_empty() && [450.0, 550.0, 650.0].into_iter().all(same) {
        let hint = "the index is relative to nothing: give it as tables do, against vacuum".to_owned();
        sink.warn(
            at.ior.clone(),
            "this interface has the index of the medium above it: it reflects nothing",
            Some(hint),
        );
    }
}

fn slab(ior: &Ior, slab: &Slab, is_last: bool, bake: &BakeSettings, at: &LayerSource, sink: &mut Sink<'_>) {
    let absorbs = slab.absorption_per_um.iter().any(|&a| a > 0.0);
    if is_last {
        if slab.thickness_um > 0.0 {
            let hint = "add the layer below it, or leave `thickness_um` out".to_owned();
            let message = "the last dielectric has no bottom: its thickness is of no consequence";
            sink.warn(at.thickness.clone(), message, Some(hint));
        }
        return;
    }
    if absorbs && slab.thickness_um == 0.0 {
        let hint = "add `thickness_um = ...`".to_owned();
        sink.warn(at.absorption.clone(), "a slab without thickness absorbs nothing", Some(hint));
    }
    // k shapes the reflection only; what the slab absorbs is said by absorption_per_um.
    let per_um = bake.wavelengths_nm().map(|nm| 4e3 * PI * ior.at(nm).im / nm);
    if !absorbs && slab.thickness_um > 0.0 && per_um.iter().any(|a| a * slab.thickness_um > 0.01) {
        let [r, g, b] = per_um.map(short);
        let hint = format!("its k absorbs like `absorption_per_um = [{r}, {g}, {b}]`");
        sink.warn(at.ior.clone(), "the index absorbs, but the slab has no `absorption_per_um`", Some(hint));
    }
}
