//! All bounces of one interface in the model `lobes`, against walks that its fit has not seen; and what one bounce alone leaves out.

use glam::DVec3;
use luthier_layers::directional_albedo::over_hemisphere;
use luthier_layers::model::Model;
use luthier_layers::models::lobes::{Lobes, Varied, Varying};
use luthier_layers::models::microfacet::{Components, Microfacet};
use luthier_layers::monochrome::Monochrome;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::stack::{Base, Distribution, Layer, Slab, Stack, Surface};

const NM: [f64; 3] = [645.0, 525.0, 445.0];
const COLOR: Color = Color::ThreeWavelengths(NM);

/// Angles of the eye, degrees: no row lies on most of them.
const THETAS_DEG: [f64; 9] = [0.5, 20.0, 40.0, 55.0, 65.0, 73.0, 79.0, 83.0, 86.0];

/// The largest error of an albedo.
const TOLERANCE: f64 = 0.01;

/// Paths of the oracle for each view: its standard error is below 0.002.
const PATHS: u64 = 16_384;

fn lone(surface: Surface, base: Base) -> Stack {
    Stack { exterior: Ior::vacuum(), layers: vec![Layer { films: vec![], surface, base }] }
}

/// White, grey and nearly black metals, by channel.
fn metal() -> Base {
    Base::Conductor { ior: Ior::vacuum().with_f0([1.0, 0.5, 0.1]) }
}

fn glass() -> Base {
    Base::Dielectric {
        ior: Ior::constant(1.5, 0.0).unwrap(),
        slab: Slab { thickness_um: 0.0, absorption_per_um: [0.0; 3] },
    }
}

fn from(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let ((sin, cos), (y, x)) = (theta_deg.to_radians().sin_cos(), phi_deg.to_radians().sin_cos());
    DVec3::new(sin * x, sin * y, cos)
}

/// The largest difference of albedos of lobes to those of walks, over all angles and channels.
fn worst(lobes: &Lobes, stack: &Stack, phi_deg: f64) -> (f64, String) {
    let walks = LayeredMc { seed: 91, ..LayeredMc::new(InterfaceMode::SmithWalk) };
    let mut worst = (0.0, String::new());
    for theta_deg in THETAS_DEG {
        let wo = from(theta_deg, phi_deg);
        let albedo = lobes.row(wo).albedo_dir;
        for c in 0..3 {
            let walked = walks.albedo(&Monochrome::new(stack, NM[c], c), wo, PATHS).mean;
            let error = (albedo[c] - walked).abs();
            if error > worst.0 {
                worst = (error, format!("{theta_deg} degrees, channel {c}: {} where walks have {walked}", albedo[c]));
            }
        }
    }
    worst
}

/// Oracle: walks between facets, one wavelength at a time, of other random numbers than those of the fit.
#[test]
fn one_rough_interface_returns_all_its_light() {
    for distribution in [Distribution::Ggx, Distribution::Beckmann] {
        for (alpha, base) in [(0.05, metal()), (0.3, metal()), (1.0, metal()), (0.2, glass()), (1.0, glass())] {
            let stack = lone(Surface::isotropic(distribution, alpha), base);
            let lobes = Lobes::of(&stack, &COLOR);
            assert!(lobes.rows.iter().all(|row| row.lobes.is_empty()));
            let (error, place) = worst(&lobes, &stack, 0.0);
            assert!(error <= TOLERANCE, "{} {alpha}: {error}, {place}", distribution.name());
        }
    }
}

/// All light of a brushed metal comes back, across all azimuths, and between the factors of a roughness map.
#[test]
fn brushed_and_mapped_interfaces_return_all_their_light() {
    let brushed = Surface { distribution: Distribution::Ggx, alpha_x: 0.1, alpha_y: 0.5, rotation: 0.3 };
    let stack = lone(brushed, metal());
    let lobes = Lobes::of(&stack, &COLOR);
    for phi_deg in [17.0, 50.0, 107.0] {
        let (error, place) = worst(&lobes, &stack, phi_deg);
        assert!(error <= TOLERANCE, "{phi_deg}: {error}, {place}");
    }
    let stack = lone(Surface::isotropic(Distribution::Ggx, 0.8), metal());
    let varied = Varied::of(&stack, &COLOR, Some(Varying::Alpha));
    for factor in [0.85, 0.3, 0.1] {
        let here = Varying::Alpha.apply(&stack, factor);
        let (error, place) = worst(&varied.at(factor), &here, 0.0);
        assert!(error <= TOLERANCE, "{factor}: {error}, {place}");
    }
}

/// Oracle: quadrature over the hemisphere. The light is what the rows say.
#[test]
fn the_light_of_one_interface_is_its_albedo() {
    let stack = lone(Surface::isotropic(Distribution::Ggx, 0.5), metal());
    let lobes = Lobes::of(&stack, &COLOR);
    for theta_deg in [10.0, 60.0, 80.0] {
        let wo = from(theta_deg, 20.0);
        let (sum, _) = over_hemisphere(DVec3::new(-wo.x, -wo.y, wo.z), |wi| lobes.eval(wi, wo));
        let albedo = lobes.row(wo).albedo_dir;
        (0..3).for_each(|c| assert!((sum[c] - albedo[c]).abs() < 3e-3, "{theta_deg}: {sum:?} {albedo:?}"));
    }
}

/// Up to the slope parameter of `ONE_BOUNCE_ALPHA` (luthier-material) one bounce is all but a hundredth of a white metal's light, up to 86 degrees; of five times that it is not.
#[test]
fn one_bounce_is_all_of_smooth_interfaces_alone() {
    for (alpha, is_all) in [(0.008, true), (0.04, false)] {
        let stack = Monochrome::new(&lone(Surface::isotropic(Distribution::Ggx, alpha), metal()), NM[0], 0);
        let wo = from(86.0, 0.0);
        let once = Microfacet::new(Components::PLAIN);
        let ([albedo], _) = over_hemisphere(DVec3::new(-wo.x, 0.0, wo.z), |wi| [once.eval(&stack, wi, wo)]);
        assert_eq!(albedo >= 1.0 - TOLERANCE, is_all, "{alpha}: {albedo}");
    }
}
