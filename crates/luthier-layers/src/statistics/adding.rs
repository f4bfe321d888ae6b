//! Adding interfaces from the top down: all paths of light between them, as one lobe per layer.

use luthier_optics::albedo::COS_THETA_MIN;

use super::energy::Energy;
use super::spread::Spread;
use crate::monochrome::{Monochrome, MonochromeBelow};

/// Number of inter-reflections that spread light, at most. Between two perfect reflectors it is infinite, and so are
/// variances.
const BOUNCES_MAX: f64 = 1e6;

/// Light that leaves a stack upward after a turn at one layer.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe<S> {
    /// Part of the incident light.
    pub energy: f64,
    /// Spread around the mirror direction.
    pub spread: S,
}

/// What becomes of light from one direction.
#[derive(Debug, Clone, PartialEq)]
pub struct Transport<S> {
    /// One lobe per interface that light reaches, from the top.
    pub lobes: Vec<Lobe<S>>,
    /// Part of the light that arrives below the last interface, slabs included: T0i.
    pub transmitted: f64,
    /// Part of the light at the mean direction below the last interface that leaves the stack upward: Ti0. Less than T0i where
    /// lobes of rough interfaces are totally reflected.
    pub emerging: f64,
    /// Reflectance of the whole stack from below at the mean direction there: Ri0.
    pub from_below: f64,
    /// Cosine of the mean direction below the last interface; 0 if light is totally reflected on its way.
    pub cos_theta: f64,
}

impl<S> Transport<S> {
    /// Energy of all lobes together.
    pub fn reflected(&self) -> f64 {
        self.lobes.iter().map(|lobe| lobe.energy).sum()
    }
}

/// Sends light at `cos_theta` (in the exterior, 0..=1) through a stack, down to the last interface or to a diffuse base.
///
/// Belcour 2018, sec. 4 and 5. Interface 12 is added below a stack 0i with Ri0 R12 summed as a geometric series; energies
/// from below are taken at the refracted mean direction, where they equal those from above. Total reflection moves the part of a
/// lobe beyond the critical angle of the interface above from Ti0 to Ri0; that part crosses the slab once more on its way down.
///
/// For any energies in 0..=1 those of the lobes sum to at most 1, and to 1 if nothing is absorbed or sent below: where
/// the series diverges its limit without absorption is taken.
pub fn add<S: Spread>(stack: &Monochrome, energy: &impl Energy, cos_theta: f64) -> Transport<S> {
    let mut lobes = Vec::with_capacity(stack.layers.len());
    let (mut t0i, mut ti0, mut ri0) = (1.0, 1.0, 0.0);
    let (mut spread_t0i, mut spread_ti0, mut spread_ri0) = (S::ZERO, S::ZERO, S::ZERO);
    let (mut jacobian_0i, mut jacobian_i0) = (1.0, 1.0);
    let mut cos_i = cos_theta.clamp(COS_THETA_MIN, 1.0);
    let mut slab = 1.0;

    for (i, layer) in stack.layers.iter().enumerate() {
        if matches!(layer.below, MonochromeBelow::Diffuse { .. }) {
            break;
        }
        let r12 = energy.fgd(i, cos_i, layer.surface.alpha_isotropic()).clamp(0.0, 1.0);
        let spread_r12 = S::of(&layer.surface, 1.0);

        if let Some(previous) = i.checked_sub(1).and_then(|above| stack.layers.get(above)) {
            let eta = previous.above / layer.above;
            if eta < 1.0 {
                let escaping = energy.escaping(cos_i, (spread_t0i + spread_r12).mean_alpha(), eta).clamp(0.0, 1.0);
                ri0 += (1.0 - escaping) * ti0 * slab;
                ti0 *= escaping;
            }
        }

        let q = 1.0 - ri0 * r12;
        // Ti0/q and T12/q are at most 1, because Ri0 + Ti0 <= 1 and R12 + T12 <= 1; 1 is their limit without absorption.
        let over_q = |t: f64| if q > 0.0 { (t / q).min(1.0) } else { 1.0 };
        let bounces = (ri0 * r12 / q.max(1.0 / BOUNCES_MAX)).min(BOUNCES_MAX);
        let upward = over_q(ti0);
        let between = (spread_r12 + spread_ri0) * bounces;
        let spread = spread_ti0 + (spread_t0i + spread_r12 + between) * jacobian_0i;
        lobes.push(Lobe { energy: t0i * r12 * upward, spread: spread.limited() });

        let MonochromeBelow::Dielectric { ior, optical_depth, .. } = layer.below else {
            (t0i, ti0, cos_i) = (0.0, 0.0, 0.0);
            break;
        };
        let n12 = ior / layer.above;
        let cos_t_sq = (cos_i * cos_i + (n12 - 1.0) * (n12 + 1.0)) / (n12 * n12);
        if cos_t_sq <= 0.0 {
            (t0i, ti0, cos_i) = (0.0, 0.0, 0.0);
            break;
        }
        let cos_t = cos_t_sq.sqrt().clamp(COS_THETA_MIN, 1.0);
        let t12 = 1.0 - r12;
        let (r21, t21) = (r12, t12);
        let j12 = n12 * cos_t / cos_i;
        let spread_t12 = S::of(&layer.surface, 0.5 * (1.0 - 1.0 / j12).abs());
        let spread_t21 = S::of(&layer.surface, 0.5 * (1.0 - j12).abs());

        let downward = over_q(t12);
        let b = t21 * ri0 * downward;
        let reflected = r21 + b;
        let deep = spread_t12 + (spread_t21 + spread_ri0 + between) * j12;
        // Means by energy: both shares are in 0..=1, and a stack that reflects nothing from below spreads nothing.
        let share = if reflected > 0.0 { b / reflected } else { 0.0 };
        spread_ri0 = (spread_r12 * (1.0 - share) + deep * share).limited();
        spread_t0i = (spread_t0i * j12 + spread_t12 + between * j12).limited();
        spread_ti0 = (spread_t21 * jacobian_i0 + spread_ti0 + between * jacobian_i0).limited();
        t0i *= downward;
        ti0 = t21 * upward;
        ri0 = reflected;
        jacobian_0i *= j12;
        jacobian_i0 /= j12;
        cos_i = cos_t;

        slab = libm::exp(-optical_depth / cos_i);
        t0i *= slab;
        ti0 *= slab;
        ri0 *= slab * slab;
    }
    Transport { lobes, transmitted: t0i, emerging: ti0, from_below: ri0, cos_theta: cos_i }
}

#[cfg(test)]
mod tests;
