//! Drawn directions of light, with their densities, for any model.

use std::f64::consts::{FRAC_1_PI, TAU};

use luthier_layers::frame::local;
use luthier_layers::glam::DVec3;
use luthier_layers::layers::ALPHA_MIN;
use luthier_layers::models::weidlich_wilkie::sampling::Sampler;
use luthier_layers::monochrome::Monochrome;

use super::{Subject, nearest_channel};

/// Wavelength of the stack that directions are drawn from.
const WAVELENGTH_NM: f64 = 550.0;

/// Share of the draws that a cosine about the normal gets. No model is without density anywhere, so means over draws have no bias.
const COSINE: f64 = 0.1;

/// Draws of light for a subject: the layers as `wo` sees them (Weidlich and Wilkie 2009, eq. 3.6), mixed with a cosine. Every model with a shader has the same
/// draws of a material, so that two of them can be compared at the same directions. The other models have those, too, unless an interface is smooth: shaders
/// raise its slope parameters further.
///
/// ```
/// # use std::sync::Arc;
/// # use luthier::function::{Draws, Inputs, Subject};
/// # use luthier_layers::glam::DVec3;
/// # let text = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.8\n";
/// # let chalk = luthier::parse("chalk.toml", text)?;
/// # let model = luthier_layers::registry::model("elek").ok_or("no such model")?;
/// # let fit = Arc::new(luthier_layers::models::lobes::Varied::of);
/// # let subject = Subject::new(model, chalk, None, fit, &Inputs::default(), None)?;
/// let draws = Draws::new(&subject);
/// let (wi, pdf) = draws.sample(DVec3::Z, [0.5, 0.3, 0.7]).ok_or("below the horizon")?;
/// assert!((draws.pdf_solid_angle(wi, DVec3::Z) - pdf).abs() < 1e-9);
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Debug, Clone)]
pub struct Draws {
    stack: Monochrome,
    normal: DVec3,
}

impl Draws {
    /// The draws of a subject.
    pub fn new(subject: &Subject) -> Self {
        let mut shown = subject.place.stack(&subject.material.stack);
        if subject.model.info().shading().is_some() {
            // Lobes that are drawn narrower than they are shown have weights of a hundred beside their peaks.
            for surface in shown.layers.iter_mut().map(|layer| &mut layer.surface) {
                surface.alpha_x = surface.alpha_x.max(ALPHA_MIN);
                surface.alpha_y = surface.alpha_y.max(ALPHA_MIN);
            }
        }
        let stack = Monochrome::new(&shown, WAVELENGTH_NM, nearest_channel(WAVELENGTH_NM));
        Self { stack, normal: subject.place.sample.normal }
    }

    /// A direction, and its density in solid angle, from three numbers in 0..1; `None` where the draw is below the horizon.
    pub fn sample(&self, wo: DVec3, [choice, u, v]: [f64; 3]) -> Option<(DVec3, f64)> {
        let wo_here = local(self.normal, wo);
        if wo.z <= 0.0 || wo_here.z <= 0.0 {
            return None;
        }
        let layers = Sampler::new(&self.stack, wo_here);
        let drawn = if choice < COSINE {
            let (sin_phi, cos_phi) = libm::sincos(TAU * v);
            let radius = libm::sqrt(u);
            DVec3::new(radius * cos_phi, radius * sin_phi, libm::sqrt(1.0 - u))
        } else {
            layers.sample([(choice - COSINE) / (1.0 - COSINE), u, v])?.0
        };
        // The least rotation back is that to the normal's mirror image.
        let wi = local(DVec3::new(-self.normal.x, -self.normal.y, self.normal.z), drawn);
        let pdf = mixed(&layers, drawn);
        (wi.z > 0.0 && pdf > 0.0).then_some((wi, pdf))
    }

    /// The density in solid angle with which `wi` is drawn; 0 where either direction is below a horizon. Its integral is 1 less the share of draws below
    /// the horizon.
    pub fn pdf_solid_angle(&self, wi: DVec3, wo: DVec3) -> f64 {
        let [wi_here, wo_here] = [wi, wo].map(|w| local(self.normal, w));
        if [wi, wo, wi_here, wo_here].iter().any(|w| w.z <= 0.0) {
            return 0.0;
        }
        mixed(&Sampler::new(&self.stack, wo_here), wi_here)
    }
}

/// The density of the mixture, in the frame of the place.
fn mixed(layers: &Sampler, wi: DVec3) -> f64 {
    COSINE * FRAC_1_PI * wi.z + (1.0 - COSINE) * layers.pdf_solid_angle(wi)
}

#[cfg(test)]
mod tests {
    use std::sync::Arc;

    use luthier_layers::directional_albedo::integral;
    use luthier_layers::models::lobes::Varied;
    use luthier_layers::registry::model;

    use super::*;
    use crate::function::{Color, Function, Inputs, Kind};

    /// A rough coat over a red base, and a normal that leans.
    fn lacquer(normal: DVec3) -> Arc<Subject> {
        let text = "schema = 1\nname = \"lacquer\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.3\n\
                    [[layer]]\ntype = \"diffuse\"\nalbedo = [0.5, 0.1, 0.1]\n";
        let material = crate::parse("lacquer.toml", text).unwrap();
        let inputs = Inputs { normal: Some(normal), ..Inputs::default() };
        Arc::new(Subject::new(model("elek").unwrap(), material, None, Arc::new(Varied::of), &inputs, None).unwrap())
    }

    /// Oracle: the quadrature of the model. A density integrates to 1 where the normal is that of the surface, and means of weights are albedos.
    #[test]
    fn densities_integrate_to_one_and_weights_to_albedos() {
        let wo = DVec3::new(0.6, 0.0, 0.8);
        for (normal, least) in [(DVec3::Z, 0.9995), (DVec3::new(0.0, 0.28, 0.96), 0.9)] {
            let subject = lacquer(normal);
            let draws = Draws::new(&subject);
            let [all] = integral(&|wi| [draws.pdf_solid_angle(wi, wo)], DVec3::new(-0.6, 0.0, 0.8), 64);
            assert!((least..1.0005).contains(&all), "{all}");

            let function = Function::new(&subject, &Kind::Color(Color::Spectral));
            let side = 64;
            let at = |i: u32| (f64::from(i) + 0.5) / f64::from(side);
            let mut mean = 0.0;
            for (a, (b, c)) in (0..side).flat_map(|a| (0..side).flat_map(move |b| (0..side).map(move |c| (a, (b, c)))))
            {
                if let Some((wi, pdf)) = draws.sample(wo, [at(a), at(b), at(c)]) {
                    assert!((draws.pdf_solid_angle(wi, wo) / pdf - 1.0).abs() < 1e-9);
                    mean += function.values(wi, wo)[0].mean / pdf / f64::from(side * side * side);
                }
            }
            let albedo = function.albedo(wo).values[0].mean;
            assert!((mean - albedo).abs() < 2e-3, "{mean} {albedo}");
        }
    }

    /// Oracle: a part of a mixture that is drawn as it is shown has weights of about its reflectance over its share of the draws, here less than 3.
    #[test]
    fn weights_of_a_smooth_coat_are_small() {
        let text = "schema = 1\nname = \"varnish\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nsmooth = true\n\
                    [[layer]]\ntype = \"conductor\"\nior = \"al\"\nalpha = 0.4\n";
        let material = crate::parse("varnish.toml", text).unwrap();
        let inputs = Inputs::default();
        let fit = Arc::new(Varied::of);
        let subject = Arc::new(Subject::new(model("elek").unwrap(), material, None, fit, &inputs, None).unwrap());
        let (draws, function) = (Draws::new(&subject), Function::new(&subject, &Kind::Color(Color::Spectral)));
        let wo = DVec3::new(0.6, 0.0, 0.8);
        let at = |i: u32| (f64::from(i) + 0.5) / 64.0;
        // The first draws are of the cosine, the next of the coat.
        let mut coat = 0;
        for (a, (b, c)) in (6..64).flat_map(|a| (0..64).flat_map(move |b| (0..64).map(move |c| (a, (b, c))))) {
            let Some((wi, pdf)) = draws.sample(wo, [at(a), at(b), at(c)]) else { continue };
            if (wi - DVec3::new(-0.6, 0.0, 0.8)).length() < 0.01 {
                coat += 1;
                let weight = function.values(wi, wo)[0].mean / pdf;
                assert!(weight < 3.0, "{weight} at {wi}");
            }
        }
        assert!(coat > 1000, "{coat}");
    }
}
