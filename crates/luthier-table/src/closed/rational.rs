//! Polynomials of two variables and their quotients.

/// A polynomial of x and y of a degree in each: coefficients of x^i y^j, by i and then by j.
#[derive(Debug, Clone, PartialEq)]
pub struct Polynomial {
    /// Degrees in x and in y.
    pub degrees: [usize; 2],
    /// One number for every power of x and of y, y faster.
    pub coefficients: Vec<f32>,
}

impl Polynomial {
    pub(super) fn rounded(degrees: [usize; 2], coefficients: impl Iterator<Item = f64>) -> Self {
        Self { degrees, coefficients: coefficients.map(|c| c as f32).collect() }
    }
    /// The value by Horner's rule, in y within x.
    pub fn at(&self, [x, y]: [f64; 2]) -> f64 {
        self.coefficients
            .chunks_exact(self.degrees[1] + 1)
            .rev()
            .fold(0.0, |sum, line| sum * x + line.iter().rev().fold(0.0, |sum, c| sum * y + f64::from(*c)))
    }

    /// As [`Self::at`], in single precision.
    pub fn at_f32(&self, [x, y]: [f32; 2]) -> f32 {
        self.coefficients
            .chunks_exact(self.degrees[1] + 1)
            .rev()
            .fold(0.0, |sum, line| sum * x + line.iter().rev().fold(0.0, |sum, c| sum * y + c))
    }

    /// The multiply-adds of Horner's rule.
    pub fn multiply_adds(&self) -> u32 {
        self.coefficients.len() as u32 - 1
    }

    /// All powers up to the degrees, at a point: the order of the coefficients.
    pub(super) fn powers([a, b]: [usize; 2], [x, y]: [f64; 2]) -> Vec<f64> {
        let of =
            |x: f64, degree: usize| std::iter::successors(Some(1.0), move |power| Some(power * x)).take(degree + 1);
        of(x, a).flat_map(|x| of(y, b).map(move |y| x * y)).collect()
    }
}

/// A quotient of two polynomials, or one polynomial over the constant 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Rational {
    /// The dividend.
    pub numerator: Polynomial,
    /// The divisor, above 0 wherever the quotient is read.
    pub denominator: Polynomial,
}

impl Rational {
    /// The value.
    pub fn at(&self, point: [f64; 2]) -> f64 {
        self.numerator.at(point) / self.denominator.at(point)
    }

    /// The value in single precision.
    pub fn at_f32(&self, point: [f32; 2]) -> f32 {
        self.numerator.at_f32(point) / self.denominator.at_f32(point)
    }

    /// Whether the divisor is 1.
    pub fn is_polynomial(&self) -> bool {
        self.denominator.degrees == [0, 0]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn horner_is_the_sum_of_powers() {
        let polynomial = Polynomial { degrees: [2, 1], coefficients: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        let (x, y) = (0.5, 3.0);
        let expected = 1.0 + 2.0 * y + x * (3.0 + 4.0 * y) + x * x * (5.0 + 6.0 * y);
        assert!((polynomial.at([x, y]) - expected).abs() < 1e-15);
        assert_eq!(polynomial.at_f32([0.5, 3.0]), expected as f32);
        let powers = Polynomial::powers([2, 1], [x, y]);
        let sum: f64 = powers.iter().zip(&polynomial.coefficients).map(|(p, c)| p * f64::from(*c)).sum();
        assert!((sum - expected).abs() < 1e-15);
        assert_eq!(polynomial.multiply_adds(), 5);
    }
}
