//! Slopes of half vectors in a medium.
//!
//! Light that has entered a coat meets the facets below it along refracted directions. Between refracted directions the lobe of those
//! facets keeps its width and its middle at all angles; between the directions outside it widens, shifts and is cut off.

use glam::DVec3;

/// Least cosine of a direction inside. Products of several such cosines are still numbers of single precision, which shaders have.
const COS_MIN: f64 = 1e-6;

/// A direction outside, refracted at the plane of the surface into a medium of relative index `index >= 1`. Both point away from the surface. The
/// cosine comes from the cosine outside, not from the sine: an index of 1 keeps it even if rounding has changed the direction's length. It is at
/// least [`COS_MIN`].
pub(super) fn refracted(outside: DVec3, index: f64) -> DVec3 {
    let cos_sq = outside.z * outside.z + (index - 1.0) * (index + 1.0);
    let cos = (cos_sq.sqrt() / index).max(COS_MIN);
    DVec3::new(outside.x / index, outside.y / index, cos)
}

/// Slope of the half vector between two directions inside, and the factor from densities of slopes to densities of the solid angle of
/// `outside`, whose refraction is `inside`.
///
/// With h the sum of the directions, `d slope / d omega_inside = (h.h / 2) / h_z^3`, and `d omega_inside / d omega_outside = cos_outside /
/// (index^2 cos_inside)`.
pub(super) fn slope(outside: DVec3, inside: DVec3, other: DVec3, index: f64) -> ([f64; 2], f64) {
    let sum = inside + other;
    let per_inside = 0.5 * sum.length_squared() / (sum.z * sum.z * sum.z);
    ([sum.x / sum.z, sum.y / sum.z], per_inside * outside.z / (index * index * inside.z))
}

/// The direction outside whose half vector with `other` has a slope; `None` where light does not leave the medium there.
pub(super) fn outside([x, y]: [f64; 2], other: DVec3, index: f64) -> Option<DVec3> {
    let wh = DVec3::new(x, y, 1.0).normalize();
    let inside = 2.0 * wh.dot(other) * wh - other;
    let (x, y) = (inside.x * index, inside.y * index);
    let cos_sq = 1.0 - x * x - y * y;
    (inside.z > 0.0 && cos_sq > 0.0).then(|| DVec3::new(x, y, cos_sq.sqrt()))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn direction(theta: f64, phi: f64) -> DVec3 {
        let (sin, cos) = libm::sincos(theta);
        DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
    }

    #[test]
    fn slopes_lead_back_to_the_direction() {
        for index in [1.0, 1.5, 2.4] {
            let wo = refracted(direction(0.9, 0.0), index);
            for (theta, phi) in [(0.1, 0.3), (0.8, 2.0), (1.5, 3.0)] {
                let wi = direction(theta, phi);
                let (slope, _) = slope(wi, refracted(wi, index), wo, index);
                assert!((outside(slope, wo, index).unwrap() - wi).length() < 1e-12);
            }
        }
        // Beyond the critical angle.
        assert_eq!(outside([1.0, 0.0], DVec3::Z, 1.5), None);
    }

    /// Oracle: the area that differences of slopes span.
    #[test]
    fn the_factor_is_the_determinant() {
        for index in [1.0, 1.7] {
            let wo = refracted(direction(1.1, 0.0), index);
            for (theta, phi) in [(0.4, 0.5), (1.2, 2.5)] {
                let at = |theta, phi| {
                    let wi = direction(theta, phi);
                    slope(wi, refracted(wi, index), wo, index)
                };
                let step = 1e-5;
                let difference =
                    |a: [f64; 2], b: [f64; 2]| [(a[0] - b[0]) / (2.0 * step), (a[1] - b[1]) / (2.0 * step)];
                let along_theta = difference(at(theta + step, phi).0, at(theta - step, phi).0);
                let along_phi = difference(at(theta, phi + step).0, at(theta, phi - step).0);
                let area = (along_theta[0] * along_phi[1] - along_theta[1] * along_phi[0]).abs() / libm::sin(theta);
                let factor = at(theta, phi).1;
                assert!((factor / area - 1.0).abs() < 1e-7, "{index} {theta}: {factor} {area}");
            }
        }
    }
}
