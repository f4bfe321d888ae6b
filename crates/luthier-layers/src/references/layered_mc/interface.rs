//! An interface, or a diffuse base, as the paths through a stack meet it.
//!
//! Kernels are densities of light per solid angle: of a unit of light that comes in from `a`, `K(a, b)` leaves along
//! `b`. With radiance, `K = f cos_theta_b`; reciprocity reads `n_a^2 cos_a K(a, b) = n_b^2 cos_b K(b, a)`.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::stack::Surface;

use super::InterfaceMode;
use super::chance::Chance;
use super::facets::Facets;
use super::optics::{Optics, Side};
use super::random::Stream;
use super::rough::{Rough, Sided};
use super::{one_facet, walk};
use crate::formulas::oren_nayar;
use crate::monochrome::{MonochromeBelow, MonochromeLayer};

/// An interface.
#[derive(Debug, Clone)]
pub(crate) struct Interface {
    kind: Kind,
    /// Cosine and sine of the angle from the stack's tangent to the interface's, where it matters.
    rotation: Option<(f64, f64)>,
    mode: InterfaceMode,
}

#[derive(Debug, Clone)]
enum Kind {
    Smooth(Optics),
    Rough(Rough),
    Diffuse { albedo: f64, sigma: f64 },
}

impl Interface {
    /// The interface at the top of a layer.
    pub(crate) fn new(layer: &MonochromeLayer, mode: InterfaceMode) -> Self {
        let surface = &layer.surface;
        let kind = match layer.below {
            MonochromeBelow::Diffuse { albedo, sigma } => Kind::Diffuse { albedo, sigma },
            MonochromeBelow::Conductor { .. } | MonochromeBelow::Dielectric { .. } => {
                let optics = Optics::of(layer);
                match Facets::new(surface) {
                    Some(facets) if !optics.is_absent() => Kind::Rough(Rough { optics, facets }),
                    _ => Kind::Smooth(optics),
                }
            }
        };
        let rotation = turn(surface);
        Self { kind, rotation, mode }
    }

    /// Whether every direction has one mirrored and one refracted direction only.
    pub(crate) fn is_smooth(&self) -> bool {
        matches!(self.kind, Kind::Smooth(_))
    }

    /// The facets of the interface, where it has them.
    #[cfg(test)]
    pub(crate) fn rough(&self) -> Option<&Rough> {
        if let Kind::Rough(rough) = &self.kind { Some(rough) } else { None }
    }

    /// Whether it is a diffuse base that reflects nothing.
    pub(crate) fn is_black(&self) -> bool {
        matches!(self.kind, Kind::Diffuse { albedo: 0.0, .. })
    }

    /// Index of the medium on a side; `None` at a diffuse base, which does not know it.
    pub(crate) fn index(&self, side: Side) -> Option<f64> {
        match &self.kind {
            Kind::Smooth(optics) | Kind::Rough(Rough { optics, .. }) => Some(optics.index(side)),
            Kind::Diffuse { .. } => None,
        }
    }

    /// Direction in which light from `a` goes on, and its weight, by chance; `None` when it is lost.
    #[inline(always)]
    pub(crate) fn scatter(&self, stream: &mut Stream, a: Sided) -> Option<(Sided, f64)> {
        match &self.kind {
            Kind::Smooth(optics) => Some(scatter_smooth(optics, stream, a)),
            &Kind::Diffuse { albedo, sigma } => {
                let (direction, u) = stream.direction_and_uniform();
                let sin = u.sqrt();
                let b = DVec3::new(sin * direction.x, sin * direction.y, (1.0 - u).sqrt());
                Some((Sided { direction: b, ..a }, PI * diffuse_brdf(albedo, sigma, a.direction, b)))
            }
            Kind::Rough(rough) => {
                let a = a.inside(self.rotation);
                let scattered = match self.mode {
                    InterfaceMode::SmithWalk => walk::scatter(rough, stream, a).map(|(b, weight, _)| (b, weight)),
                    InterfaceMode::OneFacet => one_facet::scatter(rough, stream, a),
                };
                scattered.map(|(b, weight)| (b.outside(self.rotation), weight))
            }
        }
    }

    /// K(a, b), or an unbiased estimate of it. Zero for a smooth interface, whose kernel is no function.
    pub(crate) fn kernel(&self, stream: &mut Stream, a: Sided, b: Sided) -> f64 {
        match &self.kind {
            Kind::Smooth(_) => 0.0,
            &Kind::Diffuse { albedo, sigma } => diffuse_brdf(albedo, sigma, a.direction, b.direction) * b.direction.z,
            Kind::Rough(rough) => {
                let [a, b] = [a, b].map(|d| d.inside(self.rotation));
                match self.mode {
                    InterfaceMode::SmithWalk => walk::kernel(rough, stream, a, b),
                    InterfaceMode::OneFacet => one_facet::kernel(rough, a, b),
                }
            }
        }
    }

    /// Approximate densities with which [`Self::scatter`] draws `b` from `a`, and `a` from `b`; positive wherever the exact
    /// ones are. Weights between strategies need no more. A smooth interface, which is no strategy, has 1.
    pub(crate) fn densities(&self, a: Sided, b: Sided) -> (f64, f64) {
        let (forth, back) = match &self.kind {
            Kind::Smooth(_) => (1.0, 1.0),
            Kind::Diffuse { .. } => (b.direction.z / PI, a.direction.z / PI),
            Kind::Rough(rough) => {
                let [a, b] = [a, b].map(|d| d.inside(self.rotation));
                let (forth, back) = rough.phases(a, b);
                match self.mode {
                    InterfaceMode::SmithWalk => {
                        (forth + walk::later_density(rough, b), back + walk::later_density(rough, a))
                    }
                    InterfaceMode::OneFacet => (forth, back),
                }
            }
        };
        (forth.max(f64::MIN_POSITIVE), back.max(f64::MIN_POSITIVE))
    }
}

impl Sided {
    /// The direction in the frame of an interface; `rotation` as of [`turn`].
    pub(super) fn inside(self, rotation: Option<(f64, f64)>) -> Self {
        rotation.map_or(self, |(cos, sin)| Self { direction: rotated(self.direction, cos, -sin), ..self })
    }

    /// The direction back in the frame of the stack.
    pub(super) fn outside(self, rotation: Option<(f64, f64)>) -> Self {
        rotation.map_or(self, |(cos, sin)| Self { direction: rotated(self.direction, cos, sin), ..self })
    }
}

/// Cosine and sine of the angle from a stack's tangent to that of a surface, where it matters.
pub(super) fn turn(surface: &Surface) -> Option<(f64, f64)> {
    let is_turned = surface.alpha_x != surface.alpha_y && surface.rotation != 0.0;
    is_turned.then(|| (libm::cos(surface.rotation), libm::sin(surface.rotation)))
}

/// A direction, turned about the normal.
pub(super) fn rotated(DVec3 { x, y, z }: DVec3, cos: f64, sin: f64) -> DVec3 {
    DVec3::new(cos * x - sin * y, sin * x + cos * y, z)
}

/// Light from `a` at a smooth interface: the direction in which it goes on by chance, and the share that is not absorbed.
pub(super) fn scatter_smooth<O: Chance>(optics: &O, stream: &mut Stream, a: Sided) -> (Sided, O::Share) {
    let DVec3 { x, y, z } = a.direction;
    let chosen = optics.choose(stream, a.side, z * z);
    let Some([_, cos_theta_t]) = chosen.refracted else {
        return (Sided { direction: DVec3::new(-x, -y, z), ..a }, chosen.kept);
    };
    let eta_it = optics.eta_it(a.side);
    (Sided { side: a.side.other(), direction: DVec3::new(-x * eta_it, -y * eta_it, cos_theta_t) }, chosen.kept)
}

fn diffuse_brdf(albedo: f64, sigma: f64, a: DVec3, b: DVec3) -> f64 {
    if sigma == 0.0 {
        return albedo / PI;
    }
    oren_nayar::brdf_scalar(albedo, sigma, b, a)
}
