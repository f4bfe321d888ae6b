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

/// Models beside lobes.
const MODELS: [ShadingModel; 6] = [
    ShadingModel::Phong,
    ShadingModel::Microfacet,
    ShadingModel::WeidlichWilkie,
    ShadingModel::Elek,
    ShadingModel::Belcour,
    ShadingModel::Yamaguchi,
];

/// A model or formula on a stack.
#[derive(Debug, Clone)]
pub(super) struct Rival {
    /// Name in tables.
    pub(super) name: &'static str,
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
    for shaded in MODELS {
        let Some(model) = model(shaded.name()) else { continue };
        let judged = largest(&reference.errors(Shown::Model(model.as_ref())));
        let costs = Some(by(shaded, material, device)?);
        found.push(Rival { name: shaded.name(), judged, costs });
    }
    for drawn in drawn {
        let judged = largest(&reference.errors(Shown::Values(&|wi, wo| drawn.eval(wi, wo))));
        let timed = drawn.yardstick.map(|yardstick| costs(device, |lights| count(&yardstick.wgsl(), &[], lights)));
        found.push(Rival { name: drawn.engine, judged, costs: timed.transpose()? });
    }
    Ok(found)
}
