//! Integrals over directions around a mirror direction, fine enough near it for the narrowest lobe.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::model::Model;
use luthier_layers::monochrome::Monochrome;

/// Steps of the logarithmic grading: the first ring is `PI e^-GRADE` wide.
const GRADE: f64 = 18.0;

/// The direction at an angle from the normal, azimuth 0.
pub(crate) fn at(theta_deg: f64) -> DVec3 {
    let theta = theta_deg.to_radians();
    DVec3::new(theta.sin(), 0.0, theta.cos())
}

pub(crate) fn mirrored(w: DVec3) -> DVec3 {
    DVec3::new(-w.x, -w.y, w.z)
}

/// Angle from the centre at a graded coordinate in 0..1, and its derivative.
pub(crate) fn radius(u: f64) -> (f64, f64) {
    let scale = PI / GRADE.exp_m1();
    (scale * (GRADE * u).exp_m1(), scale * GRADE * (GRADE * u).exp())
}

/// The inverse of [`radius`].
pub(crate) fn coordinate(radius: f64) -> f64 {
    (radius / PI * GRADE.exp_m1()).ln_1p() / GRADE
}

/// A frame around a centre.
pub(crate) fn frame(centre: DVec3) -> [DVec3; 3] {
    let (x, y) = centre.any_orthonormal_pair();
    [x, y, centre]
}

pub(crate) fn direction([x, y, z]: [DVec3; 3], radius: f64, phi: f64) -> DVec3 {
    radius.sin() * (phi.cos() * x + phi.sin() * y) + radius.cos() * z
}

/// Integral over the sphere, `rings` by `sectors` midpoints graded towards a centre.
pub(crate) fn integral(centre: DVec3, rings: u32, sectors: u32, mut f: impl FnMut(DVec3) -> f64) -> f64 {
    let frame = frame(centre);
    let mut sum = 0.0;
    for i in 0..rings {
        let (r, slope) = radius((f64::from(i) + 0.5) / f64::from(rings));
        let weight = r.sin() * slope / f64::from(rings) * 2.0 * PI / f64::from(sectors);
        for j in 0..sectors {
            let phi = 2.0 * PI * (f64::from(j) + 0.5) / f64::from(sectors);
            sum += weight * f(direction(frame, r, phi));
        }
    }
    sum
}

/// Rings and sectors: 1e-4 up to 60 degrees, for any roughness.
const FINE: (u32, u32) = (500, 48);

/// Directional albedo for light from `wi`.
pub(crate) fn albedo(model: &dyn Model, stack: &Monochrome, wi: DVec3) -> f64 {
    integral(mirrored(wi), FINE.0, FINE.1, |wo| model.eval(stack, wi, wo) * wo.z / wi.z)
}

/// The light that `wo` sees from a white sky; equal to [`albedo`] for a reciprocal model.
pub(crate) fn furnace(model: &dyn Model, stack: &Monochrome, wo: DVec3) -> f64 {
    integral(mirrored(wo), FINE.0, FINE.1, |wi| model.eval(stack, wi, wo))
}
