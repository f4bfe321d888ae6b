//! Layer records: what a shader needs of each layer.

use luthier_layers::elek::{self, ALPHA_MIN, Below};
use luthier_lut::{LayerKind, LayerRecord};
use luthier_optics::color::Color;
use luthier_optics::interface::Interface;
use luthier_optics::stack::Stack;

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
                    record.eta = eta;
                    record.optical_depth = optical_depth;
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
                    (record.ior_n[c], record.ior_k[c]) = (below.re, below.im);
                    if let Some(film) = here.films.first() {
                        let relative = film.ior / here.above;
                        (record.film_ior_n[c], record.film_ior_k[c]) = (relative.re, relative.im);
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
