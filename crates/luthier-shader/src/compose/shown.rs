//! Directions in which a lobe of the model `lobes` shows the environment.

/// A direction: where it lies over the standard deviations of a Gaussian, and its weight in thousandths of all.
type Point = [f64; 3];

/// A number of reads for each lobe.
struct Step {
    /// Blur of a direction of a lobe, over its widths. Measured: `docs/pages/environment.md` has the errors.
    blur: f64,
    points: &'static [Point],
}

/// Points with weights whose blurs together come near to a Gaussian, found by descent from a spiral. With a blur of 0.6 standard deviations the test below has
/// their errors; those of a spiral with equal weights are 1.3 times as large with two points, twice with eight and eleven times with 32.
const STEPS: [Step; 6] = [
    Step { blur: 0.6, points: &[[0.0, 0.0, 1000.0]] },
    Step { blur: 0.5, points: &[[0.711, -0.626, 500.0], [-0.711, 0.626, 500.0]] },
    Step {
        blur: 0.4,
        points: &[[0.562, -0.133, 360.0], [-0.983, 0.758, 266.1], [-0.748, -1.371, 219.1], [1.280, 1.957, 154.7]],
    },
    Step {
        blur: 0.32,
        points: &[
            [0.392, -0.061, 183.5],
            [-0.551, 0.633, 179.2],
            [-0.147, -1.039, 174.6],
            [1.002, 1.032, 140.9],
            [-1.534, -0.300, 113.3],
            [1.702, -0.954, 102.3],
            [-1.002, 2.047, 68.0],
            [-1.415, -2.462, 38.2],
        ],
    },
    Step {
        blur: 0.28,
        points: &[
            [0.230, -0.001, 64.0],
            [-0.399, 0.254, 85.6],
            [0.123, -0.681, 93.0],
            [0.461, 0.604, 85.2],
            [-1.004, -0.272, 98.2],
            [0.998, -0.385, 84.6],
            [-0.339, 1.219, 85.6],
            [-0.551, -1.322, 82.6],
            [1.390, 0.773, 61.6],
            [-1.506, 0.781, 59.5],
            [0.987, -1.588, 52.6],
            [0.758, 1.873, 41.8],
            [2.211, -0.434, 34.6],
            [-2.198, -0.832, 33.8],
            [-1.345, 2.362, 20.7],
            [-0.237, -3.007, 16.7],
        ],
    },
    Step {
        blur: 0.28,
        points: &[
            [-0.328, 0.144, 71.2],
            [0.383, 0.081, 69.4],
            [-0.042, -0.544, 69.1],
            [-0.249, 0.831, 61.3],
            [0.524, 0.723, 55.9],
            [0.771, -0.539, 59.5],
            [-0.936, -0.128, 54.1],
            [-0.656, -0.831, 46.9],
            [1.220, 0.202, 49.0],
            [0.263, -1.250, 46.0],
            [-1.081, 0.702, 48.1],
            [0.349, 1.494, 36.0],
            [1.278, 1.076, 31.1],
            [-1.435, -0.858, 28.7],
            [-0.619, 1.556, 30.8],
            [-0.544, -1.587, 30.0],
            [-1.718, 0.056, 27.3],
            [1.633, -0.560, 25.8],
            [1.143, -1.302, 26.3],
            [-1.643, 1.385, 15.2],
            [2.173, 0.324, 16.2],
            [0.455, -2.152, 15.5],
            [-1.569, -1.798, 11.8],
            [1.151, 2.105, 11.3],
            [-0.012, 2.428, 10.6],
            [-2.399, 0.703, 9.4],
            [-2.467, -0.729, 9.0],
            [2.243, 1.432, 7.0],
            [2.484, -0.958, 7.4],
            [-0.569, -2.609, 6.9],
            [1.678, -2.082, 7.1],
            [-1.276, 2.415, 6.1],
        ],
    },
];

/// The text with this many directions for each lobe.
pub(super) fn directions(text: &str, reads: u32) -> String {
    let step = STEPS.iter().find(|step| step.points.len() >= reads as usize).unwrap_or(&STEPS[STEPS.len() - 1]);
    let count = step.points.len() as f64;
    let taps = step.points.iter().map(|[x, y, weight]| {
        // Over widths, which are the square root of 2 standard deviations.
        let [across, along] = [x, y].map(|v| v * std::f64::consts::FRAC_1_SQRT_2);
        let (distance_sq, weight) = (across * across + along * along, 1e-3 * count * weight);
        format!("    shown = luthier_shown_tap(shown, lobe, prepared, frame, vec4<f32>({across:.6}, {along:.6}, {distance_sq:.6}, {weight:.6}));\n")
    });
    text.replace("    $each_direction\n", &taps.collect::<String>()).replace("$tap_blur", &format!("{:?}", step.blur))
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use luthier_manifest::FunctionGroup;

    use super::*;

    #[test]
    fn every_group_has_its_step() {
        for reads in FunctionGroup::ALL.into_iter().filter_map(FunctionGroup::environment_reads) {
            let found = directions("    $each_direction\nconst BLUR: f32 = $tap_blur;", reads);
            assert_eq!(found.matches("luthier_shown_tap(").count(), reads as usize);
            assert!(found.contains("const BLUR: f32 = 0.") && !found.contains('$'), "{found}");
        }
    }

    /// Root of the mean squared difference between a Gaussian and blurs about points, over the Gaussian's own: integrals of products of Gaussians.
    fn error(points: &[Point], blur: f64) -> f64 {
        let gaussian =
            |distance_sq: f64, variance: f64| libm::exp(-0.5 * distance_sq / variance) / (2.0 * PI * variance);
        let spread_sq = 1.0 - blur * blur;
        let (mut pairs, mut crosses) = (0.0, 0.0);
        for a in points {
            crosses += 1e-3 * a[2] * gaussian(spread_sq * (a[0] * a[0] + a[1] * a[1]), 1.0 + blur * blur);
            for b in points {
                let [x, y] = [a[0] - b[0], a[1] - b[1]];
                let distance_sq = x * x + y * y;
                pairs += 1e-6 * a[2] * b[2] * gaussian(spread_sq * distance_sq, 2.0 * blur * blur);
            }
        }
        let own = gaussian(0.0, 2.0);
        ((pairs - 2.0 * crosses + own) / own).max(0.0).sqrt()
    }

    /// A spiral with equal weights (Vogel 1979) is off by 0.17 with eight points, 0.088 with 16 and 0.045 with 32.
    #[test]
    fn blurs_about_the_points_are_nearly_a_gaussian() {
        for (step, limit) in STEPS.iter().zip([0.93, 0.6, 0.3, 0.1, 0.03, 0.005]) {
            let weights: f64 = step.points.iter().map(|point| point[2]).sum();
            assert!((weights - 1000.0).abs() < 1.0, "{weights}");
            let found = error(step.points, 0.6);
            assert!(found < limit, "{} points: {found}", step.points.len());
        }
    }
}
