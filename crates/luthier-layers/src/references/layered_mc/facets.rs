//! Anisotropic facets of a micro-surface: their distribution, the area that a direction sees of them, and samples.
//!
//! Everything is the isotropic surface of unit slope in a frame stretched by the two slopes (Heitz 2014, sec. 5.3).
//! Directions that see the surface may come from below the horizon, as rays between facets do.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_optics::albedo::ALPHA_MIN;
use luthier_optics::stack::{Distribution, Surface};
use luthier_optics::visible_normals;

use super::random::Stream;

/// A rough micro-surface in the frame of its tangents.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Facets {
    distribution: Distribution,
    alpha_x: f64,
    alpha_y: f64,
    /// 1 / (pi alpha_x alpha_y).
    peak: f64,
    /// Whether samples of Beckmann's distribution are drawn by rejection.
    is_rejecting: bool,
}

/// The facets from a direction.
#[derive(Debug, Clone, Copy)]
pub(crate) struct View {
    pub(crate) direction: DVec3,
    /// Direction in the frame where slopes have unit scale; `length` is its length.
    stretched: DVec3,
    length: f64,
    /// [`Facets::visible_area`].
    pub(crate) area: f64,
}

impl Facets {
    /// `None` if both slopes are too small to make a micro-surface. If only one is too small, it is raised to the least.
    pub(crate) fn new(surface: &Surface) -> Option<Self> {
        if surface.alpha_x < ALPHA_MIN && surface.alpha_y < ALPHA_MIN {
            return None;
        }
        let (alpha_x, alpha_y) = (surface.alpha_x.max(ALPHA_MIN), surface.alpha_y.max(ALPHA_MIN));
        Some(Self {
            distribution: surface.distribution.walked(),
            alpha_x,
            alpha_y,
            peak: 1.0 / (PI * alpha_x * alpha_y),
            is_rejecting: false,
        })
    }

    /// The facets with samples of Beckmann's distribution by rejection: three times as fast as an inversion, and less even, because they take a varying
    /// number of random numbers.
    pub(crate) fn rejecting(self) -> Self {
        Self { is_rejecting: true, ..self }
    }

    /// Product of the slopes: the scale of light that bounces more than once.
    pub(crate) fn alpha_sq(&self) -> f64 {
        self.alpha_x * self.alpha_y
    }

    /// Density D of facet normals; zero from the horizon down.
    #[inline]
    pub(crate) fn density(&self, m: DVec3) -> f64 {
        if m.z <= 0.0 {
            return 0.0;
        }
        let (x, y, z_sq) = (m.x / self.alpha_x, m.y / self.alpha_y, m.z * m.z);
        let slope_sq = x * x + y * y;
        match self.distribution {
            Distribution::Beckmann => self.peak * libm::exp(-slope_sq / z_sq) / (z_sq * z_sq),
            _ => self.peak / ((z_sq + slope_sq) * (z_sq + slope_sq)),
        }
    }

    /// The facets as a direction sees them.
    #[inline(always)]
    pub(crate) fn view(&self, direction: DVec3) -> View {
        let (x, y, z) = (self.alpha_x * direction.x, self.alpha_y * direction.y, direction.z);
        let length = (x * x + y * y + z * z).sqrt();
        let area = self.area(x * x + y * y, z, length);
        View { direction, stretched: DVec3::new(x, y, z), length, area }
    }

    /// Area of facets that a direction sees, per area of surface: the integral of D max(0, w.m). With Smith's Lambda
    /// it is `cos (1 + Lambda)` from above and `|cos| Lambda` from below (Heitz et al. 2016, eq. 10).
    #[inline]
    pub(crate) fn visible_area(&self, w: DVec3) -> f64 {
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        let s_sq = x * x + y * y;
        self.area(s_sq, w.z, (w.z * w.z + s_sq).sqrt())
    }

    /// A bound of [`Self::visible_area`] from below the horizon, where that is slow to work out: its exponential by a series, and without the part of the error
    /// function.
    #[inline(always)]
    pub(crate) fn most_seen_from_below(&self, w: DVec3) -> Option<f64> {
        if self.distribution != Distribution::Beckmann {
            return None;
        }
        let (x, y) = (self.alpha_x * w.x, self.alpha_y * w.y);
        let s_sq = x * x + y * y;
        // Squared cotangent, over the slopes.
        let q = w.z * w.z / s_sq.max(f64::MIN_POSITIVE);
        Some((0.5 / PI.sqrt() * (1.0 + 1e-9)) * s_sq.sqrt() / (1.0 + q * (1.0 + q * (0.5 + q / 6.0))))
    }

    #[inline(always)]
    fn area(&self, s_sq: f64, z: f64, length: f64) -> f64 {
        match self.distribution {
            Distribution::Beckmann => beckmann_area(s_sq.sqrt(), z),
            // From below the difference cancels.
            _ if z < 0.0 => 0.5 * s_sq / (length - z),
            _ => 0.5 * (z + length),
        }
    }

    /// Smith's Lambda of a direction above the horizon.
    #[inline]
    pub(crate) fn lambda(&self, w: DVec3) -> f64 {
        if w.z > 0.0 { self.visible_area(-w) / w.z } else { f64::INFINITY }
    }

    /// A facet normal with density `D max(0, w.m) / area`, of any length: nothing that follows needs it, and roots
    /// are slow.
    #[inline(always)]
    pub(crate) fn sample(&self, stream: &mut Stream, view: &View) -> DVec3 {
        let View { stretched, length, .. } = *view;
        let m = match self.distribution {
            Distribution::Beckmann if self.is_rejecting && stretched.z > 0.0 => gaussian(stream, stretched / length),
            Distribution::Beckmann => {
                let numbers = [stream.uniform(), stream.uniform()];
                visible_normals::sample(Distribution::Beckmann, 1.0, stretched / length, numbers)
            }
            _ => {
                // Dupuy and Benyoub 2023: the half vector of a uniform point of a spherical cap; here on a sphere as
                // large as the stretched direction is long.
                let (direction, u) = stream.direction_and_uniform();
                let z = (1.0 - u) * (length + stretched.z) - stretched.z;
                let radius = (length * length - z * z).max(0.0).sqrt();
                DVec3::new(radius * direction.x, radius * direction.y, z) + stretched
            }
        };
        DVec3::new(self.alpha_x * m.x, self.alpha_y * m.y, m.z.max(1e-150))
    }
}

/// Cotangent, over the slopes, beyond which [`beckmann_area`] is the cosine to the last digit.
const STEEP: f64 = 6.5;

/// A visible normal of Gaussian slopes of unit scale, of any length, from a direction above the horizon.
///
/// Slopes x along the direction, away from it, have the density `max(0, cos - x sin) exp(-x^2)`. Below 0 that is a sum of a normal and a Rayleigh density;
/// above 0 it is below the normal one.
#[inline(never)]
fn gaussian(stream: &mut Stream, from: DVec3) -> DVec3 {
    let (sin, cos) = (libm::hypot(from.x, from.y), from.z);
    let normal = cos * PI.sqrt();
    let (x, y) = loop {
        let is_normal = stream.uniform() * (normal + 0.5 * sin) < normal;
        let (turn, u) = stream.direction_and_uniform();
        let radius = (-libm::log(1.0 - u)).sqrt();
        if !is_normal {
            break (-(-libm::log(1.0 - stream.uniform())).sqrt(), radius * turn.x);
        }
        let x = radius * turn.x;
        if x <= 0.0 || stream.uniform() * cos < cos - x * sin {
            break (x, radius * turn.y);
        }
    };
    let (cos_phi, sin_phi) = if sin > 0.0 { (from.x / sin, from.y / sin) } else { (1.0, 0.0) };
    DVec3::new(-(cos_phi * x - sin_phi * y), -(sin_phi * x + cos_phi * y), 1.0)
}

#[inline(never)]
fn beckmann_area(s: f64, z: f64) -> f64 {
    if s == 0.0 {
        return z.max(0.0);
    }
    let nu = z / s;
    if nu > STEEP {
        return z;
    }
    let area = 0.5 * z * libm::erfc(-nu) + 0.5 * s * libm::exp(-nu * nu) / PI.sqrt();
    area.max(0.0)
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::microfacet;

    const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];

    fn direction(cos: f64, phi: f64) -> DVec3 {
        let sin = libm::sqrt(1.0 - cos * cos);
        DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
    }

    #[test]
    fn isotropic_surfaces_are_those_of_the_optics_crate() {
        for d in BOTH {
            for alpha in [0.01, 0.3, 1.0] {
                let Some(facets) = Facets::new(&Surface::isotropic(d, alpha)) else { panic!("rough") };
                for cos in [0.01, 0.3, 0.9, 1.0] {
                    let m = direction(cos, 0.7);
                    let sin_sq = m.x * m.x + m.y * m.y;
                    let (ours, theirs) = (facets.density(m), microfacet::distribution(d, alpha, cos, sin_sq));
                    assert!((ours - theirs).abs() <= 1e-9 * theirs, "{d:?} {alpha} {cos}: {ours} {theirs}");
                    let (ours, theirs) = (facets.lambda(m), microfacet::lambda(d, alpha, cos));
                    assert!((ours - theirs).abs() <= 1e-9 * theirs + 1e-12, "{d:?} {alpha} {cos}: {ours} {theirs}");
                }
            }
        }
    }

    #[test]
    fn what_is_seen_from_below_is_bounded() {
        let surface = Surface { distribution: Distribution::Beckmann, alpha_x: 0.7, alpha_y: 0.3, rotation: 0.0 };
        let Some(facets) = Facets::new(&surface) else { panic!("rough") };
        for (cos, phi) in [(1e-9, 0.3), (0.01, 0.3), (0.1, 1.0), (0.4, 0.5), (0.9, 2.0), (1.0, 0.0)] {
            let w = direction(-cos, phi);
            let (most, area) = (facets.most_seen_from_below(w).unwrap(), facets.visible_area(w));
            assert!(most >= area && most < 0.1 + 2.0 * area, "{cos}: {most} {area}");
        }
    }

    #[test]
    fn visible_area_and_samples_match_quadrature_from_both_sides() {
        for (d, is_rejecting) in BOTH.map(|d| (d, false)).into_iter().chain([(Distribution::Beckmann, true)]) {
            let surface = Surface { distribution: d, alpha_x: 0.7, alpha_y: 0.3, rotation: 0.0 };
            let Some(mut facets) = Facets::new(&surface) else { panic!("rough") };
            if is_rejecting {
                facets = facets.rejecting();
            }
            for (cos, phi) in [(0.9, 0.4), (0.2, 1.2), (-0.1, 0.3)] {
                let w = direction(cos, phi);
                let moments = |m: DVec3| [m.x, m.y, m.z, m.dot(w), m.x * m.y];
                let (mut area, mut expected) = (0.0, [0.0; 5]);
                let (thetas, phis) = (1000u32, 360u32);
                for i in 0..thetas {
                    let theta = (f64::from(i) + 0.5) / f64::from(thetas) * 0.5 * PI;
                    for j in 0..phis {
                        let m = direction(libm::cos(theta), (f64::from(j) + 0.5) / f64::from(phis) * 2.0 * PI);
                        let cell = 0.5 * PI / f64::from(thetas) * 2.0 * PI / f64::from(phis) * libm::sin(theta);
                        let p = facets.density(m) * m.dot(w).max(0.0) * cell;
                        area += p;
                        expected.iter_mut().zip(moments(m)).for_each(|(e, v)| *e += p * v);
                    }
                }
                assert_eq!(facets.visible_area(w), facets.view(w).area);
                assert!((facets.visible_area(w) - area).abs() < 1e-3 * area, "{d:?} {cos}: {area}");
                let mut stream = Stream::new(3, 0);
                let n = 200_000;
                let mut sampled = [0.0; 5];
                for _ in 0..n {
                    let m = facets.sample(&mut stream, &facets.view(w)).normalize();
                    assert!(m.dot(w) > -1e-9);
                    sampled.iter_mut().zip(moments(m)).for_each(|(s, v)| *s += v / f64::from(n));
                }
                for (s, e) in sampled.into_iter().zip(expected) {
                    assert!((s - e / area).abs() < 5e-3, "{d:?} {cos}: {s} {}", e / area);
                }
            }
        }
    }
}
