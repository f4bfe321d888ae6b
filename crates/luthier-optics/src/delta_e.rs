//! CIEDE2000 between reflectances seen under D65.

use std::f64::consts::{PI, TAU};

use crate::Rgb;

/// Linear Rec.709 to XYZ over the white of D65, rows X, Y, Z (IEC 61966-2-1); each row sums to 1.
const TO_XYZ: [[f64; 3]; 3] = [[0.4339, 0.3762, 0.1899], [0.2126, 0.7152, 0.0722], [0.0178, 0.1094, 0.8728]];

/// CIE 1976 L*a*b* of a linear Rec.709 colour; what is below black is black.
pub fn lab(rgb: Rgb) -> [f64; 3] {
    let f = |row: [f64; 3]| {
        let t = (row[0] * rgb[0] + row[1] * rgb[1] + row[2] * rgb[2]).max(0.0);
        if t > 216.0 / 24389.0 { libm::cbrt(t) } else { (24389.0 / 27.0 * t + 16.0) / 116.0 }
    };
    let [x, y, z] = TO_XYZ.map(f);
    [116.0 * y - 16.0, 500.0 * (x - y), 200.0 * (y - z)]
}

/// CIEDE2000 with unit weights (Sharma, Wu and Dalal 2005).
pub fn ciede2000([l1, a1, b1]: [f64; 3], [l2, a2, b2]: [f64; 3]) -> f64 {
    let seventh = |c: f64| {
        let c7 = libm::pow(c, 7.0);
        (c7 / (c7 + 6_103_515_625.0)).sqrt()
    };
    let g = 0.5 * (1.0 - seventh(0.5 * (libm::hypot(a1, b1) + libm::hypot(a2, b2))));
    let polar = |a: f64, b: f64| {
        let a = (1.0 + g) * a;
        let angle = if a == 0.0 && b == 0.0 { 0.0 } else { libm::atan2(b, a) };
        (libm::hypot(a, b), if angle < 0.0 { angle + TAU } else { angle })
    };
    let ((c1, h1), (c2, h2)) = (polar(a1, b1), polar(a2, b2));
    let turn = match h2 - h1 {
        _ if c1 * c2 == 0.0 => 0.0,
        d if d > PI => d - TAU,
        d if d < -PI => d + TAU,
        d => d,
    };
    let d_h = 2.0 * (c1 * c2).sqrt() * libm::sin(0.5 * turn);
    let (d_l, d_c, l, c) = (l2 - l1, c2 - c1, 0.5 * (l1 + l2), 0.5 * (c1 + c2));
    let h = match h1 + h2 {
        sum if c1 * c2 == 0.0 => sum,
        sum if (h1 - h2).abs() <= PI => 0.5 * sum,
        sum if sum < TAU => 0.5 * (sum + TAU),
        sum => 0.5 * (sum - TAU),
    };
    let cos = |times: f64, degrees: f64| libm::cos(times * h + degrees.to_radians());
    let t = 1.0 - 0.17 * cos(1.0, -30.0) + 0.24 * cos(2.0, 0.0) + 0.32 * cos(3.0, 6.0) - 0.20 * cos(4.0, -63.0);
    let l_50 = (l - 50.0) * (l - 50.0);
    let s_l = 1.0 + 0.015 * l_50 / (20.0 + l_50).sqrt();
    let (s_c, s_h) = (1.0 + 0.045 * c, 1.0 + 0.015 * c * t);
    let away = (h.to_degrees() - 275.0) / 25.0;
    let rotation = -2.0 * seventh(c) * libm::sin((60.0 * libm::exp(-away * away)).to_radians());
    let [l, c, h] = [d_l / s_l, d_c / s_c, d_h / s_h];
    (l * l + c * c + h * h + rotation * c * h).max(0.0).sqrt()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Pairs 1, 4, 7, 10, 16, 20 and 25 of the test data of Sharma, Wu and Dalal 2005.
    #[test]
    fn published_pairs() {
        for (one, two, expected) in [
            ([50.0, 2.6772, -79.7751], [50.0, 0.0, -82.7485], 2.0425),
            ([50.0, -1.3802, -84.2814], [50.0, 0.0, -82.7485], 1.0000),
            ([50.0, 0.0, 0.0], [50.0, -1.0, 2.0], 2.3669),
            ([50.0, 2.49, -0.001], [50.0, -2.49, 0.0010], 7.1792),
            ([50.0, 2.5, 0.0], [50.0, 0.0, -2.5], 4.3065),
            ([50.0, 2.5, 0.0], [58.0, 24.0, 15.0], 19.4535),
            ([60.2574, -34.0099, 36.2677], [60.4626, -34.1751, 39.4387], 1.2644),
        ] {
            assert!((ciede2000(one, two) - expected).abs() < 5e-5, "{one:?}: {}", ciede2000(one, two));
            assert!((ciede2000(two, one) - expected).abs() < 5e-5);
        }
    }

    #[test]
    fn white_is_neutral() {
        let [l, a, b] = lab([1.0; 3]);
        assert!((l - 100.0).abs() < 1e-9 && a.abs() < 1e-9 && b.abs() < 1e-9, "{l} {a} {b}");
        assert_eq!(lab([0.0; 3]), [0.0; 3]);
    }
}
