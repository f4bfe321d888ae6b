//! Axes of tables: the mapping between a quantity and the coordinate of a texel.

use serde::{Deserialize, Serialize};

/// How an axis coordinate `u` in 0..=1 becomes a value between `min` and `max`.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(tag = "kind", rename_all = "kebab-case")]
pub enum Mapping {
    /// `value = min + (max - min) u`.
    Linear,
    /// `value = min + (max - min) u^exponent`.
    Power {
        /// Exponent of u; 8 for Elek's angle axis, 2 for a square-root axis.
        exponent: f64,
    },
    /// `value = min + (max - min) bend u / (1 + bend - u)`: nodes crowd at `min`, the more the smaller the bend. One quotient both ways.
    Rational {
        /// Above 0.
        bend: f64,
    },
    /// `value = min (max/min)^u`; both ends positive.
    Logarithmic,
    /// Linear and repeating: node `i` lies at `i/size`, and `u` is taken modulo 1.
    Periodic,
    /// Linear, and nothing lies between nodes: as the y axis of a tile, its rows are side by side, see [`crate::AtlasLayout`].
    Apart,
}

/// One axis of a table. Nodes are texel centres; the first lies at `u = 0`, and unless the axis is
/// periodic the last lies at `u = 1`.
///
/// ```
/// use luthier_lut::{Axis, Mapping};
///
/// let (quantity, unit) = ("alpha".to_owned(), String::new());
/// let axis = Axis { quantity, unit, min: 0.01, max: 1.0, size: 3, mapping: Mapping::Logarithmic };
/// assert!((axis.node(1) - 0.1).abs() < 1e-12);
/// // Values outside are clamped.
/// assert_eq!((axis.index(0.001), axis.index(2.0)), (0.0, 2.0));
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Axis {
    /// Name of the quantity, as in the conventions: `cos_theta`, `alpha`, `theta_h`.
    pub quantity: String,
    /// Unit, empty for pure numbers.
    pub unit: String,
    /// Value at `u = 0`.
    pub min: f64,
    /// Value at `u = 1`.
    pub max: f64,
    /// Number of nodes, at least 2.
    pub size: u32,
    /// Mapping from u to the value.
    pub mapping: Mapping,
}

impl Axis {
    /// The value at coordinate `u` in 0..=1.
    pub fn decode(&self, u: f64) -> f64 {
        match self.mapping {
            Mapping::Linear | Mapping::Periodic | Mapping::Apart => self.min + (self.max - self.min) * u,
            Mapping::Power { exponent } => self.min + (self.max - self.min) * libm::pow(u, exponent),
            Mapping::Rational { bend } => self.min + (self.max - self.min) * (bend * u / (bend + (1.0 - u))),
            Mapping::Logarithmic => self.min * libm::pow(self.max / self.min, u),
        }
    }

    /// The coordinate of a value, clamped to 0..=1 (periodic: wrapped to 0..1).
    pub fn encode(&self, value: f64) -> f64 {
        let t = (value - self.min) / (self.max - self.min);
        match self.mapping {
            Mapping::Linear | Mapping::Apart => t.clamp(0.0, 1.0),
            Mapping::Periodic => {
                // A hair below a whole period rounds up to 1, which is 0 again.
                let wrapped = t - libm::floor(t);
                if wrapped < 1.0 { wrapped } else { 0.0 }
            }
            Mapping::Power { exponent } => libm::pow(t.clamp(0.0, 1.0), 1.0 / exponent),
            Mapping::Rational { bend } => {
                let t = t.clamp(0.0, 1.0);
                (1.0 + bend) * t / (t + bend)
            }
            Mapping::Logarithmic => {
                let v = value.clamp(self.min, self.max);
                (libm::log(v / self.min) / libm::log(self.max / self.min)).clamp(0.0, 1.0)
            }
        }
    }

    /// The value at node `i`.
    pub fn node(&self, i: u32) -> f64 {
        self.decode(self.node_coordinate(f64::from(i)))
    }

    /// The coordinate `u` of a (fractional) node index.
    pub fn node_coordinate(&self, index: f64) -> f64 {
        index / f64::from(self.intervals())
    }

    /// The fractional node index of a value: 0 at the first node.
    pub fn index(&self, value: f64) -> f64 {
        self.encode(value) * f64::from(self.intervals())
    }

    /// Number of intervals between nodes that interpolation can fall into.
    pub fn intervals(&self) -> u32 {
        match self.mapping {
            Mapping::Periodic => self.size,
            _ => self.size - 1,
        }
    }
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// encode(decode(u)) goes through two powers or two logarithms, each good to some units in the last place, and
    /// through a division by a range that is at least a third of the maximum.
    const INVERSE_TOLERANCE: f64 = 1e-12;

    fn axis(mapping: Mapping, min: f64, max: f64, size: u32) -> Axis {
        Axis { quantity: "alpha".into(), unit: String::new(), min, max, size, mapping }
    }

    /// Power axes begin at 0, as every table's do: a power flattens the axis at its minimum, and only around 0 are
    /// there digits enough to invert that.
    fn any_axis() -> impl Strategy<Value = Axis> {
        let mapping = prop_oneof![
            Just(Mapping::Linear),
            (0.25..8.0).prop_map(|exponent| Mapping::Power { exponent }),
            (0.02..2.0).prop_map(|bend| Mapping::Rational { bend }),
            Just(Mapping::Logarithmic),
        ];
        (mapping, 1e-3..1.0, 1.5..100.0, 2..2000u32).prop_map(|(mapping, min, ratio, size)| {
            let start = if matches!(mapping, Mapping::Power { .. }) { 0.0 } else { min };
            axis(mapping, start, min * ratio, size)
        })
    }

    proptest! {
        #[test]
        fn encode_inverts_decode(axis in any_axis(), u in 0.0..=1.0) {
            let again = axis.encode(axis.decode(u));
            prop_assert!((again - u).abs() <= INVERSE_TOLERANCE, "{u} {again}");
        }

        #[test]
        fn decode_ascends_from_min_to_max(axis in any_axis(), u in 0.0..1.0, step in 1e-6..1.0) {
            let [lower, upper] = [u, f64::min(u + step, 1.0)].map(|u| axis.decode(u));
            prop_assert!(axis.min <= lower && lower <= upper && upper <= axis.max * (1.0 + f64::EPSILON));
        }

        #[test]
        fn nodes_have_whole_indices(axis in any_axis(), node in 0..2000u32) {
            let node = node % axis.size;
            prop_assert!((axis.index(axis.node(node)) - f64::from(node)).abs() < 1e-8);
        }

        #[test]
        fn values_outside_clamp(axis in any_axis(), beyond in 0.0..10.0) {
            prop_assert_eq!(axis.encode(axis.min - beyond), 0.0);
            prop_assert_eq!(axis.encode(axis.max + beyond), 1.0);
        }

        #[test]
        fn periodic_axes_wrap(value in -50.0..50.0, turns in -3..=3, size in 2..64u32) {
            let axis = axis(Mapping::Periodic, 2.0, 5.0, size);
            let u = axis.encode(value);
            prop_assert!((0.0..1.0).contains(&u));
            let again = axis.encode(value + 3.0 * f64::from(turns));
            let apart = (u - again).abs();
            prop_assert!(apart.min(1.0 - apart) < 1e-12);
            prop_assert!(axis.index(value) < f64::from(size));
        }
    }

    #[test]
    fn a_hair_below_the_period_is_its_start() {
        assert_eq!(axis(Mapping::Periodic, 0.0, 1.0, 4).encode(-1e-20), 0.0);
    }

    #[test]
    fn known_points() {
        let half_pi = std::f64::consts::FRAC_PI_2;
        // Elek 2010: angle = (pi/2) u^8, read with u = (2 angle / pi)^(1/8).
        let angle = axis(Mapping::Power { exponent: 8.0 }, 0.0, half_pi, 512);
        assert_eq!(angle.decode(0.5), half_pi / 256.0);
        assert_eq!(angle.encode(half_pi / 256.0), 0.5);
        let alpha = axis(Mapping::Logarithmic, 0.01, 1.0, 3);
        assert!((alpha.node(1) - 0.1).abs() < 1e-15);
        let ends = |axis: &Axis| (axis.index(axis.min), axis.index(axis.max));
        assert_eq!(ends(&angle), (0.0, 511.0));
        assert_eq!(ends(&alpha), (0.0, 2.0));
        // b u / (1 + b - u) by hand: (1/8) / (3/4) and (3/16) / (1/2).
        let bent = axis(Mapping::Rational { bend: 0.25 }, 0.0, 1.0, 5);
        assert_eq!([0, 2, 3, 4].map(|i| bent.node(i)), [0.0, 1.0 / 6.0, 0.375, 1.0]);
        assert!((bent.encode(1.0 / 6.0) - 0.5).abs() < 1e-15);
        // Four nodes at 0, 1/4, 1/2, 3/4 of the period.
        let turn = axis(Mapping::Periodic, 0.0, 1.0, 4);
        assert_eq!([0, 1, 2, 3].map(|i| turn.node(i)), [0.0, 0.25, 0.5, 0.75]);
    }
}
