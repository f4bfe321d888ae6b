//! The closed form that holds an error at the least cost.

use luthier_lut::ErrorStats;
use luthier_optics::split_sum::{Masking, SplitSum, split_sum};
use luthier_optics::stack::Distribution;

use super::minimax::{Degrees, Target, fit};
use super::rational::Rational;
use super::{ClosedForm, STRETCH};

/// Nodes of the grid along each axis.
const NODES: u32 = 24;
/// Lowest cosine and alpha of a form. The functions have no limit at the corner below.
const LOWEST: f64 = 1e-3;
/// Degrees in t and alpha that are tried for the loss, the cheapest first. Of all degrees up to 4 over 3, these are the
/// ones that no cheaper ones match, for GGX with correlated masking.
const LOSSES: [Degrees; 11] = [
    [[2, 1], [0, 0]],
    [[2, 2], [0, 0]],
    [[3, 2], [0, 0]],
    [[2, 2], [1, 1]],
    [[2, 2], [1, 2]],
    [[3, 2], [1, 2]],
    [[3, 2], [2, 2]],
    [[3, 2], [3, 2]],
    [[3, 3], [3, 2]],
    [[3, 3], [3, 3]],
    [[4, 4], [3, 2]],
];
/// Degrees in t and r that are tried for the cosine, likewise.
const COSINES: [Degrees; 11] = [
    [[1, 1], [0, 0]],
    [[1, 2], [0, 0]],
    [[1, 3], [0, 0]],
    [[1, 4], [0, 0]],
    [[1, 2], [1, 1]],
    [[2, 2], [1, 2]],
    [[2, 3], [1, 1]],
    [[2, 3], [1, 2]],
    [[3, 2], [2, 2]],
    [[3, 3], [3, 2]],
    [[4, 3], [3, 3]],
];

/// The outcome of a fit.
#[derive(Debug, Clone, PartialEq)]
pub struct FittedForm {
    /// The closed form.
    pub form: ClosedForm,
    /// Its error, against quadrature.
    pub error: ErrorStats,
    /// Whether the error is within the limit.
    pub held: bool,
}

impl ClosedForm {
    /// The cheapest closed form whose bias and albedo err by at most `max_abs`, over cosines and alphas from the given
    /// ones on (at least 0.001). If none holds the error, the most accurate.
    ///
    /// Errors are the least of each form, to a few parts in a hundred, on a grid of 24 x 24 points by quadrature. The
    /// outcome is measured between these points, in single precision. Deterministic.
    pub fn fit(distribution: Distribution, masking: Masking, max_abs: f64, min_cos: f64, min_alpha: f64) -> FittedForm {
        let floor = [min_cos, min_alpha].map(|lowest| lowest.clamp(LOWEST, 0.5));
        let points = Points::new(distribution, masking, floor);
        let mut best: Option<FittedForm> = None;
        for loss in promising(&LOSSES, &points.losses(), &points.between(loss_variables), max_abs) {
            let (cosines, between) = (points.cosines(&loss), points.between(polar));
            for cosine in promising(&COSINES, &cosines, &between, max_abs) {
                let form = ClosedForm { distribution, masking, floor, loss: loss.clone(), cosine };
                let error = form.error(floor[0], floor[1]);
                let held = error.max_abs_err <= max_abs;
                if held {
                    return FittedForm { form, error, held };
                }
                if best.as_ref().is_none_or(|best| error.max_abs_err < best.error.max_abs_err) {
                    best = Some(FittedForm { form, error, held });
                }
            }
        }
        best.unwrap_or_else(|| unreachable!("a polynomial always fits"))
    }
}

/// Tries degrees in turn until a quotient holds an error at the grid and has a positive divisor between its points. If
/// none does, the most accurate.
fn promising<'a, T: Target>(
    degrees: &'a [Degrees],
    grid: &'a [T],
    between: &'a [[f64; 2]],
    max_abs: f64,
) -> impl Iterator<Item = Rational> + 'a {
    let mut rest = degrees.iter();
    let mut best: Option<(Rational, f64)> = None;
    let mut has_held = false;
    std::iter::from_fn(move || {
        for degrees in rest.by_ref() {
            let Some((found, error)) = fit(*degrees, grid) else { continue };
            if between.iter().any(|at| found.denominator.at(*at) <= 0.0) {
                continue;
            }
            if error <= max_abs {
                has_held = true;
                return Some(found);
            }
            if best.as_ref().is_none_or(|(_, least)| error < *least) {
                best = Some((found, error));
            }
        }
        best.take().filter(|_| !has_held).map(|(found, _)| found)
    })
}

/// The split sum at a grid of cosines and alphas.
struct Points {
    floor: [f64; 2],
    sums: Vec<([f64; 2], SplitSum)>,
}

/// Coordinates along an axis: squares of the extremes of Chebyshev's polynomials, which are dense at both ends, and
/// denser at the lower.
fn along(lowest: f64, count: u32) -> impl Iterator<Item = f64> + Clone {
    (0..count).map(move |i| {
        let u = 0.5 - 0.5 * libm::cos(std::f64::consts::PI * f64::from(i) / f64::from(count - 1));
        (lowest + (1.0 - lowest) * u * u).min(1.0)
    })
}

impl Points {
    fn new(distribution: Distribution, masking: Masking, floor: [f64; 2]) -> Self {
        let [cosines, alphas] = floor.map(|lowest| along(lowest, NODES));
        let points = alphas.flat_map(|alpha| cosines.clone().map(move |cos_theta| [cos_theta, alpha]));
        Self { floor, sums: points.map(|at| (at, split_sum(distribution, masking, at[1], at[0]))).collect() }
    }

    /// Points of a grid four times as fine, in some variables.
    fn between(&self, variables: fn([f64; 2]) -> [f64; 2]) -> Vec<[f64; 2]> {
        let [cosines, alphas] = self.floor.map(|lowest| along(lowest, 4 * NODES));
        alphas.flat_map(|alpha| cosines.clone().map(move |cos_theta| variables([cos_theta, alpha]))).collect()
    }

    fn losses(&self) -> Vec<Loss> {
        self.sums.iter().map(|&(point, sum)| Loss { at: loss_variables(point), loss: 1.0 - sum.albedo() }).collect()
    }

    fn cosines(&self, loss: &Rational) -> Vec<Cosine> {
        self.sums
            .iter()
            .map(|&(point, sum)| {
                let albedo = (1.0 - loss.at(loss_variables(point))).clamp(1e-6, 1.0);
                Cosine { at: polar(point), albedo, bias: sum.bias }
            })
            .collect()
    }
}

/// t and r of a cosine and an alpha.
fn polar([cos_theta, alpha]: [f64; 2]) -> [f64; 2] {
    let r = (cos_theta * cos_theta + STRETCH * alpha * alpha).sqrt();
    [cos_theta / r, r]
}

/// t and alpha of a cosine and an alpha.
fn loss_variables([cos_theta, alpha]: [f64; 2]) -> [f64; 2] {
    [polar([cos_theta, alpha])[0], alpha]
}

struct Loss {
    at: [f64; 2],
    loss: f64,
}

impl Target for Loss {
    fn at(&self) -> [f64; 2] {
        self.at
    }

    fn within(&self, error: f64) -> [f64; 2] {
        [self.loss - error, self.loss + error]
    }

    fn error(&self, value: f64) -> f64 {
        (value - self.loss).abs()
    }
}

/// The cosine z. Its error is that of albedo (1 - z)^5, with the albedo of the form.
struct Cosine {
    at: [f64; 2],
    albedo: f64,
    bias: f64,
}

impl Target for Cosine {
    fn at(&self) -> [f64; 2] {
        self.at
    }

    fn within(&self, error: f64) -> [f64; 2] {
        [self.bias + error, self.bias - error].map(|bias| {
            let power = bias / self.albedo;
            1.0 - libm::pow(power.abs(), 0.2).copysign(power)
        })
    }

    fn error(&self, value: f64) -> f64 {
        (self.albedo * libm::pow((1.0 - value).clamp(0.0, 1.0), 5.0) - self.bias).abs()
    }
}
