//! Albedo scaling: the base times 1 less the directional albedo of the coat, as Cycles' Principled BSDF and Arnold's `standard_surface` layer.
//!
//! Source: Blender, `intern/cycles/kernel/svm/closure.h` (Principled BSDF), `kernel/closure/bsdf_util.h` (`closure_layering_weight`: `1 - reduce_max(albedo)`) and
//! `kernel/closure/bsdf_microfacet.h` (`microfacet_ggx_preserve_energy`); Kulla and Conty 2017, section "Layering".
//!
//! The directional albedo is that at the eye, which is not reciprocal. Coat, metal and plastic have `1 + F_ms (1 - E)/E` on their lobes, with
//! `F_ms = F E_avg / (1 - F (1 - E_avg))`, for light between facets. Plastic keeps its index in air. The base has neither another width nor a factor.
//!
//! A choice here: albedos are integrals, where Cycles has tables.

use std::f64::consts::FRAC_1_PI;

use luthier_optics::dielectric_albedo::{JointMasking, fresnel_dielectric};
use luthier_optics::fresnel::dielectric_average;

use super::surface::{Albedo, INDEX, Shader, Surface, grazing, rgb};

/// A lobe of facets, and its factor for light between them.
struct Facets {
    facets: Albedo,
    dielectric: Albedo,
}

impl Facets {
    fn new(alpha: f64) -> Self {
        let of = |reflectance: &dyn Fn(f64) -> f64| Albedo::new(JointMasking::Correlated, alpha, reflectance);
        Self { facets: of(&|_| 1.0), dielectric: of(&|cos| fresnel_dielectric(INDEX, cos)) }
    }

    /// Factor for an average reflectance of the facets.
    fn more(&self, average: f64, cos_theta: f64) -> f64 {
        let (all, here) = (self.facets.average, self.facets.at(cos_theta));
        1.0 + average * all / (1.0 - average * (1.0 - all)) * (1.0 - here) / here
    }

    /// Directional albedo of index 1.5.
    fn albedo(&self, cos_theta: f64) -> f64 {
        self.dielectric.at(cos_theta) * self.more(dielectric_average(INDEX), cos_theta)
    }
}

pub(super) fn shader(surface: &Surface) -> Shader {
    let (surface, alpha) = (surface.clone(), surface.alpha_or(surface.alpha));
    let (scale, below) = (surface.scale_or([1.0; 3]), Facets::new(alpha));
    let above = surface.coat.map(|coat| (coat, Facets::new(coat)));
    Box::new(move |at| {
        let (lobe, edge) = (at.correlated(alpha), grazing(at.d));
        let fresnel = fresnel_dielectric(INDEX, at.d);
        let gloss = fresnel * lobe * below.more(dielectric_average(INDEX), at.o);
        let base = |c: usize| {
            let color = surface.color[c];
            let metal = (color + (1.0 - color) * edge) * lobe * below.more(color + (1.0 - color) / 21.0, at.o);
            let plastic = gloss + (1.0 - below.albedo(at.o)) * color * FRAC_1_PI;
            surface.metallic * metal + (1.0 - surface.metallic) * plastic
        };
        let Some((alpha, above)) = &above else { return rgb(|c| base(c) * at.i) };
        let coat = fresnel * at.correlated(*alpha) * above.more(dielectric_average(INDEX), at.o);
        rgb(|c| ((1.0 - above.albedo(at.o)) * scale[c] * base(c) + coat) * at.i)
    })
}
