//! Texels moved off their values, so that reads between them err less.

use crate::Image;

/// Texels between which linear interpolation errs evenly.
///
/// Between nodes that lie on a curve of second derivative f'', linear interpolation is too large by up to h^2 f''/8. Nodes
/// moved by half of that the other way, `-h^2 f''/16`, spread the error evenly to both sides and halve its maximum (the
/// usual minimax argument for broken lines). Second differences stand for h^2 f''. A node on the border of an axis
/// is not moved along it. No node is moved from above `floor` to below: at the foot of a lobe a second difference says little.
pub fn balance(image: &Image, floor: f64) -> Image {
    let mut out = image.clone();
    let at = |x: u32, y: u32, c: usize| f64::from(image.texel(x, y)[c]);
    for y in 0..image.height {
        for x in 0..image.width {
            for c in 0..image.channels as usize {
                let here = at(x, y, c);
                let mut curvature = 0.0;
                if x > 0 && x + 1 < image.width {
                    curvature += at(x - 1, y, c) - 2.0 * here + at(x + 1, y, c);
                }
                if y > 0 && y + 1 < image.height {
                    curvature += at(x, y - 1, c) - 2.0 * here + at(x, y + 1, c);
                }
                out.texel_mut(x, y)[c] = (here - curvature / 16.0).max(floor.min(here)) as f32;
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Largest error of linear interpolation of a parabola between nodes, away from the border.
    fn worst(image: &Image) -> f64 {
        let f = |x: f64| x * x;
        (10..150).map(|i| f64::from(i) / 10.0).fold(0.0, |worst, x: f64| {
            let i = (x as u32).clamp(1, 14);
            let t = x - f64::from(i);
            let read = f64::from(image.texel(i, 0)[0]) * (1.0 - t) + f64::from(image.texel(i + 1, 0)[0]) * t;
            if (1.0..15.0).contains(&x) { f64::max(worst, (read - f(x)).abs()) } else { worst }
        })
    }

    #[test]
    fn a_parabola_is_met_twice_as_well() {
        let plain = Image { width: 17, height: 1, channels: 1, data: (0..17).map(|i| (i * i) as f32).collect() };
        assert!((worst(&plain) - 0.25).abs() < 1e-6);
        assert!((worst(&balance(&plain, 0.0)) - 0.125).abs() < 1e-6);
    }

    #[test]
    fn the_foot_of_a_lobe_is_not_dug_out() {
        let lobe = Image { width: 5, height: 1, channels: 1, data: vec![1.0, 0.9, 0.0, -0.2, 0.9] };
        let balanced = balance(&lobe, 0.0);
        assert_eq!((balanced.data[2], balanced.data[3]), (0.0, -0.2));
        assert!(balance(&lobe, f64::NEG_INFINITY).data[2] < 0.0);
    }
}
