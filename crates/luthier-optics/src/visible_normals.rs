//! Sampling of the visible micro-normals of an isotropic surface.

use std::f64::consts::PI;

use glam::DVec3;

use crate::stack::Distribution;

/// A micro-normal `m` with density `max(0, w.m) D(m) / integral`, from two numbers in 0..1. `m.z > 0` and `w.m >= 0`.
///
/// `w` is any unit direction that sees the surface: from above, or from below (`w.z < 0`) as the rays of a walk between
/// facets do. GGX: Dupuy and Benyoub 2023, "Sampling Visible GGX Normals with Spherical Caps", whose cap holds for
/// directions from below too. Beckmann: Heitz and d'Eon 2014, the slope along the plane of incidence by inverting its
/// cumulative distribution; slopes end at six times alpha, so a direction from below has to see such slopes (one that does
/// not meets no facet). GGX stands in for other distributions ([`Distribution::walked`]). `alpha` > 0.
pub fn sample(distribution: Distribution, alpha: f64, w: DVec3, u: [f64; 2]) -> DVec3 {
    let stretched = DVec3::new(alpha * w.x, alpha * w.y, w.z).normalize();
    match distribution {
        Distribution::Beckmann => {
            let sin = libm::hypot(stretched.x, stretched.y);
            let last = if sin > 0.0 { (stretched.z / sin).clamp(-SLOPE_LIMIT, SLOPE_LIMIT) } else { SLOPE_LIMIT };
            let along = visible_slope(stretched.z, sin, last, u[0]);
            let across = normal_slope(u[1]);
            let (cos_phi, sin_phi) = if sin > 0.0 { (stretched.x / sin, stretched.y / sin) } else { (1.0, 0.0) };
            let x = cos_phi * along - sin_phi * across;
            let y = sin_phi * along + cos_phi * across;
            DVec3::new(-alpha * x, -alpha * y, 1.0).normalize()
        }
        _ => {
            let phi = 2.0 * PI * u[1];
            let z = (1.0 - u[0]) * (1.0 + stretched.z) - stretched.z;
            let sin = libm::sqrt((1.0 - z * z).max(0.0));
            let (sin_phi, cos_phi) = libm::sincos(phi);
            let h = DVec3::new(sin * cos_phi, sin * sin_phi, z) + stretched;
            // Rounding must not put a normal below the horizon, where it would have no slope.
            DVec3::new(alpha * h.x, alpha * h.y, h.z.max(1e-300)).normalize()
        }
    }
}

/// Slopes beyond this many standard widths are never drawn.
pub const SLOPE_LIMIT: f64 = 6.0;

/// The slope x with `C(x) = u C(last)`, where C is the cumulative visible distribution of Gaussian slopes of unit alpha,
/// `C(x) = cos (1 + erf x)/2 + sin exp(-x^2)/(2 sqrt pi)`, for x from -[`SLOPE_LIMIT`] up to `last`, at most cos/sin. Halley's steps, kept inside
/// a bracket.
pub fn visible_slope(cos: f64, sin: f64, last: f64, u: f64) -> f64 {
    let scale = 0.5 / libm::sqrt(PI);
    let cumulative = |x: f64, gauss: f64| cos * 0.5 * libm::erfc(-x) + sin * scale * gauss;
    let mut high = last;
    let mut low = -SLOPE_LIMIT;
    let target = u * cumulative(high, libm::exp(-high * high));
    // Between a logistic guess at the normal quantile (seen from the normal) and Rayleigh's (grazing). Both are infinite at 0 or 1.
    let v = u.clamp(1e-9, 1.0 - 1e-9);
    let guess = cos.max(0.0) * 0.43 * libm::log(v / (1.0 - v)) - sin * libm::sqrt(-libm::log(v));
    // Where the visible slopes end, their density starts like a wedge: the rest of it grows like a square.
    let limit = high;
    let mut x = if guess < limit { guess.max(low) } else { (limit - libm::sqrt(1.0 - u)).max(low) };
    // Bisection alone would bring the bracket to 1e-12 in 44 steps.
    for _ in 0..60 {
        let gauss = libm::exp(-x * x);
        let excess = cumulative(x, gauss) - target;
        if excess > 0.0 {
            high = x;
        } else {
            low = x;
        }
        // Halley's step; its error is the cube of the last.
        let visible = cos - x * sin;
        let newton = excess / (2.0 * scale * gauss * visible);
        let step = newton / (1.0 + newton * (x + 0.5 * sin / visible));
        let next = x - step;
        let inside = next > low && next < high;
        x = if inside { next } else { 0.5 * (low + high) };
        if (inside && step.abs() < 1e-4 * (limit - next).min(1.0)) || high - low < 1e-12 {
            break;
        }
    }
    x
}

/// The slope x with `(1 + erf x)/2 = u`: Winitzki's closed form, good to 2e-3, and one step of Halley's method on it.
pub fn normal_slope(u: f64) -> f64 {
    let u = u.clamp(1e-15, 1.0 - 1e-15);
    let tails = libm::log(4.0 * u * (1.0 - u));
    let a = 2.0 / (PI * 0.147) + 0.5 * tails;
    let guess = libm::copysign(libm::sqrt(libm::sqrt(a * a - tails / 0.147) - a), u - 0.5);
    let newton = (0.5 * libm::erfc(-guess) - u) * libm::sqrt(PI) * libm::exp(guess * guess);
    guess - newton / (1.0 + newton * guess)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::microfacet;

    /// Compares the sampled mean of a function of the normal with its quadrature over the visible distribution.
    fn check(distribution: Distribution, alpha: f64, cos: f64) {
        let w = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos);
        let n = 512u32;
        let moments = |m: DVec3| [m.x, m.z, m.dot(w), m.y * m.y];
        let mut sampled = [0.0; 4];
        for i in 0..n {
            for j in 0..n {
                let u = [(f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n)];
                let m = sample(distribution, alpha, w, u);
                assert!(m.z > 0.0 && m.dot(w) > -1e-9, "{m} {w}");
                for (s, v) in sampled.iter_mut().zip(moments(m)) {
                    *s += v / f64::from(n * n);
                }
            }
        }
        let (mut weight, mut expected) = (0.0, [0.0; 4]);
        let (thetas, phis) = (2000, 720);
        for i in 0..thetas {
            let theta = (f64::from(i) + 0.5) / f64::from(thetas) * 0.5 * PI;
            let (s, c) = (libm::sin(theta), libm::cos(theta));
            let d = microfacet::distribution(distribution, alpha, c, s * s);
            for j in 0..phis {
                let phi = (f64::from(j) + 0.5) / f64::from(phis) * 2.0 * PI;
                let m = DVec3::new(s * libm::cos(phi), s * libm::sin(phi), c);
                let p = d * m.dot(w).max(0.0) * s;
                weight += p;
                for (e, v) in expected.iter_mut().zip(moments(m)) {
                    *e += p * v;
                }
            }
        }
        for (s, e) in sampled.iter().zip(expected) {
            assert!((s - e / weight).abs() < 2e-3, "{distribution:?} {alpha} {cos}: {s} against {}", e / weight);
        }
    }

    #[test]
    fn normal_slopes_invert_the_error_function() {
        for i in 1..1000 {
            let u = f64::from(i) / 1000.0;
            assert!((0.5 * libm::erfc(-normal_slope(u)) - u).abs() < 1e-8, "{u}");
        }
    }

    #[test]
    fn moments_match_quadrature_from_above_and_below() {
        for distribution in [Distribution::Beckmann, Distribution::Ggx] {
            for (alpha, cos) in [(0.3, 1.0), (0.3, 0.2), (0.9, 0.6), (0.9, -0.3), (0.5, -0.1), (0.2, 0.01)] {
                check(distribution, alpha, cos);
            }
        }
    }
}
