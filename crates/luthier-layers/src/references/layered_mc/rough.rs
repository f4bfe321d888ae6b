//! Scattering at one facet of a rough interface: sampled directions and their density.

use glam::DVec3;

use super::chance::Chance;
use super::facets::{Facets, View};
use super::optics::{Optics, Side};
use super::random::Stream;

/// A rough interface, in the frame of its tangents.
#[derive(Debug, Clone)]
pub(crate) struct Rough<O = Optics> {
    pub(crate) optics: O,
    pub(crate) facets: Facets,
}

/// A direction at an interface: a side, and a unit vector in the frame of that side. Its z axis is the normal that points
/// into the side; frames of both sides share x and y.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Sided {
    pub(crate) side: Side,
    pub(crate) direction: DVec3,
}

impl<O: Chance> Rough<O> {
    /// Light that arrives on a side, seen from `view`, meets a facet: the direction in which it goes on, and the
    /// share that is not absorbed. Reflection or refraction by chance.
    #[inline(always)]
    pub(crate) fn scatter(&self, stream: &mut Stream, side: Side, view: &View) -> (Sided, O::Share) {
        let w = view.direction;
        let m = self.facets.sample(stream, view);
        let along = w.dot(m).max(0.0);
        let projected = along / m.length_squared();
        let chosen = self.optics.choose(stream, side, along * projected);
        let Some([cos_theta, cos_theta_t]) = chosen.refracted else {
            return (Sided { side, direction: 2.0 * projected * m - w }, chosen.kept);
        };
        let eta_it = self.optics.eta_it(side);
        let refracted = m * (projected * (eta_it - cos_theta_t / cos_theta)) - w * eta_it;
        (Sided { side: side.other(), direction: mirrored(refracted) }, chosen.kept)
    }
}

impl Rough {
    /// Density per solid angle, absorption included, with which a facet seen from `view` on a side sends light to
    /// `b`: its integral over `b` is the share that is not absorbed. The view may be from below the horizon of its
    /// side.
    ///
    /// Visible normals (Heitz et al. 2016, eq. 8-9) times the Jacobian of the half vector (Walter et al. 2007, eq. 14
    /// and 17). With the visible areas A, `n_a^2 A_a phase(a, b) = n_b^2 A_b phase(b, a)`.
    #[inline]
    pub(crate) fn phase(&self, side: Side, view: &View, b: Sided) -> f64 {
        let w = view.direction;
        if side == b.side {
            let m = (w + b.direction).normalize_or_zero();
            let density = self.facets.density(m);
            if density == 0.0 || view.area <= 0.0 {
                return 0.0;
            }
            return self.optics.split(side, w.dot(m)).reflectance * density / (4.0 * view.area);
        }
        if !self.optics.is_transparent() || view.area <= 0.0 {
            return 0.0;
        }
        let (index_i, index_t) = (self.optics.index(side), self.optics.index(b.side));
        let through = mirrored(b.direction);
        let sum = index_i * w + index_t * through;
        let length_sq = sum.length_squared();
        if length_sq == 0.0 {
            return 0.0;
        }
        let m = sum / length_sq.sqrt().copysign(sum.z);
        let (cos_i, cos_t) = (w.dot(m), -through.dot(m));
        if cos_i <= 0.0 || cos_t <= 0.0 {
            return 0.0;
        }
        let jacobian = cos_t * index_t * index_t / length_sq;
        self.optics.split(side, cos_i).transmittance * self.facets.density(m) * cos_i * jacobian / view.area
    }

    /// [`Self::phase`] from `a` to `b` and from `b` to `a`.
    pub(crate) fn phases(&self, a: Sided, b: Sided) -> (f64, f64) {
        let view = self.facets.view(a.direction);
        let forth = self.phase(a.side, &view, b);
        if forth == 0.0 {
            return (0.0, 0.0);
        }
        let (index_a, index_b) = (self.optics.index(a.side), self.optics.index(b.side));
        let area_b = self.facets.visible_area(b.direction);
        (forth, forth * (index_a * index_a * view.area) / (index_b * index_b * area_b))
    }
}

/// A direction in the frame of the other side.
fn mirrored(direction: DVec3) -> DVec3 {
    DVec3::new(direction.x, direction.y, -direction.z)
}
