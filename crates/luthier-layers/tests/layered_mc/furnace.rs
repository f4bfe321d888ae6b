//! White furnace: stacks that absorb nothing return all light.

use luthier_layers::model::Estimate;
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::InterfaceMode;
use luthier_optics::stack::{Distribution, Surface};

use crate::scenes::{BOTH, assert_agrees, at, dielectric, ggx, lambert, mc, mirror};

#[test]
fn lossless_stacks_return_everything() {
    for d in BOTH {
        for alpha in [0.05, 0.3, 1.0] {
            let rough = Surface::isotropic(d, alpha);
            let elongated = Surface { distribution: d, alpha_x: 0.8, alpha_y: 0.1, rotation: 0.5 };
            let stacks = [
                Monochrome::bare(&[(rough, mirror())]),
                Monochrome::bare(&[(rough, dielectric(1.5, 0.0)), (rough, mirror())]),
                Monochrome::bare(&[(rough, dielectric(1.5, 0.0)), (Surface::smooth(), lambert(1.0))]),
                Monochrome::bare(&[(Surface::smooth(), dielectric(1.5, 0.0)), (elongated, mirror())]),
                Monochrome::bare(&[
                    (elongated, dielectric(1.3, 0.0)),
                    (rough, dielectric(1.7, 0.0)),
                    (ggx(0.2), mirror()),
                ]),
            ];
            for (i, white) in stacks.iter().enumerate() {
                for theta in [0.0, 60.0, 88.0] {
                    let albedo = mc(InterfaceMode::SmithWalk, 0).albedo(white, at(theta, 40.0), 2_000);
                    // All that spreads are the few walks that die by chance: too few for an error that can be believed.
                    let albedo = Estimate::known(albedo.mean, albedo.variance().sqrt());
                    assert_agrees(albedo, 1.0, 1e-3, &format!("{d:?} {alpha} stack {i} {theta}"));
                }
            }
        }
    }
}

#[test]
fn one_facet_loses_what_is_blocked() {
    // Height-correlated Smith, GGX, F = 1 at a cosine of one half (physics reference, section E).
    for (alpha, expected) in [(0.1, 0.969205), (0.25, 0.857263), (0.5, 0.69825), (0.75, 0.56462), (1.0, 0.45069)] {
        let rough = Monochrome::bare(&[(Surface::isotropic(Distribution::Ggx, alpha), mirror())]);
        let albedo = mc(InterfaceMode::OneFacet, 0).albedo(&rough, at(60.0, 0.0), 200_000);
        assert_agrees(albedo, expected, 1e-3, &format!("{alpha}"));
    }
    // At normal incidence the light that comes in sees no shadows: exactly 1 - ln 2 for alpha = 1.
    for (alpha, expected) in [
        (0.1, 0.9883040565),
        (0.25, 0.9158124302),
        (0.5, 0.6878485151),
        (0.75, 0.4639165109),
        (1.0, 1.0 - std::f64::consts::LN_2),
    ] {
        let rough = Monochrome::bare(&[(Surface::isotropic(Distribution::Ggx, alpha), mirror())]);
        let albedo = mc(InterfaceMode::OneFacet, 0).albedo(&rough, at(0.0, 0.0), 200_000);
        assert_agrees(albedo, expected, 1e-3, &format!("{alpha}"));
    }
}
