//! Shares of shapes above the horizon, as estimates in closed form.

use glam::DVec3;

use super::{Lobe, Shape};

/// Least reciprocal radius of the disc: beyond, single precision would see noise.
const DISC_MIN: f64 = 0.05;

/// Distance of the middles of a shape and of the disc, a slope, below which no direction leads from one to the other.
const DISC_SOFT: f64 = 1e-4;

/// Least share, so that ratios of shares are bounded.
pub(super) const LEAVING_MIN: f64 = 1e-3;

/// Slopes of half vectors, in a medium, to light above the horizon.
///
/// They fill a disc: with the sine s and the cosine c of the eye inside, times the index n, its middle is `s / d` and its radius `1 / d`, where
/// `d = c + sqrt(n^2 - 1)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaving {
    middle: [f64; 2],
    radius: f64,
}

impl Leaving {
    /// The disc of an eye inside a medium of relative index `index`.
    pub(super) fn new(eye: DVec3, index: f64) -> Self {
        let radius = 1.0 / (index * eye.z + ((index - 1.0) * (index + 1.0)).max(0.0).sqrt()).max(DISC_MIN);
        Self { middle: [eye.x, eye.y].map(|eye| index * eye * radius), radius }
    }

    /// Share above the horizon of a lobe in the plane of the eye, as an estimate.
    ///
    /// As [`Self::share`], but an ellipse whose middle is that of the disc counts as a circle of its mean width, and the nearer its middle is to the edge of
    /// the disc the more its width along the way counts. So estimates change slowly from view to view.
    pub(super) fn in_plane(&self, lobe: &Lobe, sin_theta: f64) -> f64 {
        let away = (self.middle[0] - lobe.shift * sin_theta).abs();
        let [along, across] = lobe.sharpness;
        let mean = (along * across).sqrt();
        let out = (away / self.radius).min(1.0);
        let near = self.radius * (mean - (mean - along) * out * (2.0 - out)) - away * along;
        self.between(&lobe.in_plane(sin_theta), near, mean)
    }

    /// Share of a shape above the horizon where its middle is moved by a slope, as an estimate.
    ///
    /// GGX is a uniform density on a sphere in stereographic projection, so that the share in a disc is that of a cap of the sphere:
    /// `(1 - cos(a + b)) / 2`, if the tangents of a and b are the distances of the middle of the shape to the near edge (below 0 outside) and to the far
    /// edge, in widths. For other tails a distance counts as the one beyond which GGX has as much: `cos a` is the root of the share of the shape that is
    /// farther from its middle. An ellipse has its width towards the middle of the disc, and its mean width on the whole. For round lobes with the tail of
    /// GGX the share is exact.
    pub(super) fn share(&self, shape: &Shape, moved: [f64; 2]) -> f64 {
        let radius = self.radius;
        let [x, y] = [0, 1].map(|axis: usize| self.middle[axis] - moved[axis] - shape.middle[axis]);
        let away = libm::hypot(x, y);
        // Width of the shape along the way to the middle of the disc.
        let ([cos, sin], [first, second]) = (shape.turn, shape.width);
        let mean = (first * second).sqrt();
        let along = libm::hypot((cos * x + sin * y) * first, (cos * y - sin * x) * second);
        let near = (radius - away) * (away + DISC_SOFT) / (along + DISC_SOFT * mean);
        self.between(shape, near, 1.0 / mean)
    }

    /// Share of a shape of a mean sharpness between the near edge and the far one.
    fn between(&self, shape: &Shape, near: f64, mean_sharpness: f64) -> f64 {
        let far = (2.0 * self.radius * mean_sharpness - near).max(near);
        let [(cos_near, sin_near), (cos_far, sin_far)] = [near, far].map(|edge| {
            let beyond = shape.beyond(edge * edge);
            (beyond.sqrt(), (1.0 - beyond).sqrt().copysign(edge))
        });
        (0.5 - 0.5 * (cos_near * cos_far - sin_near * sin_far)).max(LEAVING_MIN)
    }
}
