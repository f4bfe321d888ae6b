//! Questions about models, which their rows of facts answer.

use luthier_lut::TableKind;

use crate::domain::COMMON;
use crate::facts::{Facts, Family, Shows};
use crate::rows::row;
use crate::{DefaultFor, Feature, Form, Limit, Masking, ModelPart, ShadingModel};

impl ShadingModel {
    /// Its number in the material buffer.
    pub const fn number(self) -> u32 {
        self as u32
    }

    /// Its row of facts.
    pub const fn facts(self) -> &'static Facts {
        row(self)
    }

    /// The heading of a model in f64, by its name: the heading of the shader's model that it is a form of or stands beside.
    pub fn heading_of(name: &str) -> Option<&'static str> {
        let kin = Self::ALL.iter().find(|kin| name.starts_with(kin.name()) || kin.facts().beside.contains(&name));
        kin.map(|model| model.facts().heading)
    }

    /// Name and source, for headers and reports.
    pub const fn title(self) -> &'static str {
        self.facts().title
    }

    /// Whether its shader has a form; a model that exists in tables alone has the form `baked` only.
    pub fn has(self, form: Form) -> bool {
        self.facts().forms.contains(&form)
    }

    /// Whether the shader of a form shows a feature of a material. Tests of luthier-shader and luthier-scene compare every
    /// entry with what shaders and their f64 twins do.
    pub fn honours(self, feature: Feature, form: Form) -> bool {
        let Shows { always, baked, full } = &self.facts().shows;
        let in_form = if form == Form::Baked { baked } else { full };
        always.iter().any(|group| group.contains(&feature)) || in_form.contains(&feature)
    }

    /// Whether it goes down a path of refracted directions, layer by layer.
    pub fn is_path(self) -> bool {
        self.facts().family == Family::Path
    }

    /// Whether it follows light through the layers as statistics of lobes.
    pub fn is_statistical(self) -> bool {
        self.facts().family == Family::Statistics
    }

    /// Whether its light from below the first interface is simulated and fitted.
    pub fn is_fitted(self) -> bool {
        self.facts().family == Family::Lobes
    }

    /// Whether a material may choose a part of it.
    pub fn takes(self, part: ModelPart) -> bool {
        self.facts().takes(part)
    }

    /// Whether a material may choose a masking of it: any of a model of facets alone, V-cavities or Kelemen's of one that goes down a path.
    pub fn takes_masking(self, masking: Masking) -> bool {
        let is_of_path = matches!(masking, Masking::VCavity | Masking::Kelemen);
        self.takes(ModelPart::Masking) || is_of_path && self.takes(ModelPart::CavityMasking)
    }

    /// Whether its `baked` shader reads a kind of table for some interface.
    pub fn reads_some(self, kind: TableKind) -> bool {
        self.facts().tables.iter().any(|table| table.kind == kind)
    }

    /// The ranges within which it may be used: those of all models, and its own.
    pub fn limits(self) -> impl Iterator<Item = &'static Limit> {
        COMMON.iter().chain(self.facts().domain)
    }
}

impl DefaultFor {
    /// The models to choose among, the first choice first.
    pub fn models(self) -> impl Iterator<Item = ShadingModel> {
        let ranked = ShadingModel::ALL.into_iter().filter_map(|model| {
            model.facts().default_for.iter().find(|(of, _)| *of == self).map(|(_, rank)| (*rank, model))
        });
        let mut ranked: Vec<(u8, ShadingModel)> = ranked.collect();
        ranked.sort_unstable();
        ranked.into_iter().map(|(_, model)| model)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Feature, Form};

    #[test]
    fn names_and_numbers_are_those_of_files_and_buffers() {
        for (i, model) in ShadingModel::ALL.into_iter().enumerate() {
            assert_eq!(model.number() as usize, i);
            assert!(model.title().starts_with(model.name()), "{model}");
            assert_eq!(ShadingModel::from_name(model.name()), Some(model));
            assert_eq!(serde_json::to_string(&model).unwrap(), format!("\"{}\"", model.name()));
        }
        assert_eq!(ShadingModel::from_name("Elek"), None);
    }

    #[test]
    fn ranks_are_places_of_a_list() {
        for of in [DefaultFor::Stack, DefaultFor::Facets, DefaultFor::Closed] {
            let ranks = |model: ShadingModel| model.facts().default_for.iter().find(|(other, _)| *other == of);
            let places: Vec<usize> = of.models().map(|model| usize::from(ranks(model).unwrap().1)).collect();
            assert!(!places.is_empty() && places.iter().copied().eq(0..places.len()), "{of:?}: {places:?}");
        }
    }

    /// Whatever a file asks for, some model of the list shows it. A lean is refused for models without beams.
    #[test]
    fn the_last_closed_form_shows_everything() {
        let last = DefaultFor::Closed.models().last().unwrap();
        let mut shown = Feature::ALL.into_iter().filter(|feature| *feature != Feature::LeanMap);
        assert!(shown.all(|feature| last.honours(feature, Form::Baked)));
    }
}
