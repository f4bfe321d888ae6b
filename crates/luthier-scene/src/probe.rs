//! Directions at which candidates and reference are compared.

use std::f64::consts::PI;

use glam::DVec3;
use luthier_layers::layers::ALPHA_MIN;
use luthier_manifest::SceneDirection;
use luthier_material::{Light, View};
use luthier_optics::stack::{Base, Stack};

/// Directions at which a model is compared with the reference.
///
/// ```
/// use luthier_material::{Light, View};
/// use luthier_optics::ior::Ior;
/// use luthier_optics::stack::Stack;
/// use luthier_scene::{Probe, probes};
///
/// let (bare, view) = (Stack { exterior: Ior::vacuum(), layers: vec![] }, View { angles_deg: [0.0, 60.0], footprint_deg: 0.0 });
/// // Light from everywhere is compared at three views.
/// let found = probes(&bare, &[Light::Environment], &view);
/// assert!(found.len() == 3 && found.iter().all(|probe| matches!(probe, Probe::Sky { .. })));
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Probe {
    /// `f cos theta_i` for a pair of directions.
    Pair {
        /// Direction to the light.
        wi: DVec3,
        /// Direction to the eye.
        wo: DVec3,
    },
    /// Directional albedo over pi: light of radiance 1/pi from everywhere.
    Sky {
        /// Direction to the eye.
        wo: DVec3,
    },
}

impl Probe {
    /// Its angles.
    pub(crate) fn direction(&self) -> SceneDirection {
        match *self {
            Self::Pair { wi, wo } => {
                let around = libm::atan2(wo.x * wi.y - wo.y * wi.x, wo.x * wi.x + wo.y * wi.y).abs();
                SceneDirection { eye_deg: theta_deg(wo), light_deg: Some([theta_deg(wi), tenths_deg(around)]) }
            }
            Self::Sky { wo } => SceneDirection { eye_deg: theta_deg(wo), light_deg: None },
        }
    }
}

/// Angle between a direction and the normal.
fn theta_deg(w: DVec3) -> f64 {
    tenths_deg(libm::acos(w.z.clamp(-1.0, 1.0)))
}

/// An angle in degrees, to a tenth.
fn tenths_deg(radians: f64) -> f64 {
    (10.0 * radians.to_degrees()).round() / 10.0
}

/// Azimuth of the eye in the surface's frame: neither along nor across the axes of an anisotropic surface.
const AZIMUTH_DEG: f64 = 30.0;
/// Steps over the range of view angles, and of a point light's angles to the eye.
const STEPS: [f64; 3] = [0.0, 0.5, 1.0];
/// Azimuths about the eye, counted from the light, towards which normals lean.
const LEANS_DEG: [f64; 3] = [0.0, 90.0, 180.0];
/// Slopes of normals away from the half vector, over the slope parameter: top, flank and foot of a highlight.
const FLANKS: [f64; 4] = [0.0, 0.5, 1.0, 2.0];
/// Least cosine of light and eye.
const COS_THETA_MIN: f64 = 0.05;

/// The directions of a scene.
///
/// A curved object shows every normal in the range of view angles. For each light, normals lean from the eye by three view angles at three
/// azimuths, and both directions are turned into the frame of each normal. Highlights have normals at the half vector, and at slopes of 1/2, 1
/// and 2 times each slope parameter from it. Light from everywhere is seen at the three view angles.
pub fn probes(stack: &Stack, lights: &[Light], view: &View) -> Vec<Probe> {
    let [least, most] = view.angles_deg;
    let thetas = STEPS.map(|step| (least + step * (most - least)).to_radians());
    let mut found = Vec::new();
    for light in lights {
        let apart: Vec<f64> = match *light {
            Light::Directional { from_eye_deg } => vec![from_eye_deg.to_radians()],
            Light::Point { from_eye_deg: [near, far] } => {
                STEPS.iter().map(|step| (near + step * (far - near)).to_radians()).collect()
            }
            Light::Environment => {
                found.extend(thetas.map(|theta| Probe::Sky { wo: direction(theta, AZIMUTH_DEG.to_radians()) }));
                continue;
            }
        };
        for apart in apart {
            for theta in thetas {
                for lean in LEANS_DEG {
                    found.extend(pair(apart, theta, lean.to_radians()));
                    if theta == 0.0 {
                        break;
                    }
                }
            }
            // The normal of the highlight, if it is in view.
            if (thetas[0]..=thetas[2]).contains(&(0.5 * apart)) {
                for (i, alpha) in alphas(stack).into_iter().enumerate() {
                    // The top of the highlight is common to all slope parameters.
                    for flank in FLANKS.into_iter().skip(usize::from(i > 0)) {
                        found.extend(beside(apart, libm::atan(flank * alpha)));
                    }
                }
            }
        }
    }
    found.dedup();
    found
}

/// The stack as a pixel sees it. The footprint widens the slopes of every interface, and slope parameters are at least the smallest of the models.
/// Smooth interfaces then reflect a lobe instead of a single direction, in the models as in the reference.
pub fn footprint(stack: &Stack, footprint_deg: f64) -> Stack {
    let slope = libm::tan(footprint_deg.to_radians());
    let mut stack = stack.clone();
    for layer in stack.layers.iter_mut().filter(|layer| !matches!(layer.base, Base::Diffuse(_))) {
        for alpha in [&mut layer.surface.alpha_x, &mut layer.surface.alpha_y] {
            *alpha = libm::hypot(*alpha, slope).clamp(ALPHA_MIN, 1.0);
        }
    }
    stack
}

/// The slope parameters of a stack, each once, from the top down.
fn alphas(stack: &Stack) -> Vec<f64> {
    let mut found: Vec<f64> = Vec::new();
    for layer in stack.layers.iter().filter(|layer| !matches!(layer.base, Base::Diffuse(_))) {
        let alpha = layer.surface.alpha_isotropic();
        if !found.contains(&alpha) {
            found.push(alpha);
        }
    }
    found
}

/// Eye at +z, light `apart` from it; the normal leans from the eye by `theta` at azimuth `lean` from the light's.
fn pair(apart: f64, theta: f64, lean: f64) -> Option<Probe> {
    in_frame(direction(apart, 0.0), direction(theta, lean))
}

/// The normal leans from the half vector by `tilt`, across the plane of eye and light.
fn beside(apart: f64, tilt: f64) -> Option<Probe> {
    let half = direction(0.5 * apart, 0.0);
    in_frame(direction(apart, 0.0), half * libm::cos(tilt) + DVec3::Y * libm::sin(tilt))
}

/// Eye and light in the frame of a normal; `None` if one of them is near or below the horizon.
fn in_frame(light: DVec3, normal: DVec3) -> Option<Probe> {
    let eye = DVec3::Z;
    let along = eye - normal * eye.dot(normal);
    // If the eye lies along the normal, any tangent will do. The guard keeps `normalize` away from rounding errors of zero.
    let along = if along.length() > 1e-9 { along } else { DVec3::X - normal * normal.x };
    let (x, z) = (along.normalize(), normal);
    let y = z.cross(x);
    let (sin, cos) = (libm::sin(AZIMUTH_DEG.to_radians()), libm::cos(AZIMUTH_DEG.to_radians()));
    let [wi, wo] = [light, eye].map(|w| {
        let (a, b) = (w.dot(x), w.dot(y));
        DVec3::new(cos * a - sin * b, sin * a + cos * b, w.dot(z)).normalize()
    });
    (wi.z >= COS_THETA_MIN && wo.z >= COS_THETA_MIN).then_some(Probe::Pair { wi, wo })
}

fn direction(theta: f64, phi: f64) -> DVec3 {
    let (sin, cos) = (libm::sin(theta), libm::cos(theta));
    DVec3::new(sin * libm::cos(phi), sin * libm::sin(phi), cos)
}

/// Points along each of four parts of the hemisphere.
const POINTS: usize = 24;

/// Directions over the hemisphere with their weights for an integral over solid angle. They crowd at the mirror direction of `wo`, because lobes
/// are narrow there.
pub(crate) fn hemisphere(wo: DVec3) -> Vec<(DVec3, f64)> {
    let theta_o = libm::acos(wo.z.clamp(0.0, 1.0));
    let mirror = libm::atan2(-wo.y, -wo.x);
    let thetas = crowded(theta_o, [-theta_o, 0.5 * PI - theta_o]);
    let phis = crowded(mirror, [PI, -PI]);
    let mut found = Vec::with_capacity(thetas.len() * phis.len());
    for &(theta, theta_weight) in &thetas {
        for &(phi, phi_weight) in &phis {
            found.push((direction(theta, phi), theta_weight * phi_weight * libm::sin(theta)));
        }
    }
    found
}

/// Points and weights of two intervals that begin at `start`; by the third power they crowd there.
fn crowded(start: f64, spans: [f64; 2]) -> Vec<(f64, f64)> {
    let rule = luthier_optics::quadrature::gauss_legendre(POINTS);
    let points = spans.into_iter().flat_map(|span| rule.iter().map(move |&(u, weight)| (span, u, weight)));
    points.map(|(span, u, weight)| (start + span * u * u * u, 3.0 * u * u * weight * span.abs())).collect()
}

#[cfg(test)]
mod tests {
    use luthier_optics::ior::Ior;
    use luthier_optics::stack::{Distribution, Layer, Surface};

    use super::*;

    fn gold(alpha: f64) -> Stack {
        let surface = Surface::isotropic(Distribution::Ggx, alpha);
        let base = Base::Conductor { ior: Ior::constant(0.2, 3.0).unwrap() };
        Stack { exterior: Ior::vacuum(), layers: vec![Layer { films: Vec::new(), surface, base }] }
    }

    #[test]
    fn lights_keep_their_angle_to_the_eye_and_views_their_range() {
        let view = View { angles_deg: [10.0, 70.0], footprint_deg: 0.0 };
        let found = probes(&gold(0.1), &[Light::Directional { from_eye_deg: 50.0 }, Light::Environment], &view);
        let mut seen = Vec::new();
        for probe in &found {
            let wo = match *probe {
                Probe::Pair { wi, wo } => {
                    assert!((wi.dot(wo) - libm::cos(50_f64.to_radians())).abs() < 1e-12);
                    assert!(wi.z > 0.0 && (wi.length() - 1.0).abs() < 1e-12);
                    wo
                }
                Probe::Sky { wo } => wo,
            };
            let theta = libm::acos(wo.z).to_degrees();
            assert!((9.99..71.0).contains(&theta), "{theta}");
            seen.push(theta);
        }
        // The highlight: normal and half vector agree, where both lean by 25 degrees.
        let top = found.iter().any(|p| matches!(p, Probe::Pair { wi, wo } if (*wi + *wo).normalize().z > 1.0 - 1e-12));
        assert!(top && seen.iter().any(|t| (t - 25.0).abs() < 1e-6), "{seen:?}");
    }

    #[test]
    fn the_hemisphere_is_whole() {
        for theta in [0.0, 0.5, 1.3] {
            let points = hemisphere(direction(theta, 0.4));
            let solid: f64 = points.iter().map(|(_, weight)| weight).sum();
            let cosine: f64 = points.iter().map(|(w, weight)| w.z * weight).sum();
            assert!((solid - 2.0 * PI).abs() < 1e-9 && (cosine - PI).abs() < 1e-9, "{solid} {cosine}");
        }
    }

    #[test]
    fn a_footprint_adds_slopes() {
        let wide = footprint(&gold(0.03), libm::atan(0.04_f64).to_degrees());
        assert!((wide.layers[0].surface.alpha_x - 0.05).abs() < 1e-12);
        assert_eq!(footprint(&gold(0.0), 0.0).layers[0].surface.alpha_x, ALPHA_MIN);
    }
}
