//! Thickness textures of films: Granier and Heidrich 2003, section 6.

use std::f64::consts::PI;

use luthier_lut::{Axis, Comparison, Image, Scan, TableKind, TexelFormat, WeightBits, measure_scan};
use noise::{NoiseFn, Perlin};
use serde_json::{Value, json};
use sha2::{Digest, Sha256};

use crate::job::{TileData, lone_tile};
use crate::json;

/// Half the step, in repeats, of the central differences that give the slopes.
const SLOPE_STEP: f64 = 1.0 / 4096.0;

/// Texels repeated around the tile.
const APRON: u32 = 1;

/// Where the thickness between its extremes comes from.
#[derive(Debug, Clone)]
pub(crate) enum Relief {
    /// Fractal Perlin noise on a torus.
    Noise { seed: u32, frequency: f64, octaves: u32 },
    /// An image with one channel in 0..1, which repeats.
    Image(Image),
}

#[derive(Debug, Clone)]
pub(crate) struct ThicknessJob {
    pub(crate) relief: Relief,
    pub(crate) min_nm: f64,
    pub(crate) max_nm: f64,
    pub(crate) extent_um: f64,
    pub(crate) axes: [Axis; 2],
    pub(crate) format: TexelFormat,
}

impl ThicknessJob {
    pub(crate) fn inputs(&self) -> Value {
        let relief = match &self.relief {
            Relief::Noise { seed, frequency, octaves } => json!({"perlin": [seed, frequency, octaves]}),
            Relief::Image(image) => {
                let mut hash = Sha256::new();
                image.data.iter().for_each(|v| hash.update(v.to_le_bytes()));
                let digest: String = hash.finalize().iter().map(|b| format!("{b:02x}")).collect();
                json!({"image": [image.width, image.height, digest]})
            }
        };
        json!({
            "relief": relief,
            "range_nm": [self.min_nm, self.max_nm],
            "extent_um": self.extent_um,
            "axes": self.axes.iter().map(json::axis).collect::<Vec<_>>(),
            "format": self.format.name(),
        })
    }

    pub(crate) fn run(&self) -> TileData {
        let [x, y] = &self.axes;
        let surface = Surface::new(self);
        let mut truth = Image::zeros(x.size + 2 * APRON, y.size + 2 * APRON, 4);
        for j in 0..truth.height {
            for i in 0..truth.width {
                // The apron repeats the opposite edge, so that filtering wraps around.
                let u = x.node((i + x.size - APRON) % x.size);
                let v = y.node((j + y.size - APRON) % y.size);
                truth.texel_mut(i, j).copy_from_slice(&surface.record([u, v]).map(|c| c as f32));
            }
        }
        let atlas = lone_tile(TableKind::Thickness, &[x, y], self.format, &truth);
        let error = measure_scan(
            &Scan::whole([x.intervals(), y.intervals()], [1, 1]),
            |u| Comparison { expected: surface.record(u), sampled: atlas.sample(0, u, WeightBits::Fixed(8)) },
            |u| u.to_vec(),
        );
        TileData {
            model: "d/(2 d_max), slopes dd/dx and dd/dy, sqrt(1 + slopes^2); Granier and Heidrich 2003 sec. 6".into(),
            truth,
            texels: atlas.texels,
            error,
        }
    }
}

/// The film's upper boundary over one repeat.
struct Surface<'a> {
    job: &'a ThicknessJob,
    octaves: Vec<Perlin>,
    /// Lowest and highest value of the relief over the nodes: stretched to 0..1.
    range: [f64; 2],
}

impl<'a> Surface<'a> {
    fn new(job: &'a ThicknessJob) -> Self {
        let octaves = match job.relief {
            Relief::Noise { seed, octaves, .. } => (0..octaves).map(|i| Perlin::new(seed.wrapping_add(i))).collect(),
            Relief::Image(_) => Vec::new(),
        };
        let mut surface = Self { job, octaves, range: [0.0, 1.0] };
        if let Relief::Noise { .. } = job.relief {
            let [x, y] = &job.axes;
            let mut range = [f64::INFINITY, f64::NEG_INFINITY];
            for j in 0..y.size {
                for i in 0..x.size {
                    let value = surface.relief([x.node(i), y.node(j)]);
                    range = [range[0].min(value), range[1].max(value)];
                }
            }
            surface.range = range;
        }
        surface
    }

    /// Thickness record at a point; both coordinates repeat after 1.
    fn record(&self, uv: [f64; 2]) -> [f64; 4] {
        let job = self.job;
        let thickness = |uv| job.min_nm + (job.max_nm - job.min_nm) * self.unit(uv);
        let run = 2.0 * SLOPE_STEP * job.extent_um * 1e3;
        let [u, v] = uv;
        let slope_x = (thickness([u + SLOPE_STEP, v]) - thickness([u - SLOPE_STEP, v])) / run;
        let slope_y = (thickness([u, v + SLOPE_STEP]) - thickness([u, v - SLOPE_STEP])) / run;
        let normalisation = libm::sqrt(1.0 + slope_x * slope_x + slope_y * slope_y);
        [thickness(uv) / (2.0 * job.max_nm), slope_x, slope_y, normalisation]
    }

    /// The relief stretched to 0..1.
    fn unit(&self, uv: [f64; 2]) -> f64 {
        let [low, high] = self.range;
        if high > low { ((self.relief(uv) - low) / (high - low)).clamp(0.0, 1.0) } else { 0.5 }
    }

    fn relief(&self, [u, v]: [f64; 2]) -> f64 {
        match &self.job.relief {
            Relief::Image(image) => periodic(image, [u, v]),
            Relief::Noise { frequency, .. } => {
                // A square that repeats is a torus in four dimensions.
                let (cu, su) = (libm::cos(2.0 * PI * u), libm::sin(2.0 * PI * u));
                let (cv, sv) = (libm::cos(2.0 * PI * v), libm::sin(2.0 * PI * v));
                let mut radius = frequency / (2.0 * PI);
                let mut weight = 1.0;
                let mut sum = 0.0;
                for octave in &self.octaves {
                    sum += weight * octave.get([radius * cu, radius * su, radius * cv, radius * sv]);
                    radius *= 2.0;
                    weight *= 0.5;
                }
                sum
            }
        }
    }
}

/// Bilinear in an image that repeats; texel centres at (i + 1/2) / size.
fn periodic(image: &Image, uv: [f64; 2]) -> f64 {
    let wrap = |t: f64| t - libm::floor(t);
    let (w, h) = (f64::from(image.width), f64::from(image.height));
    let (x, y) = (wrap(uv[0]) * w, wrap(uv[1]) * h);
    let base = [libm::floor(x - 0.5), libm::floor(y - 0.5)];
    let fraction = [x - 0.5 - base[0], y - 0.5 - base[1]];
    let texel = |i: f64, j: f64| {
        let i = (i + w) as u32 % image.width;
        let j = (j + h) as u32 % image.height;
        f64::from(image.texel(i, j)[0])
    };
    let row = |j: f64| {
        let (a, b) = (texel(base[0], j), texel(base[0] + 1.0, j));
        a + (b - a) * fraction[0]
    };
    let (top, bottom) = (row(base[1]), row(base[1] + 1.0));
    top + (bottom - top) * fraction[1]
}
