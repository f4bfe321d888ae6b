//! Reflectances at normal incidence as the lecture prints them, and as the built-in indices give them.
//!
//! W. Palubicki, lecture GRK 7, after N. Hoffman's course on physically based shading. Numbers are kept as printed, wrong ones
//! included: [`F0Entry::computed`] gives the spectral value of the named data set, and the difference is for the reader to judge. Zinc's
//! red (0.664 against 0.875) is supported by no published data; iron's and titanium's stem from other measurements.

use crate::Rgb;
use crate::color::Color;
use crate::constants::dataset;
use crate::interface::Interface;
use crate::ior::Ior;

/// A row of the lecture's table of metals, or of its one semiconductor.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct F0Entry {
    /// Name as printed.
    pub name: &'static str,
    /// F0 as printed: linear, Rec.709 primaries. Gold's red is above 1: out of gamut.
    pub linear: Rgb,
    /// F0 as printed: sRGB-encoded, eight bits.
    pub srgb: [u8; 3],
    /// Built-in data set to compare with.
    pub dataset: &'static str,
}

impl F0Entry {
    /// Reflectance of the data set at normal incidence from vacuum, spectral under D65; `None` if the set does not exist.
    pub fn computed(&self) -> Option<Rgb> {
        let below = dataset(self.dataset)?.ior.clone();
        Some(Interface { above: Ior::vacuum(), films: Vec::new(), below }.sampled(&Color::Spectral).rgb(1.0))
    }

    /// Computed less printed, per channel.
    pub fn difference(&self) -> Option<Rgb> {
        let computed = self.computed()?;
        Some([0, 1, 2].map(|c: usize| computed[c] - self.linear[c]))
    }
}

const fn row(name: &'static str, linear: Rgb, srgb: [u8; 3], dataset: &'static str) -> F0Entry {
    F0Entry { name, linear, srgb, dataset }
}

/// The table, in the printed order.
pub const F0_TABLE: [F0Entry; 12] = [
    row("Titanium", [0.542, 0.497, 0.449], [194, 187, 179], "ti"),
    row("Chromium", [0.549, 0.556, 0.554], [196, 197, 196], "cr"),
    row("Iron", [0.562, 0.565, 0.578], [198, 198, 200], "fe"),
    row("Nickel", [0.660, 0.609, 0.526], [212, 205, 192], "ni"),
    row("Platinum", [0.673, 0.637, 0.585], [214, 209, 201], "pt"),
    row("Copper", [0.955, 0.638, 0.538], [250, 209, 194], "cu"),
    row("Palladium", [0.733, 0.697, 0.652], [222, 217, 211], "pd"),
    row("Zinc", [0.664, 0.824, 0.850], [213, 234, 237], "zn"),
    row("Gold", [1.022, 0.782, 0.344], [255, 229, 158], "au"),
    row("Aluminum", [0.913, 0.922, 0.924], [245, 246, 246], "al"),
    row("Silver", [0.972, 0.960, 0.915], [252, 250, 245], "ag"),
    row("Silicon", [0.345, 0.369, 0.426], [159, 164, 174], "si"),
];

/// A class of dielectrics and its printed range of F0.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DielectricF0 {
    /// Class as printed.
    pub name: &'static str,
    /// Least and greatest F0, linear; equal where one number is printed.
    pub linear: [f64; 2],
    /// Least and greatest F0 as printed: sRGB-encoded, eight bits.
    pub srgb: [u8; 2],
}

/// The lecture's table of dielectrics, in the printed order.
pub const DIELECTRIC_F0: [DielectricF0; 4] = [
    DielectricF0 { name: "Water", linear: [0.020, 0.020], srgb: [39, 39] },
    DielectricF0 { name: "Plastic, Glass", linear: [0.040, 0.045], srgb: [56, 60] },
    DielectricF0 { name: "Crystalware, Gems", linear: [0.050, 0.080], srgb: [63, 80] },
    DielectricF0 { name: "Diamond-like", linear: [0.100, 0.200], srgb: [90, 124] },
];

/// Names of the substances of both tables, those of [`F0_TABLE`] first. A class of two substances has two names.
pub const F0_NAMES: [&str; 18] = [
    "titanium",
    "chromium",
    "iron",
    "nickel",
    "platinum",
    "copper",
    "palladium",
    "zinc",
    "gold",
    "aluminum",
    "silver",
    "silicon",
    "water",
    "plastic",
    "glass",
    "crystalware",
    "gems",
    "diamond-like",
];

/// The F0 as printed of a substance, by its name in [`F0_NAMES`]; the middle of the range where a range is printed. Gold's red is above 1.
///
/// ```
/// use luthier_optics::f0_table::printed_f0;
///
/// assert_eq!(printed_f0("copper"), Some([0.955, 0.638, 0.538]));
/// assert_eq!(printed_f0("water"), Some([0.02; 3]));
/// ```
pub fn printed_f0(name: &str) -> Option<Rgb> {
    let number = F0_NAMES.iter().position(|known| *known == name)?;
    let class = match number.checked_sub(F0_TABLE.len()) {
        None => return Some(F0_TABLE[number].linear),
        Some(0) => 0,
        Some(1 | 2) => 1,
        Some(3 | 4) => 2,
        Some(_) => 3,
    };
    let [least, greatest] = DIELECTRIC_F0[class].linear;
    Some([0.5 * (least + greatest); 3])
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Computed less printed, three digits: the same sums over the same tables by another program.
    const DIFFERENCES: [(&str, Rgb); 12] = [
        ("Titanium", [0.077, 0.082, 0.094]),
        ("Chromium", [0.001, 0.000, 0.000]),
        ("Iron", [-0.032, -0.052, -0.084]),
        ("Nickel", [0.037, 0.031, 0.037]),
        ("Platinum", [0.006, 0.003, -0.001]),
        ("Copper", [-0.023, -0.015, -0.016]),
        ("Palladium", [0.000, 0.000, 0.000]),
        ("Zinc", [0.211, 0.045, 0.005]),
        ("Gold", [0.016, -0.054, 0.021]),
        ("Aluminum", [-0.006, -0.006, -0.002]),
        ("Silver", [0.017, 0.024, 0.063]),
        ("Silicon", [0.000, -0.001, 0.001]),
    ];

    #[test]
    fn differences_from_the_lecture_are_the_known_ones() {
        for (entry, (name, expected)) in F0_TABLE.iter().zip(DIFFERENCES) {
            assert_eq!(entry.name, name);
            let found = entry.difference().unwrap();
            for c in 0..3 {
                assert!((found[c] - expected[c]).abs() < 6.5e-4, "{name}: {found:?} against {expected:?}");
            }
        }
    }

    fn encode(linear: f64) -> u8 {
        let x = linear.clamp(0.0, 1.0);
        let v = if x <= 0.003_130_8 { 12.92 * x } else { 1.055 * libm::pow(x, 1.0 / 2.4) - 0.055 };
        (255.0 * v).round() as u8
    }

    /// The printed bytes are the printed floats through the curve of IEC 61966-2-1, give or take the rounding of the floats.
    #[test]
    fn bytes_are_the_floats_encoded() {
        for entry in F0_TABLE {
            for c in 0..3 {
                assert!(encode(entry.linear[c]).abs_diff(entry.srgb[c]) <= 1, "{}", entry.name);
            }
        }
        for class in DIELECTRIC_F0 {
            for (linear, byte) in class.linear.into_iter().zip(class.srgb) {
                assert!(encode(linear).abs_diff(byte) <= 1, "{}: {}", class.name, encode(linear));
            }
        }
    }

    /// Bytes of the slides, of each substance by its name: least and greatest of each channel.
    #[test]
    fn substances_have_the_bytes_of_the_slides() {
        for (name, bytes) in F0_NAMES.iter().zip(F0_TABLE.iter().map(|entry| entry.srgb.map(|byte| [byte; 2])).chain(
            ["water", "plastic", "glass", "crystalware", "gems", "diamond-like"].map(|name| {
                let range = match name {
                    "water" => [39, 39],
                    "plastic" | "glass" => [56, 60],
                    "crystalware" | "gems" => [63, 80],
                    _ => [90, 124],
                };
                [range; 3]
            }),
        )) {
            for (linear, [least, greatest]) in printed_f0(name).unwrap().into_iter().zip(bytes) {
                let found = encode(linear);
                assert!(found.saturating_add(1) >= least && found <= greatest.saturating_add(1), "{name}: {found}");
            }
        }
        assert!(F0_TABLE.iter().zip(F0_NAMES).all(|(entry, name)| entry.name.to_lowercase() == name));
        assert_eq!(printed_f0("Gold"), None);
    }

    #[test]
    fn real_dielectrics_lie_in_their_classes() {
        for (class, id) in [(0, "water"), (1, "n_bk7"), (2, "al2o3_o"), (3, "diamond")] {
            let entry = F0Entry { name: "", linear: [0.0; 3], srgb: [0; 3], dataset: id };
            let green = entry.computed().unwrap()[1];
            let [low, high] = DIELECTRIC_F0[class].linear;
            assert!(green > low - 1e-3 && green < high + 1e-3, "{id}: {green}");
        }
    }
}
