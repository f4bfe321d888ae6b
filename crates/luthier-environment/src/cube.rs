//! Radiance on a cube.

use std::f64::consts::PI;

use luthier_lut::Image;

use crate::faces::solid_angles;
use crate::integral::Integral;

/// Radiance on a cube: means over its texels.
#[derive(Debug)]
pub(crate) struct Cube {
    size: u32,
    faces: Vec<Image>,
}

impl Cube {
    /// The cube of a map, of an even size. Each texel is the mean of the area that it covers.
    pub(crate) fn of_map(map: &Image, size: u32) -> Self {
        let integral = Integral::new(map);
        Self::new(size, |face| integral.face(face, size))
    }

    /// The cube with half the side: means of four texels by solid angle.
    pub(crate) fn halved(&self) -> Self {
        let size = self.size / 2;
        let weights = solid_angles(self.size);
        Self::new(size, |face| {
            let means = (0..size).flat_map(|y| (0..size).map(move |x| [x, y])).map(|[x, y]| {
                let (mut sum, mut total) = ([0.0; 3], 0.0);
                for [x, y] in [[0, 0], [1, 0], [0, 1], [1, 1]].map(|[i, j]| [2 * x + i, 2 * y + j]) {
                    let weight = weights[(y * self.size + x) as usize];
                    let texel = self.faces[face].texel(x, y);
                    total += weight;
                    (0..3).for_each(|c| sum[c] += weight * f64::from(texel[c]));
                }
                sum.map(|v| v / total)
            });
            means.collect()
        })
    }

    /// The cube of the values of each face, row by row.
    fn new(size: u32, values: impl Fn(usize) -> Vec<[f64; 3]>) -> Self {
        let faces = (0..6).map(|face| {
            let data = values(face).into_iter().flatten().map(|v| v as f32).collect();
            Image { width: size, height: size, channels: 3, data }
        });
        Self { size, faces: faces.collect() }
    }

    /// Its faces.
    pub(crate) fn faces(&self) -> &[Image] {
        &self.faces
    }

    /// The value of a texel.
    pub(crate) fn texel_at(&self, face: usize, x: u32, y: u32) -> &[f32] {
        self.faces[face].texel(x, y)
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::faces::texel_direction;

    /// Oracle: the function in the middle of a texel.
    #[test]
    fn means_over_texels_follow_a_smooth_function() {
        let value = |d: [f64; 3]| [2.0 + d[0], 2.0 + d[1], 2.0 + d[2] * d[0]];
        let mut map = Image::zeros(256, 128, 3);
        for (y, x) in (0..128).flat_map(|y| (0..256).map(move |x| (y, x))) {
            let d = crate::panorama::texel_direction(&map, x, y);
            map.texel_mut(x, y).copy_from_slice(&value(d).map(|v| v as f32));
        }
        // The second value is curved: means over texels are not quite those in their middle.
        for (cube, most) in [(Cube::of_map(&map, 64), 7e-4), (Cube::of_map(&map, 64).halved(), 2e-3)] {
            for (face, image) in cube.faces().iter().enumerate() {
                for (y, x) in (0..cube.size()).flat_map(|y| (0..cube.size()).map(move |x| (y, x))) {
                    let expected = value(texel_direction(face, cube.size(), x, y));
                    for (found, expected) in image.texel(x, y).iter().zip(expected) {
                        assert!((f64::from(*found) - expected).abs() < most, "{face} {x} {y}: {found} {expected}");
                    }
                }
            }
        }
    }
}
