//! Directions in which a lobe of the model `lobes` shows the environment.

/// A direction: where it lies over the standard deviations of a Gaussian, and its weight in thousandths of all.
type Point = [f64; 3];

/// A number of reads for each lobe.
struct Step {
    reads: u32,
    /// Half the length of the line on which the directions of one sample lie, in standard deviations. Longer lines waste their ends, shorter ones lose them; found
    /// by least squares for lobes two to six times as long as wide.
    reach: f64,
    /// Directions of samples with turns of their own; none where two or one would be too few.
    turned: Option<Turned>,
}

/// Directions that turn.
struct Turned {
    /// Blur of a direction of a lobe, over its widths, and its limit over the lesser width. Measured: `docs/pages/environment.md` has the errors.
    blur: f64,
    narrowest: f64,
    points: &'static [Point],
}

/// Points with weights whose blurs together come near to a Gaussian, found by descent from a spiral. With a blur of 0.6 standard deviations the test below has
/// their errors; those of a spiral with equal weights are twice as large with eight points.
const STEPS: [Step; 4] = [
    Step { reads: 1, reach: 1.1, turned: None },
    Step { reads: 2, reach: 1.3, turned: None },
    Step {
        reads: 4,
        reach: 1.65,
        turned: Some(Turned {
            blur: 0.4,
            narrowest: 0.707,
            points: &[[0.562, -0.133, 360.0], [-0.983, 0.758, 266.1], [-0.748, -1.371, 219.1], [1.280, 1.957, 154.7]],
        }),
    },
    Step {
        reads: 8,
        reach: 2.1,
        turned: Some(Turned {
            blur: 0.294,
            narrowest: 0.566,
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
        }),
    },
];

/// The text with this many directions for each lobe.
pub(super) fn directions(text: &str, reads: u32) -> String {
    let step = STEPS.iter().find(|step| step.reads >= reads).unwrap_or(&STEPS[STEPS.len() - 1]);
    let turned = step.turned.as_ref();
    let still: String = (0..step.reads).map(|number| still(step.reads, number)).collect();
    text.replace("    $still_blurs\n", blurs(step.reads))
        .replace("$still_apart", &format!("{:?}", 1.0 / f64::from(step.reads)))
        .replace("$still_reach", &format!("{:?}", step.reach))
        .replace("    $each_still\n", &still)
        .replace("    $turned_mean\n", if turned.is_some() { TURNED_MEAN } else { "" })
        .replace("    $turned_wide\n", if turned.is_some() { TURNED_WIDE } else { "" })
        .replace("    $each_direction\n", &turned.map_or_else(String::new, |turned| taps(turned.points)))
        .replace("$tap_blur", &format!("{:?}", turned.map_or(1.0, |turned| turned.blur)))
        .replace("$tap_narrowest", &format!("{:?}", turned.map_or(1.0, |turned| turned.narrowest)))
}

const TURNED_MEAN: &str = "    if turn.z != 0.0 {
        return luthier_shown_turned(lobe, prepared, frame, turn.xy);
    }
";

const TURNED_WIDE: &str = "    if turn.z != 0.0 {
        return luthier_turned_wide(prepared, frame, turn.xy);
    }
";

/// Statements for the blurs of one sample. Few reads are Gaussians. Of four and more, every other one is that of the tail, which two Gaussians follow
/// within .02 of a lobe's own size by least squares; lobes without a tail have both alike.
fn blurs(reads: u32) -> &'static str {
    if reads < 4 {
        return "    still.apart = $still_apart;
    still.core = vec2<f32>(1.0 / (1.0 + 0.15 * tail), 1.0);
";
    }
    "    let root = sqrt(tail);
    still.apart = (1.0 + root) * $still_apart;
    let blurs = exp(0.5 * tail + vec2<f32>(-0.95, 1.15) * root);
    let shares = vec2<f32>(0.55, 0.45) / (1.0 + still.fall * still.across_sq * blurs);
    still.core = vec2<f32>(blurs.x, shares.x);
    still.tail = vec2<f32>(blurs.y, shares.y);
"
}

/// A statement that reads one of the directions of one sample.
fn still(reads: u32, number: u32) -> String {
    let at = (f64::from(number) + 0.5) / f64::from(reads);
    let blur = if reads >= 4 && number % 2 == 1 { "tail" } else { "core" };
    format!("    shown = luthier_still_tap(shown, still, lobe, prepared, frame, {at:?}, still.{blur});\n")
}

/// Statements that read directions that turn.
fn taps(points: &[Point]) -> String {
    let count = points.len() as f64;
    let taps = points.iter().map(|[x, y, weight]| {
        // Over widths, which are the square root of 2 standard deviations.
        let [across, along] = [x, y].map(|v| v * std::f64::consts::FRAC_1_SQRT_2);
        let (distance_sq, weight) = (across * across + along * along, 1e-3 * count * weight);
        format!("    shown = luthier_turned_tap(shown, lobe, spread, prepared, frame, turn, vec4<f32>({across:.6}, {along:.6}, {distance_sq:.6}, {weight:.6}));\n")
    });
    taps.collect()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use luthier_manifest::FunctionGroup;

    use super::*;

    #[test]
    fn every_group_has_its_step() {
        for reads in FunctionGroup::ALL.into_iter().filter_map(FunctionGroup::environment_reads) {
            let marks = ["still_blurs", "each_still", "turned_mean", "turned_wide", "each_direction"];
            let marks: String = marks.map(|mark| format!("    ${mark}\n")).concat();
            let found =
                directions(&format!("{marks}const REACH: f32 = $still_reach;\nconst BLUR: f32 = $tap_blur;"), reads);
            assert_eq!(found.matches("luthier_still_tap(").count(), reads as usize);
            assert_eq!(found.matches("luthier_turned_tap(").count(), if reads < 4 { 0 } else { reads as usize });
            assert_eq!(found.contains("luthier_turned_wide("), reads >= 4);
            assert!(!found.contains('$'), "{found}");
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

    /// A spiral with equal weights (Vogel 1979) is off by 0.17 with eight points.
    #[test]
    fn blurs_about_the_points_are_nearly_a_gaussian() {
        for (turned, limit) in STEPS.iter().filter_map(|step| step.turned.as_ref()).zip([0.3, 0.1]) {
            let weights: f64 = turned.points.iter().map(|point| point[2]).sum();
            assert!((weights - 1000.0).abs() < 1.0, "{weights}");
            let found = error(turned.points, 0.6);
            assert!(found < limit, "{} points: {found}", turned.points.len());
        }
    }
}
