//! One linearly transformed cosine: its density, and its integral over a polygon.

use std::f64::consts::PI;

use glam::DVec3;

/// A linearly transformed cosine (Heitz, Dupuy, Hill and Neubelt 2016), symmetric about the plane of incidence.
///
/// The inverse matrix takes a direction of the lobe to a direction of the clamped cosine: M^-1 = [m11 0 m13; 0 1 0; m31
/// 0 m33], scaled so that the entry in the middle is 1. x points to the side of the viewer, z along the normal; the
/// mirror direction therefore has a negative x. The determinant is positive. The integral of the density over all
/// directions is 1.
///
/// ```
/// use glam::DVec3;
/// use luthier_table::Lobe;
///
/// assert!((Lobe::COSINE.pdf_solid_angle(DVec3::Z) - std::f64::consts::FRAC_1_PI).abs() < 1e-15);
/// // A huge square overhead fills the cosine's hemisphere.
/// let corners = [[-1.0, -1.0], [1.0, -1.0], [1.0, 1.0], [-1.0, 1.0]].map(|[x, y]| DVec3::new(1e6 * x, 1e6 * y, 1.0));
/// assert!((Lobe::COSINE.over_polygon(&corners) - 1.0).abs() < 1e-5);
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Lobe {
    /// Row 1, column 1 of the inverse.
    pub m11: f64,
    /// Row 3, column 1.
    pub m31: f64,
    /// Row 1, column 3.
    pub m13: f64,
    /// Row 3, column 3.
    pub m33: f64,
}

impl Lobe {
    /// The clamped cosine itself.
    pub const COSINE: Self = Self { m11: 1.0, m31: 0.0, m13: 0.0, m33: 1.0 };

    /// The lobe of a texel: m11, m31, m13, m33, the order of engines.
    pub fn of_texel([m11, m31, m13, m33]: [f64; 4]) -> Self {
        Self { m11, m31, m13, m33 }
    }

    /// The entries in the order of [`Self::of_texel`].
    pub fn texel(self) -> [f64; 4] {
        [self.m11, self.m31, self.m13, self.m33]
    }

    /// The determinant of the inverse.
    pub fn determinant(self) -> f64 {
        self.m11 * self.m33 - self.m13 * self.m31
    }

    /// Density over solid angle of a unit direction (eq. 1 and 2); 0 if the transformed direction is below its horizon.
    pub fn pdf_solid_angle(self, w: DVec3) -> f64 {
        let z = self.m31 * w.x + self.m33 * w.z;
        if z <= 0.0 {
            return 0.0;
        }
        let x = self.m11 * w.x + self.m13 * w.z;
        let length_sq = x * x + w.y * w.y + z * z;
        self.determinant() * z / (PI * length_sq * length_sq)
    }

    /// The share of the lobe below the surface: the cosine over a lune, in closed form.
    pub fn below_horizon(self) -> f64 {
        // The horizon's normal in the space of the cosine is the last row of M, which is (-m31, 0, m11) but for a factor.
        let cos = self.m11 / libm::sqrt(self.m11 * self.m11 + self.m31 * self.m31);
        0.5 * (1.0 - cos)
    }

    /// The integral of the density over the directions of a flat polygon, given by its corners as seen from the shaded point, in order.
    ///
    /// The polygon is clipped at the horizon of the cosine; then Lambert's formula is exact (eq. 9 to 11). Corners on
    /// either side of the surface are let through, as in the paper. The polygon must be convex; its sense of rotation
    /// does not matter.
    pub fn over_polygon(self, corners: &[DVec3]) -> f64 {
        let transformed =
            corners.iter().map(|w| DVec3::new(self.m11 * w.x + self.m13 * w.z, w.y, self.m31 * w.x + self.m33 * w.z));
        let clipped: Vec<DVec3> =
            clip(&transformed.collect::<Vec<_>>()).into_iter().map(DVec3::normalize_or_zero).collect();
        let next = clipped.iter().cycle().skip(1);
        let sum: f64 = clipped.iter().zip(next).map(|(&a, &b)| edge(a, b)).sum();
        sum.abs() / (2.0 * PI)
    }
}

/// The part of a polygon above the plane z = 0.
pub(super) fn clip(corners: &[DVec3]) -> Vec<DVec3> {
    let mut kept = Vec::with_capacity(corners.len() + 1);
    for (i, &a) in corners.iter().enumerate() {
        let b = corners[(i + 1) % corners.len()];
        if a.z >= 0.0 {
            kept.push(a);
        }
        if (a.z > 0.0 && b.z < 0.0) || (a.z < 0.0 && b.z > 0.0) {
            let crossing = a + (b - a) * (a.z / (a.z - b.z));
            kept.push(DVec3::new(crossing.x, crossing.y, 0.0));
        }
    }
    kept
}

/// The angle between unit vectors, times the z of the unit normal to both.
fn edge(a: DVec3, b: DVec3) -> f64 {
    let cross = a.cross(b);
    let sin = cross.length();
    if sin == 0.0 { 0.0 } else { libm::atan2(sin, a.dot(b)) * cross.z / sin }
}

#[cfg(test)]
mod tests {
    use luthier_optics::quadrature::gauss_legendre;

    use super::*;

    const LOBES: [Lobe; 4] = [
        Lobe::COSINE,
        Lobe { m11: 0.7, m31: -0.2, m13: 0.5, m33: 0.4 },
        Lobe { m11: 1.3, m31: 0.1, m13: -0.2, m33: 0.8 },
        Lobe { m11: 0.3, m31: -0.15, m13: 0.4, m33: 0.2 },
    ];

    /// Midpoints over the sphere: an integral, and that of the directions below the surface.
    fn over_sphere(f: impl Fn(DVec3) -> f64) -> [f64; 2] {
        let (rings, azimuths) = (2000, 720);
        let mut sums = [0.0; 2];
        for i in 0..rings {
            let z = 2.0 * (f64::from(i) + 0.5) / f64::from(rings) - 1.0;
            let r = libm::sqrt(1.0 - z * z);
            for j in 0..azimuths {
                let phi = PI * (f64::from(j) + 0.5) / f64::from(azimuths);
                let value = f(DVec3::new(r * libm::cos(phi), r * libm::sin(phi), z));
                sums[0] += value;
                sums[1] += if z < 0.0 { value } else { 0.0 };
            }
        }
        sums.map(|sum| sum * 4.0 * PI / f64::from(rings * azimuths))
    }

    #[test]
    fn the_identity_is_the_clamped_cosine() {
        for z in [-1.0, -0.2, 0.0, 0.3, 1.0] {
            let w = DVec3::new(libm::sqrt(1.0 - z * z), 0.0, z);
            assert!((Lobe::COSINE.pdf_solid_angle(w) - z.max(0.0) / PI).abs() < 1e-15);
        }
    }

    #[test]
    fn densities_integrate_to_one_and_know_their_part_below() {
        for lobe in LOBES {
            let [all, below] = over_sphere(|w| lobe.pdf_solid_angle(w));
            assert!((all - 1.0).abs() < 2e-4, "{lobe:?}: {all}");
            assert!((below - lobe.below_horizon()).abs() < 2e-4, "{lobe:?}: {below} {}", lobe.below_horizon());
        }
    }

    /// Lambert's formula against Gauss-Legendre over the area of the rectangle; one that crosses the surface is cut into above and below by the area.
    #[test]
    fn polygons_agree_with_quadrature_over_their_area() {
        let rectangles = [
            [DVec3::new(-1.5, -0.5, 0.6), DVec3::new(1.0, 0.0, 0.0), DVec3::new(0.0, 1.2, 0.1)],
            [DVec3::new(-2.0, -1.0, -0.5), DVec3::new(0.0, 2.0, 0.0), DVec3::new(0.3, 0.0, 1.5)],
            [DVec3::new(0.3, -0.2, 1.0), DVec3::new(0.4, 0.0, 0.0), DVec3::new(0.0, 0.3, 0.0)],
        ];
        let rule = gauss_legendre(16);
        let patches = 24;
        for lobe in LOBES {
            for [corner, u, v] in rectangles {
                let normal = u.cross(v);
                let mut sum = 0.0;
                for (i, j) in (0..patches * patches).map(|k| (k / patches, k % patches)) {
                    for (x, wx) in &rule {
                        for (y, wy) in &rule {
                            let at = |i: i32, x: f64| (f64::from(i) + x) / f64::from(patches);
                            let p = corner + u * at(i, *x) + v * at(j, *y);
                            let r_sq = p.length_squared();
                            let w = p / libm::sqrt(r_sq);
                            sum += wx * wy * lobe.pdf_solid_angle(w) * normal.dot(w).abs() / r_sq;
                        }
                    }
                }
                sum /= f64::from(patches * patches);
                let closed = lobe.over_polygon(&[corner, corner + u, corner + u + v, corner + v]);
                // The kink at the horizon of the cosine, where it crosses the rectangle, costs quadrature accuracy.
                assert!((sum - closed).abs() < 2e-5, "{lobe:?} {corner}: {sum} {closed}");
                let turned = lobe.over_polygon(&[corner, corner + v, corner + u + v, corner + u]);
                assert!((turned - closed).abs() < 1e-14);
            }
        }
    }
}
