//! Jobs that fit lobes.

use std::sync::Arc;

use luthier_layers::models::lobes::{
    Cover, EXCESS, Family, FitError, FitSettings, Judge, LOBES, SlopeAxis, Traced, Varied, Varying, most_lobes,
    most_searched, shown,
};
use luthier_material::Material;
use luthier_optics::Rgb;
use luthier_optics::color::Color;
use luthier_optics::stack::{Base, Stack};
use serde::{Deserialize, Serialize};
use serde_json::{Value, json};

use super::rows::{ROWS, STEPS, is_family, varying};
use crate::graph::{Artefact, Inputs, Job, JobKind, Store, result_of};
use crate::json;

/// Jobs that fit lobes.
pub(crate) const FIT: JobKind = JobKind::part("fit");

/// The job that fits a material; for every number of lobes, if a search chooses among them.
pub(super) fn fit(material: &Material, is_searched: bool) -> Arc<FitJob> {
    let (stack, color, varying) = (shown(&material.stack), material.color(), varying(material));
    let stack = match varying {
        Some(Varying::Family(family)) => alike(&stack, family),
        _ => stack,
    };
    Arc::new(FitJob { stack, color, varying, is_searched })
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
    let job = FitJob { stack: shown(stack), color: *color, varying, is_searched: false };
    let fits = result_of(&job, store);
    let fits: &Fits = fits.get().unwrap_or_else(|| unreachable!("results at the address of a fit are fits"));
    fits.of(None).varied.clone()
}

/// Lobes of a material, and their errors with each of [`STEPS`].
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Fit {
    pub(super) varied: Varied,
    errors: [FitError; STEPS.len()],
    /// Errors with [`OneWidth`](luthier_layers::models::lobes::OneWidth), of a search where lobes have it.
    pub(super) of_one_width: Option<[FitError; STEPS.len()]>,
}

impl Fit {
    fn new(varied: Varied, judge: &Judge) -> Self {
        Self { errors: errors(&varied, judge), varied, of_one_width: None }
    }

    /// With the errors of lobes of one width.
    fn and_of_one_width(self, judge: &Judge) -> Self {
        let of_one_width = self.varied.clone().of_one_width().map(|varied| errors(&varied, judge));
        Self { of_one_width, ..self }
    }

    /// Errors with each of [`STEPS`].
    pub(super) fn errors(&self, has_one_width: bool) -> &[FitError; STEPS.len()] {
        self.of_one_width.as_ref().filter(|_| has_one_width).unwrap_or(&self.errors)
    }

    /// The lobes, with one width if so.
    pub(super) fn shaped(&self, has_one_width: bool) -> Varied {
        let narrowed = has_one_width.then(|| self.varied.clone().of_one_width()).flatten();
        narrowed.unwrap_or_else(|| self.varied.clone())
    }

    /// Number of lobes.
    pub(super) fn lobes(&self) -> usize {
        self.varied.nodes[0].rows[0].lobes.len()
    }
}

/// Errors of lobes with each of [`STEPS`]: those of the views of a judge, and those of the rows that are left out.
pub(super) fn errors(varied: &Varied, judge: &Judge) -> [FitError; STEPS.len()] {
    STEPS.map(|step| judge.error(&thinned(varied.clone(), step)).max(varied.error_of_thinning(step)))
}

/// Lobes with every `step`-th of [`ROWS`]. Fits with fewer get those between.
pub(super) fn thinned(varied: Varied, step: usize) -> Varied {
    let own = (ROWS - 1) / (varied.nodes[0].axis.size() - 1);
    let varied = if own > 1 { varied.refined(own) } else { varied };
    varied.thinned(step)
}

/// Result of a [`FitJob`]: one fit without a search, else one for each largest number of lobes from 0 on, or of a family for as many halvings of its nodes as
/// lobes lack.
#[derive(Debug, Serialize, Deserialize)]
pub(super) struct Fits(Vec<Fit>);

impl Fits {
    /// The most lobes among which a search chooses.
    pub(super) fn most(&self) -> usize {
        self.0.len() - 1
    }

    /// The fit; with at most `most` lobes, if a search decided so.
    pub(super) fn of(&self, most: Option<usize>) -> &Fit {
        &self.0[most.unwrap_or(0).min(self.0.len() - 1)]
    }
}

/// The simulation of a stack, and the fits to it: [`Fits`].
#[derive(Debug)]
pub(super) struct FitJob {
    pub(super) stack: Stack,
    pub(super) color: Color,
    pub(super) varying: Option<Varying>,
    pub(super) is_searched: bool,
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
        if is_family(self.varying) { 15 } else { 10 }
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
        })
    }

    fn run(&self, _: &Inputs<'_>) -> Artefact {
        let Self { stack, color, varying, is_searched } = self;
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
        let wanted: Vec<(usize, f64)> =
            if *is_searched { (0..=most).map(|most| (most, 0.0)).collect() } else { vec![(most, EXCESS)] };
        let fits = wanted.into_iter().map(|(most, excess)| {
            let fit = Fit::new(traced.fit(most, excess), &judge);
            if *is_searched && most <= 1 { fit.and_of_one_width(&judge) } else { fit }
        });
        Artefact::new(Fits(fits.collect()))
    }

    fn decode(&self, bytes: &[u8]) -> Option<Artefact> {
        Artefact::decode::<Fits>(bytes)
    }
}

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
