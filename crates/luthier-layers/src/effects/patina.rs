//! Patina: a first layer that has grown over the others in places.

use std::f64::consts::FRAC_1_PI;

use glam::DVec3;

use crate::frame;
use crate::model::{Claims, Input, Inputs, Kind, Model, ModelInfo};
use crate::models::elek::Elek;
use crate::monochrome::Monochrome;

/// Patina over the layers of a stack, at one wavelength (Elek 2010, section 4.2): the stack's first layer is the patina.
///
/// Where it has grown, scattering in it shows as a diffuse term, and the layer below may have become rougher and darker.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Patina {
    /// Extent of its growth, in `-transition..=1 + transition`.
    pub extent: f64,
    /// Softness of its boundary, 0..=1.
    pub transition: f64,
    /// Diffuse reflectance that stands for scattering in the patina. The paper multiplies it by a term of the absorption spectrum, in a line of code
    /// that is lost; here the product is given.
    pub diffuse_albedo: f64,
    /// Slope parameter of the layer below grown patina; `None` leaves that layer unchanged.
    pub base_alpha: Option<f64>,
    /// Factor on the reflection of the layer below grown patina.
    pub tarnish: f64,
}

impl Patina {
    /// Amount of patina at a value of the map (0..=1; dark places come first):
    /// `clamp(1/2 + (extent - map) / (2 transition), 0, 1)`, a step at transition 0.
    ///
    /// The paper's line of code is lost. As its text demands, this form gives 0 at extent -transition and 1 at extent 1 + transition, for every
    /// value of the map.
    ///
    /// ```
    /// use luthier_layers::effects::patina::{Patina, PatinaAt};
    ///
    /// let patina = Patina { extent: 0.5, transition: 0.25, ..PatinaAt::default().patina };
    /// assert_eq!([0.0, 0.25, 0.5, 0.625, 1.0].map(|map| patina.amount(map)), [1.0, 1.0, 0.5, 0.25, 0.0]);
    /// ```
    pub fn amount(&self, map: f64) -> f64 {
        let ahead = self.extent - map;
        if self.transition > 0.0 {
            (0.5 + ahead / (2.0 * self.transition)).clamp(0.0, 1.0)
        } else if ahead >= 0.0 {
            1.0
        } else {
            0.0
        }
    }

    /// `f cos_theta_i` of Elek's model at a value of the map. The amount of patina blends the model with and without the first layer, and also the
    /// roughness and the tarnish of the layer below.
    pub fn eval(&self, stack: &Monochrome, map: f64, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        let amount = self.amount(map);
        let tarnish = 1.0 + (self.tarnish - 1.0) * amount;
        let mut grown = stack.clone();
        if let (Some(layer), Some(base_alpha)) = (grown.layers.get_mut(1), self.base_alpha) {
            for alpha in [&mut layer.surface.alpha_x, &mut layer.surface.alpha_y] {
                *alpha += (base_alpha - *alpha) * amount;
            }
        }
        let mut bare = grown.clone();
        if !bare.layers.is_empty() {
            bare.layers.remove(0);
        }
        if let Some(layer) = bare.layers.first_mut() {
            layer.above = bare.exterior;
        }

        let mut value = 0.0;
        if amount < 1.0 {
            value += (1.0 - amount) * Elek::default().eval_tinted(&bare, [tarnish, tarnish], wi, wo, DVec3::Z);
        }
        if amount > 0.0 {
            let passed = grown.layers.first().map_or(1.0, |l| 1.0 - l.reflectance(frame::cos_theta_d(wi, wo)));
            let layered = Elek::default().eval_tinted(&grown, [1.0, tarnish], wi, wo, DVec3::Z);
            value += amount * (layered + passed * self.diffuse_albedo * FRAC_1_PI * wi.z);
        }
        value
    }
}

/// Patina at one value of its map: the model without a texture.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct PatinaAt {
    /// The patina.
    pub patina: Patina,
    /// The map's value, 0..=1.
    pub map: f64,
}

impl Default for PatinaAt {
    /// Half grown, a pale diffuse reflectance, no tarnish.
    fn default() -> Self {
        let patina = Patina { extent: 0.5, transition: 0.5, diffuse_albedo: 0.3, base_alpha: None, tarnish: 1.0 };
        Self { patina, map: 0.5 }
    }
}

impl Model for PatinaAt {
    fn info(&self) -> ModelInfo {
        ModelInfo {
            name: "patina",
            kind: Kind::Place,
            claims: Claims::RECIPROCAL,
            inputs: &[Input::Extent, Input::Map],
            source: "Elek 2010, section 4.2",
            domain: "a first layer that has grown over the rest; half grown, diffuse reflectance 0.3",
            leaves_out: "what Elek's model leaves out; scattering in the patina is a Lambert term",
        }
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.patina.eval(stack, self.map, wi, wo)
    }

    fn with_inputs(&self, inputs: &Inputs) -> Option<Box<dyn Model>> {
        let patina = Patina { extent: inputs.extent.unwrap_or(self.patina.extent), ..self.patina };
        Some(Box::new(Self { patina, map: inputs.map.unwrap_or(self.map) }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::monochrome::MonochromeBelow;
    use luthier_optics::stack::{Distribution, Surface};
    use num_complex::Complex64;

    const PATINA: Patina =
        Patina { extent: 0.4, transition: 0.25, diffuse_albedo: 0.0, base_alpha: None, tarnish: 1.0 };

    fn copper() -> Monochrome {
        let coat = MonochromeBelow::Dielectric { ior: 3.1, complex_ior: Complex64::new(3.1, 0.19), optical_depth: 0.2 };
        let metal = MonochromeBelow::Conductor { ior: Complex64::new(1.04, 2.59) };
        let surface = |alpha| Surface::isotropic(Distribution::Beckmann, alpha);
        Monochrome::bare(&[(surface(0.5), coat), (surface(0.1), metal)])
    }

    /// The ranges that the paper states for its two parameters.
    #[test]
    fn it_covers_nothing_at_one_end_and_all_at_the_other() {
        for transition in [0.0, 0.2, 0.65, 1.0] {
            for map in [1e-12, 0.5, 1.0] {
                let at = |extent| Patina { extent, transition, ..PATINA }.amount(map);
                assert!(at(-transition) < 1e-15, "{transition} {map}");
                assert!(at(1.0 + transition) > 1.0 - 1e-15, "{transition} {map}");
            }
        }
        assert_eq!(PATINA.amount(0.4), 0.5);
        assert!(PATINA.amount(0.3) > PATINA.amount(0.5));
    }

    #[test]
    fn its_ends_are_the_models_with_and_without_the_layer() {
        let (wi, wo) = (DVec3::new(0.2, 0.1, 0.9).normalize(), DVec3::new(-0.3, 0.2, 0.8).normalize());
        let stack = copper();
        let bare = Monochrome::joined(1.0, vec![stack.layers[1].clone()]);
        assert_eq!(PATINA.eval(&stack, 1.0, wi, wo), Elek::default().eval(&bare, wi, wo));
        assert_eq!(PATINA.eval(&stack, 0.0, wi, wo), Elek::default().eval(&stack, wi, wo));
        // Halfway there: the mean.
        let mean = 0.5 * (Elek::default().eval(&bare, wi, wo) + Elek::default().eval(&stack, wi, wo));
        assert!((PATINA.eval(&stack, 0.4, wi, wo) - mean).abs() < 1e-15);
        // Tarnish takes its part of a bare metal's light where the patina is about to grow.
        let dark = Patina { tarnish: 0.5, extent: 0.4, ..PATINA };
        assert!(dark.eval(&stack, 0.4, wi, wo) < PATINA.eval(&stack, 0.4, wi, wo));
    }
}
