//! Random stacks whose directional albedo a quadrature can resolve, and random directions.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};
use luthier_optics::fresnel::FilmLayer;
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;
use proptest::prelude::*;

use crate::stacks::{WHITE, dielectric, lambert};

/// Losses of a random stack.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Losses {
    /// Slabs absorb, bases too, or there is none.
    Any,
    /// No losses: a white mirror or white Lambert base below clear slabs.
    None,
}

/// Isotropic down to 0.02, brushed down to 0.05: what is sharper and elongated the quadrature does not resolve.
fn surface() -> impl Strategy<Value = Surface> {
    let distribution = prop_oneof![Just(Distribution::Ggx), Just(Distribution::Beckmann)];
    let alphas = prop_oneof![
        prop_oneof![0.02..0.2, 0.02..=1.0, Just(1.0)].prop_map(|alpha| (alpha, alpha)),
        (0.05..=1.0, 0.05..=1.0f64),
    ];
    (distribution, alphas, 0.0..PI).prop_map(|(distribution, (alpha_x, alpha_y), rotation)| Surface {
        distribution,
        alpha_x,
        alpha_y,
        rotation,
    })
}

fn layer(losses: Losses, below: impl Strategy<Value = MonochromeBelow>) -> impl Strategy<Value = MonochromeLayer> {
    let k = move |k| if losses == Losses::None { 0.0 } else { k };
    let film = (1.0..2.6, 0.0..0.5, 0.0..1.5f64)
        .prop_map(move |(n, im, waves)| FilmLayer { ior: Complex64::new(n, k(im)), waves });
    (surface(), prop::option::weighted(0.2, film), below).prop_map(|(surface, film, below)| MonochromeLayer {
        surface,
        above: 1.0,
        films: film.into_iter().collect(),
        below,
        f0: None,
    })
}

fn coat(losses: Losses) -> impl Strategy<Value = MonochromeBelow> {
    (1.05..2.6, 0.0..2.0).prop_map(move |(n, depth)| dielectric(n, if losses == Losses::None { 0.0 } else { depth }))
}

fn base(losses: Losses) -> BoxedStrategy<MonochromeBelow> {
    let white = prop_oneof![Just(WHITE), Just(lambert(1.0))];
    match losses {
        Losses::None => white.boxed(),
        Losses::Any => {
            let metal =
                (0.0..5.0, 0.0..8.0f64).prop_map(|(n, k)| MonochromeBelow::Conductor { ior: Complex64::new(n, k) });
            prop_oneof![white, metal, (0.0..=1.0).prop_map(lambert), coat(losses)].boxed()
        }
    }
}

/// Stacks of one to three layers under air.
pub(crate) fn stack(losses: Losses) -> impl Strategy<Value = Monochrome> {
    let coats = prop::collection::vec(layer(losses, coat(losses)), 0..=2);
    (coats, layer(losses, base(losses))).prop_map(|(mut layers, last)| {
        layers.push(last);
        for layer in layers.iter_mut().filter(|layer| matches!(layer.below, MonochromeBelow::Diffuse { .. })) {
            layer.films.clear();
        }
        Monochrome::joined(1.0, layers)
    })
}

/// Upward directions to a least cosine; a fifth of them in logarithmic steps.
pub(crate) fn upward(cos_min: f64) -> impl Strategy<Value = DVec3> {
    let grazing = (cos_min.log10()..=0.0).prop_map(|e| 10f64.powf(e));
    (prop_oneof![4 => cos_min..=1.0, 1 => grazing], 0.0..2.0 * PI).prop_map(|(cos, phi): (f64, f64)| {
        let sin = ((1.0 - cos) * (1.0 + cos)).max(0.0).sqrt();
        DVec3::new(sin * phi.cos(), sin * phi.sin(), cos)
    })
}

/// Smooth clear coats on a white base. No coat is rarer than the air above, so that light reaches the base at every angle.
pub(crate) fn smooth_white() -> impl Strategy<Value = Monochrome> {
    let base = prop_oneof![Just(WHITE), Just(lambert(1.0))];
    (prop::collection::vec(1.05..2.6f64, 0..=2), base).prop_map(|(indices, base)| {
        let mut layers: Vec<_> = indices.into_iter().map(|n| (Surface::smooth(), dielectric(n, 0.0))).collect();
        layers.push((Surface::smooth(), base));
        Monochrome::bare(&layers)
    })
}
