//! Model candidates of a material, in the order of their cost.

use std::f64::consts::FRAC_1_PI;
use std::sync::{Arc, Mutex, OnceLock, PoisonError};

use luthier_layers::models::lobes::{FitSettings, Lobes, Traced, Varying, may_be_short, most_searched};
use luthier_layers::models::shade::ShaderTerms;
use luthier_layers::twins::real_time::Twin;
use luthier_layers::twins::terms::Exact;
use luthier_manifest::{ColorMode, Feature, Form, LobesForm, ShadingModel};
use luthier_material::Material;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::Stack;
use rayon::prelude::*;

use crate::cost::CostTable;
use crate::probe::{Probe, footprint, hemisphere};
use crate::shape::shape;
use crate::simplify::{LeaveOut, variants};

/// A way to shade a material.
///
/// ```
/// use luthier_manifest::Form;
/// use luthier_scene::{Candidate, CostTable};
///
/// let chalk = "schema = 1\nname = \"chalk\"\n[[layer]]\ntype = \"diffuse\"\nalbedo = 0.5\n";
/// let chalk = luthier_material::parse("chalk.toml", chalk, &|_| Err(std::io::ErrorKind::NotFound.into())).unwrap();
/// let all = Candidate::all(&chalk.material, Form::Full, &CostTable::shipped(), true);
/// assert!(all.len() > 1 && all.is_sorted_by_key(|candidate| candidate.cost));
/// ```
#[derive(Debug)]
pub struct Candidate {
    /// The model.
    pub model: ShadingModel,
    /// The form.
    pub form: Form,
    /// Colour of its Fresnel terms.
    pub color: ColorMode,
    /// Form of its rows, of the model `lobes`; `None` where rows are over more than the view.
    pub lobes: Option<LobesForm>,
    /// Parts that are left out.
    pub left_out: Vec<LeaveOut>,
    /// The material to bake: without the parts that are left out, with model, colour and form of rows as settings.
    pub material: Material,
    /// Cost of one evaluation, in the unit of the device of the costs.
    pub cost: f64,
    /// Whether the cost is that of a similar surface, because the costs lack this one.
    pub cost_is_of_similar: bool,
    values: OnceLock<Vec<Rgb>>,
    /// Values without a footprint, for a model whose tables hold the nominal roughness only.
    sharp_values: OnceLock<Vec<Rgb>>,
    fits: Arc<Fits>,
}

/// Lobes in each of [`LobesForm::ALL`], of stacks that were simulated; candidates of one material in one colour share them.
type Fits = Mutex<Vec<(Stack, Vec<Lobes>)>>;

/// The colour of a mode.
pub(crate) fn color_of(mode: ColorMode, material: &Material) -> Color {
    match mode {
        ColorMode::Spectral => Color::Spectral,
        ColorMode::ThreeWavelengths => Color::ThreeWavelengths(material.bake.wavelengths_nm()),
    }
}

impl Candidate {
    /// The candidates for a material, cheapest first. Among equal costs, those that leave out fewer parts come first, then those in the colour of
    /// the material.
    ///
    /// A candidate leaves out a part of the material only if it becomes cheaper. No candidate leaves out flakes, a patina or the weight of a coat.
    /// Where `has_forms`, rows of `lobes` have each of their forms.
    pub fn all(material: &Material, form: Form, costs: &CostTable, has_forms: bool) -> Vec<Self> {
        let own = material.bake.color.unwrap_or_default();
        let colors: &[ColorMode] = match (form, own) {
            (Form::Baked, ColorMode::Spectral) => &[ColorMode::Spectral, ColorMode::ThreeWavelengths],
            _ => &[ColorMode::ThreeWavelengths],
        };
        // The reference has no effects, so that its errors do not show a missing one: models without an effect of the material are no candidates.
        let effects = [
            (Feature::Flakes, material.effects.flakes.is_some()),
            (Feature::Patina, material.effects.patina.is_some()),
            (Feature::Weight, material.weight().is_some() && !material.weighs_film()),
            (Feature::FilmWeight, material.weight().is_some() && material.weighs_film()),
        ];
        let maps = (0..).zip(&material.layers).flat_map(|(i, layer)| layer.varied().map(move |(_, slot)| (i, slot)));
        let mut asked: Vec<Feature> = maps.filter_map(|(i, slot)| slot.layer_feature(i)).collect();
        asked.extend(effects.iter().filter(|(_, has)| *has).map(|(effect, _)| *effect));
        let mut found: Vec<Self> = Vec::new();
        for model in ShadingModel::ALL.into_iter().filter(|model| asked.iter().all(|&part| model.honours(part, form))) {
            let has_forms = has_forms && form == Form::Baked && model.is_fitted();
            let cost_of = |material: &Material, lobes| costs.cost(model, form, &shape(&material.stack), lobes);
            for (left_out, simple) in variants(material) {
                let fits: Vec<Arc<Fits>> = colors.iter().map(|_| Arc::default()).collect();
                for lobes in if has_forms { forms(&simple) } else { vec![None] } {
                    let whole = cost_of(material, lobes).map_or(f64::INFINITY, |(cost, _)| cost);
                    let Some((cost, cost_is_of_similar)) = cost_of(&simple, lobes) else { continue };
                    if !left_out.is_empty() && cost >= whole {
                        continue;
                    }
                    for (&color, fits) in colors.iter().zip(&fits) {
                        let mut material = simple.clone();
                        material.bake.model = Some(model);
                        material.bake.color = Some(color);
                        material.bake.lobes = lobes;
                        found.push(Self {
                            model,
                            form,
                            color,
                            lobes,
                            left_out: left_out.clone(),
                            material,
                            cost,
                            cost_is_of_similar,
                            values: OnceLock::new(),
                            sharp_values: OnceLock::new(),
                            fits: fits.clone(),
                        });
                    }
                }
            }
        }
        // The second sort is stable: candidates of equal cost keep the order of the first.
        found.sort_by_key(|c| (c.left_out.len(), c.color != own));
        found.sort_by(|a, b| a.cost.total_cmp(&b.cost));
        found
    }

    /// The candidate's values at probes, computed once.
    pub(crate) fn values(&self, probes: &[Probe], footprint_deg: f64) -> &[Rgb] {
        self.values.get_or_init(|| {
            let stack = footprint(&self.material.reflecting_stack(), footprint_deg);
            self.values_of(&stack, &self.exact(&stack), probes)
        })
    }

    /// The candidate's values at probes: on exact terms, and on terms of tables. Rows of lobes were simulated at the nominal roughness, so neither
    /// has a footprint for a fitted model.
    pub(crate) fn values_with(
        &self,
        terms: &(impl ShaderTerms + Sync),
        probes: &[Probe],
        footprint_deg: f64,
    ) -> (&[Rgb], Vec<Rgb>) {
        if self.model.is_fitted() {
            let stack = &*self.material.reflecting_stack();
            let exact = self.sharp_values.get_or_init(|| self.values_of(stack, &self.exact(stack), probes));
            return (exact, self.values_of(stack, terms, probes));
        }
        let stack = footprint(&self.material.reflecting_stack(), footprint_deg);
        (self.values(probes, footprint_deg), self.values_of(&stack, terms, probes))
    }

    /// Values at probes of a stack, on some terms.
    fn values_of(&self, stack: &Stack, terms: &(impl ShaderTerms + Sync), probes: &[Probe]) -> Vec<Rgb> {
        let color = color_of(self.color, &self.material);
        let twin = Twin::new(self.model, stack, self.material.bake.wavelengths_nm(), color);
        let values = probes.par_iter().map(|probe| match *probe {
            Probe::Pair { wi, wo } => twin.eval(terms, wi, wo),
            Probe::Sky { wo } => {
                let mut sum = [0.0; 3];
                for (wi, weight) in hemisphere(wo) {
                    let value = twin.eval(terms, wi, wo);
                    (0..3).for_each(|c| sum[c] += FRAC_1_PI * weight * value[c]);
                }
                sum
            }
        });
        values.collect()
    }

    /// Lobes of a stack in a form.
    fn fitted(&self, stack: &Stack, lobes: LobesForm) -> Lobes {
        let mut fits = self.fits.lock().unwrap_or_else(PoisonError::into_inner);
        let number = fits.iter().position(|(known, _)| known == stack).unwrap_or_else(|| {
            fits.push((stack.clone(), fits_of(stack, &color_of(self.color, &self.material))));
            fits.len() - 1
        });
        fits[number].1[lobes as usize].clone()
    }

    /// The exact terms: those that the tables approximate, or, for the form `full`, those that the shader computes.
    fn exact(&self, stack: &Stack) -> Exact {
        let color = color_of(self.color, &self.material);
        if let Some(lobes) = self.lobes {
            return Exact::with_lobes(stack, color, self.fitted(stack, lobes));
        }
        let exact = Exact::new(stack, color);
        let is_statistical = self.model.is_statistical();
        if self.form == Form::Full && is_statistical {
            let three = Color::ThreeWavelengths(self.material.bake.wavelengths_nm());
            Exact::level(stack, three, exact.veil())
        } else {
            exact
        }
    }
}

/// Forms that the rows of a material may have; `None` alone where they are over a factor beside the view, or where there are none.
pub fn forms(material: &Material) -> Vec<Option<LobesForm>> {
    if !luthier_bake::has_lone_rows(material) {
        return vec![None];
    }
    let most = most_searched(&material.stack, None);
    let has_one_width = Varying::axes(None, &material.stack).is_none();
    let is_had = |form: &LobesForm| match form {
        LobesForm::ShortLobe => may_be_short(&material.stack),
        LobesForm::OneWidth => has_one_width,
        LobesForm::NoLobe | LobesForm::OneLobe | LobesForm::TwoLobes | LobesForm::ThreeLobes => true,
    };
    LobesForm::ALL.into_iter().filter(|form| form.most() <= most && is_had(form)).map(Some).collect()
}

/// Lobes of a stack in each of [`LobesForm::ALL`], as bakes fit them.
fn fits_of(stack: &Stack, color: &Color) -> Vec<Lobes> {
    let traced = Traced::new(stack, color, None, FitSettings::of(None));
    let most = most_searched(stack, None);
    let by_most = traced.fit_each(most);
    let fits = LobesForm::ALL.map(|form| {
        let fit = by_most[form.most().min(most)].clone();
        match form {
            LobesForm::ShortLobe => traced.fit_short().unwrap_or(fit),
            LobesForm::OneWidth => fit.clone().of_one_width().unwrap_or(fit),
            LobesForm::NoLobe | LobesForm::OneLobe | LobesForm::TwoLobes | LobesForm::ThreeLobes => fit,
        }
        .nominal()
    });
    fits.into()
}
