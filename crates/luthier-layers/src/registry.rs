//! All models by name.

use crate::belcour::Belcour;
use crate::elek_model::Elek;
use crate::facets::Masking;
use crate::flakes::FlakeMean;
use crate::granier_heidrich::GranierHeidrich;
use crate::layered_mc::{InterfaceMode, LayeredMc};
use crate::microfacet::Microfacet;
use crate::model::Model;
use crate::patina::PatinaAt;
use crate::phong::Phong;
use crate::random_walk::RandomWalk;
use crate::statistics::evaluate::Follow;
use crate::weidlich_wilkie::{Refraction, Transmission, WeidlichWilkie};
use crate::weidlich_wilkie_corrected::WeidlichWilkieCorrected;
use crate::yamaguchi::Yamaguchi;

/// Every model, in the order of listings.
pub fn models() -> Vec<Box<dyn Model>> {
    vec![
        Box::new(Phong),
        Box::new(Microfacet { masking: Masking::Smith }),
        Box::new(Microfacet { masking: Masking::VCavity }),
        Box::new(Elek),
        Box::new(FlakeMean::default()),
        Box::new(PatinaAt::default()),
        Box::new(WeidlichWilkie::default()),
        Box::new(WeidlichWilkie { transmission: Transmission::Directions, ..WeidlichWilkie::default() }),
        Box::new(WeidlichWilkie { refraction: Refraction::Facet, ..WeidlichWilkie::default() }),
        Box::new(WeidlichWilkieCorrected::new()),
        Box::new(GranierHeidrich::default()),
        Box::new(Belcour::new(Follow::Eye)),
        Box::new(Belcour::new(Follow::HalfVector)),
        Box::new(Yamaguchi::new(Follow::Eye)),
        Box::new(Yamaguchi::new(Follow::HalfVector)),
        Box::new(RandomWalk::new()),
        Box::new(LayeredMc::new(InterfaceMode::SmithWalk)),
        Box::new(LayeredMc::new(InterfaceMode::OneFacet)),
    ]
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
        assert!(model("").is_none() && model("Phong").is_none());
    }
}
