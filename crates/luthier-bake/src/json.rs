//! Inputs of jobs as JSON: the canonical text that keys are hashes of.

use luthier_lut::Axis;
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::ior::Ior;
use serde_json::{Value, json};

pub(crate) fn ior(ior: &Ior) -> Value {
    ior.samples().iter().map(|s| json!([s.wavelength_nm, s.n, s.k])).collect()
}

pub(crate) fn interface(interface: &Interface) -> Value {
    let films: Vec<Value> =
        interface.films.iter().map(|f| json!({"ior": ior(&f.ior), "thickness_nm": f.thickness.nominal_nm()})).collect();
    json!({"above": ior(&interface.above), "films": films, "below": ior(&interface.below)})
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
