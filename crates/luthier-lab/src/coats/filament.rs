//! Filament's clear coat.
//!
//! Source: google/filament, `shaders/src/surface_shading_model_standard.fs`, `surface_brdf.fs`, `common_material.fs` and `surface_shading_lit.fs`, at the highest
//! quality (the WGSL of `luthier_shader::Yardstick::FilamentClearcoat` has the source, too).
//!
//! To the letter: Kelemen's masking for the coat, its reflectance at the half vector, which is taken from the whole base once; a base at least as rough as
//! the coat; the F0 of the base below index 1.5 by Filament's polynomial; Lambert's base without a factor for what the surface reflects; the
//! specular lobe times `1 + f0 (1 / E - 1)`.
//!
//! A choice here: E is the integral, where Filament reads a table of 128 by 128.

use luthier_optics::dielectric_albedo::JointMasking;

use super::surface::{Albedo, F0, Shader, Surface, ggx, grazing, rgb};

/// F0 of the base below a coat of index 1.5, from that in air (`f0ClearCoatToSurface`).
fn below_coat(f0: f64) -> f64 {
    (f0 * (f0 * (0.941892 - 0.263008 * f0) + 0.346479) - 0.0285998).clamp(0.0, 1.0)
}

pub(super) fn shader(surface: &Surface) -> Shader {
    let alpha = surface.alpha_or(surface.alpha.max(surface.coat.unwrap_or(0.0)));
    let (coat, scale, matt) = (surface.coat, surface.scale_or([1.0; 3]), surface.diffuse());
    let f0 = surface.mixed_f0().map(|f0| if coat.is_some() { below_coat(f0) } else { f0 });
    let f90 = (50.0 * 0.33 * f0.iter().sum::<f64>()).clamp(0.0, 1.0);
    let energy = Albedo::new(JointMasking::Correlated, alpha, |_| 1.0);
    Box::new(move |at| {
        let (lobe, edge, lost) = (at.correlated(alpha), grazing(at.d), 1.0 / energy.at(at.o) - 1.0);
        let base = |c: usize| matt[c] + (f0[c] + (f90 - f0[c]) * edge) * lobe * (1.0 + f0[c] * lost);
        let Some(coat) = coat else { return rgb(|c| base(c) * at.i) };
        let share = F0 + (1.0 - F0) * edge;
        let above = share * ggx(coat, at.h) * 0.25 / (at.d * at.d);
        rgb(|c| ((1.0 - share) * scale[c] * base(c) + above) * at.i)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: index 1.5 below index 1.5 reflects nothing, and what reflects all goes on doing so, within the polynomial's fit.
    #[test]
    fn plastic_vanishes_below_its_own_index() {
        assert!(below_coat(0.04) == 0.0 && (below_coat(1.0) - 1.0).abs() < 0.01, "{}", below_coat(1.0));
    }
}
