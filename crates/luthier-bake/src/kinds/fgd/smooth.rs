//! Smoothing of estimates that carry noise.

/// Local quadratic fits over 7 nodes, along both axes of a grid (Savitzky and Golay 1964). At the borders the window stays
/// inside and the fit is evaluated off its centre. Quadratics pass unchanged; independent noise shrinks to a third. Grids
/// narrower than the window are left alone along that axis.
pub(crate) fn savitzky_golay(values: &mut [f64], width: usize, height: usize) {
    for row in 0..height {
        smooth_line(values, row * width, 1, width);
    }
    for column in 0..width {
        smooth_line(values, column, width, height);
    }
}

const HALF: usize = 3;
const WINDOW: usize = 2 * HALF + 1;

fn smooth_line(values: &mut [f64], start: usize, stride: usize, count: usize) {
    if count < WINDOW {
        return;
    }
    let line: Vec<f64> = (0..count).map(|i| values[start + i * stride]).collect();
    for i in 0..count {
        let centre = i.clamp(HALF, count - 1 - HALF);
        let at = i as f64 - centre as f64;
        values[start + i * stride] = (0..WINDOW)
            .map(|k| {
                let x = k as f64 - HALF as f64;
                // Orthogonal polynomials 1, x, x^2 - 4 on -3..3, of square norms 7, 28, 84.
                let weight = 1.0 / 7.0 + at * x / 28.0 + (at * at - 4.0) * (x * x - 4.0) / 84.0;
                weight * line[centre + k - HALF]
            })
            .sum();
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn quadratics_pass_unchanged() {
        let (w, h) = (11, 9);
        let f = |i: usize, j: usize| {
            let (x, y) = (i as f64, j as f64);
            1.0 + 0.3 * x - 0.02 * x * x + 0.1 * y + 0.05 * y * y - 0.01 * x * y
        };
        let mut values: Vec<f64> = (0..w * h).map(|k| f(k % w, k / w)).collect();
        let before = values.clone();
        savitzky_golay(&mut values, w, h);
        for (a, b) in values.iter().zip(before) {
            assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn a_lone_spike_shrinks_by_nine() {
        let mut values = vec![0.0; 15 * 15];
        values[7 * 15 + 7] = 1.0;
        savitzky_golay(&mut values, 15, 15);
        assert!((values[7 * 15 + 7] - (7.0 / 21.0) * (7.0 / 21.0)).abs() < 1e-12);
    }
}
