//! The form factor of a sphere that the horizon clips.

use std::f64::consts::{FRAC_PI_2, PI};

/// The clipped form factor of a sphere, over the length of its vector form factor: the fourth channel of engines'
/// second table.
///
/// `cos_elevation` in -1..=1 is the cosine of the direction of the sphere's centre against the normal. `length` in
/// 0..=1 is the length of the vector form factor, which is sin^2 of the sphere's angular radius. The result times
/// `length` is the integral of the clamped cosine over the sphere, over pi. Engines light a polygon as the sphere of
/// equal vector form factor (Hill and Heitz 2016, "Real-Time Area Lighting: a Journey from Research to Production").
/// Closed form of Snyder 1996, "Area Light Sources for Real-Time Graphics".
pub fn clipped_sphere_form_factor(cos_elevation: f64, length: f64) -> f64 {
    let z = cos_elevation.clamp(-1.0, 1.0);
    let sin_sq = length.clamp(0.0, 1.0);
    if sin_sq == 0.0 {
        return z.max(0.0);
    }
    let omega = libm::acos(z);
    let sin_sigma = libm::sqrt(sin_sq);
    let sigma = libm::asin(sin_sigma);
    if omega + sigma <= FRAC_PI_2 {
        return z;
    }
    if omega - sigma >= FRAC_PI_2 {
        return 0.0;
    }
    let cos_sigma = libm::sqrt(1.0 - sin_sq);
    let sin_omega = libm::sqrt(1.0 - z * z);
    // The rim of the sphere meets the horizon where the sine of this angle is cos sigma / sin omega.
    let sin_g = (cos_sigma / sin_omega).min(1.0);
    let cos_g = libm::sqrt(1.0 - sin_g * sin_g);
    let segment = FRAC_PI_2 - libm::asin(sin_g) + sin_g * cos_g - 2.0 * sin_omega * cos_sigma * cos_g;
    let rest = libm::sqrt((sin_sq - cos_g * cos_g).max(0.0));
    let ellipse = z * (cos_g * rest + sin_sq * libm::asin((cos_g / sin_sigma).min(1.0)));
    let integral = if z > 0.0 { PI * z * sin_sq + segment - ellipse } else { segment + ellipse };
    integral.max(0.0) / (PI * sin_sq)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Midpoints over the cap, in its own polar coordinates.
    fn by_midpoints(z: f64, length: f64) -> f64 {
        let sin_omega = libm::sqrt(1.0 - z * z);
        let (rings, azimuths) = (1500, 1000);
        let mut sum = 0.0;
        for i in 0..rings {
            // Even in sin^2: the measure is the projected solid angle of the cap, made a solid angle by 1 / cos.
            let sin_sq = length * (f64::from(i) + 0.5) / f64::from(rings);
            let (sin, cos) = (libm::sqrt(sin_sq), libm::sqrt(1.0 - sin_sq));
            for j in 0..azimuths {
                let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                sum += (z * cos + sin_omega * sin * libm::cos(phi)).max(0.0) / cos;
            }
        }
        sum / f64::from(rings * azimuths)
    }

    #[test]
    fn agrees_with_midpoints_over_the_cap() {
        for length in [0.01, 0.2, 0.5, 0.9] {
            for z in [-0.95, -0.6, -0.1, 0.0, 0.1, 0.5, 0.9, 1.0] {
                let (closed, sum) = (clipped_sphere_form_factor(z, length), by_midpoints(z, length));
                assert!((closed - sum).abs() < 2e-4, "{z} {length}: {closed} {sum}");
            }
        }
    }

    #[test]
    fn a_point_is_the_clamped_cosine_and_all_directions_half() {
        assert_eq!(clipped_sphere_form_factor(0.3, 0.0), 0.3);
        assert_eq!(clipped_sphere_form_factor(-0.3, 0.0), 0.0);
        // A hemisphere about a direction: the lune that it shares with the surface's.
        for z in [-1.0, -0.4, 0.0, 0.7, 1.0] {
            assert!((clipped_sphere_form_factor(z, 1.0) - 0.5 * (1.0 + z)).abs() < 1e-12, "{z}");
        }
    }
}
