//! Facets of the first interface, drawn with their reflectance.
//!
//! Facets that an eye sees reflect .04 of the light where they face it, and all of it at grazing angles. If they are drawn as they are seen
//! (Heitz and d'Eon 2014), a weight is up to nine times the albedo. Here more of those are drawn that reflect more.
//!
//! In the frame where the surface is rough by 1, facets of GGX that an eye o sees mirror it to directions c that are uniform above a cosine (Dupuy and Benyoub
//! 2023); those that leave the surface are above a greater one (Eto and Tokuyoshi 2023). Of such a c the height z is drawn as it is, and the azimuth by a
//! density in proportion to `1 / (x + 1 / v)`, where x is the squared cosine of eye and facet, `(1 + o.c) / 2`. At a height it is `a - b cos phi`, so that this is
//! Poisson's kernel: the cumulative distribution has an inverse without trigonometry. v depends on z, so that the density is one of the facet's own cosine on the
//! real surface.
//!
//! Facets of Beckmann: [`GaussianDraw`].

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luthier_optics::Rgb;
use luthier_optics::stack::Distribution;

use super::gaussian::GaussianDraw;
use crate::formulas::facets::Facets;
use crate::models::lobes::tally::mean;

/// Bounds of the reflectance at normal incidence in [`FacetDraw::new`]: below the least, nearly all draws graze.
const F0: [f64; 2] = [1e-3, 1.0];

/// Least squared distance from the flattest directions.
const FLAT: f64 = 1e-12;

/// Facets as an eye draws them.
#[derive(Debug, Clone, Copy)]
pub(super) struct FacetDraw {
    facets: Facets,
    wo: DVec3,
    /// The eye where the surface is rough by 1, its length before, and minus the least height of directions there.
    eye: DVec3,
    size: f64,
    lowest: f64,
    /// The square of the slope parameter, and v of a facet at a distance of 1 from the flattest directions.
    flat: f64,
    pull: f64,
    /// Facets of Beckmann.
    gaussian: Option<GaussianDraw>,
}

impl FacetDraw {
    /// The draw of an eye (unit, above the surface); `f0` is the reflectance at normal incidence.
    ///
    /// Schlick's reflectance falls by about `1 / (cos + k)`. This k was fitted to the largest weights of indices from 1.3 to 2.2 and of metals, slope parameters from
    /// .001 to 1 and views up to 85 degrees.
    pub(super) fn new(facets: &Facets, wo: DVec3, f0: Rgb) -> Self {
        let alphas = facets.alphas();
        let [x, y] = alphas;
        let turned = facets.turned(wo);
        let stretched = DVec3::new(x * turned.x, y * turned.y, turned.z);
        let size = stretched.length();
        // The greatest height below which no direction leaves.
        let (least_sq, reach) = (x.min(y) * x.min(y), 1.0 + libm::hypot(wo.x, wo.y));
        let bound = (1.0 - least_sq) * reach * reach / (reach * reach + least_sq * wo.z * wo.z);
        let (alpha, f0) = (libm::sqrt(x * y), mean(f0).clamp(F0[0], F0[1]));
        let rest_sq = (1.0 - f0) * (1.0 - f0);
        let sharpness = rest_sq * rest_sq * (alpha + 0.8) / (f0 * alpha * (3.6 + 13.0 * wo.z * wo.z));
        let is_gaussian = facets.drawn_distribution() == Distribution::Beckmann;
        Self {
            facets: *facets,
            wo,
            eye: stretched / size,
            size,
            lowest: bound * wo.z / size,
            flat: alpha * alpha,
            pull: 2.0 * size * sharpness,
            gaussian: is_gaussian.then(|| GaussianDraw::new(alphas, turned, f0)),
        }
    }

    /// A facet in the frame of the surface, for three numbers that are uniform in 0..1.
    pub(super) fn sample(&self, [way, u, v]: [f64; 3]) -> DVec3 {
        if let Some(gaussian) = &self.gaussian {
            return self.facets.unturned(gaussian.sample([way, u, v]));
        }
        let z = (1.0 - u) * (1.0 + self.lowest) - self.lowest;
        let above = z + self.eye.z;
        let (mean, pull) = self.pulled(above);
        let ring = libm::sqrt((1.0 - z * z).max(0.0));
        let across = libm::hypot(self.eye.x, self.eye.y);
        let lean = 0.5 * across * ring * pull / (1.0 + mean * pull);
        let upright = self.gathering(above) / (1.0 + mean * pull);
        let (sin, cos) = libm::sincos(2.0 * PI * v);
        let beside = (1.0 + lean * cos).max(FLAT);
        let [along, beyond] = [ring * (cos + lean) / beside, ring * upright * sin / beside];
        let away = self.azimuth();
        let level = DVec2::new(self.eye.x, self.eye.y) - along * away - beyond * away.perp();
        let [x, y] = self.facets.alphas();
        self.facets.unturned(DVec3::new(x * level.x, y * level.y, above.max(1e-300)).normalize())
    }

    /// The azimuth of the eye.
    fn azimuth(&self) -> DVec2 {
        DVec2::new(self.eye.x, self.eye.y).try_normalize().unwrap_or(DVec2::X)
    }

    /// Density in solid angle of light from `wi` (unit, above the surface) that drawn facets mirror.
    pub(super) fn pdf_solid_angle(&self, wi: DVec3) -> f64 {
        let sum = wi + self.wo;
        let turned = self.facets.turned(sum);
        if let Some(gaussian) = &self.gaussian {
            return gaussian.pdf_solid_angle(turned);
        }
        let [x, y] = self.facets.alphas();
        let steep_sq = DVec3::new(turned.x / x, turned.y / y, turned.z).length_squared();
        // The cosine of eye and facet times the length of the sum; unit directions have no other.
        let half = 0.5 * sum.length_squared();
        let above = 2.0 * half * sum.z / (self.size * steep_sq);
        let facing = half * half / (self.size * self.size * steep_sq);
        let (_, pull) = self.pulled(above);
        let uniform = facing * self.size / (2.0 * PI * x * y * steep_sq * (1.0 + self.lowest));
        4.0 * uniform * self.gathering(above) / (1.0 + facing * pull)
    }

    /// The mean of x at a height above the flattest directions, and v there.
    fn pulled(&self, above: f64) -> (f64, f64) {
        let mean = 0.5 + 0.5 * self.eye.z * (above - self.eye.z);
        let far = 4.0 * self.flat * mean + (1.0 - self.flat) * above * above;
        (mean, self.pull / libm::sqrt(far.max(FLAT)))
    }

    /// The root of the mean of `1 / (1 + x v)` over azimuths, inverse.
    fn gathering(&self, above: f64) -> f64 {
        let (mean, pull) = self.pulled(above);
        libm::sqrt(1.0 + pull * (2.0 * mean + 0.25 * above * above * pull))
    }
}

#[cfg(test)]
mod tests {
    use luthier_optics::stack::Surface;

    use super::*;

    /// Oracle: the density by a midpoint rule over bins of cosines and azimuths. Draws are those of a lattice (Roberts 2018).
    #[test]
    fn draws_follow_their_density() {
        const DRAWN: u32 = 200_000;
        let bins = [5, 8];
        let points = [60, 40];
        for distribution in [Distribution::Ggx, Distribution::Beckmann] {
            for (alpha_x, alpha_y, f0, theta) in [
                (0.4, 0.4, 0.04, 0.6),
                (0.3, 0.6, 0.02, 1.3),
                (0.8, 0.8, 0.04, 0.0),
                (0.3, 0.3, 0.9, 1.4),
                (1.0, 0.7, 0.04, 1.45),
            ] {
                let facets = Facets::new(&Surface { distribution, alpha_x, alpha_y, rotation: 0.7 });
                let (sin, cos) = libm::sincos(theta);
                let draw = FacetDraw::new(&facets, DVec3::new(0.6 * sin, 0.8 * sin, cos), [f0; 3]);
                let sides = [bins[0] * points[0], bins[1] * points[1]];
                let mut shares = vec![0.0; bins[0] * bins[1]];
                for (i, j) in (0..sides[0]).flat_map(|i| (0..sides[1]).map(move |j| (i, j))) {
                    let z = (i as f64 + 0.5) / sides[0] as f64;
                    let (y, x) = libm::sincos(2.0 * PI * (j as f64 + 0.5) / sides[1] as f64);
                    let flat = libm::sqrt(1.0 - z * z);
                    let solid_angle = 2.0 * PI / (sides[0] * sides[1]) as f64;
                    shares[i / points[0] * bins[1] + j / points[1]] -=
                        draw.pdf_solid_angle(DVec3::new(x * flat, y * flat, z)) * solid_angle;
                }
                for i in 0..DRAWN {
                    let steps = [0.819_172_513_396_164_4, 0.671_043_606_703_789_2, 0.549_700_477_901_970_3];
                    let wh = draw.sample(steps.map(|step: f64| (0.5 + step * f64::from(i)).fract()));
                    let wi = 2.0 * wh.dot(draw.wo) * wh - draw.wo;
                    if wi.z > 0.0 {
                        let turns = (libm::atan2(wi.y, wi.x) / (2.0 * PI)).rem_euclid(1.0);
                        let [bin, sector] = [wi.z * bins[0] as f64, turns * bins[1] as f64].map(|at| at as usize);
                        shares[bin.min(bins[0] - 1) * bins[1] + sector.min(bins[1] - 1)] += 1.0 / f64::from(DRAWN);
                    }
                }
                let most = shares.iter().fold(0.0, |most: f64, share| most.max(share.abs()));
                assert!(most < 2e-3, "{distribution:?} {alpha_x} {alpha_y} {f0} {theta}: {most}");
            }
        }
    }
}
