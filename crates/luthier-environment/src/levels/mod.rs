//! Levels: an environment blurred by lobes of doubling widths. Each level is a texture of half the side of the one
//! before.

use luthier_lut::Image;

use crate::cube::Cube;
use crate::environment::Environment;
use crate::error::{EnvironmentError, setting};
use crate::kernel::Kernel;
use crate::layout::{Layout, Level};
use crate::panorama;

/// Texels along the side of a face, or rows, of the last level.
const LAST: u32 = 4;

/// Texels along the side of a face, or rows, of irradiance.
const IRRADIANCE: u32 = 32;

impl Environment {
    /// The levels of a cube, of a size that suits the map.
    pub fn cube_levels(&self) -> &[Level] {
        self.levels_of_cube
            .get_or_init(|| self.levels(Layout::Cube, self.level_size()).expect("a size that is a power of two"))
    }

    /// Width of the blur of a level, for a texture with this many rows in its largest level: 0 for the first level, 8 /
    /// size for the second, then doubling up to 1 at four rows.
    pub fn level_width(size: u32, level: u32) -> f64 {
        if level == 0 { 0.0 } else { f64::from(4 << level) / f64::from(size) }
    }

    /// Copies of the environment, each blurred more and half as large as the one before. The first is the map itself.
    ///
    /// # Errors
    /// [`EnvironmentError`] for a size that is not a power of two from 32 to 1024.
    pub fn levels(&self, layout: Layout, size: u32) -> Result<Vec<Level>, EnvironmentError> {
        if !size.is_power_of_two() || !(32..=1024).contains(&size) {
            return Err(setting("size", size.to_string(), "a power of two from 32 to 1024"));
        }
        let cubes = self.cubes();
        let count = size.ilog2() - LAST.ilog2() + 1;
        let levels = (0..count).map(|k| {
            let (size, width) = (size >> k, Self::level_width(size, k));
            let images = if k == 0 {
                self.first_level(layout, size)
            } else {
                let kernel = Kernel::new(source(cubes, size), width, layout.texel(size));
                layout.images(size, |middle| kernel.mean(middle))
            };
            Level { width, images }
        });
        Ok(levels.collect())
    }

    /// The map itself. Texels are means of the area that they cover; if an equirectangular level is finer than the map,
    /// they are reads of it.
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

/// The cube with this many texels along a side; the finest if none has as many.
fn source(cubes: &[Cube], size: u32) -> &Cube {
    cubes.iter().find(|cube| cube.size() <= size).unwrap_or(&cubes[cubes.len() - 1])
}

#[cfg(test)]
mod tests;
