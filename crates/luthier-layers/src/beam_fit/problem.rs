//! The least squares problem of a fit: unbounded numbers in place of the model's, residuals, and their derivatives by differences.

use std::f64::consts::{FRAC_1_PI, TAU};

use glam::DVec3;
use levenberg_marquardt::LeastSquaresProblem;
use luthier_optics::Rgb;
use nalgebra::{DMatrix, DVector, Dyn, Owned};

use super::lobe::Sample;
use super::{Fitted, Form};
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

#[derive(Debug, Clone)]
pub(super) struct Problem<'s> {
    samples: &'s [Sample],
    form: Form,
    /// Weight of each sample.
    weights: Vec<f64>,
    numbers: DVector<f64>,
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
        Some(Self { samples, form: *form, weights, numbers: DVector::zeros(count) })
    }

    /// A grid of numbers of the film: of each lean and thickness the best, with the weight and the diffuse coefficients that suit it.
    pub(super) fn starts(&self) -> Vec<(f64, Self)> {
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
                let mut best: Option<(f64, Self)> = None;
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
                            let start = self.at(&self.balanced(fitted));
                            let sum = start.sum_of_squares();
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

    /// The problem at the numbers of a model.
    fn at(&self, fitted: &Fitted) -> Self {
        let mut numbers: Vec<f64> = fitted.index.iter().map(|n| libm::log(n - 1.0)).collect();
        numbers.extend(fitted.exponents.map(libm::log));
        numbers.push(libm::log(fitted.specular_weight));
        numbers.extend(fitted.diffuse.map(f64::sqrt));
        numbers.extend(fitted.thickness_nm.map(libm::log));
        if self.form.leans {
            numbers.extend(fitted.lean);
        }
        Self { numbers: DVector::from_vec(numbers), ..self.clone() }
    }

    /// The numbers of the model.
    fn model(&self) -> Fitted {
        let x = &self.numbers;
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

    fn differences(&self) -> DVector<f64> {
        let values = self.values(&self.model());
        let each = values.iter().zip(self.samples).zip(&self.weights);
        DVector::from_iterator(
            3 * self.samples.len(),
            each.flat_map(|((value, sample), weight)| [0, 1, 2].map(|c: usize| (value[c] - sample.value[c]) * weight)),
        )
    }

    pub(super) fn sum_of_squares(&self) -> f64 {
        self.differences().norm_squared()
    }

    /// The numbers of the model, with their errors.
    pub(super) fn fitted(&self) -> Fitted {
        let fitted = self.model();
        let values = self.values(&fitted);
        let pairs = values.iter().flatten().zip(self.samples.iter().flat_map(|sample| &sample.value));
        let apart: f64 = pairs.clone().map(|(found, value)| (found - value).abs()).sum();
        let whole: f64 = pairs.map(|(_, value)| value).sum();
        let rms_err = (self.sum_of_squares() / (3 * self.samples.len()) as f64).sqrt();
        Fitted { rms_err, lobe_err: apart / whole, ..fitted }
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, x: &DVector<f64>) {
        self.numbers.copy_from(x);
    }

    fn params(&self) -> DVector<f64> {
        self.numbers.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.differences())
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let mut jacobian = DMatrix::zeros(3 * self.samples.len(), self.numbers.len());
        let mut here = self.clone();
        for i in 0..self.numbers.len() {
            let [more, less] = [STEP, -STEP].map(|step| {
                here.numbers[i] = self.numbers[i] + step;
                here.differences()
            });
            here.numbers[i] = self.numbers[i];
            jacobian.set_column(i, &((more - less) / (2.0 * STEP)));
        }
        Some(jacobian)
    }
}
