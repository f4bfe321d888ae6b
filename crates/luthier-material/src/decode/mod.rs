//! Decoder from a document to a material. The checker has seen to keys, types and ranges; the decoder checks values against each other. A
//! stand-in for a missing or wrong value keeps the decoder going, so that one run reports everything; the result counts only when nothing
//! was reported.

mod bake;
mod darkening;
mod effects;
mod films;
mod ior;
mod layers;
mod live;
mod maps;
mod picture;
mod reradiation;
mod schlick;
mod surface;

use std::cell::RefCell;
use std::collections::BTreeSet;

use luthier_optics::ior::Ior;
use luthier_optics::stack::Stack;

use self::ior::Read;
use crate::bake_settings::SODIUM_D_NM;
use crate::class::SurfaceClass;
use crate::diagnostic::Sink;
use crate::doubt::{self, Sources};
use crate::material::Material;
use crate::section::Section;
use crate::suggest::short;

/// k up to which a medium passes for transparent: 0.2 % over a path of one wavelength.
const TRANSPARENT_K: f64 = 1e-4;

/// Decodes a document, with its doubts.
pub(crate) fn decode(label: &str, text: &str, document: &Section<'_>, read: Read<'_>, sink: &mut Sink<'_>) -> Material {
    let mut sources = Sources::default();
    let named = RefCell::new(BTreeSet::new());
    let read: Read<'_> = &|path| {
        named.borrow_mut().insert(path.to_owned());
        read(path)
    };
    let exterior = exterior(document, read, sink, &mut sources);
    let (layers, extras) = layers::decode(document, &exterior, read, sink, &mut sources);
    sources.places.add("", document);
    let stack = Stack { exterior, layers };
    let bake = bake::decode(document, sink);
    let is_fluorescent = extras.iter().any(|layer| layer.reradiation.is_some());
    let effects = effects::decode(document, &stack, is_fluorescent, sink);
    maps::check_effects(document, &extras, sink);
    if effects.patina.is_some() {
        schlick::check_bare(document, &stack, sink);
    }
    schlick::check_below_weight(document, sink);
    darkening::check(document, sink);
    let Sources { spectra, places } = sources;
    let mut material = Material {
        name: document.text("name").unwrap_or_default().to_owned(),
        source: label.to_owned(),
        text: text.to_owned(),
        files: Vec::new(),
        description: document.text("description").unwrap_or_default().to_owned(),
        references: document.texts("references"),
        class: SurfaceClass::of(&stack),
        stack,
        layers: extras,
        effects,
        bake,
        budget: bake::budget(document),
        places,
    };
    let mut files = named.into_inner();
    files.extend(material.images().iter().map(|image| image.picture.path.clone()));
    material.files = files.into_iter().collect();
    if !sink.has_errors() {
        bake::check_limits(&material, document, sink);
    }
    if !sink.has_errors() {
        doubt::report(&material, &spectra, sink);
    }
    material
}

/// The exterior medium. A trace of absorption in a data set is dropped; real absorption is an error.
fn exterior(document: &Section<'_>, read: Read<'_>, sink: &mut Sink<'_>, sources: &mut Sources) -> Ior {
    let Some(ior) = ior::decode(document, "exterior", read, sink, sources) else { return Ior::vacuum() };
    ior::check_clear(&ior, document, "exterior", sink);
    let k_max = ior.samples().iter().fold(0.0, |k: f64, s| k.max(s.k));
    if k_max > TRANSPARENT_K {
        let span = document.value_span("exterior");
        let message = format!("the exterior must be transparent, but its k reaches {}", short(k_max));
        let n = short(ior.at(SODIUM_D_NM).re);
        sink.error(span, message, Some(format!("write `exterior = {n}` for its real part alone")));
    }
    let mut samples = ior.samples().to_vec();
    samples.iter_mut().for_each(|s| s.k = 0.0);
    Ior::sampled(samples).unwrap_or(ior)
}
