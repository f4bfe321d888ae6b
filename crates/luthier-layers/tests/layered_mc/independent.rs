//! Rough stacks against another program: a brute-force Smith walk in Python, `scripts/independent/layered.py`.

use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::InterfaceMode;

use crate::scenes::{assert_agrees, at, conductor, dielectric, ggx, mc};

/// Directional albedos at 0, 45 and 75 degrees with standard errors, from `albedo` of that script: 500 000 paths each, seed 7.
fn compare(stack: &Monochrome, expected: [(f64, f64); 3]) {
    for (theta, (other, std_err)) in [0.0, 45.0, 75.0].into_iter().zip(expected) {
        let own = mc(InterfaceMode::SmithWalk, 0).albedo(stack, at(theta, 0.0), 250_000);
        assert_agrees(own.loosened(std_err), other, 1e-3, &format!("{theta}"));
    }
}

/// `scripts/independent/stacks/rough-coat-rough-gold.toml`.
#[test]
fn rough_coat_over_rough_gold_agrees_with_another_program() {
    let coated = Monochrome::bare(&[(ggx(0.4), dielectric(1.5, 0.1)), (ggx(0.3), conductor(0.2, 3.5))]);
    compare(&coated, [(0.53060, 3.8e-4), (0.48665, 3.9e-4), (0.45073, 4.1e-4)]);
}

/// `scripts/independent/stacks/rough-coat-smoother-base.toml`.
#[test]
fn very_rough_coat_over_a_smoother_metal_agrees_with_another_program() {
    let coated = Monochrome::bare(&[(ggx(0.8), dielectric(1.5, 0.0)), (ggx(0.2), conductor(3.2, 3.3))]);
    compare(&coated, [(0.27241, 2.8e-4), (0.25313, 2.9e-4), (0.25812, 3.4e-4)]);
}

/// `scripts/independent/stacks/two-rough-coats.toml`.
#[test]
fn two_rough_coats_agree_with_another_program() {
    let coats = [(ggx(0.3), dielectric(1.3, 0.05)), (ggx(0.5), dielectric(1.8, 0.1)), (ggx(1.0), conductor(1.0, 6.7))];
    compare(&Monochrome::bare(&coats), [(0.24436, 3.4e-4), (0.24348, 3.4e-4), (0.27239, 4.1e-4)]);
}
