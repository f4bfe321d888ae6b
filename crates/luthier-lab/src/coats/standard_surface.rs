//! Autodesk Standard Surface as MaterialX's graph `standard_surface` has it.
//!
//! The formula is [`luthier_layers::engines::standard_surface`], with its sources; metals have a white edge.

use luthier_layers::engines::facets::Facets;
use luthier_layers::engines::standard_surface::{Coat, Material};

use super::surface::{INDEX, Shader, Surface};

pub(super) fn shader(surface: &Surface) -> Shader {
    let coat = |alpha: f64| Coat { weight: 1.0, color: [1.0; 3], facets: Facets::isotropic(alpha), ior: INDEX };
    let material = Material {
        base_color: surface.color,
        metallic: surface.metallic,
        coat: surface.coat.map(coat),
        ..Material::plastic(surface.alpha_or(surface.alpha))
    };
    let scale = surface.scale_or([1.0; 3]);
    Box::new(move |at| material.eval_with(scale, None, at.wi, at.wo))
}
