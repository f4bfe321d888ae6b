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

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luthier_optics::Rgb;
use luthier_optics::stack::Distribution;

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
        Self {
            facets: *facets,
            wo,
            eye: stretched / size,
            size,
            lowest: bound * wo.z / size,
            flat: alpha * alpha,
            pull: 2.0 * size * sharpness,
        }
    }

    /// A facet in the frame of the surface, for two numbers that are uniform in 0..1.
    pub(super) fn sample(&self, [u, v]: [f64; 2]) -> DVec3 {
        if self.facets.drawn_distribution() == Distribution::Beckmann {
            return self.facets.sample(self.wo, [u, v]);
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
        let away = if across > 0.0 { DVec2::new(self.eye.x, self.eye.y) / across } else { DVec2::X };
        let level = DVec2::new(self.eye.x, self.eye.y) - along * away - beyond * away.perp();
        let [x, y] = self.facets.alphas();
        self.facets.unturned(DVec3::new(x * level.x, y * level.y, above.max(1e-300)).normalize())
    }

    /// Density in solid angle of light from `wi` (unit, above the surface) that drawn facets mirror.
    pub(super) fn pdf_solid_angle(&self, wi: DVec3) -> f64 {
        if self.facets.drawn_distribution() == Distribution::Beckmann {
            return self.facets.pdf_solid_angle(wi, self.wo);
        }
        let sum = wi + self.wo;
        let turned = self.facets.turned(sum);
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
