//! A landscape.

use super::patterns::{clouds, mix, noise, random, smooth};
use crate::vector::{dot, unit};

/// Direction of the sun.
const SUN: [f64; 3] = [-0.52, 0.62, 0.58];

pub(super) fn clear_day(d: [f64; 3]) -> [f64; 3] {
    let sun = unit(SUN);
    let cosine = dot(d, sun);
    let azimuth = libm::atan2(d[0], d[2]);
    let across = (d[0] * d[0] + d[2] * d[2]).sqrt().max(1e-9);
    let height = d[1] / across;
    // A wood on one side, hills all around.
    let wood = smooth(0.5, 1.0, libm::cos(azimuth - 2.4));
    let crowns = 0.06
        + 0.13
            * wood
            * (0.55 + 0.45 * noise([9.0 * azimuth + 50.0, 0.0, 0.0]) + 0.25 * noise([31.0 * azimuth + 90.0, 0.0, 5.0]));
    let hills = 0.035 + 0.05 * noise([2.0 * azimuth + 20.0, 3.0, 0.0]);
    if height < 0.0 {
        return meadow(d, cosine, height);
    }
    if height < crowns && wood > 0.05 {
        let leaves = noise([60.0 * azimuth + 200.0, 60.0 * height, 2.0]);
        let lit = 0.35 + 0.65 * smooth(0.3, 0.7, leaves) * smooth(-0.6, 0.8, libm::cos(azimuth - 2.4));
        return [0.07, 0.105, 0.03].map(|v| v * lit);
    }
    if height < hills {
        let fields = random((azimuth * 6.0).floor() as i64, (height * 60.0).floor() as i64, 77);
        let haze = mix([0.19, 0.22, 0.08], [0.34, 0.42, 0.52], 0.55);
        return haze.map(|v| v * (0.85 + 0.3 * fields));
    }
    // Brighter towards the horizon and about the sun, as skies are.
    let air = 1.0 / (0.22 + d[1].max(0.0));
    let blue = mix([0.1, 0.23, 0.56], [0.5, 0.62, 0.78], smooth(1.0, 4.5, air));
    let glow = 0.9 * libm::exp(9.0 * (cosine - 1.0)) + 2.5 * libm::exp(160.0 * (cosine - 1.0));
    let wisp = 0.5
        * smooth(0.5, 0.72, clouds([d[0] / (0.3 + d[1]), 1.0, 2.2 * d[2] / (0.3 + d[1])], 1.3))
        * smooth(0.05, 0.3, d[1]);
    let base = mix(blue, [0.95, 0.96, 0.98], wisp);
    // A quarter of a degree; a disc as bright as the real one would be mere speckle in any map.
    let disc = 2600.0 * smooth(0.999_955, 0.999_975, cosine);
    let shine = [1.0, 0.94, 0.84].map(|c| c * (glow + disc));
    [0, 1, 2].map(|c| base[c] + shine[c])
}

fn meadow(d: [f64; 3], cosine: f64, height: f64) -> [f64; 3] {
    let [x, z] = [d[0], d[2]].map(|v| v / -d[1].min(-1e-4));
    // A path, grass in tufts, flowers nearby.
    let path = (x - 0.4 * libm::sin(0.6 * z) - 0.8).abs();
    let near = smooth(-0.06, -0.5, height);
    let tufts = noise([6.0 * x + 300.0, 6.0 * z + 300.0, 1.0]) * near + 0.5 * (1.0 - near);
    let patches = noise([0.7 * x + 90.0, 0.7 * z + 90.0, 4.0]);
    let grass = mix([0.11, 0.17, 0.035], [0.24, 0.25, 0.07], patches);
    // A flower in some cells of a grid.
    let [i, j] = [16.0 * x, 16.0 * z].map(f64::floor);
    let off = [16.0 * x - i - 0.5, 16.0 * z - j - 0.5];
    let blooms = random(i as i64, j as i64, 31) > 0.97 && off[0] * off[0] + off[1] * off[1] < 0.08;
    let ground = if path < 0.22 {
        [0.36, 0.3, 0.21]
    } else if blooms && near > 0.5 {
        [0.7, 0.66, 0.3]
    } else {
        grass
    };
    let sheen = 0.9 + 0.3 * smooth(0.2, -0.8, cosine);
    ground.map(|v| v * sheen * (0.6 + 0.7 * tufts))
}
