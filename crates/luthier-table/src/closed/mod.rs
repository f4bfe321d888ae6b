//! Split sums in closed form: a few multiplications instead of a table.

mod cholesky;
mod fit;
mod linear_program;
mod minimax;
mod rational;
mod smooth;

use luthier_lut::{Comparison, ErrorStats, Scan, measure_scan};
use luthier_optics::split_sum::{Masking, SplitSum, split_sum};
use luthier_optics::stack::Distribution;

pub use fit::FittedForm;
pub use rational::{Polynomial, Rational};

/// Weight of alpha^2 beside cosine^2 in r^2. Of 1, 1.5, 2, 3 and 4 it gives the least errors of z for GGX; the loss
/// depends on it little.
pub(crate) const STRETCH: f64 = 3.0;
/// Points of the scan for errors, along each axis.
const SCAN_POINTS: u32 = 96;
/// Halvings of the climb to the worst error.
const REFINEMENTS: u32 = 10;

/// A split sum in closed form: two quotients of polynomials and Schlick's power.
///
/// The variables are r = sqrt(cos_theta^2 + 3 alpha^2) and t = cos_theta / r: polar coordinates around grazing light on
/// a mirror. There the functions have another limit along every direction of approach, which no polynomial of cosine
/// and alpha follows. loss(t, alpha) is 1 less the albedo for f0 = 1. z(t, r) is the cosine at which Schlick's formula
/// reflects as the lobe does in the mean:
///
/// albedo = 1 - loss, bias = albedo (1 - z)^5, scale = albedo - bias.
///
/// Cosines and alphas below the floor are read as the floor.
///
/// ```
/// use luthier_optics::{split_sum::Masking, stack::Distribution};
/// use luthier_table::ClosedForm;
///
/// let fitted = ClosedForm::fit(Distribution::Ggx, Masking::SmithCorrelated, 0.05, 0.1, 0.1);
/// assert!(fitted.held && fitted.form.error_at(0.5, 0.5) < 0.05);
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct ClosedForm {
    /// Slope distribution.
    pub distribution: Distribution,
    /// Masking term.
    pub masking: Masking,
    /// Lowest cosine and lowest alpha.
    pub floor: [f64; 2],
    /// The loss over t and alpha.
    pub loss: Rational,
    /// The cosine z over t and r.
    pub cosine: Rational,
}

impl ClosedForm {
    /// The split sum, in double precision.
    pub fn eval(&self, cos_theta: f64, alpha: f64) -> SplitSum {
        let [cos_theta, alpha] = [cos_theta.clamp(self.floor[0], 1.0), alpha.clamp(self.floor[1], 1.0)];
        let r = (cos_theta * cos_theta + STRETCH * alpha * alpha).sqrt();
        let t = cos_theta / r;
        let albedo = (1.0 - self.loss.at([t, alpha])).clamp(0.0, 1.0);
        let rest = (1.0 - self.cosine.at([t, r])).clamp(0.0, 1.0);
        let square = rest * rest;
        let bias = albedo * (square * square * rest);
        SplitSum { scale: albedo - bias, bias }
    }

    /// The split sum as the shader computes it, in single precision: scale and bias.
    pub fn eval_f32(&self, cos_theta: f32, alpha: f32) -> [f32; 2] {
        let [cos_theta, alpha] = [cos_theta.clamp(self.floor[0] as f32, 1.0), alpha.clamp(self.floor[1] as f32, 1.0)];
        let r_sq = cos_theta * cos_theta + STRETCH as f32 * alpha * alpha;
        let inverse = 1.0 / r_sq.sqrt();
        let (t, r) = (cos_theta * inverse, r_sq * inverse);
        let albedo = (1.0 - self.loss.at_f32([t, alpha])).clamp(0.0, 1.0);
        let rest = (1.0 - self.cosine.at_f32([t, r])).clamp(0.0, 1.0);
        let square = rest * rest;
        let bias = albedo * (square * square * rest);
        [albedo - bias, bias]
    }

    /// The error in single precision over cosines and alphas from the given ones on, by [`measure_form`].
    pub fn error(&self, min_cos: f64, min_alpha: f64) -> ErrorStats {
        measure_form(self.distribution, self.masking, [min_cos, min_alpha], |cos_theta, alpha| {
            self.read(cos_theta, alpha)
        })
    }

    /// The split sum as a shader computes it, in single precision.
    pub(crate) fn read(&self, cos_theta: f64, alpha: f64) -> SplitSum {
        let [scale, bias] = self.eval_f32(cos_theta as f32, alpha as f32).map(f64::from);
        SplitSum { scale, bias }
    }

    /// The largest error of bias and albedo in single precision at one place, against quadrature.
    pub fn error_at(&self, cos_theta: f64, alpha: f64) -> f64 {
        let exact = split_sum(self.distribution, self.masking, alpha, cos_theta);
        let read = self.read(cos_theta, alpha);
        (read.bias - exact.bias).abs().max((read.albedo() - exact.albedo()).abs())
    }

    /// Operations of a read.
    pub fn cost(&self) -> Cost {
        let quotients = [&self.loss, &self.cosine];
        let polynomials = quotients.iter().map(|q| q.numerator.multiply_adds() + q.denominator.multiply_adds());
        let divisions = quotients.iter().filter(|q| !q.is_polynomial()).count() as u32;
        Cost { multiply_adds: Self::AROUND + polynomials.sum::<u32>(), clamps: 4, specials: 1 + divisions }
    }

    /// Products, sums and products with sums around the polynomials: three for r^2, two for t and r, two differences from 1, four for the bias, one
    /// for the scale.
    const AROUND: u32 = 12;
}

/// Operations of a shader function, for one pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Cost {
    /// Products, sums, and products with a sum.
    pub multiply_adds: u32,
    /// Clamps, minima and maxima.
    pub clamps: u32,
    /// Divisions, roots, exponentials.
    pub specials: u32,
}

impl Cost {
    /// Slots of a scheduler. A special function takes four, because it issues at a quarter of the rate; others take
    /// one.
    pub fn slots(self) -> u32 {
        self.multiply_adds + self.clamps + 4 * self.specials
    }
}

impl std::ops::Add for Cost {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self {
            multiply_adds: self.multiply_adds + other.multiply_adds,
            clamps: self.clamps + other.clamps,
            specials: self.specials + other.specials,
        }
    }
}

/// The absolute error of any approximation of a split sum against quadrature, in bias and albedo, over cosines and
/// alphas from the given ones on.
///
/// Bias and albedo are the reflectances for f0 = 0 and 1, so the largest error also bounds the reflectance for any f0
/// between.
///
/// The scan has 96 x 96 points, denser towards the lower ends (squares of equal steps). A climb from the worst follows.
pub fn measure_form(
    distribution: Distribution,
    masking: Masking,
    lowest: [f64; 2],
    form: impl Fn(f64, f64) -> SplitSum + Sync,
) -> ErrorStats {
    let scan = Scan {
        points: [SCAN_POINTS; 2],
        from: [0.0; 2],
        to: [1.0; 2],
        // The border counts too.
        nodes: [SCAN_POINTS / 2; 2],
        refinements: REFINEMENTS,
    };
    measure_scan(
        &scan,
        |u| {
            let [cos_theta, alpha] = place(lowest, u);
            let sums = [split_sum(distribution, masking, alpha, cos_theta), form(cos_theta, alpha)];
            let [expected, sampled] = sums.map(|sum| [sum.bias, sum.albedo(), 0.0, 0.0]);
            Comparison { expected, sampled }
        },
        |u| place(lowest, u).to_vec(),
    )
}

/// Cosine and alpha at coordinates, denser towards the lowest.
fn place(lowest: [f64; 2], u: [f64; 2]) -> [f64; 2] {
    [0, 1].map(|k: usize| lowest[k] + (1.0 - lowest[k]) * u[k] * u[k])
}
