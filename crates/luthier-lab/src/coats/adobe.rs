//! Adobe's implementation of OpenPBR 1.1.
//!
//! Source: adobe/openpbr-bsdf, commit a29da969, `impl/openpbr_bsdf.h` (roughness, darkening), `openpbr_coating_lobe.h`, `openpbr_diffuse_lobe.h`,
//! `openpbr_microfacet_multiple_scattering_lobes.h`, `openpbr_lobe_utils.h`.
//!
//! To the letter: the base has roughness `(r^4 + (1 - 1/n) r_c^4)^(1/4)`, takes `1 - E` of the coat at either direction, which is reciprocal, and is darkened with K between that of mirrors
//! and that of diffuse bases by the base's roughness. Light between facets of metals is a lobe of its own (Kulla and Conty 2017).
//!
//! Choices here: albedos are integrals, where the source has tables; of the masking of both directions the product is taken, which the tables of the source have; the coat's own light between facets, which the source
//! leaves out, is left out.

use std::f64::consts::FRAC_1_PI;

use luthier_optics::dielectric_albedo::{JointMasking, fresnel_dielectric};

use super::surface::{Albedo, INDEX, Shader, Surface, grazing, rgb};

/// `openpbr_average_fresnel` above index 1.
fn average_fresnel(index: f64) -> f64 {
    (index - 1.0) / (4.08567 + 1.00071 * index)
}

pub(super) fn shader(surface: &Surface) -> Shader {
    let coat = surface.coat;
    let rough = coat.map_or(0.0, |coat| (1.0 - 1.0 / INDEX) * coat * coat);
    let own_alpha = (surface.alpha * surface.alpha + rough).min(1.0).sqrt();
    let alpha = surface.alpha_or(own_alpha);
    let mirror = average_fresnel(INDEX);
    let diffuse = 1.0 - (1.0 - mirror) / (INDEX * INDEX);
    // Below the coat plastic has the coat's index, and reflects nothing.
    let spread = 1.0 + (own_alpha.sqrt() - 1.0) * surface.metallic;
    let within = mirror + (diffuse - mirror) * spread;
    let average = surface.color.map(|c| c + (1.0 - c) / 21.0);
    let mean = rgb(|c| surface.metallic * average[c] + (1.0 - surface.metallic) * surface.color[c]);
    let scale = surface.scale_or(mean.map(|mean| (1.0 - within) / (1.0 - mean * within)));
    let of = |alpha, index| Albedo::new(JointMasking::Separable, alpha, move |cos| fresnel_dielectric(index, cos));
    let (above, plastic) = (coat.map(|coat| of(coat, INDEX)), coat.is_none().then(|| of(alpha, INDEX)));
    let facets = Albedo::new(JointMasking::Separable, alpha, |_| 1.0);
    let surface = surface.clone();
    Box::new(move |at| {
        let (lobe, edge) = (at.separable(alpha), grazing(at.d));
        let lost = (1.0 - facets.at(at.i)) * (1.0 - facets.at(at.o)) / (1.0 - facets.average).max(1e-9) * FRAC_1_PI;
        let fresnel = if coat.is_none() { fresnel_dielectric(INDEX, at.d) } else { 0.0 };
        let left = plastic.as_ref().map_or(1.0, |e| (1.0 - e.at(at.i)) * (1.0 - e.at(at.o)) / (1.0 - e.average));
        let base = |c: usize| {
            let color = surface.color[c];
            let metal = (color + (1.0 - color) * edge) * lobe + average[c] * average[c] * lost;
            surface.metallic * metal + (1.0 - surface.metallic) * (fresnel * lobe + left * color * FRAC_1_PI)
        };
        let (Some(coat), Some(above)) = (coat, &above) else { return rgb(|c| base(c) * at.i) };
        let passed = (1.0 - above.at(at.i)) * (1.0 - above.at(at.o));
        let coat = fresnel_dielectric(INDEX, at.d) * at.separable(coat);
        rgb(|c| (passed * scale[c] * base(c) + coat) * at.i)
    })
}
