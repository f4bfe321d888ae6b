//! Angles at interfaces that reflect all light beyond one of them.
//!
//! Below the critical cosine the reflectance is 1, and above it falls like a square root, which no row over that cosine follows. Over the
//! cosine of the refracted direction it is smooth: it is the reflectance from the other side. With cot^2 of the critical angle,
//! `1 / eta^2 - 1`, that cosine is the root of `cos^2 - cot^2 sin^2`, and with a cotangent of 0 the cosine itself.

/// The cosine below an interface for one above; 0 where nothing is refracted.
pub fn refracted_cosine(critical_cot_sq: f64, cos_theta: f64) -> f64 {
    (cos_theta * cos_theta - critical_cot_sq * (1.0 - cos_theta) * (1.0 + cos_theta)).max(0.0).sqrt()
}

/// The cosine above an interface for one below: the inverse of [`refracted_cosine`].
pub fn incident_cosine(critical_cot_sq: f64, cos_theta_t: f64) -> f64 {
    ((cos_theta_t * cos_theta_t + critical_cot_sq) / (1.0 + critical_cot_sq)).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Snell's law by sines: eta times the sine below is the sine above.
    #[test]
    fn both_ways_are_snells_law() {
        for eta in [0.99, 1.33 / 1.5, 1.0 / 1.5, 0.4] {
            let cot_sq = 1.0 / (eta * eta) - 1.0;
            for i in 0..=50 {
                let below = f64::from(i) / 50.0;
                let above = incident_cosine(cot_sq, below);
                let [sin_above, sin_below] = [above, below].map(|cos| (1.0 - cos * cos).sqrt());
                assert!((sin_above - eta * sin_below).abs() < 1e-9, "{eta} {below}");
                assert!((refracted_cosine(cot_sq, above) - below).abs() < 1e-7, "{eta} {below}");
            }
            let critical = (1.0 - eta * eta).sqrt();
            assert_eq!(refracted_cosine(cot_sq, 0.9 * critical), 0.0);
        }
    }

    #[test]
    fn without_total_reflection_cosines_stay() {
        for cos_theta in [0.0, 1e-9, 0.3, 1.0] {
            assert_eq!((refracted_cosine(0.0, cos_theta), incident_cosine(0.0, cos_theta)), (cos_theta, cos_theta));
        }
    }
}
