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
        let (mut sum, mut weights) = ([0.0; 3], 0.0);
        for image in images {
            for (y, x) in (0..image.height).flat_map(|y| (0..image.width).map(move |x| (y, x))) {
                let weight = match self {
                    Self::Cube => cube::solid_angle(image.height, x, y),
                    Self::Equirect => panorama::solid_angle(image, y),
                };
                weights += weight;
                (0..3).for_each(|c| sum[c] += weight * f64::from(image.texel(x, y)[c]));
            }
        }
        sum.map(|v| v / weights)
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

    /// Images of a function of unit directions.
    fn images(self, size: u32, value: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Vec<Image> {
        let columns = self.columns(size);
        let image = |face: usize| {
            let mut image = Image::zeros(columns, size, 3);
            image.data.par_chunks_mut(3 * columns as usize).enumerate().for_each(|(y, row)| {
                for (x, texel) in row.chunks_exact_mut(3).enumerate() {
                    let direction = match self {
                        Self::Cube => cube::texel_direction(face, size, x as u32, y as u32),
                        Self::Equirect => {
                            let [u, v] = [(x as f64 + 0.5) / f64::from(columns), (y as f64 + 0.5) / f64::from(size)];
                            panorama::direction(u, v)
                        }
                    };
                    texel.copy_from_slice(&value(direction).map(|v| v as f32));
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
        let sources = self.sources();
        let count = size.ilog2() - LAST.ilog2() + 1;
        let level = |k: u32| {
            let (size, width) = (size >> k, Self::level_width(size, k));
            let images = if k == 0 {
                layout.images(size, |direction| self.radiance(direction))
            } else {
                let source = nearest(sources, Kernel::side(width));
                let kernel = Kernel::new(width, layout.texel(size), source.texel());
                layout.images(size, |middle| kernel.mean(middle, |direction| source.read(direction)))
            };
            Level { width, images }
        };
        Ok((0..count).map(level).collect())
    }

    /// Irradiance over pi around every normal: a texture of one level with 32 rows.
    pub fn irradiance_level(&self, layout: Layout) -> Vec<Image> {
        layout.images(IRRADIANCE, |normal| self.irradiance(normal))
    }
}

/// The cube whose texels are about as large as a square of this side.
fn nearest(sources: &[Cube], side: f64) -> &Cube {
    let coarser = libm::log2(side * 0.5 * f64::from(sources[0].size()));
    // Texels in the corners of a face are smaller than in its middle.
    let level = (coarser + 0.25).round().clamp(0.0, (sources.len() - 1) as f64);
    &sources[level as usize]
}

#[cfg(test)]
mod tests;
