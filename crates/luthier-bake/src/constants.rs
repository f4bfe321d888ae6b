//! Constants of a whole surface for shaders.

use luthier_layers::models::phong::Coefficients;
use luthier_layers::monochrome::Monochrome;
use luthier_manifest::ModelPart;
use luthier_manifest::{
    BrighteningRecord, CoatRecord, FlakesRecord, GlitterRecord, LayerRecord, LobesRecord, MaterialConstants,
    PatinaRecord, SideRecord,
};
use luthier_material::{Effects, FlakeSource, Glitter, LayerExtras, Material};
use luthier_optics::brightening::Brightening;
use luthier_optics::stack::Stack;

use crate::veil::veil;

/// The constants of a material. `bare` is the record of the layer below its patina or its coat, `lobes` the fitted numbers, and `side` those of the layers
/// below its coat where these are apart.
pub(crate) fn constants(
    material: &Material,
    bare: Option<LayerRecord>,
    lobes: Option<LobesRecord>,
    side: Option<SideRecord>,
) -> MaterialConstants {
    let (stack, color) = (&*material.reflecting_stack(), material.color());
    let (internal_reflectance, upward_loss) =
        if material.model().is_statistical() { veil(stack, &color) } else { ([0.0; 3], 0.0) };
    let crossed = stack.crossed_once();
    let [phong_diffuse, phong_specular] = Coefficients::in_color(&crossed, &color);
    MaterialConstants {
        phong_diffuse,
        phong_specular,
        phong_exponent: exponent(&crossed, material.bake.wavelengths_nm()),
        internal_reflectance,
        upward_loss,
        lobes,
        beams: material.beams().filter(|_| material.model().takes(ModelPart::Beams)),
        diffuse_term: material
            .bake
            .diffuse_term
            .filter(|_| material.model().takes(ModelPart::DiffuseTerm))
            .unwrap_or_default(),
        flakes: flakes(&material.effects),
        patina: bare.clone().and_then(|bare| patina(&material.effects, bare)),
        coat: bare.and_then(|bare| Some(CoatRecord { weight: material.weight()?, bare, side })),
        brightening: material.layers.iter().find_map(brightening),
        glitter: glitter(&material.effects),
    }
}

/// The shares of a `metallic-roughness` surface below a coat, and its base colour in the file.
fn brightening(layer: &LayerExtras) -> Option<BrighteningRecord> {
    let (Brightening { diffuse, metal }, surface) = (layer.brightening?, layer.metallic?);
    Some(BrighteningRecord { diffuse, metal, base_color: surface.base_color })
}

/// Exponent of the one lobe of all channels, at the green wavelength.
fn exponent(stack: &Stack, [_, green_nm, _]: [f64; 3]) -> f64 {
    Coefficients::of(&Monochrome::new(stack, green_nm, 1)).exponent
}

fn flakes(effects: &Effects) -> Option<FlakesRecord> {
    let flakes = effects.flakes.as_ref()?;
    let (seed, count, spread) = match flakes.source {
        FlakeSource::Cells { seed, count, spread } => (seed, count, spread),
        FlakeSource::NormalMap(_) | FlakeSource::HeightMap { .. } => (0, 0, 0.0),
    };
    let (tiling, scale, fade_start) = (flakes.tiling, flakes.scale, flakes.fade_start);
    Some(FlakesRecord { seed, count, tiling, spread, scale, fade_start })
}

fn glitter(effects: &Effects) -> Option<GlitterRecord> {
    let &Glitter { seed, frequency, filled, tilt } = effects.glitter.as_ref()?;
    Some(GlitterRecord { seed, frequency, filled, tilt })
}

fn patina(effects: &Effects, bare: LayerRecord) -> Option<PatinaRecord> {
    let patina = effects.patina.as_ref()?;
    Some(PatinaRecord {
        extent: patina.extent,
        transition: patina.transition,
        diffuse_albedo: patina.diffuse_albedo,
        base_alpha: patina.base_alpha,
        tarnish: patina.tarnish,
        bare,
    })
}
