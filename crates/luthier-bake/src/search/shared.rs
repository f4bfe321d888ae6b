//! One table of Fresnel reflectance over three axes for all interfaces, as the course has it (section 3.4.1), beside rows: for
//! `docs/pages/budgets.md`.
//!
//! It is read once for each channel, at the channel's index; films have none, and colours integrated over spectra only nearly.

use std::f64::consts::PI;

use half::f16;
use luthier_lut::{Axis, Mapping, TexelFormat};
use luthier_optics::Rgb;
use luthier_optics::fresnel;
use num_complex::Complex64;
use rayon::prelude::*;

use super::cost;
use crate::settings::axis;

/// Axes of a shared table beside the cosine.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Parameters {
    /// n and k, uniform.
    Index,
    /// Magnitude and phase of the amplitude at normal incidence, (n + ik - 1)/(n + ik + 1), uniform: all indices in a half disc.
    Amplitude,
}

impl Parameters {
    /// The parameters of an index below over that above.
    fn of(self, eta: Complex64) -> [f64; 2] {
        match self {
            Self::Index => [eta.re, eta.im],
            Self::Amplitude => {
                let amplitude = (eta - 1.0) / (eta + 1.0);
                [libm::sqrt(amplitude.norm_sqr()), libm::atan2(amplitude.im, amplitude.re)]
            }
        }
    }

    /// Reflectance at these parameters.
    fn reflectance(self, [a, b]: [f64; 2], cos_theta: f64) -> f64 {
        let eta = match self {
            Self::Index => Complex64::new(a, b),
            Self::Amplitude if a >= 1.0 => return 1.0,
            Self::Amplitude => {
                let (sin, cos) = libm::sincos(b);
                let amplitude = a * Complex64::new(cos, sin);
                (1.0 + amplitude) / (1.0 - amplitude)
            }
        };
        fresnel::interface(Complex64::new(1.0, 0.0), eta, cos_theta).unpolarised()
    }

    /// The least ranges that hold some interfaces: from 0 to a whole number; of a phase, to a tenth of a half turn.
    fn ranges(self, bare: &[Bare]) -> [f64; 2] {
        let all = || bare.iter().flat_map(|b| b.etas).map(|eta| self.of(eta));
        let [a, b] = [0, 1].map(|k: usize| all().map(|p| p[k]).fold(0.0, f64::max));
        match self {
            Self::Index => [libm::ceil(a), libm::ceil(b).max(1.0)],
            Self::Amplitude => [1.0, libm::ceil(b / PI * 10.0).max(1.0) / 10.0 * PI],
        }
    }
}

/// Texels of one channel.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OneChannel {
    /// 8 bits, normalised.
    R8Unorm,
    /// 16 bits, normalised.
    R16Unorm,
    /// A half float.
    R16Float,
}

impl OneChannel {
    /// All formats of one channel.
    const ALL: [Self; 3] = [Self::R8Unorm, Self::R16Unorm, Self::R16Float];

    /// The WebGPU name.
    pub fn name(self) -> &'static str {
        match self {
            Self::R8Unorm => "r8unorm",
            Self::R16Unorm => "r16unorm",
            Self::R16Float => "r16float",
        }
    }

    fn bytes(self) -> u32 {
        if self == Self::R8Unorm { 1 } else { 2 }
    }

    fn rounded(self, value: f64) -> f64 {
        match self {
            Self::R8Unorm => libm::round(value * 255.0) / 255.0,
            Self::R16Unorm => libm::round(value * 65535.0) / 65535.0,
            Self::R16Float => f16::from_f64(value).to_f64(),
        }
    }
}

/// An interface without films.
#[derive(Debug, Clone)]
pub(crate) struct Bare {
    /// Index below over that above at three wavelengths.
    pub(crate) etas: [Complex64; 3],
    /// Cosines, and there the reflectance at the three wavelengths and that of the colour that the material asks for.
    pub(crate) points: Vec<(f64, [Rgb; 2])>,
}

/// A shared table, measured.
#[derive(Debug, Clone, PartialEq)]
pub struct SharedTable {
    /// Axes beside the cosine.
    pub parameters: Parameters,
    /// The exponent of the cosine's mapping: of those tried the one whose largest error is least.
    pub exponent: f64,
    /// Nodes over the cosine and the parameters.
    pub size: [u32; 3],
    /// Texel format.
    pub format: OneChannel,
    /// Bytes.
    pub bytes: u64,
    /// Estimated cost of a look-up of three channels, in the unit of the search; a fetch in three dimensions counted as one in two.
    pub cost: f64,
    /// Largest error against the function at three wavelengths.
    pub three_wavelengths: f64,
    /// Largest error against the colours that rows hold.
    pub colors: f64,
}

const SIZES: [[u32; 3]; 4] = [[16, 16, 16], [32, 32, 32], [128, 32, 32], [64, 64, 64]];

/// Exponents of the cosine's mapping.
const EXPONENTS: [f64; 3] = [1.0, 2.0, 3.0];

/// All shapes of shared tables, for some interfaces.
pub(crate) fn shared_tables(bare: &[Bare]) -> Vec<SharedTable> {
    let shapes: Vec<(Parameters, [u32; 3])> =
        [Parameters::Index, Parameters::Amplitude].iter().flat_map(|&p| SIZES.map(|size| (p, size))).collect();
    let tables = shapes.into_iter().map(|(parameters, size)| {
        let made: Vec<_> = EXPONENTS.into_par_iter().map(|e| Volume::new(parameters, size, e, bare)).collect();
        OneChannel::ALL.map(|format| {
            let measured = made.iter().map(|volume| volume.measured(format, bare));
            measured.reduce(|a, b| if b.three_wavelengths < a.three_wavelengths { b } else { a })
        })
    });
    tables.flatten().flatten().collect()
}

/// Values at the nodes.
struct Volume {
    parameters: Parameters,
    exponent: f64,
    axes: [Axis; 3],
    values: Vec<f64>,
}

impl Volume {
    fn new(parameters: Parameters, [x, y, z]: [u32; 3], exponent: f64, bare: &[Bare]) -> Self {
        let [a, b] = parameters.ranges(bare);
        let axes = [
            axis("cos_theta", "", [0.0, 1.0], x, Mapping::Power { exponent }),
            axis("first", "", [0.0, a], y, Mapping::Linear),
            axis("second", "", [0.0, b], z, Mapping::Linear),
        ];
        let nodes = (0..z).flat_map(|k| (0..y).map(move |j| [j, k]));
        let rows = nodes.map(|[j, k]| [axes[1].node(j), axes[2].node(k)]);
        let row = |at: [f64; 2]| (0..x).map(|i| parameters.reflectance(at, axes[0].node(i))).collect::<Vec<_>>();
        let values = rows.flat_map(row).collect();
        Self { parameters, exponent, axes, values }
    }

    /// Trilinear, with weights of 8 bits.
    fn read(&self, at: [f64; 3], format: OneChannel) -> f64 {
        let places = [0, 1, 2].map(|k: usize| {
            let index = self.axes[k].index(at[k]);
            let first = libm::floor(index).min(f64::from(self.axes[k].size - 2));
            (first as usize, libm::round((index - first) * 256.0) / 256.0)
        });
        let [columns, rows] = [0, 1].map(|k: usize| self.axes[k].size as usize);
        (0..8usize)
            .map(|corner| {
                let [i, j, k] = [0, 1, 2].map(|k: usize| places[k].0 + (corner >> k & 1));
                let weight = (0..3).map(|k| if corner >> k & 1 == 1 { places[k].1 } else { 1.0 - places[k].1 });
                weight.product::<f64>() * format.rounded(self.values[(k * rows + j) * columns + i])
            })
            .sum()
    }

    fn measured(&self, format: OneChannel, bare: &[Bare]) -> SharedTable {
        let errors = bare.iter().flat_map(|interface| {
            let parameters = interface.etas.map(|eta| self.parameters.of(eta));
            interface.points.iter().flat_map(move |(cos_theta, exact)| {
                let read = parameters.map(|[a, b]| self.read([*cos_theta, a, b], format));
                (0..3).map(move |c| exact.map(|exact| (read[c] - exact[c]).abs()))
            })
        });
        let [three_wavelengths, colors] = errors.fold([0.0_f64; 2], |[a, b], [c, d]| [a.max(c), b.max(d)]);
        let size = [0, 1, 2].map(|k: usize| self.axes[k].size);
        SharedTable {
            parameters: self.parameters,
            exponent: self.exponent,
            size,
            format,
            bytes: u64::from(size.iter().product::<u32>() * format.bytes()),
            // Texels of one channel cost as those of r16float do.
            cost: cost::axis(&self.axes[0]) + 3.0 * cost::read(TexelFormat::R16Float),
            three_wavelengths,
            colors,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn bare(etas: [Complex64; 3]) -> Bare {
        let at =
            |cos_theta: f64| etas.map(|eta| fresnel::interface(Complex64::new(1.0, 0.0), eta, cos_theta).unpolarised());
        let points = (0..=64).map(|i| f64::from(i) / 64.0).map(|c| (c, [at(c); 2])).collect();
        Bare { etas, points }
    }

    /// Gold, copper's red and a glass: indices of different kinds.
    fn some() -> [Complex64; 3] {
        [Complex64::new(0.18, 3.4), Complex64::new(0.4, 2.9), Complex64::new(1.5, 0.0)]
    }

    #[test]
    fn parameters_say_which_index() {
        for eta in some() {
            for parameters in [Parameters::Index, Parameters::Amplitude] {
                for cos_theta in [0.01, 0.3, 1.0] {
                    let exact = fresnel::interface(Complex64::new(1.0, 0.0), eta, cos_theta).unpolarised();
                    let found = parameters.reflectance(parameters.of(eta), cos_theta);
                    assert!((found - exact).abs() < 1e-12, "{eta} {parameters:?} {cos_theta}: {found} {exact}");
                }
            }
        }
    }

    #[test]
    fn normal_reflectance_is_the_square_of_an_axis() {
        let interface = bare(some());
        let volume = Volume::new(Parameters::Amplitude, [4, 9, 9], 1.0, &[interface]);
        for eta in some() {
            let [magnitude, phase] = Parameters::Amplitude.of(eta);
            let read = volume.read([1.0, magnitude, phase], OneChannel::R16Unorm);
            // A chord of a parabola over an eighth, half a step of the weights, and of 16 bits.
            let tolerance = 1.0 / 64.0 / 4.0 + 2.0 * 0.5 / 256.0 / 8.0 + 1e-5;
            assert!((read - magnitude * magnitude).abs() < tolerance, "{eta}: {read}");
        }
    }

    #[test]
    fn finer_tables_err_less() {
        let interfaces = [bare(some())];
        let error = |size| Volume::new(Parameters::Amplitude, [size; 3], 2.0, &interfaces);
        let errors = [8, 16, 32].map(|size| error(size).measured(OneChannel::R16Unorm, &interfaces).three_wavelengths);
        assert!(errors[0] > 1.5 * errors[1] && errors[1] > 1.5 * errors[2], "{errors:?}");
        assert!(errors[2] < 2e-2, "{errors:?}");
    }
}
