//! Disney's clearcoat of 2012.
//!
//! Source: wdas/brdf, `src/brdfs/disney.brdf`, and Burley 2012, "Physically-Based Shading at Disney", section 5.
//!
//! To the letter: the coat is added, `.25 clearcoat` times GTR1, Schlick's reflectance of .04 at the half vector and the masking of GGX with slope
//! parameter .25; nothing is taken from the base. `specular` is .5, an F0 of .04; the diffuse base has Burley's factors at grazing angles.
//!
//! A choice here: `clearcoatGloss` reaches slope parameters of .001 to .1; that of the coat is given to GTR1 as it is, also beyond .1.

use std::f64::consts::{FRAC_1_PI, PI};

use super::surface::{F0, Pair, Shader, Surface, grazing, rgb};

/// D of GTR with exponent 1.
fn gtr1(alpha: f64, cos_theta_h: f64) -> f64 {
    let square = alpha * alpha;
    (square - 1.0) / (PI * libm::log(square) * (1.0 + (square - 1.0) * cos_theta_h * cos_theta_h))
}

/// `smithG_GGX` of .25 for one direction.
fn masked(cos_theta: f64) -> f64 {
    let square = 0.25 * 0.25;
    1.0 / (cos_theta + (square + cos_theta * cos_theta * (1.0 - square)).sqrt())
}

fn diffuse(at: &Pair, alpha: f64) -> f64 {
    let f90 = 0.5 + 2.0 * at.d * at.d * alpha.sqrt();
    let side = |cos: f64| 1.0 + (f90 - 1.0) * grazing(cos);
    side(at.i) * side(at.o) * FRAC_1_PI
}

pub(super) fn shader(surface: &Surface) -> Shader {
    let (surface, alpha) = (surface.clone(), surface.alpha_or(surface.alpha));
    let (scale, f0) = (surface.scale_or([1.0; 3]), surface.mixed_f0());
    Box::new(move |at| {
        let (lobe, edge, matt) = (at.separable(alpha), grazing(at.d), diffuse(at, alpha));
        let coat = surface
            .coat
            .map_or(0.0, |coat| 0.25 * gtr1(coat, at.h) * masked(at.i) * masked(at.o) * (F0 + (1.0 - F0) * edge));
        rgb(|c| {
            let base = matt * surface.color[c] * (1.0 - surface.metallic) + (f0[c] + (1.0 - f0[c]) * edge) * lobe;
            (scale[c] * base + coat) * at.i
        })
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Oracle: a density over projected facets integrates to 1.
    #[test]
    fn gtr1_is_normalised() {
        for alpha in [0.05, 0.4] {
            let steps = 20_000;
            let sum: f64 = (0..steps)
                .map(|step| {
                    // Over the squared cosine: the integral of D cos over the hemisphere is pi times that of D over cos^2.
                    let square = (f64::from(step) + 0.5) / f64::from(steps);
                    PI * gtr1(alpha, square.sqrt()) / f64::from(steps)
                })
                .sum();
            assert!((sum - 1.0).abs() < 2e-3, "{alpha} {sum}");
        }
    }
}
