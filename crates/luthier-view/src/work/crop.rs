//! The part of a square rendering that the window shows.

use eframe::egui::ecolor;
use luthier_gpu::ToneMapping;
use luthier_lut::Image;

/// Longest side of a rendering, in pixels.
pub(crate) const SIDE_MAX: u32 = 2048;

/// The part of a square rendering that the window shows: all of its longer side, the middle of the other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Crop {
    pub(crate) side: u32,
    /// Sides of the window over the longer one.
    share: [f64; 2],
}

impl Crop {
    /// The part for a window of so many pixels; no side is longer than `most`.
    pub(crate) fn of([width, height]: [u32; 2], most: u32) -> Self {
        let longer = width.max(height).max(1);
        let share = [width, height].map(|length| f64::from(length.max(1)) / f64::from(longer));
        Self { side: longer.min(most), share }
    }

    /// Side of the square rendering over the shorter side of the window.
    pub(crate) fn widening(&self) -> f64 {
        1.0 / self.share[0].min(self.share[1])
    }

    /// Cuts the part out.
    pub(crate) fn cut(&self, image: &Image) -> Image {
        let [width, height] =
            self.share.map(|share| ((f64::from(image.width) * share).round() as u32).clamp(1, image.width));
        let (left, top) = ((image.width - width) / 2, (image.height - height) / 2);
        let channels = image.channels;
        let mut data = Vec::with_capacity((width * height * channels) as usize);
        for y in top..top + height {
            for x in left..left + width {
                data.extend_from_slice(image.texel(x, y));
            }
        }
        Image { width, height, channels, data }
    }
}

/// sRGB pixels of a linear picture behind a tone curve, three bytes each.
pub(crate) fn shown(image: &Image, tone: ToneMapping) -> Vec<u8> {
    image.data.iter().map(|&v| ecolor::gamma_u8_from_linear_f32(tone.value(v).min(1.0))).collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_window_cuts_the_middle() {
        let window = Crop::of([4, 2], SIDE_MAX);
        assert_eq!((window.side, window.widening()), (4, 2.0));
        let mut image = Image::zeros(4, 4, 3);
        image.texel_mut(0, 1).copy_from_slice(&[1.0, 0.5, 4.0]);
        let cut = window.cut(&image);
        assert_eq!([cut.width, cut.height], [4, 2]);
        assert_eq!(shown(&cut, ToneMapping::None)[..6], [255, 188, 255, 0, 0, 0]);
        let high = Crop::of([2, 4], SIDE_MAX).cut(&image);
        assert_eq!([high.width, high.height], [2, 4]);
        assert_eq!(Crop::of([0, 0], SIDE_MAX).side, 1);
        assert_eq!(Crop::of([10_000, 100], SIDE_MAX).side, SIDE_MAX);
    }
}
