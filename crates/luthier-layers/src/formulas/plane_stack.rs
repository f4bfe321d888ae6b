//! A stack of plane interfaces between thick slabs: powers add, phases do not.

use std::sync::OnceLock;

use luthier_optics::fresnel::coated;
use luthier_optics::quadrature::gauss_legendre;
use num_complex::Complex64;

use crate::formulas::refraction::refracted_cosine;
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// Power that the first interfaces of a stack pass and return, with all bounces between them.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Powers {
    /// Crossing, either way: reciprocity makes them equal.
    pub transmittance: f64,
    /// Reflected, for light from above.
    pub above: f64,
    /// Reflected, for light from below.
    pub below: f64,
}

/// Quadrature points per smooth piece of an integral over cosines.
const POINTS: usize = 32;

/// The Gauss-Legendre rule of those points on 0..1, made once.
pub(crate) fn rule() -> &'static [(f64, f64)] {
    static RULE: OnceLock<Vec<(f64, f64)>> = OnceLock::new();
    RULE.get_or_init(|| gauss_legendre(POINTS))
}

/// Powers of no interface: all light passes.
const CLEAR: Powers = Powers { transmittance: 1.0, above: 0.0, below: 0.0 };

/// The first `count` interfaces of a stack as if they were smooth, each with the slab below it, for the direction that makes
/// `cos_theta` with the normal in the medium below them. Adding of powers (Stokes 1862) per interface.
///
/// Beyond a critical angle all light from below is reflected: `below` is 1, less the absorption on the way. Opaque layers count as black.
pub fn seen_from_below(stack: &Monochrome, count: usize, cos_theta: f64) -> Powers {
    // Upwards: the direction's cosine in each medium, to the first that it cannot enter.
    let layers = stack.layers.get(..count).unwrap_or(&stack.layers);
    let mut cosines = vec![cos_theta; layers.len() + 1];
    let mut first = 0;
    for (i, layer) in layers.iter().enumerate().rev() {
        match refracted_cosine(cosines[i + 1], 1.0 / layer.eta()) {
            Some(cos) => cosines[i] = cos,
            None => {
                first = i + 1;
                break;
            }
        }
    }
    let start = if first == 0 { CLEAR } else { Powers { transmittance: 0.0, above: 0.0, below: 1.0 } };
    let start = match first.checked_sub(1).map(|i| layers[i].below) {
        Some(MonochromeBelow::Dielectric { optical_depth, .. }) => through_slab(start, optical_depth, cosines[first]),
        _ => start,
    };
    (first..layers.len()).fold(start, |powers, i| add(powers, &layers[i], [cosines[i], cosines[i + 1]]))
}

/// Powers as of [`seen_from_below`], for the direction that makes `cos_theta` with the normal in the exterior; and the cosine below. `None`
/// if the light is totally reflected on the way.
pub fn seen_from_above(stack: &Monochrome, count: usize, cos_theta: f64) -> Option<(Powers, f64)> {
    let mut powers = CLEAR;
    let mut cos = cos_theta;
    for layer in stack.layers.iter().take(count) {
        let below = refracted_cosine(cos, layer.eta())?;
        powers = add(powers, layer, [cos, below]);
        cos = below;
    }
    Some((powers, cos))
}

/// Adds an interface and its slab below others.
fn add(powers: Powers, layer: &MonochromeLayer, [cos_above, cos_below]: [f64; 2]) -> Powers {
    let MonochromeBelow::Dielectric { ior, complex_ior, optical_depth } = layer.below else {
        return Powers { transmittance: 0.0, above: powers.above, below: 0.0 };
    };
    let down = layer.reflectance(cos_above);
    // Without absorption, reflectances of the two sides are the same.
    let is_clear = (layer.f0.is_some() || complex_ior.im == 0.0) && layer.films.iter().all(|f| f.ior.im == 0.0);
    let up = if is_clear || layer.bare_f0().is_some() {
        down
    } else {
        let films: Vec<_> = layer.films.iter().rev().copied().collect();
        // Films over an F0 lie on another index than that which bends light.
        let (index, cos_theta) = match (layer.f0, layer.index_below()) {
            (Some(_), Some(index)) => (index, refracted_cosine(cos_above, index.re / layer.above).unwrap_or(0.0)),
            _ => (Complex64::from(ior), cos_below),
        };
        coated(index, &films, Complex64::from(layer.above), cos_theta).unpolarised()
    };
    let transmitted = (1.0 - down).max(0.0);
    let echo = 1.0 - powers.below * down;
    // If everything comes back, nothing enters, and the sum of echoes is 0 times infinity.
    let gain = if echo > 0.0 { 1.0 / echo } else { 0.0 };
    let joined = Powers {
        transmittance: powers.transmittance * transmitted * gain,
        above: powers.above + powers.transmittance * powers.transmittance * down * gain,
        below: up + transmitted * transmitted * powers.below * gain,
    };
    through_slab(joined, optical_depth, cos_below)
}

/// Powers with absorption in the slab below: light that crosses meets it once, light that returns twice.
fn through_slab(powers: Powers, optical_depth: f64, cos: f64) -> Powers {
    if optical_depth == 0.0 {
        return powers;
    }
    let once = libm::exp(-optical_depth / cos);
    Powers { transmittance: powers.transmittance * once, above: powers.above, below: powers.below * once * once }
}

/// Mean of the power that returns to the medium below the first `count` interfaces, for diffuse light in it (cosine-weighted),
/// absorption on the way included. Within 1e-7 without absorption.
pub fn diffuse_return(stack: &Monochrome, count: usize) -> f64 {
    let layers = stack.layers.get(..count).unwrap_or(&stack.layers);
    let Some(last) = layers.last() else { return 0.0 };
    let MonochromeBelow::Dielectric { ior: base, .. } = last.below else { return 0.0 };
    // Squared cosines of the critical angles towards each medium above.
    let mut knots: Vec<f64> = layers
        .iter()
        .map(|l| 1.0 - (l.above / base) * (l.above / base))
        .filter(|knot| *knot > 0.0)
        .chain([0.0, 1.0])
        .collect();
    knots.sort_by(f64::total_cmp);
    let mut sum = 0.0;
    for pair in knots.windows(2) {
        let (low, width) = (pair[0], pair[1] - pair[0]);
        // mu^2 = low + width s^2: s is the cosine in the medium whose critical angle is at `low`, up to a factor, so that
        // the square root there disappears.
        for (s, weight) in rule() {
            let mu = libm::sqrt(low + width * s * s);
            sum += 2.0 * width * s * weight * seen_from_below(stack, count, mu).below;
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;
    use luthier_optics::stack::Surface;

    fn coats(indices: &[f64], optical_depth: f64) -> Monochrome {
        let coat = |&ior| (Surface::smooth(), MonochromeBelow::dielectric(ior, optical_depth));
        Monochrome::bare(&indices.iter().map(coat).collect::<Vec<_>>())
    }

    /// Oracle: the closed form of the cosine-weighted internal reflectance.
    #[test]
    fn diffuse_light_is_held_back_by_the_published_part() {
        for (n, expected) in [(1.33, 0.4719491488), (1.5, 0.5963457597), (2.0, 0.7901491593)] {
            let found = diffuse_return(&coats(&[n], 0.0), 1);
            assert!((found - expected).abs() < 2e-7, "{n}: {found}");
        }
    }

    /// An interface between equal media changes nothing.
    #[test]
    fn matched_interfaces_do_not_count() {
        let one = diffuse_return(&coats(&[1.5], 0.0), 1);
        assert!((diffuse_return(&coats(&[1.0, 1.5, 1.5], 0.0), 3) - one).abs() < 1e-6);
    }

    #[test]
    fn both_directions_agree_and_keep_energy() {
        let stack = coats(&[1.5, 1.2, 1.9], 0.0);
        for cos in [0.05, 0.4, 1.0] {
            let (down, below) = seen_from_above(&stack, 3, cos).unwrap();
            let up = seen_from_below(&stack, 3, below);
            assert!((down.transmittance - up.transmittance).abs() < 1e-12);
            assert!((down.above + down.transmittance - 1.0).abs() < 1e-12);
            assert!((up.below + up.transmittance - 1.0).abs() < 1e-12);
        }
    }

    /// Light that cannot leave comes back whole, through every slab that it crossed twice.
    #[test]
    fn total_reflection_returns_what_absorption_leaves() {
        let stack = coats(&[1.5, 1.5], 0.3);
        let found = seen_from_below(&stack, 2, 0.5).below;
        assert!((found - libm::exp(-2.0 * 2.0 * 0.3 / 0.5)).abs() < 1e-12, "{found}");
    }
}
