//! Lossless surfaces, for a white furnace. Roughness, indices of dielectrics, films and their thicknesses stay.

use luthier_optics::schlick::F82;
use luthier_optics::stack::Surface;
use num_complex::Complex64;

use super::{Monochrome, MonochromeBelow, MonochromeLayer};

/// An index without a real part: no light enters, at any angle and under any lossless film.
const MIRROR: MonochromeBelow = MonochromeBelow::Conductor { ior: Complex64::new(0.0, 10.0) };

impl Monochrome {
    /// The stack without loss: no absorption in slabs, films and dielectrics, conductors that reflect everything, diffuse bases of albedo 1. A
    /// medium without end below the last interface gets a white Lambert base at its far end, so that light that enters comes back.
    #[must_use]
    pub fn lossless(&self) -> Self {
        let mut white = self.clone();
        for layer in &mut white.layers {
            without_absorption(layer);
        }
        if let Some(MonochromeBelow::Dielectric { ior, .. }) = white.layers.last().map(|layer| layer.below) {
            let below = MonochromeBelow::Diffuse { albedo: 1.0, sigma: 0.0 };
            white.layers.push(MonochromeLayer {
                surface: Surface::smooth(),
                above: ior,
                films: Vec::new(),
                below,
                f0: None,
            });
        }
        white
    }

    /// The first interface, without loss and with a mirror below it; a diffuse first layer is white.
    #[must_use]
    pub fn lossless_interface(&self) -> Self {
        let mut white = self.clone();
        white.layers.truncate(1);
        if let Some(layer) = white.layers.first_mut() {
            without_absorption(layer);
            if matches!(layer.below, MonochromeBelow::Dielectric { .. }) {
                layer.below = MIRROR;
                layer.f0 = None;
            }
        }
        white
    }
}

fn without_absorption(layer: &mut MonochromeLayer) {
    for film in &mut layer.films {
        film.ior.im = 0.0;
    }
    match &mut layer.below {
        MonochromeBelow::Dielectric { ior, complex_ior, optical_depth } => {
            (*complex_ior, *optical_depth) = (Complex64::new(*ior, 0.0), 0.0);
        }
        MonochromeBelow::Conductor { .. } => {
            layer.below = MIRROR;
            // A mirror under films is one by its index.
            layer.f0 = layer.bare_f0().map(|_| F82 { f0: 1.0, tint: 1.0 });
        }
        MonochromeBelow::Diffuse { albedo, .. } => *albedo = 1.0,
    }
}
