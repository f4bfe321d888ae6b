//! Equirectangular maps: columns are azimuths, rows are angles from +y.
//!
//! The middle of a map looks along -z, its left and right edges along +z, its top row up; +x is right of the middle.

use std::f64::consts::PI;

use luthier_lut::Image;

/// Direction of a point of the map, both coordinates in 0..1 from the top left.
pub(crate) fn direction(u: f64, v: f64) -> [f64; 3] {
    let phi = (u - 0.5) * 2.0 * PI;
    let (sin_theta, cos_theta) = libm::sincos(v * PI);
    let (sin_phi, cos_phi) = libm::sincos(phi);
    [sin_theta * sin_phi, cos_theta, -sin_theta * cos_phi]
}

/// The point of the map for a unit direction.
pub(crate) fn coordinates([x, y, z]: [f64; 3]) -> [f64; 2] {
    let u = 0.5 + libm::atan2(x, -z) / (2.0 * PI);
    [u, libm::atan2((x * x + z * z).sqrt(), y) / PI]
}

/// Direction of the centre of a texel.
pub(crate) fn texel_direction(map: &Image, x: u32, y: u32) -> [f64; 3] {
    direction((f64::from(x) + 0.5) / f64::from(map.width), (f64::from(y) + 0.5) / f64::from(map.height))
}

/// Cosine of the angle from +y at a number of rows from the top.
fn height_at(map: &Image, rows: f64) -> f64 {
    libm::cos(PI * rows / f64::from(map.height))
}

/// Two directions in the middle of the column of a texel, at the places of Gauss's rule in the height of its row.
pub(crate) fn gauss_directions(map: &Image, x: u32, y: u32) -> [[f64; 3]; 2] {
    let [top, bottom] = [y, y + 1].map(|y| height_at(map, f64::from(y)));
    let u = (f64::from(x) + 0.5) / f64::from(map.width);
    [1.0, -1.0].map(|side| {
        let height = 0.5 * (top + bottom) + side * 0.5 * (top - bottom) / 3.0_f64.sqrt();
        direction(u, libm::acos(height) / PI)
    })
}

/// Solid angle of a texel of a row.
pub(crate) fn solid_angle(map: &Image, y: u32) -> f64 {
    let [top, bottom] = [y, y + 1].map(|y| height_at(map, f64::from(y)));
    2.0 * PI / f64::from(map.width) * (top - bottom)
}

/// Bilinear read of an RGB map at a direction's coordinates. Columns go round, rows end.
pub(crate) fn bilinear(map: &Image, [u, v]: [f64; 2]) -> [f64; 3] {
    let (x, y) = (u * f64::from(map.width) - 0.5, v * f64::from(map.height) - 0.5);
    let (left, top) = (x.floor(), y.floor());
    let (wx, wy) = (x - left, y - top);
    let (columns, last) = (i64::from(map.width), i64::from(map.height) - 1);
    let [near, far] = [0, 1].map(|step| 3 * (left as i64 + step).rem_euclid(columns) as usize);
    let rows = [0, 1].map(|step| 3 * ((top as i64 + step).clamp(0, last) * columns) as usize);
    [0, 1, 2].map(|c| {
        let [upper, lower] = rows.map(|row| {
            let [a, b] = [near, far].map(|column| f64::from(map.data[row + column + c]));
            a + wx * (b - a)
        });
        upper + wy * (lower - upper)
    })
}

/// The map with `height` rows and twice as many columns. Each texel is the mean of its area, by solid angle.
pub(crate) fn shrunk(map: &Image, height: u32) -> Image {
    let mut small = Image::zeros(2 * height, height, 3);
    let columns: Vec<_> = (0..small.width).map(|x| overlaps(x, small.width, map.width)).collect();
    for y in 0..height {
        let rows = overlaps(y, height, map.height).into_iter();
        let rows: Vec<(u32, f64)> =
            rows.map(|(row, [from, to])| (row, height_at(map, from) - height_at(map, to))).collect();
        for (x, columns) in columns.iter().enumerate() {
            let (mut sum, mut weights) = ([0.0; 3], 0.0);
            for &(row, row_weight) in &rows {
                for &(column, [from, to]) in columns {
                    let weight = row_weight * (to - from);
                    weights += weight;
                    for (sum, value) in sum.iter_mut().zip(map.texel(column, row)) {
                        *sum += weight * f64::from(*value);
                    }
                }
            }
            small.texel_mut(x as u32, y).copy_from_slice(&sum.map(|v| (v / weights) as f32));
        }
    }
    small
}

/// Cells of a fine division that a cell of a coarse one covers, and the covered range of each, in fine cells.
fn overlaps(cell: u32, coarse: u32, fine: u32) -> Vec<(u32, [f64; 2])> {
    let scale = f64::from(fine) / f64::from(coarse);
    let (from, to) = (f64::from(cell) * scale, f64::from(cell + 1) * scale);
    let covered = from.floor() as u32..(to.ceil() as u32).min(fine);
    covered.map(|i| (i, [f64::from(i).max(from), f64::from(i + 1).min(to)])).filter(|(_, [a, b])| b > a).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::vector::dot;

    #[test]
    fn coordinates_and_directions_are_inverse() {
        for (u, v) in [(0.5, 0.5), (0.1, 0.3), (0.9, 0.99), (0.25, 0.01)] {
            let d = direction(u, v);
            assert!((dot(d, d) - 1.0).abs() < 1e-12);
            let [x, y] = coordinates(d);
            assert!((x - u).abs() < 1e-12 && (y - v).abs() < 1e-9, "{u} {v}: {x} {y}");
        }
        assert!((direction(0.5, 0.5)[2] + 1.0).abs() < 1e-12, "the middle looks along -z");
        assert!((direction(0.75, 0.5)[0] - 1.0).abs() < 1e-12, "+x is right of the middle");
        assert!((direction(0.5, 0.0)[1] - 1.0).abs() < 1e-12, "the top looks up");
    }

    #[test]
    fn solid_angles_fill_the_sphere() {
        let map = Image::zeros(20, 10, 3);
        let total: f64 = (0..10).map(|y| 20.0 * solid_angle(&map, y)).sum();
        assert!((total - 4.0 * PI).abs() < 1e-12, "{total}");
    }

    #[test]
    fn shrinking_keeps_the_flux() {
        let mut map = Image::zeros(50, 25, 3);
        for (i, value) in map.data.iter_mut().enumerate() {
            *value = ((i * 7919) % 101) as f32;
        }
        let flux = |map: &Image| -> f64 {
            let row = |y| (0..map.width).map(|x| f64::from(map.texel(x, y)[1])).sum::<f64>() * solid_angle(map, y);
            (0..map.height).map(row).sum()
        };
        let small = shrunk(&map, 8);
        assert_eq!((small.width, small.height), (16, 8));
        assert!((flux(&small) / flux(&map) - 1.0).abs() < 1e-6, "{} {}", flux(&small), flux(&map));
    }

    #[test]
    fn reading_goes_round() {
        let mut map = Image::zeros(8, 4, 3);
        for x in 0..8 {
            map.texel_mut(x, 1).copy_from_slice(&[x as f32; 3]);
        }
        // Half way between the last column and the first.
        let [seam, ..] = bilinear(&map, [1.0, 1.5 / 4.0]);
        assert!((seam - 3.5).abs() < 1e-9, "{seam}");
        assert!((bilinear(&map, [2.5 / 8.0, 1.5 / 4.0])[2] - 2.0).abs() < 1e-9);
    }
}
