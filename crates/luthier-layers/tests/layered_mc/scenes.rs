//! Stacks and directions of the Monte Carlo tests.

use glam::DVec3;
use luthier_layers::model::Estimate;
use luthier_layers::monochrome::MonochromeBelow;
use luthier_layers::references::layered_mc::{InterfaceMode, LayeredMc};
use luthier_optics::stack::{Distribution, Surface};
use num_complex::Complex64;

pub(crate) const BOTH: [Distribution; 2] = [Distribution::Beckmann, Distribution::Ggx];
pub(crate) const MODES: [InterfaceMode; 2] = [InterfaceMode::SmithWalk, InterfaceMode::OneFacet];

pub(crate) fn ggx(alpha: f64) -> Surface {
    Surface::isotropic(Distribution::Ggx, alpha)
}

pub(crate) fn dielectric(ior: f64, optical_depth: f64) -> MonochromeBelow {
    MonochromeBelow::dielectric(ior, optical_depth)
}

pub(crate) fn conductor(n: f64, k: f64) -> MonochromeBelow {
    MonochromeBelow::Conductor { ior: Complex64::new(n, k) }
}

/// A conductor that reflects all but 4e-12.
pub(crate) fn mirror() -> MonochromeBelow {
    conductor(1.0, 1e6)
}

pub(crate) fn lambert(albedo: f64) -> MonochromeBelow {
    MonochromeBelow::Diffuse { albedo, sigma: 0.0 }
}

/// A direction at an elevation and an azimuth in degrees.
pub(crate) fn at(theta_deg: f64, phi_deg: f64) -> DVec3 {
    let (theta, phi) = (theta_deg.to_radians(), phi_deg.to_radians());
    DVec3::new(theta.sin() * phi.cos(), theta.sin() * phi.sin(), theta.cos())
}

pub(crate) fn mc(mode: InterfaceMode, samples: u64) -> LayeredMc {
    LayeredMc { mode, samples, seed: 11 }
}

/// Asserts that an estimate is within four standard errors, which are at most `sigma`; a few units of rounding where there is no spread.
#[track_caller]
pub(crate) fn assert_agrees(estimate: Estimate, expected: f64, sigma: f64, what: &str) {
    let Estimate { mean, std_err, .. } = estimate;
    assert!(std_err <= sigma, "{what}: standard error {std_err}");
    let off = (mean - expected).abs();
    assert!(off <= 4.0 * std_err + 1e-9, "{what}: {mean} +- {std_err} against {expected}");
}

/// Mean of a list of independent values.
pub(crate) fn mean_of(values: &[f64]) -> Estimate {
    let n = values.len() as f64;
    let mean = values.iter().sum::<f64>() / n;
    let squares: f64 = values.iter().map(|v| (v - mean) * (v - mean)).sum();
    Estimate::known(mean, (squares / (n * (n - 1.0))).sqrt())
}

/// The i-th of a sequence of points that fill the unit square evenly (Roberts 2018, the plastic number).
pub(crate) fn evenly(i: u64) -> [f64; 2] {
    let i = i as f64 + 1.0;
    [(0.5 + i * 0.754_877_666_246_692_7).fract(), (0.5 + i * 0.569_840_290_998_053_3).fract()]
}

/// A cosine-distributed direction.
pub(crate) fn cosine(u: [f64; 2]) -> DVec3 {
    let (sin, phi) = (u[0].sqrt(), 2.0 * std::f64::consts::PI * u[1]);
    DVec3::new(sin * phi.cos(), sin * phi.sin(), (1.0 - u[0]).sqrt())
}
