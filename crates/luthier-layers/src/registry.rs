//! Registry of all models by name.

use glam::DVec2;
use luthier_model::InternalReflection;

use crate::effects::flakes::FlakeMean;
use crate::effects::fluorescence::Fluorescence;
use crate::effects::heterogeneous::{Heterogeneous, Pattern};
use crate::effects::patina::PatinaAt;
use crate::lobes::Fitted;
use crate::model::Model;
use crate::models::belcour::Belcour;
use crate::models::densities::Density;
use crate::models::diffuse::{Lambert, OrenNayar};
use crate::models::elek::Elek;
use crate::models::granier_heidrich::GranierHeidrich;
use crate::models::microfacet::{Microfacet, VARIANTS};
use crate::models::phong::Phong;
use crate::models::statistics::evaluate::Follow;
use crate::models::weidlich_wilkie::{Refraction, WeidlichWilkie};
use crate::models::weidlich_wilkie_corrected::WeidlichWilkieCorrected;
use crate::models::yamaguchi::Yamaguchi;
use crate::references::closed_form::ClosedForm;
use crate::references::layered_mc::{InterfaceMode, LayeredMc};
use crate::references::random_walk::RandomWalk;

/// Every model, in the order of listings: by kind.
pub fn models() -> Vec<Box<dyn Model>> {
    let microfacets =
        VARIANTS.iter().map(|(_, components, _)| Box::new(Microfacet::new(*components)) as Box<dyn Model>);
    let heterogeneous =
        Pattern::ALL.map(|pattern| Box::new(Heterogeneous::new(pattern, DVec2::ZERO)) as Box<dyn Model>);
    let densities = Density::ALL.map(|density| Box::new(density) as Box<dyn Model>);
    let mut models: Vec<Box<dyn Model>> = microfacets.collect();
    models.extend([Box::new(Lambert) as Box<dyn Model>, Box::new(OrenNayar), Box::new(Phong)]);
    models.extend([
        Box::new(WeidlichWilkie::default()) as Box<dyn Model>,
        Box::new(WeidlichWilkie { internal_reflection: InternalReflection::Directions, ..WeidlichWilkie::default() }),
        Box::new(WeidlichWilkie { refraction: Refraction::Facet, ..WeidlichWilkie::default() }),
        Box::new(WeidlichWilkieCorrected),
        Box::new(Elek::default()),
        Box::new(GranierHeidrich::default()),
        Box::new(Belcour::new(Follow::Eye)),
        Box::new(Belcour::new(Follow::HalfVector)),
        Box::new(Yamaguchi::new(Follow::Eye)),
        Box::new(Yamaguchi::new(Follow::HalfVector)),
        Box::new(Fitted::default()),
        Box::new(Fluorescence),
    ]);
    models.extend([Box::new(FlakeMean::default()) as Box<dyn Model>, Box::new(PatinaAt::default())]);
    models.extend(heterogeneous);
    models.extend(densities);
    models.extend([
        Box::new(RandomWalk::new()) as Box<dyn Model>,
        Box::new(LayeredMc::new(InterfaceMode::SmithWalk)),
        Box::new(LayeredMc::new(InterfaceMode::OneFacet)),
        Box::new(ClosedForm),
    ]);
    models
}

/// The model of a name.
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
