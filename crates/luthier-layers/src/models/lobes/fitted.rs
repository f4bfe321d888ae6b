//! The model at one wavelength, for stacks that it fits itself.

use std::collections::VecDeque;
use std::fmt;
use std::sync::{Arc, Mutex, PoisonError};

use glam::DVec3;
use luthier_optics::color::Color;
use luthier_optics::ior::Ior;
use luthier_optics::schlick::F82;
use luthier_optics::stack::{Base, Diffuse, Film, FilmThickness, Layer, Slab, Stack};
use num_complex::Complex64;

use super::{Fit, INFO, Lobes, Varied, bare_diffuse};
use crate::model::{Model, ModelInfo};
use crate::monochrome::{Monochrome, MonochromeBelow, MonochromeLayer};

/// Stacks whose lobes are kept.
const KEPT: usize = 8;

/// Least real part of an index. A perfect mirror has none; with this one it reflects a hundred millionth less.
const INDEX_MIN: f64 = 1e-9;

/// A wavelength for indices that do not depend on it.
const WAVELENGTH_NM: f64 = 550.0;

/// The model `lobes` for single wavelengths. It simulates a stack at the first value, for a second or so, and keeps the last eight stacks.
pub struct Fitted {
    fit: Arc<Fit<'static>>,
    kept: Mutex<VecDeque<(Monochrome, Arc<Lobes>)>>,
}

impl Default for Fitted {
    fn default() -> Self {
        Self::by(Arc::new(Varied::of))
    }
}

impl fmt::Debug for Fitted {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Fitted").field("kept", &self.kept).finish_non_exhaustive()
    }
}

impl Fitted {
    /// The model with the lobes of a function that fits them.
    pub fn by(fit: Arc<Fit<'static>>) -> Self {
        Self { fit, kept: Mutex::default() }
    }

    /// The lobes of a stack; `None` where an index is infinite or not a number.
    fn lobes(&self, stack: &Monochrome) -> Option<Arc<Lobes>> {
        // Fits under the lock: other threads that ask for the stack wait, rather than fit it again.
        let mut kept = self.kept.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some((_, lobes)) = kept.iter().find(|(known, _)| known == stack) {
            return Some(lobes.clone());
        }
        let color = Color::ThreeWavelengths([WAVELENGTH_NM; 3]);
        let lobes = Arc::new((self.fit)(&in_all_colors(stack)?, &color, None).nominal());
        kept.truncate(KEPT - 1);
        kept.push_front((stack.clone(), lobes.clone()));
        Some(lobes)
    }
}

impl Model for Fitted {
    fn info(&self) -> ModelInfo {
        INFO
    }

    fn eval(&self, stack: &Monochrome, wi: DVec3, wo: DVec3) -> f64 {
        if wi.z <= 0.0 || wo.z <= 0.0 || stack.layers.is_empty() {
            return 0.0;
        }
        bare_diffuse(stack, wi, wo).unwrap_or_else(|| self.lobes(stack).map_or(0.0, |lobes| lobes.eval(wi, wo)[0]))
    }
}

/// A stack in colour that equals this one at every wavelength and in every channel; `None` if an index is infinite or not a number.
fn in_all_colors(stack: &Monochrome) -> Option<Stack> {
    Some(Stack {
        exterior: constant(Complex64::from(stack.exterior), None)?,
        layers: stack.layers.iter().map(layer_in_all_colors).collect::<Option<_>>()?,
    })
}

fn layer_in_all_colors(layer: &MonochromeLayer) -> Option<Layer> {
    let films = layer.films.iter().map(|film| {
        let thickness_nm = film.waves * WAVELENGTH_NM;
        let thickness = FilmThickness { min_nm: thickness_nm, max_nm: thickness_nm };
        Some(Film { ior: constant(film.ior, None)?, thickness })
    });
    let films = films.collect::<Option<_>>()?;
    let base = match layer.below {
        MonochromeBelow::Dielectric { complex_ior, optical_depth, .. } => {
            let slab = Slab { thickness_um: 1.0, absorption_per_um: [optical_depth; 3] };
            Base::Dielectric { ior: constant(complex_ior, layer.f0)?, slab }
        }
        MonochromeBelow::Conductor { ior } => Base::Conductor { ior: constant(ior, layer.f0)? },
        MonochromeBelow::Diffuse { albedo, sigma } => Base::Diffuse(Diffuse { albedo: [albedo; 3], sigma }),
    };
    Some(Layer { films, surface: layer.surface, base })
}

/// An index for all wavelengths, with an F0 if the interface has one; `None` if it is infinite or not a number.
fn constant(ior: Complex64, f0: Option<F82>) -> Option<Ior> {
    let constant = Ior::constant(ior.re.max(INDEX_MIN), ior.im).ok()?;
    Some(match f0 {
        Some(F82 { f0, tint }) => constant.with_f0([f0; 3]).with_f82_tint([tint; 3]),
        None => constant,
    })
}

#[cfg(test)]
mod tests {
    use luthier_optics::fresnel::FilmLayer;
    use luthier_optics::stack::{Distribution, Surface};

    use super::*;

    #[test]
    fn a_stack_at_one_wavelength_is_itself_in_all_colors() {
        let film = FilmLayer { ior: Complex64::new(1.4, 0.1), waves: 0.7 };
        let surface = Surface::isotropic(Distribution::Ggx, 0.2);
        let mut stack = Monochrome::bare(&[
            (surface, MonochromeBelow::dielectric(1.5, 0.3)),
            (surface, MonochromeBelow::Conductor { ior: Complex64::new(0.2, 3.0) }),
        ]);
        stack.layers[0].films.push(film);
        stack.layers[1].f0 = Some(F82 { f0: 0.7, tint: 0.5 });
        let colored = in_all_colors(&stack).unwrap();
        for (nm, channel) in [(WAVELENGTH_NM, 0), (WAVELENGTH_NM, 2)] {
            assert_eq!(Monochrome::new(&colored, nm, channel), stack);
        }
    }
}
