//! Levels: an environment blurred by lobes whose widths double, each a texture of half the side of the one before.

use luthier_lut::Image;
use rayon::prelude::*;

use crate::cube::{self, Cube};
use crate::error::setting;
use crate::kernel::Kernel;
use crate::panorama;
use crate::{Environment, EnvironmentError};

/// Shapes of a texture of directions.
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
    /// Standard deviation of the blur along each of two axes, radians; a lobe `exp((cos - 1) / width^2)`.
    pub width: f64,
    /// The faces of a cube, or one map. RGB.
    pub images: Vec<Image>,
}

/// Texels along the side of a face, or rows, of the last level.
const LAST: u32 = 4;

/// Texels along the side of a face, or rows, of irradiance.
const IRRADIANCE: u32 = 32;

impl Layout {
    /// Mean over all directions of images of this layout, RGB.
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
    fn solid_angles(self, size: u32) -> Vec<f64> {
        match self {
            Self::Cube => cube::solid_angles(size),
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
    fn texel(self, size: u32) -> f64 {
        match self {
            Self::Cube => 2.0 / f64::from(size),
            Self::Equirect => std::f64::consts::PI / f64::from(size),
        }
    }

    /// Images of a smooth function of unit directions: its means over texels. Those of a cube are as good as its values in the middle. Rows of a map end
    /// at poles, where sums of such values are not exact, and take two points of Gauss's rule each.
    fn images(self, size: u32, value: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Vec<Image> {
        let columns = self.columns(size);
        let image = |face: usize| {
            let mut image = Image::zeros(columns, size, 3);
            let shape = Image { data: Vec::new(), ..image.clone() };
            image.data.par_chunks_mut(3 * columns as usize).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_exact_mut(3).enumerate() {
                    let mean = match self {
                        Self::Cube => value(cube::texel_direction(face, size, x as u32, y as u32)),
                        Self::Equirect => {
                            let [a, b] = panorama::gauss_directions(&shape, x as u32, y as u32).map(&value);
                            [0, 1, 2].map(|c| 0.5 * (a[c] + b[c]))
                        }
                    };
                    texel.copy_from_slice(&mean.map(|v| v as f32));
                }
            });
            image
        };
        (0..self.faces()).map(image).collect()
    }
}

impl Environment {
    /// Width of the blur of a level of a texture whose largest level has this many rows: 0 for the first level, 8 / size for the second, then
    /// doubling up to 1 at four rows.
    pub fn level_width(size: u32, level: u32) -> f64 {
        if level == 0 { 0.0 } else { f64::from(4 << level) / f64::from(size) }
    }

    /// Rows of the largest level that suit this environment: a power of two.
    pub fn level_size(&self) -> u32 {
        self.map().height.next_power_of_two().clamp(32, 512)
    }

    /// Copies of the environment, each blurred more and half as large as the one before; the first is the map itself.
    ///
    /// # Errors
    /// [`EnvironmentError`] for a size that is not a power of two from 32 to 1024.
    pub fn levels(&self, layout: Layout, size: u32) -> Result<Vec<Level>, EnvironmentError> {
        if !size.is_power_of_two() || !(32..=1024).contains(&size) {
            return Err(setting("size", size.to_string(), "a power of two from 32 to 1024"));
        }
        let cubes = self.cubes();
        let count = size.ilog2() - LAST.ilog2() + 1;
        let level = |k: u32| {
            let (size, width) = (size >> k, Self::level_width(size, k));
            let images = if k == 0 {
                self.first_level(layout, size)
            } else {
                let kernel = Kernel::new(source(cubes, size), width, layout.texel(size));
                layout.images(size, |middle| kernel.mean(middle))
            };
            Level { width, images }
        };
        Ok((0..count).map(level).collect())
    }

    /// The map itself: texels are means of what they cover; where an equirectangular map is finer than it, they are reads.
    fn first_level(&self, layout: Layout, size: u32) -> Vec<Image> {
        match layout {
            Layout::Cube => match self.cubes().iter().find(|cube| cube.size() == size) {
                Some(cube) => cube.faces().to_vec(),
                None => Cube::of_map(self.map(), size).faces().to_vec(),
            },
            Layout::Equirect if size <= self.map().height => vec![panorama::shrunk(self.map(), size)],
            Layout::Equirect => layout.images(size, |direction| self.radiance(direction)),
        }
    }

    /// Irradiance over pi around every normal: a texture of one level with 32 rows.
    pub fn irradiance_level(&self, layout: Layout) -> Vec<Image> {
        layout.images(IRRADIANCE, |normal| self.irradiance(normal))
    }
}

/// The cube that has so many texels along a side, or the finest where none has as many.
fn source(cubes: &[Cube], size: u32) -> &Cube {
    cubes.iter().find(|cube| cube.size() <= size).unwrap_or(&cubes[cubes.len() - 1])
}

#[cfg(test)]
mod tests;
