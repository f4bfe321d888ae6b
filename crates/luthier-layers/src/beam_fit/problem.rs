//! The least squares problem of a fit: unbounded numbers in place of the model's, residuals, and their derivatives by differences.

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;
use luthier_optics::Rgb;

use super::lobe::Sample;
use super::{Fitted, Form};
use crate::least_squares::{Column, Residuals};
use crate::models::granier_heidrich::Film;

/// Numbers of every fit: logarithms of three indices less 1, of two exponents and of a weight, and roots of three diffuse coefficients.
const COMMON: usize = 9;

/// Step of a central difference, of numbers of the order of 1.
const STEP: f64 = 1e-5;

/// Exponents of the starts.
const EXPONENTS: [f64; 4] = [5.0, 30.0, 200.0, 2000.0];
/// Indices of the starts, alike in all channels.
const INDICES: [f64; 2] = [1.4, 1.8];
/// Slopes of leans of the starts, and the azimuths of each: near enough to each other for a lobe of exponent 170 to be found.
const LEANS: [f64; 5] = [0.08, 0.16, 0.24, 0.32, 0.45];
const AZIMUTHS: u32 = 12;
/// Thicknesses of the starts.
const THICKNESSES: u32 = 10;

/// Largest exponent that material files accept.
const EXPONENT_MAX: f64 = 1e6;
/// Largest slope of a lean, at 80 degrees: material files accept no more.
const LEAN_MAX: f64 = 5.67;

#[derive(Debug)]
pub(super) struct Problem<'s> {
    samples: &'s [Sample],
    form: Form,
    /// Weight of each sample.
    weights: Vec<f64>,
}

/// Parts of the model of a sample and a channel: the specular one of weight 1, and the diffuse one of coefficient 1.
type Split = [f64; 2];

impl<'s> Problem<'s> {
    pub(super) fn new(samples: &'s [Sample], form: &Form) -> Option<Self> {
        let count = COMMON + usize::from(form.thickness_nm.is_some()) + if form.leans { 2 } else { 0 };
        let means: Vec<f64> = samples.iter().map(|sample| sample.value.iter().sum::<f64>() / 3.0).collect();
        let floor = 0.1 * means.iter().sum::<f64>() / samples.len().max(1) as f64;
        if 3 * samples.len() < count || floor <= 0.0 {
            return None;
        }
        let weights = means.iter().map(|mean| 1.0 / (mean + floor)).collect();
        Some(Self { samples, form: *form, weights })
    }

    /// A grid of numbers of the film: of each lean and thickness the best, with the weight and the diffuse coefficients that suit it.
    pub(super) fn starts(&self) -> Vec<(f64, Vec<f64>)> {
        let thicknesses: Vec<Option<f64>> = match self.form.thickness_nm {
            None => vec![None],
            Some([least, most]) => (0..THICKNESSES)
                .map(|i| Some(least * libm::pow(most / least, f64::from(i) / f64::from(THICKNESSES - 1))))
                .collect(),
        };
        let mut leans = vec![[0.0; 2]];
        for slope in LEANS.into_iter().filter(|_| self.form.leans) {
            leans.extend((0..AZIMUTHS).map(|i| {
                let (sin, cos) = libm::sincos(TAU * f64::from(i) / f64::from(AZIMUTHS));
                [slope * cos, slope * sin]
            }));
        }
        let mut starts = Vec::new();
        for thickness_nm in &thicknesses {
            for lean in &leans {
                let mut best: Option<(f64, Vec<f64>)> = None;
                for outer in EXPONENTS {
                    for inner in EXPONENTS {
                        for index in INDICES {
                            let fitted = Fitted {
                                index: [index; 3],
                                thickness_nm: *thickness_nm,
                                exponents: [outer, inner],
                                specular_weight: 1.0,
                                diffuse: [0.0; 3],
                                lean: *lean,
                                rms_err: 0.0,
                                lobe_err: 0.0,
                            };
                            let start = self.numbers(&self.balanced(fitted));
                            let sum = self.sum_of_squares(&start);
                            if best.as_ref().is_none_or(|(least, _)| sum < *least) {
                                best = Some((sum, start));
                            }
                        }
                    }
                }
                starts.extend(best);
            }
        }
        starts
    }

    /// Numbers with the weight and the diffuse coefficients of linear least squares, kept above 0.
    fn balanced(&self, fitted: Fitted) -> Fitted {
        let splits = self.splits(&fitted);
        // Per channel sums of products: specular with itself, with the diffuse part and with the value, and so on.
        let [mut ss, mut sd, mut sv, mut dd, mut dv] = [[0.0; 3]; 5];
        for ((split, sample), weight) in splits.iter().zip(self.samples).zip(&self.weights) {
            for c in 0..3 {
                let [s, d, v] = [split[c][0], split[c][1], sample.value[c]].map(|x| x * weight);
                ss[c] += s * s;
                sd[c] += s * d;
                sv[c] += s * v;
                dd[c] += d * d;
                dv[c] += d * v;
            }
        }
        let over: f64 = (0..3).map(|c| sv[c] - sd[c] * dv[c] / dd[c].max(f64::MIN_POSITIVE)).sum();
        let under: f64 = (0..3).map(|c| ss[c] - sd[c] * sd[c] / dd[c].max(f64::MIN_POSITIVE)).sum();
        let specular_weight = if under > 0.0 { (over / under).max(1e-3) } else { 1.0 };
        let diffuse = [0, 1, 2]
            .map(|c: usize| if dd[c] > 0.0 { ((dv[c] - specular_weight * sd[c]) / dd[c]).max(1e-4) } else { 1e-4 });
        Fitted { specular_weight, diffuse, ..fitted }
    }

    /// The unbounded numbers of a model.
    fn numbers(&self, fitted: &Fitted) -> Vec<f64> {
        let mut numbers: Vec<f64> = fitted.index.iter().map(|n| libm::log(n - 1.0)).collect();
        numbers.extend(fitted.exponents.map(libm::log));
        numbers.push(libm::log(fitted.specular_weight));
        numbers.extend(fitted.diffuse.map(f64::sqrt));
        numbers.extend(fitted.thickness_nm.map(libm::log));
        if self.form.leans {
            numbers.extend(fitted.lean);
        }
        numbers
    }

    /// The model of unbounded numbers.
    fn model(&self, x: &[f64]) -> Fitted {
        let thickness_nm = self.form.thickness_nm.map(|[least, most]| libm::exp(x[COMMON]).clamp(least, most));
        let first = COMMON + usize::from(thickness_nm.is_some());
        Fitted {
            index: [0, 1, 2].map(|i: usize| 1.0 + libm::exp(x[i].min(2.0))),
            thickness_nm,
            exponents: [3, 4].map(|i: usize| libm::exp(x[i]).min(EXPONENT_MAX)),
            specular_weight: libm::exp(x[5].min(20.0)),
            diffuse: [6, 7, 8].map(|i: usize| x[i] * x[i]),
            lean: [0, 1].map(|i: usize| if self.form.leans { x[first + i].clamp(-LEAN_MAX, LEAN_MAX) } else { 0.0 }),
            rms_err: 0.0,
            lobe_err: 0.0,
        }
    }

    fn splits(&self, fitted: &Fitted) -> Vec<[Split; 3]> {
        let [x, y] = fitted.lean;
        let inner_normal = DVec3::new(x, y, 1.0).normalize();
        let films = [0, 1, 2].map(|c: usize| Film {
            eta: fitted.index[c],
            f0: None,
            waves_inside: fitted.thickness_nm.map(|nm| fitted.index[c] * nm / self.form.wavelengths_nm[c]),
            inner_normal,
            exponents: fitted.exponents,
        });
        let diffuse = films.map(|film| film.diffuse());
        let splits = self.samples.iter().map(|sample| {
            [0, 1, 2].map(|c: usize| {
                [films[c].scaled_specular(sample.wi, sample.wo), diffuse[c] * FRAC_1_PI * sample.wi.z.max(0.0)]
            })
        });
        splits.collect()
    }

    /// Values of the model, RGB, for each sample.
    fn values(&self, fitted: &Fitted) -> Vec<Rgb> {
        let values = self.splits(fitted).into_iter().map(|split| {
            [0, 1, 2].map(|c: usize| fitted.specular_weight * split[c][0] + fitted.diffuse[c] * split[c][1])
        });
        values.collect()
    }

    fn differences(&self, numbers: &[f64]) -> Vec<f64> {
        let values = self.values(&self.model(numbers));
        let each = values.iter().zip(self.samples).zip(&self.weights);
        each.flat_map(|((value, sample), weight)| [0, 1, 2].map(|c: usize| (value[c] - sample.value[c]) * weight))
            .collect()
    }

    fn sum_of_squares(&self, numbers: &[f64]) -> f64 {
        self.differences(numbers).iter().map(|x| x * x).sum()
    }

    /// The model of unbounded numbers, with its errors.
    pub(super) fn fitted(&self, numbers: &[f64]) -> Fitted {
        let fitted = self.model(numbers);
        let values = self.values(&fitted);
        let pairs = values.iter().flatten().zip(self.samples.iter().flat_map(|sample| &sample.value));
        let apart: f64 = pairs.clone().map(|(found, value)| (found - value).abs()).sum();
        let whole: f64 = pairs.map(|(_, value)| value).sum();
        let rms_err = (self.sum_of_squares(numbers) / (3 * self.samples.len()) as f64).sqrt();
        Fitted { rms_err, lobe_err: apart / whole, ..fitted }
    }
}

impl Residuals for Problem<'_> {
    fn blocks(&self) -> usize {
        1
    }

    fn block(&self, numbers: &[f64], _: usize) -> Vec<f64> {
        self.differences(numbers)
    }

    fn slopes(&self, numbers: &[f64], _: usize, _: &[f64]) -> Vec<Column> {
        let slope = |number: usize| {
            let mut there = numbers.to_vec();
            there[number] = numbers[number] + STEP;
            let more = self.differences(&there);
            there[number] = numbers[number] - STEP;
            let less = self.differences(&there);
            more.iter().zip(less).map(|(more, less)| (more - less) / (2.0 * STEP)).collect()
        };
        (0..numbers.len()).map(|number| (number, slope(number))).collect()
    }
}
