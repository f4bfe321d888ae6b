//! OpenPBR 1.1 as MaterialX's graph `open_pbr_surface` has it.
//!
//! Source: AcademySoftwareFoundation/MaterialX 1.39, `libraries/bxdf/open_pbr_surface.mtlx`, graph `NG_open_pbr_surface_surfaceshader`, on the nodes of [`super::materialx`].
//!
//! To the letter: the base has roughness `(r^4 + 2 r_c^4)^(1/4)`; plastic the index over that of the coat; the base is darkened by `(1 - K)/(1 - E K)` with
//! `K = 1 - (1 - F0)/n^2`, the value of a diffuse base whatever the base, and E the base colour. Where the indices are equal, the node of the plastic's
//! interface reflects nothing and still takes the part of F90 from its throughput.
//!
//! A choice here: `coat_ior` is 1.5, where the default is 1.6.

use super::materialx::{dielectric, metal};
use super::surface::{F0, INDEX, Shader, Surface, grazing, rgb};

pub(super) fn shader(surface: &Surface) -> Shader {
    let (surface, coat) = (surface.clone(), surface.coat);
    let rough = coat.map_or(0.0, |coat| 2.0 * coat * coat);
    let alpha = surface.alpha_or((surface.alpha * surface.alpha + rough).min(1.0).sqrt());
    let within = 1.0 - (1.0 - F0) / (INDEX * INDEX);
    let scale = surface.scale_or(surface.color.map(|c| (1.0 - within) / (1.0 - c * within)));
    Box::new(move |at| {
        let metal = metal(at, alpha, surface.color.map(|c| c + (1.0 - c) * grazing(at.d)));
        let index = if coat.is_some() { 1.0 } else { INDEX };
        let plastic = dielectric(at, index, alpha).over(surface.color.map(|c| c * at.i / std::f64::consts::PI));
        let base = |c: usize| surface.metallic * metal[c] + (1.0 - surface.metallic) * plastic[c];
        let Some(coat) = coat else { return rgb(base) };
        dielectric(at, INDEX, coat).over(rgb(|c| scale[c] * base(c)))
    })
}
