//! Textures of normal, roughness and thickness in front of any model.

use glam::DVec3;
use luthier_optics::Rgb;

use crate::frame;
use crate::model::{Estimate, Estimator, Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow};

/// Values of normal, roughness and thickness textures at one place (Elek 2010, Algorithm 1, line 2, and section 3).
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TextureSample {
    /// Normal, unit, in the surface's frame.
    pub normal: DVec3,
    /// Factor on the slope parameters of every layer; results are clamped to 0..=1.
    pub alpha_factor: f64,
    /// Factor on the thickness of the slab below the first interface.
    pub slab_factor: f64,
    /// Factor on the thickness of the films on the first interface.
    pub film_factor: f64,
    /// Variance, along either axis, of the slopes of a pixel's normals. Squared slope parameters grow by twice this variance.
    pub slope_variance: f64,
}

impl TextureSample {
    /// The sample where there is no texture.
    pub const NONE: Self =
        Self { normal: DVec3::Z, alpha_factor: 1.0, slab_factor: 1.0, film_factor: 1.0, slope_variance: 0.0 };

    /// A slope parameter with the variance of the normals.
    pub(crate) fn widened(&self, alpha: f64) -> f64 {
        if self.slope_variance > 0.0 { libm::sqrt(alpha * alpha + 2.0 * self.slope_variance) } else { alpha }
    }

    /// The stack with the factors of the place.
    pub fn apply(&self, stack: &Monochrome) -> Monochrome {
        let mut here = stack.clone();
        for layer in &mut here.layers {
            for alpha in [&mut layer.surface.alpha_x, &mut layer.surface.alpha_y] {
                *alpha = self.widened(*alpha * self.alpha_factor).clamp(0.0, 1.0);
            }
        }
        if let Some(layer) = here.layers.first_mut() {
            for film in &mut layer.films {
                film.waves *= self.film_factor;
            }
            if let MonochromeBelow::Dielectric { optical_depth, .. } = &mut layer.below {
                *optical_depth *= self.slab_factor;
            }
        }
        here
    }

    /// `f cos_theta_i` of a model at the place; the cosine is that against the sampled normal.
    pub fn eval(&self, model: &dyn Model, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return 0.0;
        }
        model.eval(&self.apply(stack), frame::local(self.normal, wi), frame::local(self.normal, wo))
    }
}

/// A model at a place with textures.
pub struct Textured {
    /// Values of the textures at the place.
    pub sample: TextureSample,
    /// The model.
    pub model: Box<dyn Model>,
}

impl Model for Textured {
    fn info(&self) -> ModelInfo {
        self.model.info()
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        self.sample.eval(self.model.as_ref(), stack, wi, wo)
    }

    fn eval_rgb(&self, channels: &[(f64, Monochrome); 3], wi: DVec3, wo: DVec3) -> Option<Rgb> {
        let here = channels.each_ref().map(|(nm, stack)| (*nm, self.sample.apply(stack)));
        let [wi_local, wo_local] = [wi, wo].map(|w| frame::local(self.sample.normal, w));
        let seen = wi.z > 0.0 && wo.z > 0.0;
        self.model.eval_rgb(&here, wi_local, wo_local).map(|rgb| if seen { rgb } else { [0.0; 3] })
    }

    fn estimator(&self) -> Option<&dyn Estimator> {
        self.model.estimator().map(|_| self as &dyn Estimator)
    }

    fn stack_index(&self) -> usize {
        self.model.stack_index()
    }

    fn lossless(&self, stack: &Monochrome) -> Monochrome {
        self.model.lossless(stack)
    }
}

impl Estimator for Textured {
    fn eval_with_error(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> Estimate {
        match self.model.estimator() {
            Some(own) if wi.z > 0.0 && wo.z > 0.0 => {
                let [wi, wo] = [wi, wo].map(|w| frame::local(self.sample.normal, w));
                own.eval_with_error(&self.sample.apply(stack), wi, wo)
            }
            _ => Estimate::exact(self.eval(stack, wi, wo)),
        }
    }

    fn albedo_with_error(&self, stack: &Monochrome, wo: DVec3, up: DVec3) -> Estimate {
        let [wo, up] = [wo, up].map(|w| frame::local(self.sample.normal, w));
        let own = self.model.estimator();
        own.map_or(Estimate::exact(0.0), |own| own.albedo_with_error(&self.sample.apply(stack), wo, up))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::models::elek::Elek;
    use luthier_optics::fresnel::FilmLayer;
    use luthier_optics::stack::{Distribution, Surface};
    use num_complex::Complex64;

    fn coated(alpha: f64, optical_depth: f64, waves: f64) -> Monochrome {
        let coat = (Surface::isotropic(Distribution::Ggx, alpha), MonochromeBelow::dielectric(1.5, optical_depth));
        let base = (Surface::smooth(), MonochromeBelow::Diffuse { albedo: 0.5, sigma: 0.0 });
        let mut stack = Monochrome::bare(&[coat, base]);
        stack.layers[0].films.push(FilmLayer { ior: Complex64::new(1.3, 0.0), waves });
        stack
    }

    #[test]
    fn each_texture_acts_on_its_own_quantity() {
        let (wi, wo) = (DVec3::new(0.3, 0.0, 0.7).normalize(), DVec3::new(-0.1, 0.2, 0.7).normalize());
        let sample = TextureSample { alpha_factor: 0.5, slab_factor: 3.0, film_factor: 2.0, ..TextureSample::NONE };
        assert_eq!(sample.apply(&coated(0.4, 0.1, 0.2)), coated(0.2, 0.1 * 3.0, 0.4));
        // Turning normal and directions together changes nothing.
        let turned = TextureSample { normal: DVec3::new(0.1, -0.2, 0.9).normalize(), ..TextureSample::NONE };
        let stack = coated(0.4, 0.1, 0.2);
        let back = |w: DVec3| {
            let [x, y, z] = [DVec3::X, DVec3::Y, DVec3::Z].map(|e| frame::local(turned.normal, e));
            DVec3::new(x.dot(w), y.dot(w), z.dot(w))
        };
        let expected = Elek::default().eval(&stack, wi, wo);
        assert!((turned.eval(&Elek::default(), &stack, back(wi), back(wo)) / expected - 1.0).abs() < 1e-12);
    }

    /// A textured model is the model at the place: estimators keep their error, and colour of its own is that of the film at the place.
    #[test]
    fn a_textured_model_is_the_model_at_the_place() {
        use crate::formulas::interface_fresnel::Fresnel;
        use crate::models::microfacet::{Components, Microfacet};
        use crate::references::layered_mc::{InterfaceMode, LayeredMc};
        let (wi, wo) = (DVec3::new(0.3, 0.0, 0.7).normalize(), DVec3::new(-0.1, 0.2, 0.7).normalize());
        let sample = TextureSample { alpha_factor: 0.5, film_factor: 2.0, ..TextureSample::NONE };
        let (stack, here) = (coated(0.4, 0.1, 0.2), coated(0.2, 0.1, 0.4));
        let reference = LayeredMc { samples: 64, ..LayeredMc::new(InterfaceMode::SmithWalk) };
        let textured = Textured { sample, model: Box::new(reference) };
        let estimator = textured.estimator().unwrap();
        assert_eq!(estimator.eval_with_error(&stack, wi, wo), reference.eval_with_error(&here, wi, wo));
        assert_eq!(estimator.albedo_with_error(&stack, wo, DVec3::Z), reference.albedo_with_error(&here, wo, DVec3::Z));
        assert_eq!(textured.eval(&stack, wi, wo), reference.eval(&here, wi, wo));

        let prefiltered = || Microfacet::new(Components { fresnel: Fresnel::BelcourBarla, ..Components::PLAIN });
        let channels = |stack: &Monochrome| [645.0, 525.0, 445.0].map(|nm| (nm, stack.clone()));
        let textured = Textured { sample, model: Box::new(prefiltered()) };
        let found = textured.eval_rgb(&channels(&stack), wi, wo);
        assert_eq!(found, prefiltered().eval_rgb(&channels(&here), wi, wo));
        assert!(found.is_some() && textured.estimator().is_none());
    }
}
