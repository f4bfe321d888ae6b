//! OpenPBR 1.1 as MaterialX's graph `open_pbr_surface` has it.
//!
//! The formula is [`luthier_layers::engines::open_pbr`], with its sources.
//!
//! A choice here: `coat_ior` is 1.5, where the default is 1.6.

use luthier_layers::engines::facets::Facets;
use luthier_layers::engines::open_pbr::{Below, Coat, Material};

use super::surface::{INDEX, Shader, Surface};

pub(super) fn shader(surface: &Surface) -> Shader {
    let coat = |alpha: f64| Coat {
        weight: 1.0,
        color: [1.0; 3],
        facets: Facets::isotropic(alpha),
        ior: INDEX,
        darkening: 1.0,
    };
    let material = Material {
        base_color: surface.color,
        metallic: surface.metallic,
        coat: surface.coat.map(coat),
        ..Material::plastic(surface.alpha.sqrt())
    };
    let Below { facets, scale } = material.below();
    let below = Below { facets: Facets::isotropic(surface.alpha_or(facets.mean())), scale: surface.scale_or(scale) };
    Box::new(move |at| material.eval_with(&below, None, at.wi, at.wo))
}
