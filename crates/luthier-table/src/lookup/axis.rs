//! WGSL that turns a cosine or an alpha into a coordinate of a texture.

use std::fmt::Write as _;

use luthier_lut::Mapping;

use super::float;
use crate::{AxisSpec, Cost, Nodes, Quantity};

/// Writes `let NAME = ...;`, the coordinate in 0..1 at which a texture of `size` texels along this axis is read: the
/// WGSL of [`Layout::position`](crate::Layout::position) over the size. None for a periodic axis, a real index or a
/// thickness.
pub(super) fn write(out: &mut String, name: &str, axis: &AxisSpec, input: &str, size: u32) -> Option<()> {
    let (quantity, is_within) = quantity(out, axis.quantity, input)?;
    let AxisSpec { min, max, .. } = *axis;
    let is_whole = is_within && min == 0.0 && max == 1.0;
    let part = if is_whole {
        quantity.clone()
    } else {
        let shifted = if min == 0.0 { quantity.clone() } else { format!("({quantity} - {})", float(min)) };
        format!("saturate({shifted} * {})", float(1.0 / (max - min)))
    };
    let coordinate = match axis.mapping {
        Mapping::Linear | Mapping::Apart => part,
        Mapping::Power { exponent } => root(&part, exponent),
        Mapping::Rational { bend } => {
            let _ = writeln!(out, "    let {name}_part = {part};");
            format!("{name}_part * {} / ({name}_part + {})", float(1.0 + bend), float(bend))
        }
        Mapping::Logarithmic => {
            let scale = 1.0 / libm::log2(max / min);
            let clamped = format!("clamp({quantity}, {}, {})", float(min), float(max));
            format!("log2({clamped} * {}) * {}", float(1.0 / min), float(scale))
        }
        Mapping::Periodic => return None,
    };
    // Coordinates of the ends of an ascending axis: the first texel's, and the distance to the last texel's.
    let n = f64::from(size);
    let [first, span] = match axis.nodes {
        Nodes::Ends => [0.5 / n, (n - 1.0) / n],
        Nodes::Offset(offset) => [(0.5 - offset) / n, 1.0],
    };
    let [first, span] = if axis.descending { [first + span, -span] } else { [first, span] };
    let scaled = match span {
        1.0 => coordinate,
        _ => format!("{coordinate} * {}", float(span)),
    };
    let value = match first {
        0.0 => scaled,
        _ => format!("{scaled} + {}", float(first)),
    };
    let _ = writeln!(out, "    let {name} = {value};");
    Some(())
}

/// Operations of the text of [`write()`]; none if it writes none.
pub(super) fn cost(axis: &AxisSpec) -> Option<Cost> {
    let (quantity, is_within) = match axis.quantity {
        Quantity::CosTheta | Quantity::Alpha => (operations(0, 1, 0), true),
        Quantity::CosThetaSq | Quantity::AlphaSq => (operations(1, 1, 0), true),
        Quantity::SqrtCosTheta | Quantity::Roughness => (operations(0, 1, 1), true),
        Quantity::SqrtRoughness => (operations(0, 1, 2), true),
        // The root, and an arc tangent as compilers write it: a quotient of minimum and maximum, a polynomial, two choices.
        Quantity::Theta => (operations(11, 5, 2), false),
        Quantity::SqrtOneMinusCosTheta => (operations(1, 1, 1), true),
        _ => return None,
    };
    let is_whole = is_within && axis.min == 0.0 && axis.max == 1.0;
    // The shift and the scale are one product with a sum.
    let part = if is_whole { Cost::default() } else { operations(1, 1, 0) };
    let mapping = match axis.mapping {
        Mapping::Linear | Mapping::Apart => part,
        Mapping::Power { exponent } => part + exponents_cost(exponent),
        Mapping::Rational { .. } => part + operations(2, 0, 1),
        Mapping::Logarithmic => operations(2, 1, 1),
        Mapping::Periodic => return None,
    };
    let is_plain = axis.nodes == Nodes::CENTRES && !axis.descending;
    Some(quantity + mapping + operations(u32::from(!is_plain), 0, 0))
}

fn operations(multiply_adds: u32, clamps: u32, specials: u32) -> Cost {
    Cost { multiply_adds, clamps, specials }
}

/// Operations of [`root`]: roots, or a logarithm, a product and an exponential.
fn exponents_cost(exponent: f64) -> Cost {
    let roots = ROOTS.into_iter().position(|power| power == exponent);
    roots.map_or(operations(1, 0, 2), |count| operations(0, 0, count as u32))
}

/// A quantity of a cosine, an alpha or a part of a complex index, and whether it lies in 0..1. None for other
/// quantities.
fn quantity(out: &mut String, quantity: Quantity, input: &str) -> Option<(String, bool)> {
    if matches!(quantity, Quantity::IorN | Quantity::IorK) {
        return Some((input.to_owned(), false));
    }
    let input = format!("saturate({input})");
    Some(match quantity {
        Quantity::CosTheta | Quantity::Alpha => (input, true),
        Quantity::CosThetaSq | Quantity::AlphaSq => (format!("{input} * {input}"), true),
        Quantity::SqrtCosTheta | Quantity::Roughness => (format!("sqrt({input})"), true),
        Quantity::SqrtRoughness => (format!("sqrt(sqrt({input}))"), true),
        Quantity::Theta => {
            // Exact near the normal, where an arc cosine is not.
            let _ = writeln!(out, "    let cosine = {input};");
            ("atan2(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine)".to_owned(), false)
        }
        Quantity::SqrtOneMinusCosTheta => (format!("sqrt(1.0 - {input})"), true),
        _ => return None,
    })
}

/// Exponents whose roots are square roots: none, one, two, three.
const ROOTS: [f64; 4] = [1.0, 2.0, 4.0, 8.0];

/// The root of an expression in 0..1: by square roots if the exponent is a power of two up to 8, else by a power.
fn root(part: &str, exponent: f64) -> String {
    match ROOTS.into_iter().position(|power| power == exponent) {
        Some(count) => format!("{}{part}{}", "sqrt(".repeat(count), ")".repeat(count)),
        None => format!("pow({part}, {})", float(1.0 / exponent)),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn axes_are_written_as_short_as_they_are() {
        for (axis, nodes, expected) in [
            ("cos_theta", Nodes::CENTRES, "saturate(cos_theta)"),
            ("cos_theta", Nodes::Ends, "saturate(cos_theta) * 0.9375 + 0.03125"),
            ("-cos_theta", Nodes::CENTRES, "saturate(cos_theta) * -1.0 + 1.0"),
            ("-cos_theta_sq", Nodes::Ends, "saturate(cos_theta) * saturate(cos_theta) * -0.9375 + 0.96875"),
            ("cos_theta=0.5..1^2", Nodes::CENTRES, "sqrt(saturate((saturate(cos_theta) - 0.5) * 2.0))"),
            ("cos_theta^3", Nodes::CENTRES, "pow(saturate(cos_theta), 0.33333334)"),
            ("cos_theta=0.25..1@log", Nodes::CENTRES, "log2(clamp(saturate(cos_theta), 0.25, 1.0) * 4.0) * 0.5"),
        ] {
            let spec = AxisSpec { nodes, ..axis.parse().unwrap() };
            let mut out = String::new();
            write(&mut out, "x", &spec, "cos_theta", 16).unwrap();
            assert_eq!(out, format!("    let x = {expected};\n"), "{axis}");
        }
        let spec = AxisSpec { nodes: Nodes::Offset(0.0), ..AxisSpec::whole(Quantity::Theta, Nodes::CENTRES) };
        let mut out = String::new();
        write(&mut out, "x", &spec, "cos_theta", 16).unwrap();
        let angle = "atan2(sqrt((1.0 - cosine) * (1.0 + cosine)), cosine)";
        let x = format!("saturate({angle} * 0.63661975) + 0.03125");
        assert_eq!(out, format!("    let cosine = saturate(cos_theta);\n    let x = {x};\n"));
    }

    #[test]
    fn repeating_axes_have_no_look_up() {
        let spec = AxisSpec { mapping: Mapping::Periodic, ..AxisSpec::whole(Quantity::CosTheta, Nodes::CENTRES) };
        assert_eq!(write(&mut String::new(), "x", &spec, "cos_theta", 16), None);
    }
}
