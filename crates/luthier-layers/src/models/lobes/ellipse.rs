//! Ellipses of slopes by four numbers, which a fit looks for.

use super::Shape;

/// Shift of the middle, and the logarithm of the widths as a symmetric matrix `[[a + b, c], [c, a - b]]`: its exponential takes the unit circle
/// to the ellipse.
pub(super) type Numbers = [f64; 4];

/// Derivatives by one of the numbers, in the axes of the ellipse: of both coordinates of the middle, of the logarithms of both widths, and of the
/// logarithm's entry off the diagonal.
pub(super) type Slopes = [f64; 5];

/// The frame of an ellipse.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Plane {
    /// The plane of an eye, by the sine of its angle. The ellipse lies along this plane and across it: half the logarithm of the ratio of its widths
    /// is b times the squared sine.
    OfEye(f64),
    /// Tangents, in which the eye has these coordinates along the surface.
    OfTangents([f64; 2]),
}

impl Plane {
    /// The shape of numbers.
    ///
    /// In the plane of the eye the middle is at the shift times the sine. In tangents the shift counts as the first moment of a density that falls
    /// off towards the eye: covariance times eye, over the root of the covariance's determinant. For a circle that is along the eye.
    pub(super) fn shape(self, [shift, a, b, c]: Numbers, tail: f64) -> Shape {
        match self {
            Self::OfEye(sin) => {
                let ratio = b * sin * sin;
                let width = [libm::exp(a + ratio), libm::exp(a - ratio)];
                Shape { middle: [shift * sin, 0.0], width, turn: [1.0, 0.0], tail }
            }
            Self::OfTangents(eye) => {
                let (radius, turn) = principal(b, c);
                let width = [libm::exp(a + radius), libm::exp(a - radius)];
                Shape { middle: pulled(b, c, eye).map(|x| shift * x), width, turn, tail }
            }
        }
    }

    /// Slopes by each number.
    pub(super) fn slopes(self, [shift, _, b, c]: Numbers) -> [Slopes; 4] {
        match self {
            Self::OfEye(sin) => {
                let sin_sq = sin * sin;
                [[sin, 0.0, 0.0, 0.0, 0.0], [0.0, 0.0, 1.0, 1.0, 0.0], [0.0, 0.0, sin_sq, -sin_sq, 0.0], [0.0; 5]]
            }
            Self::OfTangents(eye) => {
                let (_, turn) = principal(b, c);
                let [cos, sin] = [turn[0] * turn[0] - turn[1] * turn[1], 2.0 * turn[0] * turn[1]];
                let [by_b, by_c] = pulled_slopes(b, c, eye).map(|slope| slope.map(|x| shift * x));
                [
                    (pulled(b, c, eye), [0.0; 3]),
                    ([0.0; 2], [1.0, 1.0, 0.0]),
                    (by_b, [cos, -cos, -sin]),
                    (by_c, [sin, -sin, cos]),
                ]
                .map(|([x, y], log)| {
                    let [m0, m1] = [turn[0] * x + turn[1] * y, turn[0] * y - turn[1] * x];
                    [m0, m1, log[0], log[1], log[2]]
                })
            }
        }
    }
}

/// The length of (b, c), and cosine and sine of half its angle: the axis of the greater width.
fn principal(b: f64, c: f64) -> (f64, [f64; 2]) {
    let (sin, cos) = libm::sincos(0.5 * libm::atan2(c, b));
    (libm::hypot(b, c), [cos, sin])
}

/// `exp(2 [[b, c], [c, -b]]) eye`.
fn pulled(b: f64, c: f64, [x, y]: [f64; 2]) -> [f64; 2] {
    let radius = libm::hypot(b, c);
    let (cosh, sinhc) = (libm::cosh(2.0 * radius), sinh_over(radius));
    [cosh * x + sinhc * (b * x + c * y), cosh * y + sinhc * (c * x - b * y)]
}

/// Slopes of [`pulled`] by b and by c.
fn pulled_slopes(b: f64, c: f64, [x, y]: [f64; 2]) -> [[f64; 2]; 2] {
    let radius = libm::hypot(b, c);
    let sinhc = sinh_over(radius);
    // The slope of sinhc over the radius.
    let bend = if radius < 1e-2 { 8.0 / 3.0 } else { (2.0 * libm::cosh(2.0 * radius) - sinhc) / (radius * radius) };
    let turned = [b * x + c * y, c * x - b * y];
    [(b, [x, -y]), (c, [y, x])]
        .map(|(part, own)| [0, 1].map(|i: usize| part * (2.0 * sinhc * [x, y][i] + bend * turned[i]) + sinhc * own[i]))
}

/// `sinh(2 r) / r`.
fn sinh_over(radius: f64) -> f64 {
    if radius < 1e-6 { 2.0 } else { libm::sinh(2.0 * radius) / radius }
}

/// The numbers of a centred ellipse whose squared widths are a covariance: along x, along y, and between them. Widths are within bounds.
pub(super) fn logarithm([xx, yy, xy]: [f64; 3], [least, most]: [f64; 2]) -> Numbers {
    if xx == yy && xy == 0.0 {
        return [0.0, libm::log(xx.sqrt().clamp(least, most)), 0.0, 0.0];
    }
    let (mean, radius) = (0.5 * (xx + yy), libm::hypot(0.5 * (xx - yy), xy));
    let [major, minor] =
        [mean + radius, mean - radius].map(|square| libm::log(square.max(0.0).sqrt().clamp(least, most)));
    let half = 0.5 * (major - minor);
    [0.0, 0.5 * (major + minor), half * 0.5 * (xx - yy) / radius, half * xy / radius]
}

#[cfg(test)]
mod tests {
    use super::*;

    const NUMBERS: [Numbers; 3] = [[0.3, -1.0, 0.7, -0.4], [-0.2, -2.0, -0.1, 0.9], [0.5, -0.5, 0.0, 0.0]];

    fn matrix(shape: &Shape) -> [f64; 3] {
        let [x, y, shear] = shape.sharpness();
        [x, y, shear]
    }

    /// Oracle: the series of the exponential of the negative logarithm.
    #[test]
    fn widths_are_the_exponential() {
        for numbers in NUMBERS {
            let [_, a, b, c] = numbers;
            let log = [[-(a + b), -c], [-c, -(a - b)]];
            let (mut term, mut sum) = ([[1.0, 0.0], [0.0, 1.0]], [[1.0, 0.0], [0.0, 1.0]]);
            for k in 1..40 {
                let product = |i: usize, j: usize| (term[i][0] * log[0][j] + term[i][1] * log[1][j]) / f64::from(k);
                term = [[product(0, 0), product(0, 1)], [product(1, 0), product(1, 1)]];
                (0..4).for_each(|i| sum[i / 2][i % 2] += term[i / 2][i % 2]);
            }
            let found = matrix(&Plane::OfTangents([0.2, 0.4]).shape(numbers, 0.5));
            for (found, expected) in found.iter().zip([sum[0][0], sum[1][1], sum[0][1]]) {
                assert!((found - expected).abs() < 1e-9 * (1.0 + expected.abs()), "{found} {expected}");
            }
        }
    }

    /// Oracle: matrices. The middle is covariance times eye over the root of the covariance's determinant.
    #[test]
    fn the_middle_is_pulled_by_the_covariance() {
        let shape = Plane::OfTangents([0.2, 0.4]).shape(NUMBERS[0], 0.5);
        let [x, y, shear] = matrix(&shape);
        let det = x * y - shear * shear;
        // S m = shift adj(S) eye.
        let found = [x * shape.middle[0] + shear * shape.middle[1], shear * shape.middle[0] + y * shape.middle[1]];
        let expected = [y * 0.2 - shear * 0.4, x * 0.4 - shear * 0.2].map(|adjugate| 0.3 * adjugate);
        assert!(det > 0.0 && (found[0] - expected[0]).abs() < 1e-12 && (found[1] - expected[1]).abs() < 1e-12);
    }

    /// Oracle: differences.
    #[test]
    fn slopes_are_those_of_the_shape() {
        for (plane, numbers) in [Plane::OfTangents([0.3, -0.6]), Plane::OfEye(0.8)]
            .into_iter()
            .flat_map(|plane| NUMBERS.map(|n| (plane, n)))
        {
            let slopes = plane.slopes(numbers);
            let here = plane.shape(numbers, 0.5);
            let [cos, sin] = here.turn;
            for (number, slopes) in slopes.iter().enumerate().take(if plane == Plane::OfEye(0.8) { 3 } else { 4 }) {
                let step = 1e-6;
                let [more, less] = [step, -step].map(|step| {
                    let mut moved = numbers;
                    moved[number] += step;
                    plane.shape(moved, 0.5)
                });
                let by = |f: &dyn Fn(&Shape) -> f64| (f(&more) - f(&less)) / (2.0 * step);
                let middle = [by(&|shape| shape.middle[0]), by(&|shape| shape.middle[1])];
                let expected = [cos * middle[0] + sin * middle[1], cos * middle[1] - sin * middle[0]];
                assert!((slopes[0] - expected[0]).abs() < 1e-6 && (slopes[1] - expected[1]).abs() < 1e-6);
                // S^2 in the axes of the ellipse changes by -2 S^2 d log there, and between the axes by the difference quotient.
                let along = |shape: &Shape| {
                    let [x, y, k] = matrix(shape);
                    let squares = [x * x + k * k, y * y + k * k, k * (x + y)];
                    let part = |c: f64, s: f64| c * c * squares[0] + s * s * squares[1] + 2.0 * c * s * squares[2];
                    let off = (cos * cos - sin * sin) * squares[2] + cos * sin * (squares[1] - squares[0]);
                    [part(cos, sin), part(-sin, cos), off]
                };
                let [first, second] = here.width.map(|width| 1.0 / (width * width));
                let between = if (first - second).abs() < 1e-9 {
                    -2.0 * first
                } else {
                    (first - second) / libm::log(here.width[0] / here.width[1])
                };
                let expected = [-2.0 * first * slopes[2], -2.0 * second * slopes[3], between * slopes[4]];
                for (i, expected) in expected.into_iter().enumerate() {
                    let found = by(&|shape| along(shape)[i]);
                    assert!(
                        (found - expected).abs() < 1e-4 * (1.0 + expected.abs()),
                        "{number} {i}: {found} {expected}"
                    );
                }
            }
        }
    }

    /// Oracle: a covariance made of two widths and an angle.
    #[test]
    fn logarithms_are_those_of_covariances() {
        let (widths, [cos, sin]) = ([0.5, 0.1], [0.8, 0.6]);
        let [xx, yy] = widths.map(|width: f64| width * width);
        let turned = [cos * cos * xx + sin * sin * yy, sin * sin * xx + cos * cos * yy, cos * sin * (xx - yy)];
        let shape = Plane::OfTangents([0.0; 2]).shape(logarithm(turned, [1e-3, 1.0]), 0.0);
        assert!((shape.width[0] - 0.5).abs() < 1e-9 && (shape.width[1] - 0.1).abs() < 1e-9, "{shape:?}");
        assert!((shape.turn[0] - 0.8).abs() < 1e-9 && (shape.turn[1] - 0.6).abs() < 1e-9, "{shape:?}");
        assert_eq!(logarithm([0.04, 0.04, 0.0], [1e-3, 1.0]), [0.0, libm::log(0.2), 0.0, 0.0]);
    }
}
