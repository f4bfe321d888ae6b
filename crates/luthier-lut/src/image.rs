//! Images of 32-bit floats, the unquantised form of tables and maps.

use serde::{Deserialize, Serialize};

/// A rectangle of texels in f32, row by row from the top, channels interleaved.
///
/// ```
/// use luthier_lut::Image;
///
/// let mut image = Image::zeros(2, 2, 1);
/// image.texel_mut(1, 0)[0] = 4.0;
/// assert_eq!(image.data, [0.0, 4.0, 0.0, 0.0]);
/// assert_eq!(image.halved().data, [1.0]);
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Image {
    /// Texels across.
    pub width: u32,
    /// Texels down.
    pub height: u32,
    /// Values per texel, 1..=4.
    pub channels: u32,
    /// `width * height * channels` values.
    pub data: Vec<f32>,
}

impl Image {
    /// Texels across and down.
    pub fn size(&self) -> [u32; 2] {
        [self.width, self.height]
    }

    /// An image of zeros.
    pub fn zeros(width: u32, height: u32, channels: u32) -> Self {
        Self { width, height, channels, data: vec![0.0; width as usize * height as usize * channels as usize] }
    }

    /// Number of texels.
    pub fn texel_count(&self) -> usize {
        self.width as usize * self.height as usize
    }

    /// The channels of one texel.
    pub fn texel(&self, x: u32, y: u32) -> &[f32] {
        let start = self.start(x, y);
        &self.data[start..start + self.channels as usize]
    }

    /// The channels of one texel, to write.
    pub fn texel_mut(&mut self, x: u32, y: u32) -> &mut [f32] {
        let start = self.start(x, y);
        &mut self.data[start..start + self.channels as usize]
    }

    /// All texels, row by row.
    pub fn texels(&self) -> impl Iterator<Item = &[f32]> {
        self.data.chunks_exact(self.channels as usize)
    }

    /// The image with half the columns and rows, each texel the mean of four; a last odd one is left out.
    pub fn halved(&self) -> Self {
        let [width, height] = self.size().map(|side| (side / 2).max(1));
        let mut half = Self::zeros(width, height, self.channels);
        for (y, x) in (0..height).flat_map(|y| (0..width).map(move |x| (y, x))) {
            let texels = [(0, 0), (1, 0), (0, 1), (1, 1)]
                .map(|(dx, dy)| self.texel((2 * x + dx).min(self.width - 1), (2 * y + dy).min(self.height - 1)));
            for (c, value) in half.texel_mut(x, y).iter_mut().enumerate() {
                *value = texels.iter().map(|texel| texel[c]).sum::<f32>() / 4.0;
            }
        }
        half
    }

    fn start(&self, x: u32, y: u32) -> usize {
        (y as usize * self.width as usize + x as usize) * self.channels as usize
    }
}

/// The two texels beside a coordinate of a picture that repeats, along one side of so many texels, and the share of the second: as samplers filter, with centres
/// of texels at (i + 1/2) / size.
///
/// ```
/// use luthier_lut::repeated;
///
/// assert_eq!(repeated(0.375, 4), ([1, 2], 0.0));
/// // Across the edge: the last texel and the first.
/// assert_eq!(repeated(3.0, 4), ([3, 0], 0.5));
/// ```
pub fn repeated(at: f64, size: u32) -> ([u32; 2], f64) {
    let at = (at - at.floor()) * f64::from(size) - 0.5;
    let low = at.floor();
    ([low, low + 1.0].map(|i| i.rem_euclid(f64::from(size)) as u32), at - low)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn texels_are_rows_from_the_top() {
        let mut image = Image::zeros(3, 2, 2);
        image.texel_mut(2, 0).copy_from_slice(&[1.0, 2.0]);
        image.texel_mut(0, 1)[1] = 3.0;
        assert_eq!(image.data, [0.0, 0.0, 0.0, 0.0, 1.0, 2.0, 0.0, 3.0, 0.0, 0.0, 0.0, 0.0]);
        assert_eq!(image.texel(2, 0), [1.0, 2.0]);
        assert_eq!(image.texels().count(), image.texel_count());
    }
}
