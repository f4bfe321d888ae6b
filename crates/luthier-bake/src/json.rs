//! Inputs of jobs as JSON: the canonical text that keys are hashes of.

use luthier_lut::Axis;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Film, Layer, Stack, Surface};
use serde_json::{Value, json};

pub(crate) fn ior(ior: &Ior) -> Value {
    let samples: Value = ior.samples().iter().map(|s| json!([s.wavelength_nm, s.n, s.k])).collect();
    match ior.f0() {
        Some(f0) if ior.f82_tint() != [1.0; 3] => json!({"samples": samples, "f0": f0, "f82_tint": ior.f82_tint()}),
        Some(f0) => json!({"samples": samples, "f0": f0}),
        None => samples,
    }
}

pub(crate) fn interface(interface: &Interface) -> Value {
    let films: Vec<Value> = interface.films.iter().map(film).collect();
    json!({"above": ior(&interface.above), "films": films, "below": ior(&interface.below)})
}

pub(crate) fn stack(stack: &Stack) -> Value {
    json!({"exterior": ior(&stack.exterior), "layers": stack.layers.iter().map(layer).collect::<Vec<_>>()})
}

fn layer(layer: &Layer) -> Value {
    let Surface { distribution, alpha_x, alpha_y, rotation } = layer.surface;
    let base = match &layer.base {
        Base::Dielectric { ior: index, slab } => {
            json!({"ior": ior(index), "thickness_um": slab.thickness_um, "absorption_per_um": slab.absorption_per_um})
        }
        Base::Conductor { ior: index } => json!({"conductor": ior(index)}),
        Base::Diffuse(diffuse) => json!({"albedo": diffuse.albedo, "sigma": diffuse.sigma}),
    };
    json!({
        "films": layer.films.iter().map(film).collect::<Vec<_>>(),
        "surface": [distribution_of(distribution), json!(alpha_x), json!(alpha_y), json!(rotation)],
        "base": base,
    })
}

fn film(film: &Film) -> Value {
    json!({"ior": ior(&film.ior), "thickness_nm": film.thickness.nominal_nm()})
}

/// A name, or a name with the parameters that make another surface.
pub(crate) fn distribution_of(distribution: Distribution) -> Value {
    match distribution {
        Distribution::Abc(shape) | Distribution::Sgd(shape) => json!([distribution.name(), shape.parameters()]),
        Distribution::Beckmann | Distribution::Ggx | Distribution::Blinn => json!(distribution.name()),
    }
}

pub(crate) fn color(color: &Color) -> Value {
    match color {
        Color::Spectral => json!("cie-1931-2deg-d65-rec709"),
        Color::ThreeWavelengths(nm) => json!(nm),
    }
}

pub(crate) fn axis(axis: &Axis) -> Value {
    json!(axis)
}
