//! LDR-FLIP: the visible difference when a viewer flips between two pictures.
//!
//! P. Andersson, J. Nilsson, T. Akenine-Möller, M. Oskarsson, K. Åström, M. D. Fairchild. FLIP: A Difference Evaluator for
//! Alternating Images. Proc. ACM Comput. Graph. Interact. Tech. 3, 2 (2020). Section numbers are of that paper;
//! constants are those of its published code.

use std::f64::consts::PI;

use luthier_lut::Image;

mod color;
mod filter;

pub use color::lightness_chroma_hue;
use color::{clipped_rgb, hunt_lab, hyab, opponent};
use filter::{Kernel, convolved};

/// Exponent of the colour difference (sec. 4.1).
const COLOR_EXPONENT: f64 = 0.7;
/// Share of the largest colour difference that is mapped to [`COLOR_SHARE_MAPPED`] (sec. 4.1).
const COLOR_SHARE: f64 = 0.4;
const COLOR_SHARE_MAPPED: f64 = 0.95;
/// Exponent of the feature difference (sec. 4.2).
const FEATURE_EXPONENT: f64 = 0.5;
/// Width of the features, degrees (sec. 4.2).
const FEATURE_WIDTH: f64 = 0.082;

/// The FLIP map of two linear RGB pictures of the same size, one channel, 0 (same) to 1. Values are clipped to 0..1, as a
/// display does. The order of the pictures does not matter.
pub(crate) fn flip(reference: &Image, test: &Image, pixels_per_degree: f64) -> Image {
    let [a, b] = [reference, test].map(|image| Seen::new(image, pixels_per_degree));
    let largest = largest_color_difference();
    let data = (0..reference.texel_count())
        .map(|i| {
            let color = redistributed(libm::pow(hyab(a.lab[i], b.lab[i]), COLOR_EXPONENT), largest);
            let edges = (a.edges[i] - b.edges[i]).abs();
            let points = (a.points[i] - b.points[i]).abs();
            let feature = libm::pow(edges.max(points) / std::f64::consts::SQRT_2, FEATURE_EXPONENT);
            // The feature difference lowers the exponent: a pixel of equal colour stays at 0, whatever its features.
            libm::pow(color, 1.0 - feature) as f32
        })
        .collect();
    Image { width: reference.width, height: reference.height, channels: 1, data }
}

/// One picture, prepared for the comparison.
struct Seen {
    /// Pixels filtered by the contrast sensitivity, in Hunt-adjusted L*a*b*.
    lab: Vec<[f64; 3]>,
    edges: Vec<f64>,
    points: Vec<f64>,
}

impl Seen {
    fn new(image: &Image, pixels_per_degree: f64) -> Self {
        let size = [image.width as usize, image.height as usize];
        let pixels: Vec<[f64; 3]> =
            image.texels().map(|t| opponent([0, 1, 2].map(|c| f64::from(t[c]).clamp(0.0, 1.0)))).collect();
        let filtered = SENSITIVITY.map(|(channel, terms)| {
            let plane: Vec<f64> = pixels.iter().map(|p| p[channel]).collect();
            sensed(&plane, size, terms, pixels_per_degree)
        });
        let lab = (0..pixels.len()).map(|i| hunt_lab(clipped_rgb([0, 1, 2].map(|c| filtered[c][i])))).collect();

        let lightness: Vec<f64> = pixels.iter().map(|p| (p[0] + 16.0) / 116.0).collect();
        let deviation = 0.5 * FEATURE_WIDTH * pixels_per_degree;
        let radius = (3.0 * deviation).ceil() as i32;
        let gauss = |x: f64| libm::exp(-x * x / (2.0 * deviation * deviation));
        let flat = Kernel::new(radius, gauss).normalised();
        let slope = Kernel::new(radius, |x| -x * gauss(x)).balanced();
        let bump = Kernel::new(radius, |x| (x * x / (deviation * deviation) - 1.0) * gauss(x)).balanced();
        let [edges, points] = [slope, bump].map(|kernel| {
            let across = convolved(&lightness, size, &kernel, &flat);
            let down = convolved(&lightness, size, &flat, &kernel);
            across.iter().zip(down).map(|(x, y)| (x * x + y * y).sqrt()).collect()
        });
        Self { lab, edges, points }
    }
}

/// Contrast sensitivity of a channel as a sum of Gaussians: weight a and b of a sqrt(pi / b) exp(-(pi x)^2 / b), x in degrees.
type Terms = [[f64; 2]; 2];

const SENSITIVITY: [(usize, Terms); 3] =
    [(0, [[1.0, 0.0047], [0.0, 1e-5]]), (1, [[1.0, 0.0053], [0.0, 1e-5]]), (2, [[34.1, 0.04], [13.5, 0.025]])];

/// Widest b of all channels, which sets the radius of all filters.
const WIDEST: f64 = 0.04;

/// A channel filtered by the sensitivity to it.
fn sensed(plane: &[f64], size: [usize; 2], terms: Terms, pixels_per_degree: f64) -> Vec<f64> {
    let radius = (3.0 * (WIDEST / (2.0 * PI * PI)).sqrt() * pixels_per_degree).ceil() as i32;
    let mut total = vec![0.0; plane.len()];
    let mut weights = 0.0;
    for [a, b] in terms.into_iter().filter(|[a, _]| *a > 0.0) {
        let scale = PI / pixels_per_degree;
        let kernel = Kernel::new(radius, |x| libm::exp(-(x * scale) * (x * scale) / b));
        let weight = a * (PI / b).sqrt();
        weights += weight * kernel.sum() * kernel.sum();
        let term = convolved(plane, size, &kernel, &kernel);
        total.iter_mut().zip(term).for_each(|(total, term)| *total += weight * term);
    }
    total.iter_mut().for_each(|v| *v /= weights);
    total
}

/// Colour difference between green and blue (sec. 4.1).
fn largest_color_difference() -> f64 {
    libm::pow(hyab(hunt_lab([0.0, 1.0, 0.0]), hunt_lab([0.0, 0.0, 1.0])), COLOR_EXPONENT)
}

/// Differences mapped to 0..1 by two lines (sec. 4.1).
fn redistributed(difference: f64, largest: f64) -> f64 {
    let knee = COLOR_SHARE * largest;
    if difference < knee {
        return COLOR_SHARE_MAPPED / knee * difference;
    }
    COLOR_SHARE_MAPPED + (difference - knee) / (largest - knee) * (1.0 - COLOR_SHARE_MAPPED)
}

#[cfg(test)]
mod tests;
