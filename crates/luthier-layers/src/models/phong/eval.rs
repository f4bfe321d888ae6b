//! Twin of `eval.wgsl`, which reads the coefficients from the material buffer.

use glam::DVec3;
use luthier_optics::Rgb;

use super::Coefficients;
use crate::models::path::Tilts;
use crate::models::shade::{Given, Shade, ShaderTerms, Under};
use crate::monochrome::Monochrome;

#[derive(Debug)]
struct Twin([Coefficients; 3]);

/// The twin for a surface, with coefficients in colour. The channels share one lobe, whose exponent is that of the green wavelength.
pub(super) fn twin(given: &Given<'_>) -> Box<dyn Shade> {
    let [diffuse, specular] = Coefficients::in_color(given.stack, &given.color);
    let Coefficients { exponent, .. } = Coefficients::of(&Monochrome::new(given.stack, given.wavelengths_nm[1], 1));
    Box::new(Twin([0, 1, 2].map(|c| Coefficients { diffuse: diffuse[c], specular: specular[c], exponent })))
}

impl Shade for Twin {
    fn eval(&self, _: &dyn ShaderTerms, _: &Under, _: Tilts<'_>, wi: DVec3, wo: DVec3) -> Rgb {
        if wi.z <= 0.0 || wo.z <= 0.0 {
            return [0.0; 3];
        }
        let lobe = self.0[0].lobe(wi, wo);
        self.0.map(|coefficients| coefficients.with_lobe(wi, lobe))
    }
}
