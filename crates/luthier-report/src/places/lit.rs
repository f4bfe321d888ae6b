//! Light that a place sends to the eye under surroundings: by a formula, by the model, and simulated.

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;
use luthier_optics::Rgb;
use luthier_optics::sampling::split_mix::SplitMix64;
use luthier_optics::stack::Distribution;
use luthier_optics::visible_normals;

use super::Site;

/// Radiance that a place sends to the eye, RGB.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
pub struct Ways {
    /// By the formula.
    pub formula: Rgb,
    /// By the model.
    pub model: Rgb,
    /// By simulation.
    pub simulated: Rgb,
}

impl Site<'_> {
    /// The light that the eye at `wo` sees of surroundings of a radiance by direction, in the frame of the place. `formula` is `f cos_theta_i` of the same
    /// surface in another way.
    ///
    /// Formula and model are means over `count` directions: by the cosine, and by facets of GGX of the slope parameters `alphas`, those of the interfaces,
    /// above 0. The simulation has about `count` paths. All are without bias; their noise falls with `count`.
    pub fn lit(
        &self,
        formula: &dyn Fn(DVec3, DVec3) -> Rgb,
        alphas: &[f64],
        wo: DVec3,
        radiance: &dyn Fn(DVec3) -> Rgb,
        count: u32,
        seed: u64,
    ) -> Ways {
        let mut ways = Ways::default();
        self.trace(seed, count.into(), wo, |wi, share| {
            let light = radiance(wi);
            (0..3).for_each(|c| ways.simulated[c] += share[c] * light[c]);
        });
        let kinds = 1 + alphas.len() as u32;
        // Directions of a kind: 0 is that of the cosine.
        let drawn = |kind: u32| f64::from((count + kinds - 1 - kind) / kinds);
        let mut random = SplitMix64::new(seed);
        let shift = [random.unit(), random.unit()];
        for i in 0..count {
            // Roberts 2018: multiples of the powers of the root of x^3 = x + 1.
            let u = [0, 1].map(|d: usize| ([0.754_877_666, 0.569_840_291][d] * f64::from(i) + shift[d]).fract());
            let wi = match (i % kinds).checked_sub(1) {
                None => {
                    let (sin, cos) = libm::sincos(TAU * u[1]);
                    DVec3::new(u[0].sqrt() * cos, u[0].sqrt() * sin, (1.0 - u[0]).sqrt())
                }
                Some(facets) => {
                    let m = visible_normals::sample(Distribution::Ggx, alphas[facets as usize], wo, u);
                    2.0 * wo.dot(m) * m - wo
                }
            };
            if wi.z <= 1e-6 {
                continue;
            }
            let by_facets = (1..kinds).zip(alphas).map(|(kind, alpha)| drawn(kind) * density(*alpha, wi, wo));
            let density = drawn(0) * wi.z * FRAC_1_PI + by_facets.sum::<f64>();
            let (light, found, model) = (radiance(wi), formula(wi, wo), self.eval(wi, wo));
            for c in 0..3_usize {
                ways.formula[c] += found[c] * light[c] / density;
                ways.model[c] += model[c] * light[c] / density;
            }
        }
        ways
    }
}

/// Density of a direction that visible facets of GGX mirror `wo` into, over solid angle: `D(m) / (4 cos_theta_o (1 + Lambda))`.
fn density(alpha: f64, wi: DVec3, wo: DVec3) -> f64 {
    let m = (wi + wo).normalize();
    let square = alpha * alpha;
    let fall = (m.x * m.x + m.y * m.y) / square + m.z * m.z;
    let root = (square * (1.0 - wo.z * wo.z) + wo.z * wo.z).sqrt();
    FRAC_1_PI / (square * fall * fall) / (2.0 * (wo.z + root))
}
