//! Values of inputs: one to four numbers, and spaces of colours.

use luthier_lut::srgb;

/// One to four numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Value {
    pub(super) channels: [f64; 4],
    pub(super) count: usize,
}

impl Value {
    pub(super) fn number(value: f64) -> Self {
        Self { channels: [value; 4], count: 1 }
    }

    pub(super) fn rgb([r, g, b]: [f64; 3]) -> Self {
        Self { channels: [r, g, b, 1.0], count: 3 }
    }

    pub(super) fn new(values: &[f64]) -> Self {
        if let [only] = values {
            return Self::number(*only);
        }
        let mut channels = [0.0, 0.0, 0.0, 1.0];
        channels.iter_mut().zip(values).for_each(|(channel, value)| *channel = *value);
        Self { channels, count: values.len().clamp(1, 4) }
    }

    /// One number: the first.
    pub(super) fn first(self) -> f64 {
        self.channels[0]
    }

    /// Three numbers: one number stands for all.
    pub(super) fn three(self) -> [f64; 3] {
        let [r, g, b, _] = self.channels;
        if self.count == 1 { [r; 3] } else { [r, g, b] }
    }

    /// As many numbers as a type has: one stands for all, and after three the fourth is 1.
    pub(super) fn fitted(self, count: usize) -> Self {
        let [r, g, b, a] = self.channels;
        match (self.count, count) {
            (_, 1) => Self::number(r),
            (1, _) => Self { channels: [r; 4], count },
            (2, _) => Self { channels: [r, g, 0.0, 1.0], count },
            (3, 4) => Self { channels: [r, g, b, 1.0], count },
            _ => Self { channels: [r, g, b, a], count },
        }
    }

    /// A function of each number of two values: one number goes with all of the other.
    pub(super) fn zip(self, other: Self, of: impl Fn(f64, f64) -> f64) -> Self {
        let count = self.count.max(other.count);
        let [a, b] = [self, other].map(|value| if value.count == 1 { [value.channels[0]; 4] } else { value.channels });
        Self { channels: [0, 1, 2, 3].map(|c: usize| of(a[c], b[c])), count }
    }

    pub(super) fn map(self, of: impl Fn(f64) -> f64) -> Self {
        Self { channels: self.channels.map(of), count: self.count }
    }

    /// The numbers that count.
    pub(super) fn all(&self) -> &[f64] {
        &self.channels[..self.count]
    }
}

/// Numbers that a type has; `None` for types that are no numbers.
pub(super) fn count(of_type: &str) -> Option<usize> {
    Some(match of_type {
        "float" | "integer" | "boolean" => 1,
        "vector2" => 2,
        "color3" | "vector3" => 3,
        "color4" | "vector4" => 4,
        _ => return None,
    })
}

/// The value of a text.
pub(super) fn parse(text: &str, count: usize) -> Option<Value> {
    let word = |word: &str| match word.trim() {
        "true" => Some(1.0),
        "false" => Some(0.0),
        number => number.parse().ok().filter(|number: &f64| number.is_finite()),
    };
    let numbers: Vec<f64> = text.split(',').map(word).collect::<Option<_>>()?;
    (numbers.len() == count || numbers.len() == 1).then(|| Value::new(&numbers).fitted(count))
}

/// A space of colours.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Space {
    curve: Curve,
    /// Rows of the matrix to linear Rec.709; `None` where the primaries are those.
    to_rec709: Option<[[f64; 3]; 3]>,
}

#[derive(Debug, Clone, Copy, PartialEq)]
enum Curve {
    Linear,
    Srgb,
    Gamma(f64),
}

/// From the primaries of ACEScg, by Bradford's adaptation from its white.
const AP1: [[f64; 3]; 3] = [
    [1.705050992658, -0.621792120657, -0.083258872001],
    [-0.130256417507, 1.140804736575, -0.010548319068],
    [-0.024003356805, -0.128968976065, 1.15297233287],
];

/// From the primaries of Adobe RGB (1998).
const ADOBE: [[f64; 3]; 3] = [[1.39835574, -0.398355744, 0.0], [0.0, 1.0, 0.0], [0.0, -0.0429289893, 1.04292899]];

/// From the primaries of Display P3.
const P3: [[f64; 3]; 3] =
    [[1.22493029, -0.22492968, 0.0], [-0.04205868, 1.04205894, 0.0], [-0.01964128, -0.07864794, 1.09828925]];

impl Space {
    /// Linear Rec.709.
    pub(super) const LINEAR: Self = Self { curve: Curve::Linear, to_rec709: None };

    /// The space of a name; `None` for names that are not known.
    pub(super) fn named(name: &str) -> Option<Self> {
        let (curve, to_rec709) = match name {
            "" | "none" | "raw" | "lin_rec709" | "lin_rec709_scene" | "linear" => (Curve::Linear, None),
            "srgb_texture" | "srgb_rec709_scene" | "srgb" => (Curve::Srgb, None),
            "rec709_display" => (Curve::Gamma(2.4), None),
            "g22_rec709" | "g22_rec709_scene" | "gamma22" => (Curve::Gamma(2.2), None),
            "g18_rec709" | "g18_rec709_scene" | "gamma18" => (Curve::Gamma(1.8), None),
            "acescg" | "lin_ap1" | "lin_ap1_scene" => (Curve::Linear, Some(AP1)),
            "g22_ap1" | "g22_ap1_scene" => (Curve::Gamma(2.2), Some(AP1)),
            "srgb_ap1" | "srgb_ap1_scene" => (Curve::Srgb, Some(AP1)),
            "lin_adobergb" | "lin_adobergb_scene" => (Curve::Linear, Some(ADOBE)),
            "adobergb" | "g22_adobergb_scene" => (Curve::Gamma(563.0 / 256.0), Some(ADOBE)),
            "lin_displayp3" | "lin_p3d65_scene" => (Curve::Linear, Some(P3)),
            "srgb_displayp3" | "srgb_p3d65_scene" => (Curve::Srgb, Some(P3)),
            _ => return None,
        };
        Some(Self { curve, to_rec709 })
    }

    /// Whether stored numbers are those of linear Rec.709.
    pub(super) fn is_linear(&self) -> bool {
        *self == Self::LINEAR
    }

    /// Whether stored numbers differ from linear Rec.709 by the sRGB curve alone.
    pub(super) fn is_srgb(&self) -> bool {
        *self == Self { curve: Curve::Srgb, to_rec709: None }
    }

    /// Linear Rec.709 of stored numbers. Alpha has no curve.
    pub(super) fn linear(&self, [r, g, b, a]: [f64; 4]) -> [f64; 4] {
        let [r, g, b] = [r, g, b].map(|c| match self.curve {
            Curve::Linear => c,
            Curve::Srgb => f64::from(srgb::linear(c as f32)),
            Curve::Gamma(power) => libm::pow(c.max(0.0), power),
        });
        let Some(matrix) = self.to_rec709 else { return [r, g, b, a] };
        let [r, g, b] = matrix.map(|[x, y, z]| x * r + y * g + z * b);
        [r, g, b, a]
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn white_stays_white() {
        for name in ["acescg", "adobergb", "srgb_displayp3", "g22_rec709", "srgb_texture", "lin_rec709"] {
            let white = Space::named(name).unwrap().linear([1.0; 4]);
            assert!(white.iter().all(|c| (c - 1.0).abs() < 2e-6), "{name}: {white:?}");
        }
    }

    #[test]
    fn texts_are_values() {
        assert_eq!(parse("0.5, 1,2", 3), Some(Value::new(&[0.5, 1.0, 2.0])));
        assert_eq!(parse("true", 1), Some(Value::number(1.0)));
        assert_eq!(parse("0.5", 3), Some(Value::rgb([0.5; 3]).fitted(3)).map(|v| Value { channels: [0.5; 4], ..v }));
        assert_eq!([parse("", 1), parse("1,2", 3), parse("nan", 1), parse("1e999", 1)], [None; 4]);
    }
}
