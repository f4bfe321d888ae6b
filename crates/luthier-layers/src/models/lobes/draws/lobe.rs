//! Slopes of lobes, drawn where light leaves.
//!
//! Up to two thirds of a lobe are beyond the horizon. The slopes whose light leaves fill a disc. A round lobe with the tail of GGX is uniform on a sphere
//! in stereographic projection, and the disc is a cap of that sphere: a uniform draw in the cap has all of the lobe's light and no other. An elliptic lobe
//! gets a circle about its ellipse ([`Cap::about`]), or is drawn as a round one as wide as it is long. Other tails are drawn with that of GGX, of which they are
//! at most 1.47 times. Where most of the lobe leaves, it is drawn as it is.

use std::f64::consts::PI;

use glam::DVec2;

use crate::models::lobes::leaving::{Leaving, RADIUS_MAX};
use crate::models::lobes::{Shape, TAIL_MIN};

/// A lobe as it is drawn.
#[derive(Debug, Clone, Copy)]
pub(in crate::models::lobes) struct LobeDraw {
    shape: Shape,
    /// Of what is drawn in a cap.
    cap: Option<Cap>,
    /// Factor on the strength of the lobe for its chance: a bound on its weights is the sum of such products.
    pub(in crate::models::lobes) chance: f64,
}

/// A cap of the sphere on which a lobe is uniform, with its coordinates over slopes.
#[derive(Debug, Clone, Copy)]
struct Cap {
    /// Widths of what is drawn, along the axes of the shape.
    width: [f64; 2],
    /// Towards the middle of the cap, unit, and cosine and sine of the angle there.
    towards: DVec2,
    axis: [f64; 2],
    /// Share of the sphere.
    share: f64,
}

impl Cap {
    /// The cap about the circle of a radius at a place.
    fn new(width: [f64; 2], middle: DVec2, radius: f64) -> Self {
        let away = middle.length();
        let (near, far) = (away - radius, away + radius);
        let scale = 1.0 / libm::sqrt((1.0 + near * near) * (1.0 + far * far));
        let (cos, sin) = ((1.0 + near * far) * scale, 2.0 * radius * scale);
        // Without cancellation where the cap is small.
        let share = if cos > 0.0 { 0.5 * sin * sin / (1.0 + cos) } else { 0.5 - 0.5 * cos };
        let towards = if away > 0.0 { middle / away } else { DVec2::X };
        Self { width, towards, axis: [(1.0 - near * far) * scale, (near + far) * scale], share }
    }
}

/// Steps towards the least cap: any number of them gives a cap about the ellipse.
const STEPS: u32 = 4;

impl Cap {
    /// The least cap about an ellipse with a middle and half axes along the coordinates, of which the second is the longer one.
    ///
    /// A circle whose middle lies t beyond that of the ellipse, along the short axis and away from the lobe, is about an ellipse with the half axes a < b if its
    /// squared radius is `b^2 (1 + e u^2)`, where `e = b^2 - a^2` and `u = t / e`, at most 1 / a. With c, the distance of the middle along the short axis, and d, that on the
    /// whole, its cap is least at the one root of `a^2 e u^3 + (1 + d^2 + 2 a^2 - b^2) u - 2 c`, to which Newton's steps come down from any bound.
    fn about(width: [f64; 2], middle: [f64; 2], [a, b]: [f64; 2], is_turned: bool) -> Self {
        let short = usize::from(is_turned);
        let excess = (b - a) * (b + a);
        let (cubic, linear) = (a * a * excess, 1.0 + DVec2::from(middle).length_squared() + 2.0 * a * a - b * b);
        let constant = 2.0 * middle[short].abs();
        let mut u = 1.0 / a.max(linear / constant.max(f64::MIN_POSITIVE));
        for _ in 0..STEPS {
            u -= (u * (cubic * u * u + linear) - constant) / (3.0 * cubic * u * u + linear);
        }
        let mut moved = middle;
        moved[short] += (excess * u).copysign(middle[short]);
        Self::new(width, DVec2::from(moved), b * libm::sqrt(1.0 + excess * u * u))
    }
}

impl LobeDraw {
    /// The draw of a shape whose middle is moved by a slope, where light leaves from a disc of slopes.
    pub(in crate::models::lobes) fn new(shape: Shape, disc: &Leaving, moved: [f64; 2]) -> Self {
        let middle = [0, 1].map(|axis: usize| disc.middle[axis] - moved[axis]);
        let widest = shape.width[0].max(shape.width[1]);
        let narrowest = shape.width[0].min(shape.width[1]);
        let axes = [disc.radius / widest, disc.radius / narrowest];
        let own = Cap::about(shape.width, shape.scaled(middle), axes, shape.width[1] > shape.width[0]);
        let wide = Shape { width: [widest; 2], ..shape };
        let round = Cap::new(wide.width, DVec2::from(wide.scaled(middle)), disc.radius / widest);
        let of_round = round.share * widest / narrowest;
        let (cap, cost) = if of_round < own.share { (round, of_round) } else { (own, own.share) };
        let tail = shape.tail.max(TAIL_MIN);
        let bound = cost * (1.0 + 0.47 * (1.0 - tail) * (1.0 - 0.5 * tail));
        if bound < 1.0 && disc.radius < RADIUS_MAX {
            Self { shape, cap: Some(cap), chance: cost }
        } else {
            Self { shape, cap: None, chance: 1.0 }
        }
    }

    /// Density of slopes.
    pub(in crate::models::lobes) fn density(&self, slope: [f64; 2]) -> f64 {
        let Some(cap) = self.cap else { return self.shape.density(slope) };
        let drawn = Shape { width: cap.width, tail: 1.0, ..self.shape };
        drawn.density(slope) / cap.share
    }

    /// A slope for two numbers that are uniform in 0..1.
    pub(in crate::models::lobes) fn sample(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        let Some(cap) = self.cap else { return self.shape.sample([u, v]) };
        let (sin, cos) = libm::sincos(2.0 * PI * v);
        let below = 2.0 * cap.share * u;
        let ring = libm::sqrt(below * (2.0 - below));
        let [axis_cos, axis_sin] = cap.axis;
        let along = (1.0 - below) * axis_sin + ring * cos * axis_cos;
        let up = (1.0 - below) * axis_cos - ring * cos * axis_sin;
        let place = (along * cap.towards + ring * sin * cap.towards.perp()) / (1.0 + up).max(1e-12);
        Shape { width: cap.width, ..self.shape }.unscaled(place.to_array())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: points along the ellipse, and caps about it whose circles lie farther along the short axis, step by step.
    #[test]
    fn caps_about_ellipses_are_least() {
        for (middle, [a, b]) in [
            ([0.6, 1.1], [0.7, 2.2]),
            ([0.5, 0.0], [1.0, 3.0]),
            ([-3.0, 0.0], [0.5, 2.0]),
            ([0.0, 2.0], [0.5, 2.0]),
            ([-5.0, 1.0], [0.1, 4.0]),
            ([0.4, 0.3], [1.5, 1.5]),
        ] {
            let cap = Cap::about([1.0; 2], middle, [a, b], false);
            // On the sphere a point has the coordinates 2 p / (1 + p^2) and (1 - p^2) / (1 + p^2).
            let [cos, sin] = cap.axis;
            let edge = 1.0 - 2.0 * cap.share;
            let ellipse = |i: u32| {
                let (sin, cos) = libm::sincos(PI * f64::from(i) / 500.0);
                DVec2::new(middle[0] + a * cos, middle[1] + b * sin)
            };
            for p in (0..1000).map(ellipse) {
                let height =
                    (2.0 * sin * p.dot(cap.towards) + cos * (1.0 - p.length_squared())) / (1.0 + p.length_squared());
                assert!(height > edge - 1e-9, "{middle:?} {a} {b}: {height} {edge}");
            }
            let shares = (0..2000).map(|i| {
                let moved = f64::from(i) * 1e-2;
                let center = DVec2::new(middle[0] + moved.copysign(middle[0]), middle[1]);
                let radius = (0..1000).map(|i| ellipse(i).distance(center)).fold(0.0, f64::max);
                Cap::new([1.0; 2], center, radius).share
            });
            let least = shares.fold(f64::INFINITY, f64::min);
            assert!(cap.share < 1.02 * least, "{middle:?} {a} {b}: {} {least}", cap.share);
        }
    }
}
