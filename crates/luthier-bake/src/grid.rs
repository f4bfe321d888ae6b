//! Functions on a grid, between its nodes.

use luthier_lut::{Axis, Image};
use luthier_optics::interpolation::cubic_stencil;

/// Image of a function at other nodes, by cubics between the nodes of a grid.
pub(crate) fn resampled(image: &Image, grid: &[Axis; 2], axes: &[Axis; 2]) -> Image {
    let mut out = Image::zeros(axes[0].size, axes[1].size, image.channels);
    for j in 0..axes[1].size {
        for i in 0..axes[0].size {
            let value = cubic(image, grid, [axes[0].node(i), axes[1].node(j)]);
            let channels = image.channels as usize;
            out.texel_mut(i, j).copy_from_slice(&value.map(|v| v as f32)[..channels]);
        }
    }
    out
}

/// Value by cubics through the four nearest nodes along each axis (Lagrange). A node returns its own value.
pub(crate) fn cubic(image: &Image, grid: &[Axis; 2], values: [f64; 2]) -> [f64; 4] {
    let [(i, x), (j, y)] = [0, 1].map(|k: usize| cubic_stencil(grid[k].index(values[k]), grid[k].size as usize));
    let mut out = [0.0; 4];
    for (row, y) in (j..).zip(y) {
        for (column, x) in (i..).zip(x) {
            if x * y == 0.0 {
                continue;
            }
            for (sum, value) in out.iter_mut().zip(image.texel(column as u32, row as u32)) {
                *sum += x * y * f64::from(*value);
            }
        }
    }
    out
}

#[cfg(test)]
mod tests {
    use luthier_lut::Mapping;

    use super::*;

    #[test]
    fn cubics_pass_unchanged() {
        let axis = |size| Axis {
            quantity: "x".into(),
            unit: String::new(),
            min: 0.0,
            max: 1.0,
            size,
            mapping: Mapping::Linear,
        };
        let (grid, axes) = ([axis(9), axis(7)], [axis(13), axis(5)]);
        let f = |x: f64, y: f64| 0.3 + x * x * x - 0.5 * x * y + 0.2 * y * y * y;
        let image = |axes: &[Axis; 2]| {
            let nodes = (0..axes[1].size).flat_map(|j| (0..axes[0].size).map(move |i| (i, j)));
            let data = nodes.map(|(i, j)| f(axes[0].node(i), axes[1].node(j)) as f32).collect();
            Image { width: axes[0].size, height: axes[1].size, channels: 1, data }
        };
        let found = resampled(&image(&grid), &grid, &axes);
        for (a, b) in found.data.iter().zip(&image(&axes).data) {
            assert!((a - b).abs() < 1e-6, "{a} {b}");
        }
    }
}
