//! Layer records: what a shader needs of each layer.

use luthier_layers::domain::INDEX_MAX;
use luthier_layers::elek::{self, ALPHA_MIN, Below};
use luthier_lut::{LayerKind, LayerRecord};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;
use num_complex::Complex64;

/// A relative index that single precision can square twice: both parts at most [`INDEX_MAX`], and not next to nothing. What reflects all
/// the light does so still, within 4e-4.
fn storable(ior: Complex64) -> (f64, f64) {
    let (n, k) = (ior.re.min(INDEX_MAX), ior.im.min(INDEX_MAX));
    (if n.max(k) < 1.0 / INDEX_MAX { 1.0 / INDEX_MAX } else { n }, k)
}

/// Optical depth beyond which nothing comes through, in any precision; without it a shader would meet infinities.
const DEPTH_MAX: f64 = 1e4;

/// The records of a stack, without tiles.
pub(crate) fn records(stack: &Stack, wavelengths_nm: [f64; 3]) -> Vec<LayerRecord> {
    let nodes = Color::ThreeWavelengths(wavelengths_nm).nodes();
    elek::layers(stack)
        .iter()
        .enumerate()
        .map(|(i, layer)| {
            let surface = &stack.layers[i].surface;
            let mut record = LayerRecord {
                kind: LayerKind::Conductor,
                distribution: layer.distribution.name().to_owned(),
                alpha: layer.alpha,
                alpha_xy: [surface.alpha_x, surface.alpha_y].map(|alpha| alpha.clamp(ALPHA_MIN, 1.0)),
                rotation: surface.rotation,
                eta: 1.0,
                ior_n: [1.0; 3],
                ..LayerRecord::default()
            };
            match layer.below {
                Below::Dielectric { eta, optical_depth } => {
                    record.kind = LayerKind::Dielectric;
                    record.eta = eta.clamp(1.0 / INDEX_MAX, INDEX_MAX);
                    record.optical_depth = optical_depth.map(|depth| depth.min(DEPTH_MAX));
                }
                Below::Conductor => {}
                Below::Diffuse(diffuse) => {
                    record.kind = LayerKind::Diffuse;
                    record.albedo = diffuse.albedo;
                    record.sigma = diffuse.sigma;
                }
            }
            if let Some(interface) = Interface::of(stack, i) {
                for (c, node) in nodes.iter().enumerate() {
                    let here = interface.at(node.wavelength_nm);
                    let below = here.below / here.above;
                    (record.ior_n[c], record.ior_k[c]) = storable(below);
                    if let Some(film) = here.films.first() {
                        let relative = film.ior / here.above;
                        (record.film_ior_n[c], record.film_ior_k[c]) = storable(relative);
                        record.film_thickness_waves[c] = film.waves * here.above.re;
                    }
                }
                if let Some(film) = interface.films.first() {
                    record.film_thickness_nm = film.thickness.nominal_nm();
                    record.film_thickness_max_nm = film.thickness.max_nm;
                }
            }
            record
        })
        .collect()
}
