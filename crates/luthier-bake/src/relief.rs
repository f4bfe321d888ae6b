//! Scalar fields over a surface, from noise or images.

use std::f64::consts::PI;

use luthier_layers::noise::perlin::Octaves;
use luthier_lut::Image;
use luthier_material::{PictureRef, VariationSource};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::BakeError;

/// Reads an image that a material names. Its arguments are the material file and the reference in it.
pub type ImageReader<'a> = &'a (dyn Fn(&str, &PictureRef) -> Result<Image, String> + Sync);

/// Source of a field.
#[derive(Debug, Clone)]
pub(crate) enum Relief {
    /// Fractal Perlin noise on a torus.
    Noise { seed: u32, frequency: f64, octaves: u32 },
    /// An image with one channel in 0..1, which repeats.
    Image(Image),
}

impl Relief {
    /// The relief that a material describes, with `read` to fetch images.
    pub(crate) fn of(
        source: &VariationSource,
        read: impl FnOnce(&PictureRef) -> Result<Image, BakeError>,
    ) -> Result<Self, BakeError> {
        Ok(match source {
            VariationSource::Noise { seed, frequency, octaves } => {
                Self::Noise { seed: *seed, frequency: *frequency, octaves: *octaves }
            }
            VariationSource::Image(picture) => Self::Image(read(picture)?),
        })
    }

    pub(crate) fn inputs(&self) -> Value {
        match self {
            Self::Noise { seed, frequency, octaves } => json!({"perlin": [seed, frequency, octaves]}),
            Self::Image(image) => {
                let mut hash = Sha256::new();
                image.data.iter().for_each(|v| hash.update(v.to_le_bytes()));
                let digest: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
                json!({"image": [image.width, image.height, digest]})
            }
        }
    }
}

/// A relief with values in 0..1. Noise is stretched to this range over the points (i/width, j/height).
pub(crate) struct Field<'a> {
    relief: &'a Relief,
    octaves: Octaves,
    /// Lowest and highest value of the relief: stretched to 0..1.
    range: [f64; 2],
}

impl<'a> Field<'a> {
    pub(crate) fn new(relief: &'a Relief, [width, height]: [u32; 2]) -> Self {
        let octaves = match relief {
            Relief::Noise { seed, octaves, .. } => Octaves::new(*seed, *octaves),
            Relief::Image(_) => Octaves::new(0, 0),
        };
        let mut field = Self { relief, octaves, range: [0.0, 1.0] };
        if let Relief::Noise { .. } = relief {
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for j in 0..height {
                for i in 0..width {
                    let value = field.raw([f64::from(i) / f64::from(width), f64::from(j) / f64::from(height)]);
                    range = [range[0].min(value), range[1].max(value)];
                }
            }
            field.range = range;
        }
        field
    }

    /// The field at a point; both coordinates repeat after 1.
    pub(crate) fn unit(&self, uv: [f64; 2]) -> f64 {
        let [low, high] = self.range;
        if high > low { ((self.raw(uv) - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
    }

    fn raw(&self, [u, v]: [f64; 2]) -> f64 {
        match self.relief {
            Relief::Image(image) => periodic(image, [u, v]),
            Relief::Noise { frequency, .. } => {
                // A periodic square is a torus in four dimensions: noise sampled along it repeats without a seam.
                let (cu, su) = (libm::cos(2.0 * PI * u), libm::sin(2.0 * PI * u));
                let (cv, sv) = (libm::cos(2.0 * PI * v), libm::sin(2.0 * PI * v));
                let radius = frequency / (2.0 * PI);
                self.octaves.in_four_dimensions([cu, su, cv, sv].map(|x| radius * x))
            }
        }
    }
}

/// Bilinear read of a periodic image; texel centres are at (i + 1/2) / size.
fn periodic(image: &Image, uv: [f64; 2]) -> f64 {
    let (w, h) = (f64::from(image.width), f64::from(image.height));
    let [u, v] = uv.map(|t| t - libm::floor(t));
    let (x, y) = (u * w, v * h);
    let base = [libm::floor(x - 0.5), libm::floor(y - 0.5)];
    let fraction = [x - 0.5 - base[0], y - 0.5 - base[1]];
    let columns = [base[0], base[0] + 1.0].map(|i| (i + w) as u32 % image.width);
    let rows = [base[1], base[1] + 1.0].map(|j| (j + h) as u32 % image.height);
    let [top, bottom] = rows.map(|row| {
        let [a, b] = columns.map(|column| f64::from(image.texel(column, row)[0]));
        a + (b - a) * fraction[0]
    });
    top + (bottom - top) * fraction[1]
}
