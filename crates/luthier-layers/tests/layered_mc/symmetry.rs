//! Reciprocity and determinism of the Monte Carlo reference.

use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc, Side};
use luthier_layers::references::random_walk::RandomWalk;
use luthier_optics::stack::{Distribution, Surface};

use crate::scenes::{MODES, at, conductor, dielectric, ggx, lambert, mc};

fn stacks() -> Vec<(&'static str, Monochrome)> {
    let brushed = Surface { distribution: Distribution::Ggx, alpha_x: 0.6, alpha_y: 0.2, rotation: 0.8 };
    let beckmann = Surface::isotropic(Distribution::Beckmann, 0.5);
    vec![
        ("metal", Monochrome::bare(&[(brushed, conductor(0.2, 3.5))])),
        ("coated metal", Monochrome::bare(&[(ggx(0.3), dielectric(1.5, 0.1)), (brushed, conductor(0.2, 3.5))])),
        ("coated Lambert", Monochrome::bare(&[(beckmann, dielectric(1.5, 0.2)), (ggx(0.0), lambert(0.8))])),
        (
            "two coats",
            Monochrome::bare(&[
                (ggx(0.2), dielectric(1.3, 0.1)),
                (beckmann, dielectric(1.8, 0.1)),
                (ggx(0.5), conductor(3.0, 3.0)),
            ]),
        ),
    ]
}

#[test]
fn brdfs_are_reciprocal() {
    for (name, stack) in stacks() {
        for mode in MODES {
            for (wi, wo) in [(at(20.0, 0.0), at(60.0, 170.0)), (at(75.0, 40.0), at(10.0, 0.0))] {
                let mc = mc(mode, 10_000);
                let (one, two) = (mc.estimate(&stack, wi, wo), mc.estimate(&stack, wo, wi));
                let (f, g) = (one.mean / wi.z, two.mean / wo.z);
                let sigma = (one.std_err / wi.z).hypot(two.std_err / wo.z);
                assert!((f - g).abs() <= 4.0 * sigma + 1e-12 * f, "{name} {mode:?}: {f} {g} +- {sigma}");
                assert!(sigma < 0.05 * f, "{name} {mode:?}: {f} +- {sigma}");
            }
        }
    }
}

#[test]
fn walks_through_an_interface_are_reciprocal() {
    let n = 1.5;
    let glass = Monochrome::bare(&[(ggx(0.6), dielectric(n, 0.0))]);
    let walks = RandomWalk { samples: 200_000, seed: 5 };
    for (above, below) in [(at(30.0, 0.0), at(25.0, 170.0)), (at(70.0, 0.0), at(20.0, 200.0))] {
        let down = walks.density(&glass.layers[0], (Side::Above, above), (Side::Below, below));
        let up = walks.density(&glass.layers[0], (Side::Below, below), (Side::Above, above));
        let (a, b) = (down.mean * above.z, up.mean * below.z * n * n);
        let sigma = (down.std_err * above.z).hypot(up.std_err * below.z * n * n);
        assert!((a - b).abs() < 4.0 * sigma && sigma < 0.02 * a, "{a} {b} +- {sigma}");
    }
}

#[test]
fn the_same_seed_gives_the_same_bits_and_another_seed_does_not() {
    for (name, stack) in stacks() {
        let value = |seed| LayeredMc { mode: InterfaceMode::SmithWalk, samples: 500, seed };
        let (wi, wo) = (at(20.0, 0.0), at(30.0, 170.0));
        assert_eq!(value(3).estimate(&stack, wi, wo), value(3).estimate(&stack, wi, wo), "{name}");
        assert_ne!(value(3).estimate(&stack, wi, wo), value(4).estimate(&stack, wi, wo), "{name}");
        assert_eq!(value(3).albedo(&stack, wo, 500), value(3).albedo(&stack, wo, 500), "{name}");
    }
}

#[test]
fn nothing_comes_from_below_the_horizon_and_grazing_is_finite() {
    for (name, stack) in stacks() {
        let mc = mc(InterfaceMode::SmithWalk, 200);
        let up = at(30.0, 0.0);
        for other in [at(90.0, 0.0) * glam::DVec3::new(1.0, 1.0, 0.0), -up] {
            assert_eq!(mc.estimate(&stack, up, other).mean, 0.0, "{name}");
            assert_eq!(mc.estimate(&stack, other, up).mean, 0.0, "{name}");
            assert_eq!(mc.albedo(&stack, other, 10).mean, 0.0, "{name}");
        }
        for grazing in [at(89.9999, 10.0), at(89.999999999, 180.0)] {
            for (wi, wo) in [(up, grazing), (grazing, up), (grazing, grazing)] {
                let value = mc.estimate(&stack, wi, wo);
                assert!(
                    value.mean.is_finite() && value.mean >= 0.0 && value.variance().is_finite(),
                    "{name} {value:?}"
                );
            }
        }
    }
}
