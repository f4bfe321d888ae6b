//! Appearance of errors: colour differences on a display.

use luthier_lut::Image;
use luthier_optics::Rgb;
use luthier_optics::color_difference::{ciede2000, lab};
use serde::{Deserialize, Serialize};

use crate::measure::directions::Pair;

luthier_lut::named! {
    /// Light for the comparison of colours. A colour is `pi f cos_theta_i` times the light, clipped per channel to the range of a Rec.709 display, and
    /// seen by an eye that is adapted to D65.
    #[derive(Serialize, Deserialize)]
    #[serde(rename_all = "kebab-case")]
    pub enum SeenLight("seen light") {
        /// D65, so bright that a white diffuser lit along its normal is the white of the display.
        Daylight = "daylight",
        /// Light 16 times as bright as `Daylight` (four stops): it shows errors in dark colours, and clips highlights.
        BrightDaylight = "daylight × 16",
        /// CIE illuminant A of the luminance of `Daylight`.
        Incandescent = "incandescent",
    }
}

impl SeenLight {
    /// Colour of the light, linear Rec.709. `Incandescent` has the tristimulus values (1.09850, 1, 0.35585) of illuminant A (CIE 15), converted by the
    /// matrix of IEC 61966-2-1.
    fn rgb(self) -> Rgb {
        match self {
            Self::Daylight => [1.0; 3],
            Self::BrightDaylight => [16.0; 3],
            Self::Incandescent => [1.8452, 0.8262, 0.2333],
        }
    }

    /// L*a*b* of a value of `f cos_theta_i`.
    fn lab(self, value: Rgb) -> [f64; 3] {
        let light = self.rgb();
        lab([0, 1, 2].map(|c: usize| (std::f64::consts::PI * value[c] * light[c]).clamp(0.0, 1.0)))
    }
}

/// Colour differences of a comparison under one light: CIEDE2000 with unit weights. Values that are not finite are left out.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Seen {
    /// The light.
    pub light: SeenLight,
    /// Largest difference.
    pub max: f64,
    /// 99th percentile, by nearest rank.
    pub p99: f64,
    /// Mean.
    pub mean: f64,
    /// Share of the pairs whose difference is above 1, which is just visible between two patches side by side.
    pub above_one: f64,
    /// The pair with the largest difference.
    pub worst: Option<Pair>,
}

/// Differences under one light, filled set by set.
#[derive(Debug, Clone, Default)]
struct Gathered {
    differences: Vec<f64>,
    worst: Option<(f64, Pair)>,
}

/// Differences under all lights, filled set by set.
#[derive(Debug, Clone, Default)]
pub(crate) struct SeenBy([Gathered; SeenLight::ALL.len()]);

impl SeenBy {
    pub(crate) fn add(&mut self, pairs: &[Pair], found: &[Rgb], expected: &[Rgb]) {
        for ((pair, found), expected) in pairs.iter().zip(found).zip(expected) {
            if !found.iter().chain(expected).all(|v| v.is_finite()) {
                continue;
            }
            for (light, gathered) in SeenLight::ALL.into_iter().zip(&mut self.0) {
                let difference = ciede2000(light.lab(*found), light.lab(*expected));
                if gathered.worst.is_none_or(|(worst, _)| difference > worst) {
                    gathered.worst = Some((difference, *pair));
                }
                gathered.differences.push(difference);
            }
        }
    }

    pub(crate) fn finish(self) -> Vec<Seen> {
        let seen = SeenLight::ALL.into_iter().zip(self.0).map(|(light, mut gathered)| {
            let differences = &mut gathered.differences;
            let count = differences.len();
            let sums = [differences.iter().sum(), differences.iter().filter(|d| **d > 1.0).count() as f64];
            let [mean, above_one] = sums.map(|sum: f64| if count == 0 { 0.0 } else { sum / count as f64 });
            differences.sort_by(f64::total_cmp);
            Seen {
                light,
                max: differences.last().copied().unwrap_or(0.0),
                p99: differences.get((count * 99).div_ceil(100).saturating_sub(1)).copied().unwrap_or(0.0),
                mean,
                above_one,
                worst: gathered.worst.map(|(_, pair)| pair),
            }
        });
        seen.collect()
    }
}

/// Mean and largest CIEDE2000 difference of the pixels of two RGB pictures of one size, `shown` being the tone curve of a value.
pub fn picture_color_difference(a: &Image, b: &Image, shown: impl Fn(f32) -> f32) -> [f64; 2] {
    let pixels = a.data.chunks_exact(3).zip(b.data.chunks_exact(3));
    let count = pixels.len().max(1) as f64;
    let (mut sum, mut max) = (0.0, 0.0_f64);
    for (a, b) in pixels {
        let [a, b] = [a, b].map(|p| lab([0, 1, 2].map(|c: usize| f64::from(shown(p[c])).clamp(0.0, 1.0))));
        let difference = ciede2000(a, b);
        sum += difference;
        max = max.max(difference);
    }
    [sum / count, max]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::FRAC_1_PI;

    use super::*;

    const UP: Pair = ([0.0, 0.0, 1.0], [0.0, 0.0, 1.0]);

    fn seen(found: &[Rgb], expected: &[Rgb]) -> Vec<Seen> {
        let mut seen = SeenBy::default();
        seen.add(&vec![UP; found.len()], found, expected);
        seen.finish()
    }

    /// Greys differ in lightness alone; CIEDE2000 of L* 50 and 52 is 2/S_L with S_L at the mean, 1 + 0.015 / sqrt(21).
    #[test]
    fn greys_by_hand() {
        let grey = |lightness: f64| {
            let f = (lightness + 16.0) / 116.0;
            [f * f * f * FRAC_1_PI; 3]
        };
        let found = seen(&[grey(50.0), grey(50.0)], &[grey(52.0), grey(50.0)]);
        let expected = 2.0 / (1.0 + 0.015 / 21.0_f64.sqrt());
        assert!((found[0].max - expected).abs() < 1e-9, "{found:?}");
        assert!((found[0].mean - 0.5 * expected).abs() < 1e-9 && found[0].above_one == 0.5);
        assert_eq!(found[1].max, 0.0, "16 times brighter both are clipped to white");
    }

    /// The dark is seen in bright light only; what is not finite is not seen here.
    #[test]
    fn lights_show_different_things() {
        let dark = |v: f64| [v * FRAC_1_PI, 0.0, 0.0];
        let found = seen(&[dark(0.001), [f64::NAN; 3]], &[dark(0.002), [0.0; 3]]);
        assert!(found[1].max > 5.0 * found[0].max, "{found:?}");
        assert!(found[0].max > 0.0 && found[2].max > found[0].max, "red is brighter in incandescent light");
    }

    /// Illuminant A has the luminance of D65.
    #[test]
    fn incandescent_light_is_as_bright_as_daylight() {
        let [r, g, b] = SeenLight::Incandescent.rgb();
        assert!((0.2126 * r + 0.7152 * g + 0.0722 * b - 1.0).abs() < 1e-3);
    }

    #[test]
    fn pictures_differ_by_their_pixels() {
        let a = Image { data: vec![0.5; 6], ..Image::zeros(2, 1, 3) };
        let mut b = a.clone();
        assert_eq!(picture_color_difference(&a, &b, |v| v), [0.0, 0.0]);
        b.data[0] = 0.6;
        let [mean, max] = picture_color_difference(&a, &b, |v| v);
        assert!(max > 1.0 && (mean - 0.5 * max).abs() < 1e-12, "{mean} {max}");
    }
}
