//! Slopes of lobes, drawn where light leaves.
//!
//! Up to two thirds of a lobe are beyond the horizon. The slopes whose light leaves fill a disc. A round lobe with the tail of GGX is uniform on a sphere
//! in stereographic projection, and the disc is a cap of that sphere: a uniform draw in the cap has all of the lobe's light and no other. An elliptic lobe
//! gets the circle about its ellipse, or is drawn as a round one as wide as it is long. Other tails are drawn with that of GGX, of which they are at most 1.47
//! times. Where most of the lobe leaves, it is drawn as it is.

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

impl LobeDraw {
    /// The draw of a shape whose middle is moved by a slope, where light leaves from a disc of slopes.
    pub(in crate::models::lobes) fn new(shape: Shape, disc: &Leaving, moved: [f64; 2]) -> Self {
        let middle = [0, 1].map(|axis: usize| disc.middle[axis] - moved[axis]);
        let widest = shape.width[0].max(shape.width[1]);
        let narrowest = shape.width[0].min(shape.width[1]);
        let own = Cap::new(shape.width, DVec2::from(shape.scaled(middle)), disc.radius / narrowest);
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
