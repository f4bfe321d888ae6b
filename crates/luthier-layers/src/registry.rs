//! Registry of all models by name.

use glam::DVec2;
use luthier_model::ShadingModel;

use crate::effects::flakes::FlakeMean;
use crate::effects::fluorescence::Fluorescence;
use crate::effects::heterogeneous::{Heterogeneous, Pattern};
use crate::effects::patina::PatinaAt;
use crate::model::Model;
use crate::models::densities::Density;
use crate::models::diffuse::{Lambert, OrenNayar};
use crate::models::room;
use crate::references::closed_form::ClosedForm;
use crate::references::layered_mc::{InterfaceMode, LayeredMc};
use crate::references::random_walk::RandomWalk;

/// Every model, in the order of listings: by kind, those with a shader first.
pub fn models() -> Vec<Box<dyn Model>> {
    let mut models: Vec<Box<dyn Model>> =
        ShadingModel::ALL.into_iter().flat_map(|model| (room(model).models)()).collect();
    models.extend([
        Box::new(Lambert) as Box<dyn Model>,
        Box::new(OrenNayar),
        Box::new(Fluorescence),
        Box::new(FlakeMean::default()),
        Box::new(PatinaAt::default()),
    ]);
    models.extend(Pattern::ALL.map(|pattern| Box::new(Heterogeneous::new(pattern, DVec2::ZERO)) as Box<dyn Model>));
    models.extend(Density::ALL.map(|density| Box::new(density) as Box<dyn Model>));
    models.extend([
        Box::new(RandomWalk::new()) as Box<dyn Model>,
        Box::new(LayeredMc::new(InterfaceMode::SmithWalk)),
        Box::new(LayeredMc::new(InterfaceMode::OneFacet)),
        Box::new(ClosedForm),
    ]);
    models.sort_by_key(|model| model.info().kind);
    models
}

/// The model with a name; `None` for an unknown name.
pub fn model(name: &str) -> Option<Box<dyn Model>> {
    models().into_iter().find(|model| model.info().name == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_unique_and_found() {
        let names: Vec<&str> = models().iter().map(|model| model.info().name).collect();
        for (i, name) in names.iter().enumerate() {
            assert!(!names[..i].contains(name), "{name} twice");
            assert_eq!(model(name).map(|model| model.info().name), Some(*name));
        }
        let kinds: Vec<_> = models().iter().map(|model| model.info().kind).collect();
        assert!(kinds.is_sorted(), "{kinds:?}");
        assert!(model("").is_none() && model("Phong").is_none());
    }
}
