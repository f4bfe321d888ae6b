//! Factors that rows of a material are over, and how many rows there are.

use luthier_layers::models::lobes::{Cover, Family, FitSettings, Varied, Varying, base_below, shown};
use luthier_manifest::MapSlot;
use luthier_material::{Material, Patina};
use luthier_optics::interface::Interface;

/// Rows of a fit.
pub(super) const ROWS: usize = FitSettings::DEFAULT_ROWS;

/// Numbers of rows that are kept, among which a search chooses.
pub(super) const KEPT: [usize; 4] = [ROWS, 10, 7, 4];

/// Rows of a fit of its own, of a search where none of the others is near enough.
pub(super) const FINE_ROWS: usize = 2 * ROWS - 1;

/// The factor that a texture varies and that rows are over, or the slope parameters and colours of single layers. A material has at most one of these.
pub(super) fn varying(material: &Material) -> Option<Varying> {
    let first = material.layers.first()?;
    let family = material.family().and_then(|ranges| {
        Some(
            Family::new(&shown(&material.stack), ranges.coat, ranges.base, ranges.is_metallic)?
                .tinted(ranges.is_tinted)
                .below_varied_slab(ranges.has_lengths),
        )
    });
    if let Some(family) = family {
        return Some(Varying::Family(family));
    }
    let slab = first.varies_slab().then_some(Varying::Slab);
    let scaled =
        first.varies(MapSlot::Roughness).then_some(Varying::Alpha).or(slab).or_else(|| Varying::film(&material.stack));
    let is_covered = material.is_bare_in_places() && !material.has_side();
    let covers = is_covered.then_some(match &material.effects.patina {
        &Some(Patina { diffuse_albedo, base_alpha, tarnish, .. }) => Cover { diffuse_albedo, base_alpha, tarnish },
        None => Cover::PLAIN,
    });
    scaled.or_else(|| covers.map(Varying::Patina))
}

/// The layers below a coat with a weight, if they have rows of their own.
pub(super) fn side(material: &Material) -> Option<Material> {
    material.side().filter(has_rows)
}

/// Whether a material has rows: a diffuse base alone has a closed form.
pub(crate) fn has_rows(material: &Material) -> bool {
    Interface::of(&material.stack, 0).is_some()
}

/// Whether a material has rows over the view alone, or over the azimuth too, and none of other layers beside them.
pub fn has_lone_rows(material: &Material) -> bool {
    has_rows(material) && varying(material).is_none() && !material.is_bare_in_places()
}

/// Whether rows are those of a family.
pub(super) fn is_family(varying: Option<Varying>) -> bool {
    matches!(varying, Some(Varying::Family(_)))
}

/// Most layers of a stack with rows over something beside the view: such a stack has a fit for each of its tiles. The
/// time of a fit is proportional to the layers. With transparent layers of alpha 0.25, a fit of 50 takes 31 s of a
/// core, and one of 16 under a roughness map 46 s: no fit takes a minute.
pub const VARIED_LAYERS_MAX: usize = 16;

/// Whether a material of the model `lobes` has more layers than can be fitted.
pub fn is_too_deep(material: &Material) -> bool {
    let is_varied = |material: &Material| Varied::tiles_of(&shown(&material.stack), varying(material)) > 1;
    material.stack.layers.len() > VARIED_LAYERS_MAX
        && material.model().is_fitted()
        && (is_varied(material) || side(material).is_some())
}

/// Materials of the model.
pub(super) fn of_model(materials: &[Material]) -> impl Iterator<Item = &Material> {
    materials.iter().filter(|material| material.model().is_fitted())
}

/// Whether rows of a material contain the light of a diffuse base, as parts before the others. Families have parts of their own.
pub(super) fn has_base(material: &Material) -> bool {
    let is_other = matches!(varying(material), Some(Varying::Patina(_) | Varying::Family(_)));
    !is_other && base_below(&material.stack).is_some()
}
