//! Diffuse base below the layers of statistical models. The papers have none, because its light has no mean direction to follow.

use std::array::from_fn;

use glam::DVec3;
use luthier_optics::quadrature::gauss_legendre;

use super::adding::{Transport, add};
use super::energy::Energy;
use crate::formulas::oren_nayar;
use crate::layers::{Below, Layers};

/// Points over the directions of diffuse light: within 1e-7 for smooth interfaces.
const POINTS: usize = 24;

/// A diffuse base seen through layers, in `C` channels.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DiffuseBase<const C: usize> {
    albedo: [f64; C],
    sigma: f64,
    /// Index above the base over index of the exterior.
    eta: f64,
    veil: Veil<C>,
}

/// Effect of the layers above a diffuse base on diffuse light. It does not depend on directions.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Veil<const C: usize> {
    /// Part of the base's cosine-weighted light that the layers send back to it.
    pub internal: [f64; C],
    /// Ratio of the shares of such light that the layers pass up and down; 1 for smooth layers.
    pub upward: [f64; C],
}

impl<const C: usize> Veil<C> {
    /// The veil of a base without layers above.
    pub const NONE: Self = Self { internal: [0.0; C], upward: [1.0; C] };

    /// The veil of the layers above the base of a stack, or `None` if it has no diffuse one.
    ///
    /// Light of the base beyond the critical angle of the exterior is totally reflected. It is taken to cross the lowest slab only.
    pub fn new(stack: &Layers<C>, energy: &dyn Energy<C>) -> Option<Self> {
        let (base, ..) = stack.base()?;
        let Some(lowest) = base.checked_sub(1).and_then(|above| stack.layers.get(above)) else {
            return Some(Self::NONE);
        };
        let depth = match lowest.below {
            Below::Dielectric { optical_depth, .. } => optical_depth,
            Below::Conductor | Below::Diffuse { .. } => [0.0; C],
        };
        let eta = stack.layers[base].above / stack.exterior;
        let critical_sq = ((eta - 1.0) * (eta + 1.0) / (eta * eta)).max(0.0);
        let critical = critical_sq.sqrt();
        let (mut sum, mut up, mut down) = ([0.0; C], [0.0; C], [0.0; C]);
        for (x, weight) in gauss_legendre(POINTS) {
            let beyond = critical * x;
            // In a medium no denser than the exterior there is no light beyond, and the exponent would be 0/0 without absorption.
            for c in (0..C).filter(|_| beyond > 0.0) {
                sum[c] += weight * critical * 2.0 * beyond * libm::exp(-2.0 * depth[c] / beyond);
            }
            // The square gathers points at the critical angle, from which reflectances fall like square roots.
            let cos = critical + (1.0 - critical) * x * x;
            let cos_outside_sq = 1.0 - eta * eta * (1.0 - cos) * (1.0 + cos);
            if cos_outside_sq > 0.0 {
                let transport = add::<f64, C>(stack, energy, cos_outside_sq.sqrt().min(1.0));
                let share = weight * (1.0 - critical) * 2.0 * x * 2.0 * cos;
                for c in 0..C {
                    sum[c] += share * transport.from_below[c];
                    up[c] += share * transport.emerging[c];
                    down[c] += share * transport.transmitted[c];
                }
            }
        }
        let upward = from_fn(|c| if down[c] > 0.0 { (up[c] / down[c]).min(1.0) } else { 1.0 });
        Some(Self { internal: sum.map(|r| r.clamp(0.0, 1.0)), upward })
    }
}

impl<const C: usize> DiffuseBase<C> {
    /// The base of a stack, or `None` if it has no diffuse one.
    pub fn new(stack: &Layers<C>, energy: &dyn Energy<C>) -> Option<Self> {
        Self::veiled(stack, Veil::new(stack, energy)?)
    }

    /// The base of a stack, with a known veil, or `None` if it has no diffuse one.
    pub fn veiled(stack: &Layers<C>, veil: Veil<C>) -> Option<Self> {
        let (base, albedo, sigma) = stack.base()?;
        Some(Self { albedo, sigma, eta: stack.layers[base].above / stack.exterior, veil })
    }

    /// BRDF of the base seen through the layers, in 1/sr, from the transports of both directions at their own angles.
    ///
    /// `f = T(wi) T(wo) f_base / (n^2 (1 - rho R))`, with R the diffuse reflectance from below. This is exact for smooth layers on Lambert's base.
    ///
    /// The statistics count total reflection only on the way up. So rough layers pass less light up (Ti0) than down (T0i), and R belongs to Ti0. Both T
    /// here are T0i, which keeps f reciprocal. One factor, the ratio of the means of Ti0 and T0i over diffuse light, makes up for the difference: the
    /// base never returns more light than enters, and returns all of it if it is white and nothing absorbs.
    pub fn brdf<S>(&self, wi: (DVec3, &Transport<S, C>), wo: (DVec3, &Transport<S, C>)) -> [f64; C] {
        from_fn(|c| {
            let transmitted = wi.1.transmitted[c] * wo.1.transmitted[c] * self.veil.upward[c];
            // Nothing is lost only between a white base and layers that return everything. These let no light in.
            let lost = 1.0 - self.albedo[c] * self.veil.internal[c];
            if transmitted <= 0.0 || lost <= 0.0 {
                return 0.0;
            }
            let f = oren_nayar::brdf_scalar(self.albedo[c], self.sigma, inside(wi), inside(wo));
            transmitted * f / (self.eta * self.eta * lost)
        })
    }

    /// Effect of the layers above on the light of the base.
    pub fn veil(&self) -> Veil<C> {
        self.veil
    }
}

/// The mean direction of light above the base, at the azimuth of its direction outside.
fn inside<S, const C: usize>((w, transport): (DVec3, &Transport<S, C>)) -> DVec3 {
    let cos = transport.cos_theta;
    let across = libm::hypot(w.x, w.y);
    let scale = if across > 0.0 { (1.0 - cos * cos).max(0.0).sqrt() / across } else { 0.0 };
    DVec3::new(w.x * scale, w.y * scale, cos)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::models::statistics::fixtures::fresnel;
    use crate::monochrome::{Monochrome, MonochromeBelow};
    use luthier_optics::stack::Surface;

    fn coated(albedo: f64, optical_depth: f64) -> Monochrome {
        let base = MonochromeBelow::Diffuse { albedo, sigma: 0.0 };
        Monochrome::bare(
            &[MonochromeBelow::dielectric(1.5, optical_depth), base].map(|below| (Surface::smooth(), below)),
        )
    }

    #[test]
    fn smooth_coat_on_lambert_closed_forms() {
        // Oracle: closed-form averages of Fresnel's formulas; normal incidence and hemispherical.
        for (rho, normal, hemispherical) in [
            (0.18, 0.11813908, 0.16570257),
            (0.5, 0.31607089, 0.35295886),
            (0.8, 0.63283341, 0.65263668),
            (1.0, 1.0, 1.0),
        ] {
            let stack = coated(rho, 0.0);
            let energy = fresnel(&stack);
            let stack = Layers::from(&stack);
            let base = DiffuseBase::new(&stack, &energy).unwrap();
            assert!((base.veil().internal[0] - 0.5963457597).abs() < 1e-7);
            let albedo = |cos: f64| {
                let eye = add::<f64, 1>(&stack, &energy, cos);
                let wo = DVec3::new((1.0 - cos * cos).sqrt(), 0.0, cos);
                // f depends on the cosine of wi only; cos^2 gathers points at grazing angles.
                let [mut sum] = eye.reflected();
                for (x, weight) in gauss_legendre(64) {
                    let mu = x * x;
                    let wi = DVec3::new((1.0 - mu * mu).sqrt(), 0.0, mu);
                    let light = add::<f64, 1>(&stack, &energy, mu);
                    sum += weight * 2.0 * x * 2.0 * PI * mu * base.brdf((wi, &light), (wo, &eye))[0];
                }
                sum
            };
            assert!((albedo(1.0) - normal).abs() < 1e-7, "{rho}: {}", albedo(1.0));
            let mean: f64 = gauss_legendre(64).iter().map(|(x, w)| w * 2.0 * x * 2.0 * x * x * albedo(x * x)).sum();
            assert!((mean - hemispherical).abs() < 1e-7, "{rho}: {mean}");
        }
    }

    /// A free film, or a gap, above the base: the medium on it is no denser than the exterior, so that there is no critical angle.
    #[test]
    fn a_base_below_air_has_no_light_beyond_a_critical_angle() {
        for ior in [1.0, 0.7] {
            let mut stack = coated(0.5, 0.0);
            stack.layers[0].below = MonochromeBelow::dielectric(ior, 0.0);
            stack = Monochrome::joined(1.0, stack.layers);
            let veil = Veil::new(&Layers::from(&stack), &fresnel(&stack)).unwrap();
            // An interface between equal media returns nothing; that of a thinner medium some, by refraction inwards.
            assert!(
                (0.0..0.5).contains(&veil.internal[0]) && (ior < 1.0 || veil.internal[0] < 1e-12),
                "{ior}: {veil:?}"
            );
        }
    }

    #[test]
    fn absorption_darkens_the_base() {
        let internal = |depth| {
            let stack = coated(0.5, depth);
            Veil::new(&Layers::from(&stack), &fresnel(&stack)).unwrap().internal[0]
        };
        assert!(internal(0.1) < internal(0.0) && internal(50.0) < 1e-9);
    }
}
