//! Lambert's and Oren and Nayar's models of the diffuse base of a stack, as if nothing lay above it.

use glam::DVec3;

use crate::formulas::oren_nayar;
use crate::model::{Claims, Kind, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// Lambert 1760: `f = albedo / pi`. Zero for a stack without a diffuse base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Lambert;

/// Oren and Nayar 1994, with inter-reflection: [`oren_nayar::brdf`]. Zero for a stack without a diffuse base.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct OrenNayar;

impl Model for Lambert {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "lambert",
            kind: Kind::Surface,
            claims: Claims::BOTH,
            source: "Lambert 1760",
            domain: "the diffuse base of any stack, by itself; 0 without one",
            leaves_out: "everything above the base, and the base's roughness",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        base(stack, wi, wo, |albedo, _| oren_nayar::brdf_scalar(albedo, 0.0, wi, wo))
    }

    fn lossless(&self, stack: &Monochrome) -> Monochrome {
        white_base(stack)
    }
}

impl Model for OrenNayar {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "oren-nayar",
            kind: Kind::Surface,
            claims: Claims::RECIPROCAL,
            source: "Oren and Nayar 1994, eq. 26-30, with inter-reflection",
            domain: "the diffuse base of any stack, by itself; 0 without one",
            leaves_out: "everything above the base; gains at grazing angles, 1.7% at 89 degrees for sigma 0.5",
            inputs: &[],
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        base(stack, wi, wo, |albedo, sigma| oren_nayar::brdf_scalar(albedo, sigma, wi, wo))
    }

    fn lossless(&self, stack: &Monochrome) -> Monochrome {
        white_base(stack)
    }
}

fn base(stack: &Monochrome, wi: DVec3, wo: DVec3, brdf: impl Fn(f64, f64) -> f64) -> f64 {
    match stack.layers.last().map(|layer| layer.below) {
        Some(MonochromeBelow::Diffuse { albedo, sigma }) if wi.z > 0.0 && wo.z > 0.0 => wi.z * brdf(albedo, sigma),
        _ => 0.0,
    }
}

/// The base alone, white; no layers if there is none.
fn white_base(stack: &Monochrome) -> Monochrome {
    let mut layers: Vec<MonochromeLayer> = stack.layers.last().cloned().into_iter().collect();
    layers.retain_mut(|layer| match &mut layer.below {
        MonochromeBelow::Diffuse { albedo, .. } => {
            *albedo = 1.0;
            true
        }
        MonochromeBelow::Dielectric { .. } | MonochromeBelow::Conductor { .. } => false,
    });
    Monochrome { exterior: stack.exterior, layers }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::directional_albedo::directional_albedo;
    use luthier_optics::stack::Surface;
    use num_complex::Complex64;

    fn stack(last: MonochromeBelow) -> Monochrome {
        Monochrome::bare(&[MonochromeBelow::dielectric(1.5, 1.0), last].map(|below| (Surface::smooth(), below)))
    }

    /// Values by hand: albedo cos / pi; and Oren and Nayar's C1 + C3-free value at the normal, 1 - 0.5 s/(s + 0.33) + 0.17 rho s/(s +
    /// 0.13), s being sigma squared.
    #[test]
    fn the_base_alone_is_seen() {
        let base = stack(MonochromeBelow::Diffuse { albedo: 0.6, sigma: 0.5 });
        let wi = DVec3::new(0.6, 0.0, 0.8);
        assert!((Lambert.eval(&base, wi, DVec3::Z) - 0.6 * 0.8 / PI).abs() < 1e-15);
        let expected = 0.6 / PI * (1.0 - 0.5 * 0.25 / 0.58 + 0.17 * 0.6 * 0.25 / 0.38);
        let found = OrenNayar.eval(&base, DVec3::Z, DVec3::Z);
        assert!((found - expected).abs() < 1e-12, "{found} {expected}");
        let metal = stack(MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.0) });
        assert_eq!([Lambert.eval(&metal, wi, DVec3::Z), OrenNayar.eval(&metal, wi, DVec3::Z)], [0.0; 2]);
        for (wi, wo) in [(-wi, DVec3::Z), (DVec3::Z, -wi), (-wi, -wi), (DVec3::Z, DVec3::X), (DVec3::X, DVec3::Z)] {
            assert_eq!([Lambert.eval(&base, wi, wo), OrenNayar.eval(&base, wi, wo)], [0.0; 2], "{wi} {wo}");
        }
    }

    /// Values by hand, light at 60 degrees and the eye at 30, facing each other and side by side: Oren and Nayar's C1 to C3 and the
    /// bounced part, s being sigma squared 0.25, albedo 0.6.
    #[test]
    fn a_rough_base_has_the_cosine_of_the_light() {
        let base = stack(MonochromeBelow::Diffuse { albedo: 0.6, sigma: 0.5 });
        let direction = |theta: f64, phi: f64| {
            DVec3::new(libm::sin(theta) * libm::cos(phi), libm::sin(theta) * libm::sin(phi), libm::cos(theta))
        };
        let wi = direction(PI / 3.0, 0.0);
        let (c1, third) = (1.0 - 0.125 / 0.58, 1.0 / 3.0);
        // tan(beta) = 1/sqrt 3, tan((alpha + beta)/2) = 1, (2 beta/pi)^2 = 1/9, (4 alpha beta/pi^2)^2 = 4/81.
        let facing = c1 + 0.1125 / 0.34 * libm::sin(PI / 3.0) / libm::sqrt(3.0);
        let beside = c1 + 0.03125 / 0.34 * 4.0 / 81.0;
        for (phi, direct, bounced) in [(0.0, facing, 1.0 - third * third), (0.5 * PI, beside, 1.0)] {
            let expected = 0.5 * 0.6 / PI * (direct + 0.6 * 0.0425 / 0.38 * bounced);
            let found = OrenNayar.eval(&base, wi, direction(PI / 6.0, phi));
            assert!((found - expected).abs() < 1e-12, "{phi}: {found} {expected}");
        }
    }

    /// The white furnace of a base is the base alone and white, as rough as it was; a white Lambert base returns all light.
    #[test]
    fn the_furnace_of_a_base_is_white() {
        for (model, sigma) in [(&Lambert as &dyn Model, 0.0), (&OrenNayar, 0.0), (&OrenNayar, 0.5)] {
            let white = model.lossless(&stack(MonochromeBelow::Diffuse { albedo: 0.3, sigma }));
            assert_eq!(white.layers.len(), 1);
            assert_eq!(white.layers[0].below, MonochromeBelow::Diffuse { albedo: 1.0, sigma });
            assert_eq!(white.exterior, 1.0);
            let wo = DVec3::new(0.6, 0.0, 0.8);
            let radiance = directional_albedo(model, &white, wo).value;
            assert!(sigma > 0.0 || (radiance - 1.0).abs() < 1e-6, "{radiance}");
        }
        let metal = stack(MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.0) });
        assert!(Lambert.lossless(&metal).layers.is_empty() && OrenNayar.lossless(&metal).layers.is_empty());
    }
}
