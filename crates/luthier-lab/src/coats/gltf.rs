//! glTF 2.0 with the extension `KHR_materials_clearcoat`.
//!
//! Source: glTF 2.0 specification, appendix B (B.2, B.3), and `KHR_materials_clearcoat` as ratified, section "Layering": `fresnel_coat(normal, ior 1.5,
//! weight, base, layer) = mix(base, layer, weight (f0 + (1 - f0)(1 - |cos_theta_o|)^5))`. Three.js, Babylon.js and Bevy follow it.
//!
//! To the letter: GGX, Smith's masking as the separable product that B.3.2 prints, Schlick's reflectance at the half vector for the base and at the
//! normal for the coat; metal and plastic mixed by `metallic`.
//!
//! Left open: the appendix is not normative, so that viewers take the height-correlated masking; nothing is said of the F0 of the base below a coat, of
//! a wider base, nor of light that the coat sends back.

use super::surface::{F0, Shader, Surface, grazing, rgb};

pub(super) fn shader(surface: &Surface) -> Shader {
    let (surface, alpha) = (surface.clone(), surface.alpha_or(surface.alpha));
    let (scale, matt) = (surface.scale_or([1.0; 3]), surface.diffuse());
    Box::new(move |at| {
        let (lobe, edge) = (at.separable(alpha), grazing(at.d));
        let plastic = F0 + (1.0 - F0) * edge;
        let base = |c: usize| {
            let metal = (surface.color[c] + (1.0 - surface.color[c]) * edge) * lobe;
            surface.metallic * metal + (1.0 - plastic) * matt[c] + (1.0 - surface.metallic) * plastic * lobe
        };
        let Some(coat) = surface.coat else { return rgb(|c| base(c) * at.i) };
        let share = F0 + (1.0 - F0) * grazing(at.o);
        rgb(|c| ((1.0 - share) * scale[c] * base(c) + share * at.separable(coat)) * at.i)
    })
}
