//! Textures of directions: shapes, texels and levels.

use luthier_lut::Image;
use rayon::prelude::*;

use crate::{faces, panorama};

/// Shapes of a texture of directions.
///
/// ```
/// use luthier_environment::{Environment, Layout, Sky};
///
/// let environment = Environment::sky(&Sky::uniform([0.25; 3]))?;
/// for layout in [Layout::Cube, Layout::Equirect] {
///     let [red, ..] = layout.mean(&environment.irradiance_level(layout));
///     assert!((red - 0.25).abs() < 1e-6);
/// }
/// # Ok::<(), luthier_environment::EnvironmentError>(())
/// ```
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// Six faces, along +x, -x, +y, -y, +z, -z.
    Cube,
    /// One map, twice as wide as high.
    Equirect,
}

/// One level of a texture.
#[derive(Debug, Clone, PartialEq)]
pub struct Level {
    /// Width of the lobe `exp((cos - 1) / width^2)`: the standard deviation of the blur along each of two axes,
    /// radians.
    pub width: f64,
    /// The faces of a cube, or one map. RGB.
    pub images: Vec<Image>,
}

impl Layout {
    /// Mean over all directions of the images of this layout, RGB.
    pub fn mean(self, images: &[Image]) -> [f64; 3] {
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for image in images {
            let weights = self.solid_angles(image.height);
            for (texel, weight) in image.texels().zip(weights) {
                total += weight;
                (0..3).for_each(|c| sum[c] += weight * f64::from(texel[c]));
            }
        }
        sum.map(|v| v / total)
    }

    /// Solid angles of the texels of an image, row by row.
    pub(crate) fn solid_angles(self, size: u32) -> Vec<f64> {
        match self {
            Self::Cube => faces::solid_angles(size),
            Self::Equirect => {
                let shape = Image { width: 2 * size, height: size, channels: 3, data: Vec::new() };
                (0..2 * size * size).map(|i| panorama::solid_angle(&shape, i / (2 * size))).collect()
            }
        }
    }

    /// An image for each face.
    fn faces(self) -> usize {
        match self {
            Self::Cube => 6,
            Self::Equirect => 1,
        }
    }

    fn columns(self, size: u32) -> u32 {
        match self {
            Self::Cube => size,
            Self::Equirect => 2 * size,
        }
    }

    /// Side of a texel in radians, in the middle of a face or of the map.
    pub(crate) fn texel(self, size: u32) -> f64 {
        match self {
            Self::Cube => 2.0 / f64::from(size),
            Self::Equirect => std::f64::consts::PI / f64::from(size),
        }
    }

    /// Images of a smooth function of unit directions: its means over texels. For texels of a cube the value in the
    /// middle is exact enough. Rows of a map end at poles, where sums of middles are not exact, so each texel takes two
    /// points of Gauss's rule.
    pub(crate) fn images(self, size: u32, value: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Vec<Image> {
        let columns = self.columns(size);
        let images = (0..self.faces()).map(|face| {
            let mut image = Image::zeros(columns, size, 3);
            let shape = Image { data: Vec::new(), ..image.clone() };
            image.data.par_chunks_mut(3 * columns as usize).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_exact_mut(3).enumerate() {
                    let mean = match self {
                        Self::Cube => value(faces::texel_direction(face, size, x as u32, y as u32)),
                        Self::Equirect => {
                            let [a, b] = panorama::gauss_directions(&shape, x as u32, y as u32).map(&value);
                            [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]))
                        }
                    };
                    texel.copy_from_slice(&mean.map(|v| v as f32));
                }
            });
            image
        });
        images.collect()
    }
}
