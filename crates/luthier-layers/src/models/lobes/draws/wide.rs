//! Directions of the wide remainder.

use std::f64::consts::PI;

use glam::DVec3;

use crate::models::lobes::Wide;

/// A wide remainder as it is drawn: by the cosine mu of the light, and by mu (1 - mu)^2 and mu (1 - mu)^5 as far as its shape has them beside 1.
///
/// A shape that falls towards the horizon is drawn by the cosine alone, and with a greater chance.
#[derive(Debug, Clone, Copy)]
pub(super) struct WideDraw {
    /// Shares of the second and of the third way, and their sum with the first.
    shares: [f64; 2],
    /// Factor on the energy of the remainder for its chance: a bound on its weights.
    pub(super) chance: f64,
}

impl WideDraw {
    /// The draw of a shape.
    pub(super) fn new(wide: &Wide) -> Self {
        let [fifth, square] = wide.falloff();
        let more = [(-square).max(0.0) / 6.0, (-fifth).max(0.0) / 21.0];
        let all = 1.0 + more[0] + more[1];
        Self { shares: more.map(|more| more / all), chance: (all / wide.integral()).max(1.0) }
    }

    /// Density in solid angle at a cosine.
    pub(super) fn pdf_solid_angle(&self, cos_theta: f64) -> f64 {
        let away = 1.0 - cos_theta;
        let square = away * away;
        let [squares, fifths] = self.shares;
        let by_cosine = 1.0 - squares - fifths + 6.0 * squares * square + 21.0 * fifths * (square * square * away);
        by_cosine * cos_theta / PI
    }

    /// A direction for three numbers that are uniform in 0..1.
    pub(super) fn sample(&self, [way, u, v]: [f64; 3]) -> DVec3 {
        let [squares, fifths] = self.shares;
        let (sin_phi, cos_phi) = libm::sincos(2.0 * PI * v);
        let cos_theta = if way < squares + fifths {
            // 1 - mu has the density of a product of powers: mu is the lesser of what both leave.
            let power = if way < squares { 3.0 } else { 6.0 };
            let rest = if way < squares { way / squares } else { (way - squares) / fifths };
            1.0 - libm::pow(u, 1.0 / power) * libm::pow(1.0 - rest, 1.0 / (power + 1.0))
        } else {
            libm::sqrt(1.0 - u)
        };
        let sin_theta = libm::sqrt(((1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0));
        DVec3::new(sin_theta * cos_phi, sin_theta * sin_phi, cos_theta)
    }
}
