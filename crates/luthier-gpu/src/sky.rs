use std::f64::consts::PI;

use crate::GpuError;

/// A smooth surrounding for the preview: a vertical gradient and two soft lights. Radiance, linear RGB; +y is up.
///
/// The gradient is the quadratic in the height `y` of the direction that takes the three colours at -1, 0 and 1:
/// Legendre bands 0 to 2 and no more. A soft light is a von Mises-Fisher lobe. Blurring both, and integrating both
/// against a cosine, is therefore closed form: no picture, no samples, no noise.
///
/// `sky.wgsl` is the device's copy of this file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Sky {
    /// Straight down.
    pub ground: [f32; 3],
    /// At the horizon.
    pub horizon: [f32; 3],
    /// Straight up.
    pub zenith: [f32; 3],
    /// Lights large enough to be seen in reflections.
    pub lights: [SoftLight; 2],
}

/// A light with a soft edge: radiance `radiance exp(sharpness (cos - 1))` at an angle to its centre.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SoftLight {
    /// To its centre; need not be unit.
    pub direction: [f32; 3],
    /// Concentration, 1 to 1e4; about `1 / spread^2` with the spread in radians.
    pub sharpness: f32,
    /// At its centre.
    pub radiance: [f32; 3],
}

/// Bands of the clamped cosine (Ramamoorthi and Hanrahan 2001, eq. 8): irradiance is radiance band by band times these.
const COSINE_BANDS: [f64; 3] = [PI, 2.0 * PI / 3.0, PI / 4.0];

impl Sky {
    /// The same radiance from everywhere: the white furnace.
    pub fn uniform(radiance: [f32; 3]) -> Self {
        let dark = SoftLight { direction: [0.0, 1.0, 0.0], sharpness: 1.0, radiance: [0.0; 3] };
        Self { ground: radiance, horizon: radiance, zenith: radiance, lights: [dark; 2] }
    }

    /// Radiance around a unit direction, blurred as by a mirror with slope parameter `alpha`; the sky itself at 0.
    ///
    /// The blur is diffusion on the sphere with the variance of the mirrored direction: facet slopes vary by `alpha^2
    /// / 2` along each tangent (Beckmann; the core of GGX is alike), a mirrored direction turns by twice the slope,
    /// so `2 alpha^2`. Diffusion damps Legendre band l by `exp(-l (l + 1) alpha^2)`; for a lobe, `2 alpha^2` adds to
    /// `1 / sharpness` at constant flux, which is exact for narrow lobes.
    pub fn radiance(&self, direction: [f64; 3], alpha: f64) -> [f64; 3] {
        let y = direction[1];
        let variance = 2.0 * alpha * alpha;
        let bands = [1.0, libm::exp(-variance) * y, libm::exp(-3.0 * variance) * (1.5 * y * y - 0.5)];
        let mut total = self.gradient(bands);
        for light in &self.lights {
            let sharpness = f64::from(light.sharpness);
            let blurred = 1.0 / (1.0 / sharpness + variance);
            let peak = lobe_integral(sharpness) / lobe_integral(blurred);
            let value = peak * libm::exp(blurred * (light.cosine(direction) - 1.0));
            add(&mut total, light.radiance, value);
        }
        total
    }

    /// Irradiance of a patch with this unit normal. Exact for the gradient; lobes enter with their bands 0 to 2,
    /// which is within 7% of their largest irradiance, and less the softer they are.
    pub fn irradiance(&self, normal: [f64; 3]) -> [f64; 3] {
        let legendre = |x: f64| [1.0, x, 1.5 * x * x - 0.5];
        let weigh = |bands: [f64; 3]| [0, 1, 2].map(|l| COSINE_BANDS[l] * bands[l]);
        let mut total = self.gradient(weigh(legendre(normal[1])));
        for light in &self.lights {
            let sharpness = f64::from(light.sharpness);
            // Bands of the normalised lobe: (2 l + 1) / (4 pi) times 1, coth k - 1/k, and 1 - 3/k of that.
            let first = 1.0 / libm::tanh(sharpness) - 1.0 / sharpness;
            let lobe = [1.0, 3.0 * first, 5.0 * (1.0 - 3.0 * first / sharpness)];
            let weighed = weigh(legendre(light.cosine(normal)));
            let sum: f64 = (0..3).map(|l| lobe[l] * weighed[l]).sum();
            add(&mut total, light.radiance, (lobe_integral(sharpness) / (4.0 * PI) * sum).max(0.0));
        }
        total
    }

    /// The gradient with its Legendre bands weighed.
    fn gradient(&self, bands: [f64; 3]) -> [f64; 3] {
        let words = self.gradient_words();
        [0, 1, 2].map(|c| (0..3).map(|l| f64::from(words[l][c]) * bands[l]).sum())
    }

    /// Legendre coefficients of the gradient, RGB.
    fn gradient_words(&self) -> [[f32; 4]; 3] {
        let square = |c: usize| 0.5 * (self.ground[c] + self.zenith[c]) - self.horizon[c];
        let word = |f: &dyn Fn(usize) -> f32| [f(0), f(1), f(2), 0.0];
        [
            word(&|c| self.horizon[c] + square(c) / 3.0),
            word(&|c| 0.5 * (self.zenith[c] - self.ground[c])),
            word(&|c| 2.0 / 3.0 * square(c)),
        ]
    }

    /// The words that the device reads: three of the gradient, then direction and sharpness, radiance of each light.
    pub(crate) fn words(&self) -> [[f32; 4]; 7] {
        let [a, b, c] = self.gradient_words();
        let [first, second] = self.lights.map(|light| {
            let [x, y, z] = light.unit().map(|v| v as f32);
            let [r, g, b] = light.radiance;
            [[x, y, z, light.sharpness], [r, g, b, 0.0]]
        });
        [a, b, c, first[0], first[1], second[0], second[1]]
    }

    pub(crate) fn check(&self) -> Result<(), GpuError> {
        let colors = [self.ground, self.horizon, self.zenith, self.lights[0].radiance, self.lights[1].radiance];
        for color in colors {
            if !color.iter().all(|v| v.is_finite() && *v >= 0.0) {
                return Err(setting("sky", format!("{color:?}"), "radiances are finite and not negative"));
            }
        }
        for light in &self.lights {
            if !(1.0..=1e4).contains(&light.sharpness) {
                return Err(setting("sky.lights.sharpness", light.sharpness.to_string(), "between 1 and 1e4"));
            }
            check_direction("sky.lights.direction", light.direction)?;
        }
        Ok(())
    }
}

impl Default for Sky {
    /// A studio: dark floor, bright horizon, a large soft light above on the right, a smaller one behind on the left.
    fn default() -> Self {
        Self {
            ground: [0.03, 0.028, 0.026],
            horizon: [0.32, 0.32, 0.325],
            zenith: [0.14, 0.155, 0.18],
            lights: [
                SoftLight { direction: [0.65, 0.6, 0.5], sharpness: 28.0, radiance: [3.6, 3.5, 3.35] },
                SoftLight { direction: [-0.95, 0.15, -0.3], sharpness: 22.0, radiance: [2.2, 2.35, 2.6] },
            ],
        }
    }
}

impl SoftLight {
    fn unit(&self) -> [f64; 3] {
        let v = self.direction.map(f64::from);
        let length = libm::sqrt(v[0] * v[0] + v[1] * v[1] + v[2] * v[2]);
        v.map(|x| x / length)
    }

    fn cosine(&self, direction: [f64; 3]) -> f64 {
        let unit = self.unit();
        (0..3).map(|c| unit[c] * direction[c]).sum()
    }
}

/// Integral of `exp(k (cos - 1))` over the sphere.
fn lobe_integral(sharpness: f64) -> f64 {
    2.0 * PI * (1.0 - libm::exp(-2.0 * sharpness)) / sharpness
}

fn add(total: &mut [f64; 3], color: [f32; 3], weight: f64) {
    for c in 0..3 {
        total[c] += f64::from(color[c]) * weight;
    }
}

pub(crate) fn setting(name: &'static str, value: String, allowed: &'static str) -> GpuError {
    GpuError::Setting { name, value, allowed }
}

pub(crate) fn check_direction(name: &'static str, v: [f32; 3]) -> Result<(), GpuError> {
    let length_sq: f32 = v.iter().map(|x| x * x).sum();
    if length_sq.is_normal() { Ok(()) } else { Err(setting(name, format!("{v:?}"), "a finite direction, not zero")) }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral over the sphere by a midpoint rule, 400 x 800.
    fn sphere(f: impl Fn([f64; 3]) -> f64) -> f64 {
        let (rows, columns) = (400, 800);
        let mut sum = 0.0;
        for i in 0..rows {
            let y = (f64::from(i) + 0.5) / f64::from(rows) * 2.0 - 1.0;
            let r = (1.0 - y * y).sqrt();
            for j in 0..columns {
                let phi = (f64::from(j) + 0.5) / f64::from(columns) * 2.0 * PI;
                sum += f([r * libm::cos(phi), y, r * libm::sin(phi)]);
            }
        }
        sum * 4.0 * PI / f64::from(rows * columns)
    }

    fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
        a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
    }

    fn dark(sky: Sky) -> Sky {
        Sky { lights: Sky::uniform([0.0; 3]).lights, ..sky }
    }

    #[test]
    fn gradient_takes_its_three_colours() {
        let sky = dark(Sky::default());
        for (y, color) in [(-1.0, sky.ground), (0.0, sky.horizon), (1.0, sky.zenith)] {
            let x = f64::sqrt(1.0 - y * y);
            let got = sky.radiance([x, y, 0.0], 0.0);
            (0..3).for_each(|c| assert!((got[c] - f64::from(color[c])).abs() < 1e-6, "{y}: {got:?}"));
        }
    }

    #[test]
    fn irradiance_equals_quadrature() {
        let normals = [[0.0, 1.0, 0.0], [0.0, -1.0, 0.0], [0.6, 0.0, 0.8], [0.48, 0.64, -0.6]];
        let integral = |sky: &Sky, n| sphere(|d| sky.radiance(d, 0.0)[1] * dot(d, n).max(0.0));
        let gradient = dark(Sky::default());
        let studio = Sky::default();
        // Largest irradiance that the first light gives, facing it.
        let light = f64::from(studio.lights[0].radiance[1]) * lobe_integral(f64::from(studio.lights[0].sharpness));
        for n in normals {
            let exact = integral(&gradient, n);
            assert!((gradient.irradiance(n)[1] - exact).abs() < 1e-4 * exact, "{n:?}");
            let exact = integral(&studio, n);
            assert!((studio.irradiance(n)[1] - exact).abs() < 0.07 * light, "{n:?}");
        }
    }

    #[test]
    fn blur_keeps_the_flux() {
        let sky = Sky::default();
        let flux = sphere(|d| sky.radiance(d, 0.0)[2]);
        for alpha in [0.1, 0.5, 1.0] {
            let blurred = sphere(|d| sky.radiance(d, alpha)[2]);
            assert!((blurred / flux - 1.0).abs() < 1e-4, "alpha {alpha}: {blurred} {flux}");
        }
    }

    #[test]
    fn nonsense_is_refused() {
        let mut sky = Sky::default();
        sky.lights[1].sharpness = 0.0;
        assert!(sky.check().is_err());
        sky = Sky::default();
        sky.lights[0].direction = [0.0; 3];
        assert!(sky.check().is_err());
        sky = Sky::default();
        sky.zenith[0] = f32::NAN;
        assert!(sky.check().is_err());
        assert!(Sky::default().check().is_ok());
    }
}
