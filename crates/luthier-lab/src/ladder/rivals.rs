//! Published models and formulas of engines on the stacks of a group, beside lobes.

use luthier_cost::DeviceCost;
use luthier_layers::registry::model;
use luthier_manifest::ShadingModel;
use luthier_material::Material;
use luthier_report::{Reference, Shown};
use luthier_shader::count;
use luthier_terminal::Outcome;

use super::steps::{Costs, by, costs};
use crate::coats::Drawn;
use crate::lobes::{QUANTITIES, largest};

/// Models beside lobes, with their names on the chart. Two of them are left out there: they lie on others of their kind.
const MODELS: [(ShadingModel, Option<&str>); 6] = [
    (ShadingModel::Phong, Some("Phong 1975")),
    (ShadingModel::Microfacet, Some("top layer alone")),
    (ShadingModel::WeidlichWilkie, None),
    (ShadingModel::Elek, Some("Elek 2010")),
    (ShadingModel::Belcour, Some("Belcour 2018")),
    (ShadingModel::Yamaguchi, None),
];

/// Where a formula comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A paper.
    Published,
    /// An engine, or a format of files.
    Engine,
    /// An engine, over a base that is changed once for the coat.
    Changed,
}

/// A model or formula on a stack.
#[derive(Debug, Clone)]
pub(super) struct Rival {
    /// Name in tables.
    pub(super) name: &'static str,
    /// Name on the chart, if it is there.
    pub(super) charted: Option<&'static str>,
    pub(super) kind: Kind,
    /// Lobe error and albedo error, the largest of all views.
    pub(super) judged: [f64; QUANTITIES],
    /// Costs, if it has a shader here.
    pub(super) costs: Option<Costs>,
}

/// Published models on a stack, then the formulas of engines, all in the same order for each stack of a group.
pub(super) fn rivals(
    material: &Material,
    drawn: &[Drawn],
    reference: &Reference,
    device: &DeviceCost,
) -> Outcome<Vec<Rival>> {
    let mut found = Vec::new();
    for (shaded, charted) in MODELS {
        let Some(model) = model(shaded.name()) else { continue };
        let judged = largest(&reference.errors(Shown::Model(model.as_ref())));
        let costs = Some(by(shaded, material, device)?);
        found.push(Rival { name: shaded.name(), charted, kind: Kind::Published, judged, costs });
    }
    for drawn in drawn {
        let judged = largest(&reference.errors(Shown::Values(&|wi, wo| drawn.eval(wi, wo))));
        let timed = drawn.yardstick.map(|yardstick| costs(device, |lights| count(&yardstick.wgsl(), &[], lights)));
        let (name, charted) = (drawn.engine, Some(short(drawn.engine)));
        let kind = if drawn.is_changed { Kind::Changed } else { Kind::Engine };
        found.push(Rival { name, charted, kind, judged, costs: timed.transpose()? });
    }
    Ok(found)
}

/// The name of an engine's formula without its place.
fn short(engine: &'static str) -> &'static str {
    match engine {
        "glTF KHR_materials_clearcoat" => "glTF clear coat",
        "Filament" => "Filament clear coat",
        "Standard Surface in MaterialX" => "Standard Surface",
        "OpenPBR in MaterialX" => "OpenPBR (MaterialX)",
        "adobe/openpbr-bsdf" => "OpenPBR (Adobe)",
        other => other,
    }
}
