//! Jobs that fit lobes.

use std::collections::BTreeMap;
use std::sync::Arc;

use luthier_layers::models::lobes::{
    Cover, EXCESS, Family, FitError, FitSettings, Judge, LOBES, LOBES_MAX, SlopeAxis, Traced, Varied, Varying,
    most_lobes, most_searched, shown,
};
use luthier_lut::TableKind;
use luthier_manifest::MapSlot;
use luthier_material::Material;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::rows::{FINE_ROWS, KEPT, ROWS, is_family, varying};
use crate::form::{RowForm, Widths};
use crate::graph::{Artefact, Inputs, Job, JobKind, Key, Store, result_of};
use crate::json;
use crate::settings::Settings;

/// Jobs that fit lobes.
pub(crate) const FIT: JobKind = JobKind::part("fit");

/// The job that fits a material; for every number of lobes, if a search chooses among them.
pub(super) fn fit(material: &Material, is_searched: bool) -> Arc<FitJob> {
    let (stack, color, varying) = (shown(&material.stack), material.color(), varying(material));
    let stack = match varying {
        Some(Varying::Family(family)) => alike(&stack, family),
        _ => stack,
    };
    // Measured in the usual medium: a lobe of another returns less light where the surface of one layer leans.
    let keeps_medium = !is_searched || material.layers.iter().any(|layer| layer.varies(MapSlot::Bumps));
    Arc::new(FitJob { stack, color, varying, is_searched, keeps_medium })
}

/// The form of the rows of a material, as a file or a search decides it. Where all rows have one width, those without a lobe have it, too.
pub(crate) fn form(material: &Material, settings: &Settings) -> RowForm {
    let found = |forms: &BTreeMap<Key, RowForm>| forms.get(&fit(material, true).key()).copied();
    let searched = || settings.lobes.as_ref().map(|forms| found(forms).unwrap_or(RowForm::at_most(LOBES)));
    let own = material.bake.lobes.map(RowForm::asked).or_else(searched).unwrap_or(RowForm::NEEDED);
    let common = settings.shape(TableKind::Lobes).and_then(|shape| Some(Widths::in_parts(shape.y.as_ref()?)));
    match common {
        None | Some(Widths::Two) => own,
        Some(widths) => RowForm { widths, ..own },
    }
}

/// The stack of a family with the same numbers in place of all that its rows do not hang on: slope parameters that are axes, and colours in closed
/// form. Materials that differ in these alone share a fit.
pub(super) fn alike(stack: &Stack, family: Family) -> Stack {
    let mut stack = family.apply(stack, family.alphas(0));
    if family.is_metallic
        && let Some(Base::Diffuse(base)) = stack.layers.last_mut().map(|layer| &mut layer.base)
    {
        base.albedo = ANY_COLOR;
    }
    stack
}

/// A colour that stands for others.
pub(super) const ANY_COLOR: Rgb = [0.5; 3];

/// The lobes of a stack, as in bakes without limits on their errors. They come from the store, or are fitted now and
/// kept.
pub fn fitted(stack: &Stack, color: &Color, varying: Option<Varying>, store: &dyn Store) -> Varied {
    let job = FitJob { stack: shown(stack), color: *color, varying, is_searched: false, keeps_medium: true };
    let fits = result_of(&job, store);
    let fits: &Fits = fits.get().unwrap_or_else(|| unreachable!("results at the address of a fit are fits"));
    fits.of(None).varied.clone()
}

/// Lobes of a material, and their errors.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Fit {
    pub(super) varied: Varied,
    pub(super) own: Errors,
    /// The lobes with a [`Curve`](luthier_layers::models::lobes::Curve) and their errors, of a search where the material has one.
    pub(super) curved: Option<(Varied, Errors)>,
    /// A [short lobe](luthier_layers::models::lobes::Short) in place of one lobe with its errors, of a search where the material has one.
    pub(super) short: Option<(Varied, Vec<FitError>)>,
}

/// Errors with each of [`KEPT`]; one error where a fit has [`FINE_ROWS`], all of which are kept.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Errors {
    whole: Vec<FitError>,
    /// With [`OneWidth`](luthier_layers::models::lobes::OneWidth), of a search where lobes have it.
    pub(super) of_one_width: Option<Vec<FitError>>,
}

impl Errors {
    fn of(varied: &Varied, judge: &Judge) -> Self {
        Self { whole: errors(varied, judge), of_one_width: None }
    }

    /// With those of one width.
    fn and_of_one_width(self, varied: &Varied, judge: &Judge) -> Self {
        let of_one_width = varied.clone().of_one_width().map(|varied| errors(&varied, judge));
        Self { of_one_width, ..self }
    }
}

impl Fit {
    fn new(varied: Varied, judge: &Judge) -> Self {
        Self { own: Errors::of(&varied, judge), varied, curved: None, short: None }
    }

    /// With the errors of the other forms that it has.
    fn in_all_forms(self, judge: &Judge) -> Self {
        let own = self.own.and_of_one_width(&self.varied, judge);
        let curved = self.varied.clone().of_curve();
        let errors = |varied: &Varied| Errors::of(varied, judge).and_of_one_width(varied, judge);
        let curved = curved.map(|varied| (varied.clone(), errors(&varied)));
        Self { own, curved, ..self }
    }

    /// The error with so many rows. More than a fit has show the same light.
    pub(super) fn error(&self, RowForm { widths, is_curved, .. }: RowForm, rows: usize) -> FitError {
        let own = self.curved.as_ref().filter(|_| is_curved).map_or(&self.own, |(_, errors)| errors);
        let errors = match (widths, &own.of_one_width, &self.short) {
            (Widths::One, Some(errors), _) | (Widths::Short, _, Some((_, errors))) => errors,
            _ => &own.whole,
        };
        errors[KEPT.iter().position(|kept| *kept == rows).unwrap_or(0)]
    }

    /// The error by which fits are compared: with all rows, and the reflectance of Fresnel's equations.
    fn own_error(&self) -> f64 {
        self.own.whole[0].lobe
    }

    /// The lobes, in this form if they have it.
    pub(super) fn shaped(&self, RowForm { widths, is_curved, .. }: RowForm) -> Varied {
        let curved = self.curved.as_ref().filter(|_| is_curved).map(|(varied, _)| varied);
        let whole = curved.unwrap_or(&self.varied).clone();
        let other = match widths {
            Widths::Two => None,
            Widths::One => whole.clone().of_one_width(),
            Widths::Short => self.short.as_ref().map(|(varied, _)| varied.clone()),
        };
        other.unwrap_or(whole)
    }

    /// Relative index of the medium of the lobes.
    fn index(&self) -> f64 {
        self.varied.nodes[0].frame.index
    }

    /// Number of lobes.
    pub(super) fn lobes(&self) -> usize {
        self.varied.nodes[0].rows[0].lobes.len()
    }
}

/// Errors of lobes with each of the numbers of rows that are kept: those of the views of a judge, and those of the rows that are left out.
fn errors(varied: &Varied, judge: &Judge) -> Vec<FitError> {
    let kept: &[usize] = if varied.nodes[0].axis.size() == FINE_ROWS { &[FINE_ROWS] } else { &KEPT };
    let errors = kept.iter().map(|&rows| {
        let step = (kept[0] - 1) / (rows - 1);
        judge.error(&with_rows(varied.clone(), rows)).max(varied.error_of_thinning(step))
    });
    errors.collect()
}

/// Lobes with so many rows: those between where a fit has fewer, else some of them.
pub(super) fn with_rows(varied: Varied, rows: usize) -> Varied {
    let [own, wanted] = [varied.nodes[0].axis.size(), rows].map(|rows| rows - 1);
    let steps = own.max(wanted).max(ROWS - 1);
    let varied = if steps > own { varied.refined(steps / own) } else { varied };
    varied.thinned(steps / wanted)
}

/// The number of a fit with [`LOBES_MAX`] lobes from [`FINE_ROWS`], after those with up to so many.
pub(super) const FINE: usize = LOBES_MAX + 1;

/// The lobe error within which a search wants a fit: where none is, it makes one from [`FINE_ROWS`].
const WANTED: f64 = 0.03;

/// Result of a [`FitJob`]: one fit without a search, else one for each largest number of lobes from 0 on, and one from [`FINE_ROWS`] where none of them is within
/// [`WANTED`]; of a family one for as many halvings of its nodes as lobes lack.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Fits(Vec<Fit>);

impl Fits {
    /// The most lobes among which a search chooses; [`FINE`] where one of the fits has [`FINE_ROWS`].
    pub(super) fn most(&self) -> usize {
        self.0.len() - 1
    }

    /// The fit; with at most `most` lobes, if a search decided so. With [`FINE`] it is the one from [`FINE_ROWS`], or the last.
    pub(super) fn of(&self, most: Option<usize>) -> &Fit {
        &self.0[most.unwrap_or(0).min(self.0.len() - 1)]
    }

    /// The error in a form with so many rows.
    pub(super) fn error(&self, form: RowForm, rows: usize) -> FitError {
        self.of(form.most).error(form, rows)
    }

    /// The lobes in a form, where the material has it.
    pub(super) fn shaped(&self, form: RowForm) -> Varied {
        self.of(form.most).shaped(form)
    }
}

/// The simulation of a stack, and the fits to it: [`Fits`].
#[derive(Debug)]
pub(super) struct FitJob {
    pub(super) stack: Stack,
    pub(super) color: Color,
    pub(super) varying: Option<Varying>,
    pub(super) is_searched: bool,
    /// Whether lobes stay in the medium that a fit by itself has, see [`nearest`].
    pub(super) keeps_medium: bool,
}

impl FitJob {
    /// The most lobes of a fit.
    fn most(&self) -> usize {
        if self.is_searched { most_searched(&self.stack, self.varying) } else { most_lobes(&self.stack) }
    }

    /// Part of the stack that rows are over, where a search allows so many lobes: a family always has two, and fewer nodes in place of fewer lobes.
    pub(super) fn varying_of(&self, most: Option<usize>) -> Option<Varying> {
        let fewer = most.map_or(0, |most| LOBES.saturating_sub(most) as u32);
        self.varying.map(|varying| varying.with_fewer_nodes(fewer))
    }
}

impl Job for FitJob {
    fn kind(&self) -> JobKind {
        FIT
    }

    fn revision(&self) -> u32 {
        if is_family(self.varying) { 17 } else { 14 }
    }

    fn inputs(&self) -> Value {
        let FitSettings { rows, paths, seed } = FitSettings::of(self.varying);
        json!({
            "stack": json::stack(&self.stack),
            "color": json::color(&self.color),
            "lobes": self.most(),
            "excess": EXCESS,
            "rows": rows,
            "paths": paths,
            "seed": seed,
            "varying": self.varying.map(|varying| json!([factor_name(varying), numbers(varying)])),
            "is_searched": self.is_searched,
            "keeps_medium": self.keeps_medium,
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        let Self { stack, color, varying, is_searched, keeps_medium } = self;
        let traced = Traced::new(stack, color, *varying, FitSettings::of(*varying));
        let judge = Judge::new(stack, color, *varying);
        let most = self.most();
        if *is_searched && is_family(*varying) {
            let whole: Varied = traced.fit(most, EXCESS);
            let fits = (0..=LOBES).map(|most| {
                let fewer = self.varying_of(Some(most));
                let varied = whole.clone().at_nodes(fewer);
                let judge = Judge::new(stack, color, fewer);
                Fit::new(varied, &judge)
            });
            return Artefact::new(Fits(fits.collect()));
        }
        if !*is_searched {
            return Artefact::new(Fits(vec![Fit::new(traced.fit(most, EXCESS), &judge)]));
        }
        let media = if *keeps_medium { Vec::new() } else { traced.media() };
        let fits = nearest(&traced, &media, most, &judge).into_iter();
        let mut fits: Vec<Fit> = fits.map(|fit| fit.in_all_forms(&judge)).collect();
        if let Some(one) = fits.get_mut(1) {
            one.short = short(&traced, keeps_medium.then_some(one.index()), &judge);
        }
        if fits.len() == FINE && fits.iter().all(|fit| fit.own_error() > WANTED) {
            let fine =
                Traced::new(stack, color, *varying, FitSettings { rows: FINE_ROWS, ..FitSettings::of(*varying) });
            let medium = fine.media().iter().position(|index| *index == fits[most].index()).unwrap_or(0);
            fits.push(Fit::new(fine.in_medium(medium).fit(most, 0.0), &judge).in_all_forms(&judge));
        }
        Artefact::new(Fits(fits))
    }

    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<Fits>(bytes)
    }
}

/// Fits with up to no lobe, one, and so on, each in the one of some media where a judge finds it nearest. A fit itself compares media by their own cells, which are blind at
/// some views, and by one lobe.
fn nearest(traced: &Traced, media: &[f64], most: usize, judge: &Judge) -> Vec<Fit> {
    let judged = |fits: Vec<Varied>| fits.into_iter().map(|varied| Fit::new(varied, judge)).collect::<Vec<Fit>>();
    let mut fits = judged(traced.fit_each(most));
    if fits.iter().skip(1).all(|fit| fit.own_error() <= NEAR) {
        return fits;
    }
    let usual = fits[most].index();
    for (medium, _) in media.iter().enumerate().filter(|(_, index)| **index != usual) {
        let others = judged(traced.in_medium(medium).fit_each(most));
        for (fit, other) in fits.iter_mut().zip(others).skip(1) {
            if other.own_error() < CLEAR * fit.own_error() {
                *fit = other;
            }
        }
    }
    fits
}

/// A short lobe in the medium where a judge finds it nearest, or in one of a given index.
fn short(traced: &Traced, index: Option<f64>, judge: &Judge) -> Option<(Varied, Vec<FitError>)> {
    let media = traced.media().into_iter().enumerate().filter(|(_, own)| index.is_none_or(|index| index == *own));
    let fits = media.filter_map(|(medium, _)| traced.in_medium(medium).fit_short());
    let judged = fits.map(|varied| (errors(&varied, judge), varied));
    let nearest = judged.min_by(|(a, _), (b, _)| a[0].lobe.total_cmp(&b[0].lobe));
    nearest.map(|(errors, varied)| (varied, errors))
}

/// The lobe error at which a search looks for no other medium.
const NEAR: f64 = 0.02;

/// The share of the error that another medium may have at most, to be taken.
const CLEAR: f64 = 0.95;

/// Numbers of the varying factor, for the key.
pub(super) fn numbers(varying: Varying) -> Value {
    match varying {
        Varying::Alpha | Varying::Slab | Varying::Film(_) => json!([varying.factor(0.0), varying.factor(1.0)]),
        Varying::Patina(Cover { diffuse_albedo, base_alpha, tarnish }) => json!([diffuse_albedo, base_alpha, tarnish]),
        Varying::Family(Family { coat, base, interface, is_metallic, is_tinted, has_lengths, .. }) => {
            let axis = |SlopeAxis { least, most, nodes }| json!([least, most, nodes]);
            if is_tinted {
                return json!([axis(coat), axis(base), interface, is_metallic, "edge tint"]);
            }
            if has_lengths {
                return json!([axis(coat), axis(base), interface, is_metallic, "lengths"]);
            }
            json!([axis(coat), axis(base), interface, is_metallic])
        }
    }
}

/// Name of the varying factor.
pub(super) fn factor_name(varying: Varying) -> &'static str {
    match varying {
        Varying::Alpha => "slope parameters",
        Varying::Slab => "thickness of the first slab",
        Varying::Film(_) => "thickness of the film",
        Varying::Patina(cover) if cover.is_plain() => "first layer",
        Varying::Patina(_) => "patina",
        Varying::Family(_) => "slope parameters of single layers",
    }
}
