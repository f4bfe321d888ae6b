//! Tests of LDR-FLIP against the implementation of its authors.

use super::*;
use crate::picture::PIXELS_PER_DEGREE;

const WIDTH: u32 = 48;
const HEIGHT: u32 = 40;

/// f32 and filters cut into look-up tables there, f64 here.
const TOLERANCE: f64 = 2e-4;

/// A pattern of eight-bit sRGB values, changed by `change`, made linear.
fn picture(change: impl Fn(u32, u32, u32) -> u32) -> Image {
    let mut image = Image::zeros(WIDTH, HEIGHT, 3);
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            for c in 0..3 {
                let value = (x * (5 + c) + y * (3 + 2 * c) + x * y / (7 + c)) % 256;
                let v = f64::from((value + change(x, y, c)) % 256) / 255.0;
                let linear = if v <= 0.04045 { v / 12.92 } else { libm::pow((v + 0.055) / 1.055, 2.4) };
                image.texel_mut(x, y)[c as usize] = linear as f32;
            }
        }
    }
    image
}

/// Reference values are of the authors' implementation: the Python package `flip-evaluator` 1.7,
/// `evaluate(reference, test, "LDR", applyMagma=False)` with its default 67.02 pixels per degree, on the same patterns.
#[test]
fn values_of_the_authors_implementation() {
    let reference = picture(|_, _, _| 0);
    let patch = picture(|x, y, c| if (10..30).contains(&x) && (8..26).contains(&y) { 40 * (c + 1) } else { 0 });
    let noise = picture(|x, y, _| (x * 13 + y * 7) % 9);
    let places = [(0, 0), (15, 12), (29, 25), (30, 25), (40, 35), (47, 39)];
    let cases = [
        (patch, 0.254_971_39, [3.230_9e-5, 0.904_235_96, 0.759_410_44, 0.551_720_32, 0.0, 0.0]),
        (noise, 0.196_432_55, [0.056_308_27, 0.145_577_79, 0.132_093_34, 0.145_906_28, 0.142_443_87, 0.110_429_42]),
    ];
    for (test, mean, values) in cases {
        let map = flip(&reference, &test, PIXELS_PER_DEGREE);
        let found = map.data.iter().map(|v| f64::from(*v)).sum::<f64>() / map.data.len() as f64;
        assert!((found - mean).abs() < TOLERANCE, "mean {found} {mean}");
        for ((x, y), value) in places.into_iter().zip(values) {
            let found = f64::from(map.texel(x, y)[0]);
            assert!((found - value).abs() < TOLERANCE, "{x} {y}: {found} {value}");
        }
        let swapped = flip(&test, &reference, PIXELS_PER_DEGREE);
        assert_eq!(map, swapped);
    }
}

/// Black against white, by the source of the pictures above: 0.967400730.
#[test]
fn black_and_white() {
    let [black, white] = [0.0, 1.0].map(|v| Image { data: vec![v; 300], ..Image::zeros(10, 10, 3) });
    let map = flip(&black, &white, PIXELS_PER_DEGREE);
    assert!(map.data.iter().all(|v| (f64::from(*v) - 0.967_400_73).abs() < TOLERANCE), "{:?}", map.data[0]);
    assert!(flip(&white, &white, PIXELS_PER_DEGREE).data.iter().all(|v| *v == 0.0));
}
