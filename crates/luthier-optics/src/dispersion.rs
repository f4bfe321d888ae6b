//! Dispersion formulas of the refractiveindex.info database, by their numbers there.
//!
//! Wavelengths are in um; coefficients that are not given are 0. M. N. Polyanskiy, "Refractiveindex.info database of optical constants",
//! Scientific Data 11, 94 (2024), and the page "Dispersion formulas" of that database.

/// A formula and its coefficients.
#[derive(Debug, Clone, PartialEq)]
pub struct Formula {
    kind: Kind,
    coefficients: Vec<f64>,
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Kind {
    Sellmeier,
    Sellmeier2,
    Polynomial,
    RefractiveIndexInfo,
    Cauchy,
    Gases,
    Herzberger,
    Retro,
    Exotic,
}

/// Formulas in the order of their numbers, and the most coefficients that each takes.
const FORMULAS: [(Kind, usize); 9] = [
    (Kind::Sellmeier, 17),
    (Kind::Sellmeier2, 17),
    (Kind::Polynomial, 17),
    (Kind::RefractiveIndexInfo, 17),
    (Kind::Cauchy, 11),
    (Kind::Gases, 11),
    (Kind::Herzberger, 6),
    (Kind::Retro, 4),
    (Kind::Exotic, 6),
];

/// Why there is no such formula.
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
pub enum FormulaError {
    /// No formula has the number.
    #[error("there is no formula {0}: they are 1 to 9")]
    Unknown(usize),
    /// No coefficients, or more than the formula takes.
    #[error("{found} coefficients; formula {number} takes 1 to {most}")]
    Coefficients {
        /// Number of the formula.
        number: usize,
        /// How many were given.
        found: usize,
        /// How many there can be.
        most: usize,
    },
}

impl Formula {
    /// The formula of a number, 1 to 9.
    ///
    /// # Errors
    /// See [`FormulaError`].
    pub fn new(number: usize, coefficients: Vec<f64>) -> Result<Self, FormulaError> {
        let (kind, most) = *number.checked_sub(1).and_then(|i| FORMULAS.get(i)).ok_or(FormulaError::Unknown(number))?;
        let found = coefficients.len();
        if !(1..=most).contains(&found) {
            return Err(FormulaError::Coefficients { number, found, most });
        }
        Ok(Self { kind, coefficients })
    }

    /// The index at a vacuum wavelength in um; not finite, or not positive, where the formula gives none.
    pub fn at(&self, um: f64) -> f64 {
        let c = |i: usize| self.coefficients.get(i - 1).copied().unwrap_or(0.0);
        let sq = um * um;
        let power = |factor: f64, exponent: f64| factor * libm::pow(um, exponent);
        match self.kind {
            Kind::Sellmeier => libm::sqrt(1.0 + c(1) + self.pairs(2, |b, l| b * sq / (sq - l * l))),
            Kind::Sellmeier2 => libm::sqrt(1.0 + c(1) + self.pairs(2, |b, l_sq| b * sq / (sq - l_sq))),
            Kind::Polynomial => libm::sqrt(c(1) + self.pairs(2, power)),
            Kind::RefractiveIndexInfo => {
                let [first, second] = [2, 6].map(|i| match c(i) {
                    // A resonance without a factor adds nothing; computed, it would be 0/0.
                    0.0 => 0.0,
                    factor => power(factor, c(i + 1)) / (sq - libm::pow(c(i + 2), c(i + 3))),
                });
                libm::sqrt(c(1) + first + second + self.pairs(10, power))
            }
            Kind::Cauchy => c(1) + self.pairs(2, power),
            Kind::Gases => 1.0 + c(1) + self.pairs(2, |b, c| if b == 0.0 { 0.0 } else { b / (c - 1.0 / sq) }),
            Kind::Herzberger => {
                let l = 1.0 / (sq - 0.028);
                c(1) + c(2) * l + c(3) * l * l + c(4) * sq + c(5) * sq * sq + c(6) * sq * sq * sq
            }
            Kind::Retro => {
                let lorentz_lorenz = c(1) + c(2) * sq / (sq - c(3)) + c(4) * sq;
                libm::sqrt((1.0 + 2.0 * lorentz_lorenz) / (1.0 - lorentz_lorenz))
            }
            Kind::Exotic => {
                let away = um - c(5);
                libm::sqrt(
                    c(1) + c(2) / (sq - c(3)) + if c(4) == 0.0 { 0.0 } else { c(4) * away / (away * away + c(6)) },
                )
            }
        }
    }

    /// The sum of terms of two coefficients each, from number `first` on.
    fn pairs(&self, first: usize, term: impl Fn(f64, f64) -> f64) -> f64 {
        let pairs = self.coefficients.get(first - 1..).unwrap_or_default().chunks(2);
        pairs.map(|p| term(p[0], p.get(1).copied().unwrap_or(0.0))).sum()
    }

    /// Wavelengths in nm and indices from `first` to `last` nm, near enough for straight lines between them to err by less than 1e-6.
    /// `Err` has a wavelength at which the formula gives no index.
    pub fn samples(&self, first: f64, last: f64) -> Result<Vec<(f64, f64)>, f64> {
        let steps = libm::ceil((last - first) / STEP_NM).max(1.0) as u32;
        let mut samples = vec![self.sample(first)?];
        for step in 1..=steps {
            let to = if step == steps { last } else { first + STEP_NM * f64::from(step) };
            // Halves of a step wait until all to their left is done.
            let mut waiting = vec![(self.sample(to)?, 0)];
            while let Some((right, halvings)) = waiting.pop() {
                let left = samples[samples.len() - 1];
                let mut err: f64 = 0.0;
                for share in [0.5, 0.25, 0.75] {
                    let (_, n) = self.sample(left.0 + share * (right.0 - left.0))?;
                    err = err.max((left.1 + share * (right.1 - left.1) - n).abs());
                }
                if err <= CHORD_ERR || halvings == HALVINGS_MAX {
                    samples.push(right);
                } else {
                    waiting.push((right, halvings + 1));
                    waiting.push((self.sample(0.5 * (left.0 + right.0))?, halvings + 1));
                }
            }
        }
        Ok(samples)
    }

    /// A wavelength in nm with its index, or the wavelength alone if the formula gives none.
    fn sample(&self, nm: f64) -> Result<(f64, f64), f64> {
        Some((nm, self.at(nm / 1e3))).filter(|(_, n)| n.is_finite() && *n > 0.0).ok_or(nm)
    }
}

/// Widest step of samples.
const STEP_NM: f64 = 5.0;

/// Largest error of a straight line at three places of a step: half of the promised 1e-6, because the largest error is near the middle place
/// and not at it.
const CHORD_ERR: f64 = 5e-7;

/// Halvings of a step: a thousandth of it is narrower than any resonance of a medium, and a range has at most 10^5 samples.
const HALVINGS_MAX: u32 = 10;

#[cfg(test)]
mod tests {
    use super::*;

    /// N-BK7 (SCHOTT data sheet), Sellmeier with squared resonances.
    fn n_bk7() -> Formula {
        let c = [0.0, 1.03961212, 0.00600069867, 0.231792344, 0.0200179144, 1.01046945, 103.560653];
        Formula::new(2, c.to_vec()).unwrap()
    }

    /// Oracles: indices that the sources of the coefficients print beside them.
    #[test]
    fn formulas_give_published_indices() {
        let fused_silica = [0.0, 0.6961663, 0.0684043, 0.4079426, 0.1162414, 0.8974794, 9.896161];
        for (number, coefficients, um, n, tolerance) in [
            // Malitson 1965: 1.45846 at 587.6 nm, 1.46313 at 486.1 nm.
            (1, &fused_silica[..], 0.5876, 1.45846, 1e-5),
            (1, &fused_silica[..], 0.4861, 1.46313, 1e-5),
            // SCHOTT: n_d, n_F, n_C of N-BK7.
            (2, &n_bk7().coefficients[..], 0.5875618, 1.51680, 5e-6),
            (2, &n_bk7().coefficients[..], 0.4861327, 1.52238, 5e-6),
            (2, &n_bk7().coefficients[..], 0.6562725, 1.51432, 5e-6),
            // SCHOTT's older catalogue gave BK7 as a power series: n_d 1.51680.
            (
                3,
                &[
                    2.2718929,
                    -0.010108077,
                    2.0,
                    0.010592509,
                    -2.0,
                    0.00020816965,
                    -4.0,
                    -7.6472538e-6,
                    -6.0,
                    4.9240991e-7,
                    -8.0,
                ][..],
                0.5875618,
                1.51680,
                1e-5,
            ),
            // Eimerl 1987, beta-BaB2O4, ordinary: 1.6749 at 532 nm.
            (4, &[2.7405, 0.0184, 0.0, 0.0179, 1.0, 0.0, 0.0, 0.0, 1.0, -0.0155, 2.0][..], 0.532, 1.6749, 1e-4),
            // Cauchy's law of BK7 in textbooks: 1.5046 + 0.00420 / um^2 is 1.5168 at 587.6 nm.
            (5, &[1.5046, 0.0042, -2.0][..], 0.5876, 1.5168, 1e-4),
            // Ciddor 1996, standard air at 15 C: n - 1 = 2.7716e-4 at 633 nm.
            (6, &[0.0, 0.05792105, 238.0185, 0.00167917, 57.362][..], 0.633, 1.000_276_5, 5e-7),
        ] {
            let found = Formula::new(number, coefficients.to_vec()).unwrap().at(um);
            assert!((found - n).abs() <= tolerance, "formula {number} at {um} um: {found} against {n}");
        }
    }

    /// Closed forms of formulas that sources use in the infrared alone, and of one resonance.
    #[test]
    fn rare_formulas_are_as_documented() {
        let at = |number, c: &[f64], um| Formula::new(number, c.to_vec()).unwrap().at(um);
        // At sqrt(1.028) um, Herzberger's L is 1.
        let um = 1.028_f64.sqrt();
        let sq = 1.028;
        let herzberger = 3.0 + 0.2 + 0.1 + 0.01 * sq - 0.001 * sq * sq + 0.0001 * sq * sq * sq;
        assert!((at(7, &[3.0, 0.2, 0.1, 0.01, -0.001, 0.0001], um) - herzberger).abs() < 1e-12);
        // (n^2 - 1)/(n^2 + 2) = 0.5 is n = 2.
        assert!((at(8, &[0.1, 0.3, 0.25, 0.0], 1.0) - 2.0).abs() < 1e-12);
        // 2 + 1/(4 - 3) + 1 (2 - 1)/((2 - 1)^2 + 1) = 3.5.
        assert!((at(9, &[2.0, 1.0, 3.0, 1.0, 1.0, 1.0], 2.0) - 3.5_f64.sqrt()).abs() < 1e-12);
        // 1 + 3 um^2/(um^2 - 1) - 2 um^0 + um^1 = 1 + 4 - 2 + 2 = 5 at 2 um.
        let c = [1.0, 3.0, 2.0, 1.0, 2.0, 0.0, 0.0, 0.0, 0.0, -2.0, 0.0, 1.0, 1.0];
        assert!((at(4, &c, 2.0) - 5.0_f64.sqrt()).abs() < 1e-12);
    }

    /// Against the formula itself, between samples that are not those which the sampling looked at.
    #[test]
    fn lines_between_samples_err_by_less_than_a_millionth() {
        // The second has a resonance at 340 nm, near what is seen.
        for formula in [n_bk7(), Formula::new(1, vec![0.5, 0.9, 0.34]).unwrap()] {
            let samples = formula.samples(360.0, 830.0).unwrap();
            assert_eq!((samples[0].0, samples[samples.len() - 1].0), (360.0, 830.0));
            for pair in samples.windows(2) {
                for share in [0.1, 0.37, 0.52, 0.81] {
                    let nm = pair[0].0 + share * (pair[1].0 - pair[0].0);
                    let line = pair[0].1 + share * (pair[1].1 - pair[0].1);
                    assert!((line - formula.at(nm / 1e3)).abs() < 1e-6, "{nm}");
                }
            }
        }
    }

    #[test]
    fn what_is_no_index_is_told() {
        // A resonance at 500 nm: below it n^2 is negative.
        let resonant = Formula::new(1, vec![0.0, 1.0, 0.5]).unwrap();
        assert!((360.0..510.0).contains(&resonant.samples(360.0, 830.0).unwrap_err()));
        assert_eq!(Formula::new(0, vec![1.0]), Err(FormulaError::Unknown(0)));
        assert_eq!(Formula::new(10, vec![1.0]), Err(FormulaError::Unknown(10)));
        assert_eq!(Formula::new(8, vec![]), Err(FormulaError::Coefficients { number: 8, found: 0, most: 4 }));
        assert!(Formula::new(7, vec![1.0; 7]).unwrap_err().to_string().contains("formula 7 takes 1 to 6"));
    }
}
