//! Environments: a map of radiance, its irradiance, and its copies blurred by slope distributions.

use std::sync::OnceLock;

use luthier_lut::Image;
use rayon::prelude::*;

use crate::cube::Cube;
use crate::error::{EnvironmentError, setting};
use crate::layout::Level;
use crate::mirror::{ALPHAS, Blur, Lobe, level_height, place};
use crate::panorama::{bilinear, coordinates, direction, shrunk, solid_angle, texel_direction};
use crate::sky::Sky;
use crate::vector::{dot, tangents};

/// Rows of the largest map kept: one texel is 0.35 degrees.
const MAX_HEIGHT: u32 = 512;

/// Rows of the parts that irradiance is summed over, and of the map that it is stored in.
const IRRADIANCE_HEIGHT: u32 = 32;

/// Light from all around, far away: an equirectangular map of radiance, linear RGB, and its reflection by smooth and
/// rough surfaces.
///
/// The top of the map is +y, its middle looks along -z, as the default camera does. Blurred copies are made at their
/// first use, per slope distribution. They depend on the map only.
///
/// ```
/// use luthier_environment::{Environment, Sky};
///
/// let sky = Sky { zenith: [1.0; 3], ..Sky::uniform([0.0; 3]) };
/// let environment = Environment::sky(&sky)?;
/// let [up, down] = [1.0, -1.0].map(|y| environment.diffuse([0.0, y, 0.0])[1]);
/// assert!(up > 0.4 && down < 0.1);
/// # Ok::<(), luthier_environment::EnvironmentError>(())
/// ```
#[derive(Debug)]
pub struct Environment {
    /// The map, then each half as high as the one before.
    levels: Vec<Image>,
    /// Levels of a cube.
    pub(crate) levels_of_cube: OnceLock<Vec<Level>>,
    /// The map on a cube, then each with half the side of the one before.
    cubes: OnceLock<Vec<Cube>>,
    parts: OnceLock<Vec<Part>>,
    irradiance: OnceLock<Image>,
    ggx: OnceLock<Vec<Image>>,
    beckmann: OnceLock<Vec<Image>>,
}

/// Part of the sphere of directions, as seen by patches that have all of it above their horizon.
#[derive(Debug, Clone, Copy, Default)]
struct Part {
    /// Integral of the direction.
    area: [f64; 3],
    /// Integrals of the direction times the radiance of each channel.
    flux: [[f64; 3]; 3],
}

impl Environment {
    /// The environment of an RGB map, twice as wide as high. Maps with more than 512 rows are averaged down to that.
    ///
    /// # Errors
    /// [`EnvironmentError`] for another shape, or for radiance that is negative or not finite.
    pub fn new(map: Image) -> Result<Self, EnvironmentError> {
        if map.channels != 3 || map.height == 0 || map.width != 2 * map.height {
            let found = format!("{} x {} with {} channels", map.width, map.height, map.channels);
            return Err(setting("environment", found, "an RGB map is twice as wide as high"));
        }
        if let Some(place) = map.data.iter().position(|v| !v.is_finite() || *v < 0.0) {
            let (texel, value) = (place / 3, map.data[place]);
            let [x, y] = [texel % map.width as usize, texel / map.width as usize];
            let found = format!("{value} in column {x} of row {y}, counted from 0");
            let allowed = if value.is_finite() {
                "radiance is not negative"
            } else {
                "radiance is finite: paint such texels over, or clamp them when the map is written"
            };
            return Err(setting("environment", found, allowed));
        }
        let map = if map.height == 1 { doubled(&map) } else { map };
        let mut levels = vec![if map.height > MAX_HEIGHT { shrunk(&map, MAX_HEIGHT) } else { map }];
        while let Some(height) = levels.last().map(|map| map.height / 2).filter(|&height| height > 0) {
            let next = shrunk(&levels[levels.len() - 1], height);
            levels.push(next);
        }
        Ok(Self {
            levels,
            levels_of_cube: OnceLock::new(),
            cubes: OnceLock::new(),
            parts: OnceLock::new(),
            irradiance: OnceLock::new(),
            ggx: OnceLock::new(),
            beckmann: OnceLock::new(),
        })
    }

    /// The environment of a sky. Its map is fine enough for the sharpest light.
    ///
    /// # Errors
    /// [`EnvironmentError`].
    pub fn sky(sky: &Sky) -> Result<Self, EnvironmentError> {
        sky.check()?;
        // Eight rows to the spread of the sharpest light: bilinear reads follow it within a percent.
        let height = (8.0 * sky.sharpness().sqrt()) as u32;
        let height = height.next_power_of_two().clamp(32, MAX_HEIGHT);
        let mut map = Image::zeros(2 * height, height, 3);
        for y in 0..height {
            for x in 0..map.width {
                let radiance = sky.radiance(texel_direction(&map, x, y)).map(|v| v.max(0.0) as f32);
                map.texel_mut(x, y).copy_from_slice(&radiance);
            }
        }
        Self::new(map)
    }

    /// The map.
    pub fn map(&self) -> &Image {
        &self.levels[0]
    }

    /// Radiance from a unit direction.
    pub fn radiance(&self, direction: [f64; 3]) -> [f64; 3] {
        bilinear(self.map(), coordinates(direction))
    }

    /// Irradiance of a patch with this unit normal, over pi: the radiance of a white Lambertian patch.
    pub fn diffuse(&self, normal: [f64; 3]) -> [f64; 3] {
        bilinear(self.irradiance_map(), coordinates(normal))
    }

    /// Radiance of a rough mirror with slope parameter `alpha` around the mirrored direction, over its albedo. The
    /// facets are those of a surface at normal incidence, weighed by their cavities' masking.
    pub fn mirrored(&self, blur: Blur, alpha: f64, direction: [f64; 3]) -> [f64; 3] {
        let at = coordinates(direction);
        let (low, weight) = place(alpha);
        let [a, b] = [low, (low + 1).min(ALPHAS.len())]
            .map(|k| bilinear(if k == 0 { self.map() } else { &self.chain(blur)[k - 1] }, at));
        [0, 1, 2].map(|c| a[c] + weight * (b[c] - a[c]))
    }

    /// Irradiance over pi, on a small map.
    pub fn irradiance_map(&self) -> &Image {
        self.irradiance
            .get_or_init(|| filled(2 * IRRADIANCE_HEIGHT, IRRADIANCE_HEIGHT, |normal| self.irradiance(normal)))
    }

    /// Irradiance over pi, summed over parts of the sphere. A part that the horizon cuts counts as one direction, which
    /// costs a thousandth of an even environment; other parts are exact. The sum is divided by the sum for an even
    /// environment, which is therefore returned exactly.
    pub(crate) fn irradiance(&self, normal: [f64; 3]) -> [f64; 3] {
        let (mut sum, mut total) = ([0.0; 3], 0.0);
        for Part { area, flux } in self.parts.get_or_init(|| parts(self.map())) {
            total += dot(*area, normal).max(0.0);
            for (sum, flux) in sum.iter_mut().zip(flux) {
                *sum += dot(*flux, normal).max(0.0);
            }
        }
        sum.map(|v| v / total)
    }

    /// Rows of the largest level that suit this map: a power of two, and two for each row of the map, so that the second level is blurred by little more than
    /// a row. Lobes narrower than that have no blur of their own.
    pub fn level_size(&self) -> u32 {
        (2 * self.map().height).next_power_of_two().clamp(32, 512)
    }

    /// The map on a cube of its own fineness, and averages over ever larger texels.
    pub(crate) fn cubes(&self) -> &[Cube] {
        self.cubes.get_or_init(|| {
            let mut cubes = vec![Cube::of_map(self.map(), self.level_size())];
            while let Some(last) = cubes.last().filter(|cube| cube.size() > 2) {
                let next = last.halved();
                cubes.push(next);
            }
            cubes
        })
    }

    /// The map blurred for each of [`ALPHAS`].
    pub fn chain(&self, blur: Blur) -> &[Image] {
        let cell = match blur {
            Blur::Ggx => &self.ggx,
            Blur::Beckmann => &self.beckmann,
        };
        cell.get_or_init(|| ALPHAS.iter().map(|&alpha| self.blurred(blur, alpha)).collect())
    }

    /// The map blurred by a lobe. A lobe looks alike from every texel of a row, except for its azimuth: its samples are
    /// placed once per row.
    fn blurred(&self, blur: Blur, alpha: f64) -> Image {
        let height = level_height(alpha).min(self.map().height.max(16));
        let lobe = Lobe::new(blur, alpha, self.map().height);
        let mut map = Image::zeros(2 * height, height, 3);
        let columns = 2 * height as usize;
        map.data.par_chunks_mut(3 * columns).enumerate().for_each(|(y, row)| {
            let r = direction(0.5, (y as f64 + 0.5) / f64::from(height));
            let [t, b] = tangents(r);
            let samples: Vec<_> = lobe
                .samples
                .iter()
                .map(|sample| {
                    let [x, y, z] = sample.direction;
                    let [u, v] = coordinates([0, 1, 2].map(|c| x * t[c] + y * b[c] + z * r[c]));
                    (u - 0.5, v, sample.level, sample.weight)
                })
                .collect();
            for (x, texel) in row.chunks_exact_mut(3).enumerate() {
                let u = (x as f64 + 0.5) / columns as f64;
                let mut sum = [0.0; 3];
                for &(turn, v, level, weight) in &samples {
                    let value = self.filtered([u + turn, v], level);
                    (0..3).for_each(|c| sum[c] += weight * value[c]);
                }
                texel.copy_from_slice(&sum.map(|v| v as f32));
            }
        });
        map
    }

    /// Radiance averaged over about a texel of a level. Between two levels they are mixed.
    fn filtered(&self, at: [f64; 2], level: f64) -> [f64; 3] {
        let last = self.levels.len() - 1;
        let level = level.clamp(0.0, last as f64);
        let (low, weight) = (level as usize, level.fract());
        let near = bilinear(&self.levels[low], at);
        let far = bilinear(&self.levels[(low + 1).min(last)], at);
        [0, 1, 2].map(|c| near[c] + weight * (far[c] - near[c]))
    }
}

/// A map with each texel four times, because levels and cubes need two rows.
fn doubled(map: &Image) -> Image {
    let texels = (0..2 * map.height).flat_map(|y| (0..2 * map.width).map(move |x| map.texel(x / 2, y / 2)));
    let data = texels.flatten().copied().collect();
    Image { width: 2 * map.width, height: 2 * map.height, channels: map.channels, data }
}

/// A map in parts of a fixed number of rows, or its own texels if it has fewer.
fn parts(map: &Image) -> Vec<Part> {
    let rows = map.height.min(IRRADIANCE_HEIGHT);
    let mut parts = vec![Part::default(); (2 * rows * rows) as usize];
    for (y, x) in (0..map.height).flat_map(|y| (0..map.width).map(move |x| (y, x))) {
        let [row, column] = [y, x].map(|i| i * rows / map.height);
        let part = &mut parts[(2 * rows * row + column) as usize];
        let (direction, solid_angle) = (texel_direction(map, x, y), solid_angle(map, y));
        for (k, along) in direction.into_iter().enumerate() {
            part.area[k] += solid_angle * along;
            for (flux, radiance) in part.flux.iter_mut().zip(map.texel(x, y)) {
                flux[k] += solid_angle * along * f64::from(*radiance);
            }
        }
    }
    parts
}

/// The map of a function of the direction.
fn filled(width: u32, height: u32, value: impl Fn([f64; 3]) -> [f64; 3] + Sync) -> Image {
    let mut map = Image::zeros(width, height, 3);
    let shape = Image { data: Vec::new(), ..map.clone() };
    map.data.par_chunks_mut(3 * width as usize).enumerate().for_each(|(y, row)| {
        for (x, texel) in row.chunks_exact_mut(3).enumerate() {
            texel.copy_from_slice(&value(texel_direction(&shape, x as u32, y as u32)).map(|v| v as f32));
        }
    });
    map
}

#[cfg(test)]
mod tests;
