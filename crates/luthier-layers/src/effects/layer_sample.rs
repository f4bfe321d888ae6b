//! Textures of one layer: its own normal, slope parameters, tangent and slab.

use std::f64::consts::PI;

use glam::{DVec2, DVec3};
use luthier_optics::Rgb;
use luthier_optics::schlick::F82;
use luthier_optics::stack::{Base, Layer, Slab};

/// Length below which a texel of tangents has no direction: grey of eight bits is half a step, 0.004, from the middle.
const NO_DIRECTION: f64 = 0.02;

/// Values of the textures of one layer at one place: `LuthierLayerPlace` of the shaders.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LayerSample {
    /// Normal of this layer's interface alone, unit, in the frame of the place; for `elek`, `weidlich-wilkie` and `lobes`.
    pub normal: DVec3,
    /// Factors on its slope parameters along the tangent and along the bitangent.
    pub alpha_factors: [f64; 2],
    /// Direction that its tangent is turned to, unit, in the plane of the surface: x is no turn.
    pub tangent: DVec2,
    /// Factor on the thickness of the slab below it.
    pub slab_factor: f64,
    /// Factors on what that slab absorbs, RGB.
    pub absorption_factors: Rgb,
    /// F0 and edge tint by channel in place of the interface's own, if that is one of Schlick's.
    pub f0: Option<[F82; 3]>,
}

impl LayerSample {
    /// The sample of a layer without textures.
    pub const NONE: Self = Self {
        normal: DVec3::Z,
        alpha_factors: [1.0; 2],
        tangent: DVec2::X,
        slab_factor: 1.0,
        absorption_factors: [1.0; 3],
        f0: None,
    };

    /// The direction of a tangent from a texel of two channels, `2 texel - 1 = (cos 2 theta, sin 2 theta)`. A tangent is a line without a head: with
    /// doubled angles, texels may be averaged across any turn. A texel without a direction turns nothing.
    pub fn tangent_of(texel: [f64; 2]) -> DVec2 {
        let doubled = DVec2::new(2.0 * texel[0] - 1.0, 2.0 * texel[1] - 1.0);
        if doubled.length() < NO_DIRECTION {
            return DVec2::X;
        }
        let half = 0.5 * libm::atan2(doubled.y, doubled.x);
        DVec2::new(libm::cos(half), libm::sin(half))
    }

    /// The factor for models with one slope parameter: the geometric mean of both.
    pub(crate) fn alpha_factor(&self) -> f64 {
        libm::sqrt(self.alpha_factors[0] * self.alpha_factors[1])
    }

    /// Whether it changes slope parameters, their directions, or the F0.
    pub(crate) fn has_slopes_or_f0(&self) -> bool {
        self.alpha_factors != [1.0; 2] || self.tangent != DVec2::X || self.f0.is_some()
    }

    /// Scales what a slab absorbs.
    pub(crate) fn tint(&self, slab: &mut Slab) {
        (0..3).for_each(|c| slab.absorption_per_um[c] *= self.absorption_factors[c]);
    }

    /// Turns the tangent of a layer, and scales its slab; its slope parameters depend on the model.
    pub(crate) fn apply(&self, layer: &mut Layer) {
        let surface = &mut layer.surface;
        if self.tangent != DVec2::X {
            surface.rotation += libm::atan2(self.tangent.y, self.tangent.x);
            surface.rotation %= 2.0 * PI;
        }
        if let Base::Dielectric { slab, ior } = &mut layer.base {
            slab.thickness_um *= self.slab_factor;
            self.tint(slab);
            if let (Some(curves), Some(_)) = (self.f0, ior.f0()) {
                *ior = ior.clone().with_f82(curves);
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Lines at 179 degrees and at 1 degree are two degrees apart: their texels average to 0 degrees, which angles would not.
    #[test]
    fn tangents_average_across_the_turn() {
        let texel = |degrees: f64| {
            let doubled = (2.0 * degrees).to_radians();
            [0.5 + 0.5 * libm::cos(doubled), 0.5 + 0.5 * libm::sin(doubled)]
        };
        let [a, b] = [texel(179.0), texel(1.0)];
        let mean = LayerSample::tangent_of([0.5 * (a[0] + b[0]), 0.5 * (a[1] + b[1])]);
        assert!((mean - DVec2::X).length() < 1e-12, "{mean}");
        for degrees in [0.0, 30.0, 89.0] {
            let found = LayerSample::tangent_of(texel(degrees));
            assert!((found - DVec2::from_angle(degrees.to_radians())).length() < 1e-12, "{degrees}: {found}");
        }
        assert_eq!(LayerSample::tangent_of([0.5; 2]), DVec2::X);
    }
}
