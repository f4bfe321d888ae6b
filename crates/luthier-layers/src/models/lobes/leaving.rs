//! Shares of shapes above the horizon, as estimates in closed form.

use std::f64::consts::PI;

use glam::DVec3;

use super::{Lobe, Shape};

/// Least reciprocal radius of the disc: beyond, single precision would see noise.
const DISC_MIN: f64 = 0.05;

/// Distance of the middles of a shape and of the disc, a slope, below which no direction leads from one to the other.
const DISC_SOFT: f64 = 1e-4;

/// Points of half the edge of the disc, and more for each width of the lobe.
const EDGE_POINTS: u32 = 64;
const PER_WIDTH: f64 = 10.0;

/// Least share, so that ratios of shares are bounded.
pub(super) const LEAVING_MIN: f64 = 1e-3;

/// Slopes of half vectors, in a medium, to light above the horizon.
///
/// They fill a disc: with the sine s and the cosine c of the eye inside, times the index n, its middle is `s / d` and its radius `1 / d`, where
/// `d = c + sqrt(n^2 - 1)`.
#[derive(Debug, Clone, Copy)]
pub(super) struct Leaving {
    pub(super) middle: [f64; 2],
    pub(super) radius: f64,
}

/// Radius to which a disc is held.
pub(super) const RADIUS_MAX: f64 = 1.0 / DISC_MIN;

impl Leaving {
    /// The disc of an eye inside a medium of relative index `index`.
    pub(super) fn new(eye: DVec3, index: f64) -> Self {
        let radius = 1.0 / (index * eye.z + ((index - 1.0) * (index + 1.0)).max(0.0).sqrt()).max(DISC_MIN);
        Self { middle: [eye.x, eye.y].map(|eye| index * eye * radius), radius }
    }

    /// Share above the horizon of a lobe in the plane of the eye: that of an ellipse with the tail of GGX, or an estimate.
    ///
    /// In widths of the lobe the disc is an ellipse with half axes a and b, whose middle is c away along a. The density `1 / (pi (1 + x^2 + y^2)^2)` is the divergence
    /// of `(x, y) / (2 pi (1 + x^2 + y^2))`, and the integral of that along the edge is one of a rational function of a cosine. By residues it is
    /// `a b (1 + a^2 - c^2 + q) / (q sqrt((1 + a^2 + c^2 + q) (1 + 2 b^2 + c^2 - a^2 + q)))` with `q = sqrt((1 + (a - c)^2) (1 + (a + c)^2))`.
    ///
    /// Of other tails it is as [`Self::share`], but an ellipse whose middle is that of the disc counts as a circle of its mean width, and the nearer its middle is to
    /// the edge of the disc the more its width along the way counts. So estimates change slowly from view to view.
    pub(super) fn in_plane(&self, lobe: &Lobe, sin_theta: f64) -> f64 {
        let away = (self.middle[0] - lobe.shift * sin_theta).abs();
        let [along, across] = lobe.sharpness;
        if lobe.tail == 1.0 {
            return ellipse(self.radius * along, self.radius * across, away * along).max(LEAVING_MIN);
        }
        let mean = (along * across).sqrt();
        let out = (away / self.radius).min(1.0);
        let near = self.radius * (mean - (mean - along) * out * (2.0 - out)) - away * along;
        self.between(&lobe.in_plane(sin_theta), near, mean)
    }

    /// Share above the horizon of a lobe in the plane of the eye, of any tail, by a sum.
    ///
    /// With q, the squared distance from the middle of the lobe in widths, its density is the divergence of `(x, y) (1 - beyond(q)) / (2 pi q)`: the share is the mean of
    /// that along the edge of the disc, an ellipse.
    pub(super) fn summed(&self, lobe: &Lobe, sin_theta: f64) -> f64 {
        let shape = lobe.in_plane(sin_theta);
        let [along, across] = lobe.sharpness;
        let [a, b] = [along, across].map(|sharpness| sharpness * self.radius);
        let c = (self.middle[0] - shape.middle[0]) * along;
        let points = EDGE_POINTS + (PER_WIDTH * a.max(b).min(1e3)) as u32;
        let sum: f64 = (0..points)
            .map(|i| {
                let (sin, cos) = libm::sincos(PI * (f64::from(i) + 0.5) / f64::from(points));
                let (x, y) = (c + a * cos, b * sin);
                let q = (x * x + y * y).max(f64::MIN_POSITIVE);
                (1.0 - shape.beyond(q)) / q * b * (a + c * cos)
            })
            .sum();
        (sum / f64::from(points)).clamp(LEAVING_MIN, 1.0)
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

/// Share of the density `1 / (pi (1 + x^2 + y^2)^2)` in an ellipse with half axes a and b and the middle (c, 0).
fn ellipse(a: f64, b: f64, c: f64) -> f64 {
    let [near, far] = [a - c, a + c];
    let root = ((1.0 + near * near) * (1.0 + far * far)).sqrt();
    // 1 + d + root and 1 - d + root, without cancellation.
    let d = near * far;
    let within = if d > -1.0 { 1.0 + d + root } else { 4.0 * c * c / (root - 1.0 - d) };
    let beyond = if d < 1.0 { 1.0 - d + root } else { 4.0 * a * a / (root - 1.0 + d) };
    let sum = 1.0 + a * a + c * c + root;
    a * b * within / (root * (sum * (beyond + 2.0 * b * b)).sqrt())
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    /// Oracle: the midpoint rule over the ellipse.
    #[test]
    fn shares_of_ellipses_are_those_of_the_density() {
        const POINTS: u32 = 300;
        for (a, b, c) in
            [(1.0, 1.0, 0.0), (2.0, 0.5, 1.0), (0.5, 2.0, 1.0), (0.3, 0.3, 2.0), (3.0, 1.0, 3.0), (5.0, 4.0, 1.0)]
        {
            let mut sum = 0.0;
            for (i, j) in (0..POINTS).flat_map(|i| (0..POINTS).map(move |j| (i, j))) {
                let [radius, turn] = [i, j].map(|i| (f64::from(i) + 0.5) / f64::from(POINTS));
                let (sin, cos) = libm::sincos(TAU * turn);
                let (x, y) = (c + a * radius * cos, b * radius * sin);
                let beyond = 1.0 + x * x + y * y;
                sum += radius / (beyond * beyond);
            }
            let expected = 2.0 * a * b * sum / f64::from(POINTS * POINTS);
            let found = ellipse(a, b, c);
            assert!((found - expected).abs() < 1e-5, "{a} {b} {c}: {found} {expected}");
        }
    }

    /// Oracle: the closed form of GGX, and points of a lattice that a shape of another tail draws.
    #[test]
    fn sums_along_the_edge_are_shares() {
        let leaving = Leaving::new(DVec3::new(0.6, 0.0, 0.8), 1.5);
        let lobe = |tail, shift, sharpness| Lobe { strength: [1.0; 3], share: 1.0, shift, sharpness, shear: 0.0, tail };
        for (shift, sharpness) in [(0.0, [2.0, 1.0]), (0.9, [4.0, 7.0]), (1.2, [30.0, 20.0])] {
            let ggx = lobe(1.0, shift, sharpness);
            assert!((leaving.summed(&ggx, 0.6) - leaving.in_plane(&ggx, 0.6)).abs() < 1e-5);
            let other = lobe(0.05, shift, sharpness);
            let shape = other.in_plane(0.6);
            let count = 200_000_u32;
            let above = (0..count).filter(|i| {
                let u =
                    [0.754_877_666_246_692_8, 0.569_840_290_998_053_2].map(|step| (0.5 + step * f64::from(*i)).fract());
                let [x, y] = shape.sample(u);
                libm::hypot(x - leaving.middle[0], y) < leaving.radius
            });
            let expected = above.count() as f64 / f64::from(count);
            let found = leaving.summed(&other, 0.6);
            assert!((found - expected).abs() < 2e-3, "{shift} {sharpness:?}: {found} {expected}");
        }
    }
}
