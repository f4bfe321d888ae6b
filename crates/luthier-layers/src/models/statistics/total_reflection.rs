//! Share of a lobe inside a dense medium that lies within the critical angle.

use std::f64::consts::PI;

use luthier_optics::albedo::ALPHA_MIN;

/// Points of the integral over slopes. Shares are within 3e-4 of the limit next to grazing angles, and mostly within 1e-4.
const POINTS: u32 = 32;

/// Directions this close to the critical angle count as within it. A mean direction refracted from grazing incidence lies on it; without a
/// tolerance, rounding would decide.
const CRITICAL_TOLERANCE: f64 = 1e-9;

/// Share of a lobe that is not totally reflected: TIR of Belcour 2018, sec. 5.
///
/// The lobe is light at `cos_theta_i` that a GGX surface of slope `alpha` reflects upward (first bounce, without masking). It lies in a medium, and
/// next meets an interface; `eta` is the index above that interface over the index of the medium. The share is in 0..=1, and 1 for `eta >= 1`.
///
/// Method: slopes are in polar form. On a circle of equal slopes, the arc that reflects above an elevation has a closed form, and so has the visible
/// area on it. One integral remains, whose integrand behaves like square roots at both ends: the midpoint rule over the angle of a half circle
/// suits it.
pub fn escaping_share(cos_theta_i: f64, alpha: f64, eta: f64) -> f64 {
    if eta >= 1.0 {
        return 1.0;
    }
    let critical = ((1.0 - eta) * (1.0 + eta)).sqrt();
    if alpha < ALPHA_MIN {
        return if cos_theta_i >= critical - CRITICAL_TOLERANCE { 1.0 } else { 0.0 };
    }
    let above = reflected_above(cos_theta_i, alpha, critical);
    let all = reflected_above(cos_theta_i, alpha, 0.0);
    if all > 0.0 { (above / all).clamp(0.0, 1.0) } else { 0.0 }
}

/// Projected visible area of the facets that reflect to cosines above `cos_min`, in units of `pi` times the flat area.
fn reflected_above(cos_i: f64, alpha: f64, cos_min: f64) -> f64 {
    let sin_i = ((1.0 - cos_i) * (1.0 + cos_i)).max(0.0).sqrt();
    let sin_min = ((1.0 - cos_min) * (1.0 + cos_min)).max(0.0).sqrt();
    // Between these slopes part of the circle reflects above `cos_min`: below the first all or nothing of it does, above the second nothing.
    let sum = cos_i + cos_min;
    if sum <= 0.0 {
        return 0.0;
    }
    let (cut, end) = ((sin_min - sin_i).abs() / sum, (sin_min + sin_i) / sum);
    let (from, to) = (libm::atan(cut / alpha), libm::atan(end / alpha));
    let whole = if cos_i > cos_min {
        let s = libm::sin(from);
        2.0 * PI * cos_i * s * s
    } else {
        0.0
    };
    let mut arcs = 0.0;
    for k in 0..POINTS {
        let theta = PI * (f64::from(k) + 0.5) / f64::from(POINTS);
        let psi = from + (to - from) * 0.5 * (1.0 - libm::cos(theta));
        let slope = alpha * libm::tan(psi);
        // cos phi on the edge of the arc. The limit avoids a division by 0 at normal incidence.
        let edge = (0.5 * sum * (1.0 + slope * slope) - cos_i) / (slope * sin_i).max(f64::MIN_POSITIVE);
        let phi = libm::acos(edge.clamp(-1.0, 1.0));
        let area = 2.0 * (cos_i * phi + slope * sin_i * libm::sin(phi));
        arcs += libm::sin(2.0 * psi) * area * libm::sin(theta);
    }
    whole + arcs * 0.5 * (to - from) * PI / f64::from(POINTS)
}

#[cfg(test)]
mod tests {
    use super::*;
    use glam::DVec3;
    use luthier_optics::stack::Distribution;
    use luthier_optics::visible_normals;

    #[test]
    fn agrees_with_sampled_visible_normals() {
        // Oracle: 600 x 600 stratified visible normals, counted.
        for (cos, alpha, eta) in [
            (1.0, 0.3, 0.667),
            (0.8, 0.5, 0.667),
            (0.76, 0.1, 0.667),
            (0.9, 0.9, 0.5),
            (0.5, 0.2, 0.9),
            (0.3, 0.4, 0.7),
        ] {
            let w = DVec3::new(libm::sqrt(1.0 - cos * cos), 0.0, cos);
            let n = 600;
            let (mut above, mut all) = (0, 0);
            for i in 0..n {
                for j in 0..n {
                    let u = [(f64::from(i) + 0.5) / f64::from(n), (f64::from(j) + 0.5) / f64::from(n)];
                    let m = visible_normals::sample(Distribution::Ggx, alpha, w, u);
                    let z = 2.0 * m.dot(w) * m.z - w.z;
                    all += i32::from(z > 0.0);
                    above += i32::from(z > libm::sqrt(1.0 - eta * eta));
                }
            }
            let expected = f64::from(above) / f64::from(all);
            let got = escaping_share(cos, alpha, eta);
            assert!((got - expected).abs() < 1e-3, "{cos} {alpha} {eta}: {got} against {expected}");
        }
    }

    #[test]
    fn narrow_lobes_escape_or_do_not() {
        let critical = (1.0f64 - 0.49).sqrt();
        for alpha in [0.0, 1e-4] {
            assert!((escaping_share(critical + 0.01, alpha, 0.7) - 1.0).abs() < 1e-3);
            assert!(escaping_share(critical - 0.01, alpha, 0.7) < 1e-3);
        }
        assert_eq!(escaping_share(0.2, 0.5, 1.0), 1.0);
    }

    #[test]
    fn is_a_share_everywhere() {
        for i in 0..=40 {
            for j in 0..=20 {
                for eta in [0.0, 0.3, 0.667, 0.99, 0.999999] {
                    let share = escaping_share(f64::from(i) / 40.0, f64::from(j) / 20.0, eta);
                    assert!((0.0..=1.0).contains(&share), "{i} {j} {eta}: {share}");
                }
            }
        }
    }
}
