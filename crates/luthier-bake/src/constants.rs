//! What shaders need of a whole surface.

use luthier_layers::monochrome::{Monochrome, in_color};
use luthier_layers::phong::Coefficients;
use luthier_lut::{FlakesRecord, MaterialConstants, PatinaRecord};
use luthier_material::{Effects, FlakeSource, Material};
use luthier_optics::stack::Stack;

use crate::plan::{color, is_statistical, shading_model};
use crate::veil::veil;

/// The constants of a material.
pub(crate) fn constants(material: &Material) -> MaterialConstants {
    let (stack, color) = (&material.stack, color(material));
    let (internal_reflectance, upward_loss) =
        if is_statistical(shading_model(material)) { veil(stack, &color) } else { ([0.0; 3], 0.0) };
    MaterialConstants {
        phong_diffuse: in_color(stack, &color, |one| Coefficients::of(one).diffuse),
        phong_specular: in_color(stack, &color, |one| Coefficients::of(one).specular),
        phong_exponent: exponent(stack, material.bake.wavelengths_nm()),
        internal_reflectance,
        upward_loss,
        flakes: flakes(&material.effects),
        patina: patina(&material.effects),
    }
}

/// One lobe has one exponent: that of the green wavelength.
fn exponent(stack: &Stack, [_, green_nm, _]: [f64; 3]) -> f64 {
    Coefficients::of(&Monochrome::new(stack, green_nm, 1)).exponent
}

/// Flakes that are a grid of cells; those of a normal map are the map's.
fn flakes(effects: &Effects) -> Option<FlakesRecord> {
    let flakes = effects.flakes.as_ref()?;
    let FlakeSource::Cells { seed, count, spread } = flakes.source else { return None };
    let (tiling, scale, fade_start) = (flakes.tiling, flakes.scale, flakes.fade_start);
    Some(FlakesRecord { seed, count, tiling, spread, scale, fade_start })
}

fn patina(effects: &Effects) -> Option<PatinaRecord> {
    let patina = effects.patina.as_ref()?;
    Some(PatinaRecord {
        extent: patina.extent,
        transition: patina.transition,
        diffuse_albedo: patina.diffuse_albedo,
        base_alpha: patina.base_alpha,
        tarnish: patina.tarnish,
    })
}
