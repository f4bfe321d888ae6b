//! Surroundings with detail, from the project's own formulas, for tests and measurements, and for use without a
//! picture.

mod field;
mod patterns;
mod rooms;

use luthier_lut::Image;
use rayon::prelude::*;

use self::patterns::{clouds, meets, mix, random, smooth};
use crate::environment::Environment;
use crate::error::{EnvironmentError, setting};
use crate::panorama::texel_direction;
use crate::vector::{dot, unit};

luthier_lut::named! {
    /// Surroundings made of formulas and fixed random numbers.
    ///
    /// ```
    /// use luthier_environment::Scenery;
    ///
    /// let map = Scenery::NightStreet.map(16)?;
    /// assert_eq!((map.width, map.height), (32, 16));
    /// assert_eq!(Scenery::from_name("night-street"), Some(Scenery::NightStreet));
    /// # Ok::<(), luthier_environment::EnvironmentError>(())
    /// ```
    pub enum Scenery("scenery") {
        /// A sun of three degrees among soft clouds, over a field.
        CloudySun = "cloudy-sun",
        /// A dark room with four strip lights and a window of six panes.
        StripStudio = "strip-studio",
        /// A street at night: a hundred lamps of half a degree to two, lit windows, a faint sky.
        NightStreet = "night-street",
        /// A light studio: two large softboxes, a row of windows, a black flag.
        SoftboxStudio = "softbox-studio",
        /// A sun of half a degree in a clear sky over meadows, hills and a wood.
        ClearDay = "clear-day",
        /// A room at dusk: a lamp, a pendant, shelves of books, a window.
        EveningRoom = "evening-room",
    }
}

impl Scenery {
    /// The map with this many rows. Each texel is the mean of sixteen points.
    ///
    /// # Errors
    /// [`EnvironmentError`] for fewer than 2 or more than 4096 rows.
    pub fn map(self, rows: u32) -> Result<Image, EnvironmentError> {
        if !(2..=4096).contains(&rows) {
            return Err(setting("rows", rows.to_string(), "2 to 4096"));
        }
        let lamps = lamps();
        let fine = Image { width: 8 * rows, height: 4 * rows, channels: 3, data: Vec::new() };
        let mut map = Image::zeros(2 * rows, rows, 3);
        map.data.par_chunks_mut(3).enumerate().for_each(|(n, texel)| {
            let (x, y) = (n as u32 % (2 * rows), n as u32 / (2 * rows));
            let mut sum = [0.0; 3];
            for i in 0..16 {
                let value = self.radiance(texel_direction(&fine, 4 * x + i % 4, 4 * y + i / 4), &lamps);
                (0..3).for_each(|c| sum[c] += value[c] / 16.0);
            }
            texel.copy_from_slice(&sum.map(|v| v as f32));
        });
        Ok(map)
    }

    /// The environment with this many rows.
    ///
    /// # Errors
    /// As [`Scenery::map`].
    pub fn environment(self, rows: u32) -> Result<Environment, EnvironmentError> {
        Environment::new(self.map(rows)?)
    }

    fn radiance(self, d: [f64; 3], lamps: &[Lamp]) -> [f64; 3] {
        match self {
            Self::CloudySun => cloudy_sun(d),
            Self::StripStudio => strip_studio(d),
            Self::NightStreet => night_street(d, lamps),
            Self::SoftboxStudio => rooms::softbox_studio(d),
            Self::ClearDay => field::clear_day(d),
            Self::EveningRoom => rooms::evening_room(d),
        }
    }
}

fn cloudy_sun(d: [f64; 3]) -> [f64; 3] {
    let sun = unit([0.5, 0.55, 0.67]);
    let cosine = dot(d, sun);
    if d[1] < 0.0 {
        return [0.10, 0.11, 0.05].map(|v| v * (0.4 + 1.2 * clouds(d, 12.0)));
    }
    let sky = mix([0.55, 0.65, 0.8], [0.12, 0.25, 0.6], smooth(0.0, 0.7, d[1]));
    let cover = smooth(0.45, 0.62, clouds([d[0], 2.5 * d[1], d[2]], 3.0));
    let bright = 0.7 + 1.6 * libm::exp(6.0 * (cosine - 1.0));
    let cloud = [bright; 3];
    let glow = 2.0 * libm::exp(120.0 * (cosine - 1.0));
    // It shines through the thinner parts of a cloud.
    let disc = 180.0 * smooth(0.9985, 0.9988, cosine) * (1.0 - 0.6 * cover);
    let shine = [1.0, 0.93, 0.8].map(|c| c * (glow + disc));
    let base = mix(sky, cloud, cover);
    [0, 1, 2].map(|c| base[c] + shine[c])
}

fn strip_studio(d: [f64; 3]) -> [f64; 3] {
    let strips = [
        ([-1.2, 2.0, 0.6], [0.08, 0.0, 0.0], [0.0, 0.0, 1.3], [14.0, 13.0, 11.5]),
        ([0.9, 2.0, 0.4], [0.05, 0.0, 0.0], [0.0, 0.0, 1.6], [18.0, 18.0, 18.5]),
        ([-2.0, 0.3, 0.9], [0.0, 0.9, 0.0], [0.0, 0.0, 0.1], [9.0, 10.5, 13.0]),
        ([2.0, 0.2, 1.5], [0.0, 1.0, 0.0], [0.0, 0.0, 0.06], [16.0, 14.0, 12.0]),
    ];
    for (middle, along, across, radiance) in strips {
        if meets(d, middle, along, across).is_some() {
            return radiance;
        }
    }
    if let Some([u, v]) = meets(d, [-0.7, 0.5, 2.4], [0.7, 0.0, 0.0], [0.0, 0.6, 0.0]) {
        let frame = [1.5 * (u + 1.0), v + 1.0].map(|w| (w - w.floor() - 0.5).abs());
        if frame[0] < 0.45 && frame[1] < 0.46 {
            return [3.2, 3.6, 4.2];
        }
    }
    let wall = 0.05 + 0.05 * clouds(d, 4.0) + 0.06 * smooth(-0.2, 1.0, d[1]);
    [1.0, 0.97, 0.92].map(|c| c * wall)
}

struct Lamp {
    direction: [f64; 3],
    /// Cosine of its rim.
    rim: f64,
    radiance: [f64; 3],
}

fn lamps() -> Vec<Lamp> {
    let lamps = (0..100).map(|i| {
        let [azimuth, height, size, power, tint] = [1, 2, 3, 4, 5].map(|k| random(i, k, 7919));
        let (sin, cos) = libm::sincos(2.0 * std::f64::consts::PI * azimuth);
        let y = -0.05 + 0.75 * height * height;
        let r = (1.0 - y * y).sqrt();
        let angle = (0.25 + 0.75 * size * size) * std::f64::consts::PI / 180.0;
        let tint = mix([1.0, 0.6, 0.25], [0.8, 0.9, 1.0], tint);
        let radiance = tint.map(|c| c * (6.0 + 90.0 * power * power * power));
        Lamp { direction: [r * sin, y, r * cos], rim: libm::cos(angle), radiance }
    });
    lamps.collect()
}

fn night_street(d: [f64; 3], lamps: &[Lamp]) -> [f64; 3] {
    if let Some(lamp) = lamps.iter().find(|lamp| dot(lamp.direction, d) > lamp.rim) {
        return lamp.radiance;
    }
    // Houses: windows on a lattice of azimuths and heights, a third of them lit.
    let across = (d[0] * d[0] + d[2] * d[2]).sqrt().max(1e-9);
    let [column, row] = [libm::atan2(d[0], d[2]) * 12.0, d[1] / across * 9.0];
    let inside = [column, row].map(|v| (v - v.floor() - 0.5).abs());
    let house = 2.0 + 3.0 * random((column / 5.0).floor() as i64, 11, 3);
    if (0.0..house).contains(&row) {
        let window = random(column.floor() as i64, row.floor() as i64, 5);
        if window < 0.33 && inside[0] < 0.28 && inside[1] < 0.33 {
            return [1.3, 0.95, 0.5].map(|c| c * (0.4 + 3.0 * window));
        }
        return [0.012, 0.011, 0.012];
    }
    if d[1] < 0.0 {
        return [0.03, 0.027, 0.022].map(|v| v * (0.5 + clouds(d, 20.0)));
    }
    mix([0.03, 0.026, 0.024], [0.004, 0.006, 0.012], smooth(0.0, 0.6, d[1]))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn sceneries_have_light_and_detail() {
        for scenery in Scenery::ALL {
            assert_eq!(Scenery::from_name(scenery.name()), Some(scenery));
            let map = scenery.map(64).unwrap();
            let values: Vec<f64> = map.texels().map(|texel| f64::from(texel[1])).collect();
            let mean = values.iter().sum::<f64>() / values.len() as f64;
            let peak = values.iter().copied().fold(0.0, f64::max);
            assert!(values.iter().all(|v| *v > 0.0 && v.is_finite()), "{scenery:?}");
            assert!(peak > 15.0 * mean, "{scenery:?}: {peak} {mean}");
        }
        assert!(Scenery::CloudySun.map(1).is_err() && Scenery::from_name("studio").is_none());
    }
}
