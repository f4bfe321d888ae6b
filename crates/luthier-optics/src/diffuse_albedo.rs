//! Directional albedo of Disney's diffuse lobe (Burley 2012, "Physically-Based Shading at Disney"), in closed form.

/// Albedo of [`disney_albedo`] at roughness 1 towards the normal, its largest within 45 degrees of it: Unity divides the lobe by it.
pub const DISNEY_ALBEDO_AT_NORMAL: f64 = 29.0 / 28.0;

/// Integrals over cosines of light `2 x^(k+1) (1 - x)^5`, k = 0, 1, 2.
const MOMENTS: [f64; 3] = [1.0 / 21.0, 1.0 / 84.0, 1.0 / 252.0];

/// The albedo of Disney's diffuse lobe with base colour 1 towards a direction, without sheen and subsurface.
///
/// The lobe is `(1 + e (1 - cos_l)^5) (1 + e (1 - cos_v)^5) / pi`, `e = 2 roughness cos_d^2 - 1/2`, where cos_d is that between light and half
/// vector. It is a polynomial of the direction of light, so the integral is exact. `roughness` is the artist's, 0..=1.
pub fn disney_albedo(roughness: f64, cos_theta: f64) -> f64 {
    // 2 cos_d^2 = 1 + l . v, so e = base + along cos_l + the part that goes with the cosine of the azimuth.
    let (base, along) = (roughness - 0.5, roughness * cos_theta);
    let view = fifth_power(1.0 - cos_theta);
    let [m0, m1, m2] = MOMENTS;
    let mean = base + along * (2.0 / 3.0);
    let mean_light = base * m0 + along * m1;
    // The mean of the squared cosine of the azimuth is 1/2.
    let across_sq = 0.5 * roughness * roughness * (1.0 - cos_theta * cos_theta);
    let mean_square_light = base * base * m0 + 2.0 * base * along * m1 + along * along * m2 + across_sq * (m0 - m2);
    1.0 + mean_light + view * (mean + mean_square_light)
}

/// The albedo of Unity's diffuse lobe: [`disney_albedo`] over [`DISNEY_ALBEDO_AT_NORMAL`] (`DisneyDiffuseNoPI` of its core shader library, which
/// writes 1.03571).
pub fn unity_disney_albedo(roughness: f64, cos_theta: f64) -> f64 {
    disney_albedo(roughness, cos_theta) / DISNEY_ALBEDO_AT_NORMAL
}

fn fifth_power(x: f64) -> f64 {
    let square = x * x;
    square * square * x
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;

    /// The integral over directions by midpoints, with the lobe as Burley prints it.
    #[test]
    fn agrees_with_midpoints_over_directions() {
        let (rings, azimuths) = (1500, 40);
        for roughness in [0.0, 0.3, 0.5, 0.8, 1.0] {
            for cos_v in [0.0, 0.1, 0.5, 0.9, 1.0] {
                let sin_v = libm::sqrt(1.0 - cos_v * cos_v);
                let mut expected = 0.0;
                for i in 0..rings {
                    let cos_l = (f64::from(i) + 0.5) / f64::from(rings);
                    let sin_l = libm::sqrt(1.0 - cos_l * cos_l);
                    for j in 0..azimuths {
                        let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                        let l = glam::DVec3::new(sin_l * libm::cos(phi), sin_l * libm::sin(phi), cos_l);
                        let v = glam::DVec3::new(sin_v, 0.0, cos_v);
                        let cos_d = l.dot((l + v).normalize());
                        let f90 = 0.5 + 2.0 * cos_d * cos_d * roughness;
                        let schlick = |cos: f64| 1.0 + (f90 - 1.0) * libm::pow(1.0 - cos, 5.0);
                        expected += 2.0 * cos_l * schlick(cos_l) * schlick(cos_v) / f64::from(rings * azimuths);
                    }
                }
                let found = disney_albedo(roughness, cos_v);
                assert!((found - expected).abs() < 1e-6, "{roughness} {cos_v}: {found} {expected}");
            }
        }
    }

    /// Unity states 1.03571 for roughness 1 towards the normal.
    #[test]
    fn has_the_published_maximum() {
        assert!((disney_albedo(1.0, 1.0) - 1.035_71).abs() < 5e-6);
        assert!((unity_disney_albedo(1.0, 1.0) - 1.0).abs() < 1e-15);
    }
}
