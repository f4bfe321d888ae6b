//! Cubes: six square faces around a direction, in the order and orientation that graphics interfaces and KTX2 give to cube maps.

use std::f64::consts::PI;

use luthier_lut::Image;

use crate::vector::unit;

/// A direction (not unit) of a point of a face, both coordinates -1 to 1 from the top left. The faces look along +x, -x, +y, -y, +z, -z.
pub(crate) fn direction(face: usize, [s, t]: [f64; 2]) -> [f64; 3] {
    match face {
        0 => [1.0, -t, -s],
        1 => [-1.0, -t, s],
        2 => [s, 1.0, t],
        3 => [s, -1.0, -t],
        4 => [s, -t, 1.0],
        _ => [-s, -t, -1.0],
    }
}

/// The face that a direction meets, and where: the inverse of [`direction`].
pub(crate) fn place([x, y, z]: [f64; 3]) -> (usize, [f64; 2]) {
    let [ax, ay, az] = [x.abs(), y.abs(), z.abs()];
    if ax >= ay && ax >= az {
        if x > 0.0 { (0, [-z / ax, -y / ax]) } else { (1, [z / ax, -y / ax]) }
    } else if ay >= az {
        if y > 0.0 { (2, [x / ay, z / ay]) } else { (3, [x / ay, -z / ay]) }
    } else if z > 0.0 {
        (4, [x / az, -y / az])
    } else {
        (5, [-x / az, -y / az])
    }
}

/// Coordinates of the centre of a texel; those of an apron lie beyond -1 and 1.
fn centre(texel: i64, size: u32) -> f64 {
    (2.0 * texel as f64 + 1.0) / f64::from(size) - 1.0
}

/// Solid angle of a texel over its area on the face.
fn obliquity([s, t]: [f64; 2]) -> f64 {
    let length_sq = 1.0 + s * s + t * t;
    1.0 / (length_sq * length_sq.sqrt())
}

/// Radiance on a cube, to be read between texels: each face has an apron of one texel from its neighbours.
#[derive(Debug)]
pub(crate) struct Cube {
    size: u32,
    faces: Vec<Image>,
}

impl Cube {
    /// The cube of a function of unit directions.
    pub(crate) fn new(size: u32, value: impl Fn([f64; 3]) -> [f64; 3]) -> Self {
        let faces = (0..6).map(|face| {
            let mut image = Image::zeros(size + 2, size + 2, 3);
            for (y, x) in (0..size + 2).flat_map(|y| (0..size + 2).map(move |x| (y, x))) {
                let at = [x, y].map(|i| centre(i64::from(i) - 1, size));
                image.texel_mut(x, y).copy_from_slice(&value(unit(direction(face, at))).map(|v| v as f32));
            }
            image
        });
        Self { size, faces: faces.collect() }
    }

    /// The cube with half the side: means of four texels by solid angle.
    pub(crate) fn halved(&self) -> Self {
        let size = self.size / 2;
        let mut faces: Vec<Image> = vec![Image::zeros(size + 2, size + 2, 3); 6];
        for (face, small) in faces.iter_mut().enumerate() {
            for (y, x) in (0..size).flat_map(|y| (0..size).map(move |x| (y, x))) {
                let (mut sum, mut weights) = ([0.0; 3], 0.0);
                for [i, j] in [[0, 0], [1, 0], [0, 1], [1, 1]] {
                    let [x, y] = [2 * x + i, 2 * y + j];
                    let weight = obliquity([x, y].map(|i| centre(i64::from(i), self.size)));
                    let texel = self.faces[face].texel(x + 1, y + 1);
                    weights += weight;
                    (0..3).for_each(|c| sum[c] += weight * f64::from(texel[c]));
                }
                small.texel_mut(x + 1, y + 1).copy_from_slice(&sum.map(|v| (v / weights) as f32));
            }
        }
        let mut cube = Self { size, faces };
        cube.fill_aprons();
        cube
    }

    /// Fills the aprons from the nearest texels of the neighbours.
    fn fill_aprons(&mut self) {
        let last = i64::from(self.size);
        let rim = (-1..=last).flat_map(|i| [[i, -1], [i, last], [-1, i], [last, i]]);
        for (face, [x, y]) in (0..6).flat_map(|face| rim.clone().map(move |at| (face, at))) {
            let (other, at) = place(direction(face, [x, y].map(|i| centre(i, self.size))));
            let nearest = at.map(|c| ((0.5 * (c + 1.0) * f64::from(self.size)) as u32).min(self.size - 1) + 1);
            let value: [f32; 3] = std::array::from_fn(|c| self.faces[other].texel(nearest[0], nearest[1])[c]);
            self.faces[face].texel_mut((x + 1) as u32, (y + 1) as u32).copy_from_slice(&value);
        }
    }

    /// A bilinear read around a direction.
    pub(crate) fn read(&self, direction: [f64; 3]) -> [f64; 3] {
        let (face, at) = place(direction);
        let [x, y] = at.map(|c| 0.5 * (c + 1.0) * f64::from(self.size) + 0.5);
        let [left, top] = [x, y].map(|v| (v as u32).min(self.size));
        let [wx, wy] = [x - f64::from(left), y - f64::from(top)];
        let image = &self.faces[face];
        let row = |y: u32| {
            let (a, b) = (image.texel(left, y), image.texel(left + 1, y));
            [0, 1, 2].map(|c| f64::from(a[c]) + wx * f64::from(b[c] - a[c]))
        };
        let (above, below) = (row(top), row(top + 1));
        [0, 1, 2].map(|c| above[c] + wy * (below[c] - above[c]))
    }

    /// Texels along a side.
    pub(crate) fn size(&self) -> u32 {
        self.size
    }

    /// Side of a square as large as the mean texel, radians: those in the middle of a face have 2 over the size, those in its corners half of that.
    pub(crate) fn texel(&self) -> f64 {
        (4.0 * PI / 6.0).sqrt() / f64::from(self.size)
    }
}

/// A unit direction for each texel of a face, row by row.
pub(crate) fn texel_direction(face: usize, size: u32, x: u32, y: u32) -> [f64; 3] {
    unit(direction(face, [x, y].map(|i| centre(i64::from(i), size))))
}

/// Solid angle of a texel of a face, by its middle.
pub(crate) fn solid_angle(size: u32, x: u32, y: u32) -> f64 {
    let side = 2.0 / f64::from(size);
    side * side * obliquity([x, y].map(|i| centre(i64::from(i), size)))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn places_and_directions_are_inverse() {
        for face in 0..6 {
            for at in [[0.3, -0.7], [-0.9, 0.1], [0.0, 0.99]] {
                let (found, [s, t]) = place(direction(face, at));
                assert!(found == face && (s - at[0]).abs() < 1e-12 && (t - at[1]).abs() < 1e-12, "{face} {at:?}");
            }
        }
    }

    #[test]
    fn texels_fill_the_sphere() {
        let total: f64 = (0..64).flat_map(|y| (0..64).map(move |x| 6.0 * solid_angle(64, x, y))).sum();
        assert!((total / (4.0 * std::f64::consts::PI) - 1.0).abs() < 1e-3, "{total}");
    }

    /// Across edges too: a linear function of the direction is read within the square of a texel.
    #[test]
    fn reads_follow_a_smooth_function() {
        let value = |d: [f64; 3]| [2.0 + d[0], 2.0 + d[1], 2.0 + d[2]];
        let cube = Cube::new(32, value);
        let (fine, coarse) = (Cube::new(32, value), Cube::new(64, value).halved());
        for i in 0..2000 {
            let d = unit([f64::from(i % 13) - 6.1, f64::from(i % 17) - 8.2, f64::from(i % 11) - 5.3]);
            for (cube, most) in [(&cube, 2e-3), (&fine, 2e-3), (&coarse, 0.04)] {
                let read = cube.read(d);
                assert!((0..3).all(|c| (read[c] - value(d)[c]).abs() < most), "{d:?}: {read:?}");
            }
        }
    }
}
