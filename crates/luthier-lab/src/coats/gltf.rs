//! glTF 2.0 with the extension `KHR_materials_clearcoat`.
//!
//! The formula is [`luthier_layers::engines::gltf`], with the masking that the appendix prints.
//!
//! Left open: the appendix is not normative, so that viewers take the height-correlated masking; nothing is said of the F0 of the base below a coat, of
//! a wider base, nor of light that the coat sends back.

use luthier_layers::engines::gltf::{Coat, Material};

use super::surface::{Shader, Surface};

pub(super) fn shader(surface: &Surface) -> Shader {
    let (alpha, scale) = (surface.alpha_or(surface.alpha), surface.scale_or([1.0; 3]));
    let material = Material {
        base_color: surface.color,
        metallic: surface.metallic,
        coat: surface.coat.map(|alpha| Coat { weight: 1.0, alpha }),
        ..Material::plastic(alpha)
    };
    Box::new(move |at| {
        let mut base = material.base(at.wi, at.wo);
        if material.coat.is_some() {
            (0..3).for_each(|c| base[c] *= scale[c]);
        }
        material.coated(base, at.wi, at.wo).map(|f| f * at.i)
    })
}
