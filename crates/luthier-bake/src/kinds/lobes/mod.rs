//! Lobes tiles: the simulated light from below the first interface of a material.
//!
//! # Rooms
//!
//! Each uses those before it: `rows`, `shape`, `fit`, `member`, `tile`, `record`.

mod fit;
mod member;
mod record;
mod rows;
mod shape;
mod tile;

use std::sync::Arc;

use luthier_layers::models::lobes::{FitError, LOBES, LOBES_MAX, Varied};
use luthier_lut::{AtlasLayout, RowLayout, TableKind};
use luthier_manifest::{Budget, Candidate, CandidateForm, LobesForm, MeasuredError, Search};
use luthier_material::Material;

use self::fit::{FINE, Fit, FitJob, Fits, fit};
use self::member::{Choice, Member, Pick, measured, members};
use self::rows::{FINE_ROWS, KEPT, of_model, side};
use self::shape::{HIDDEN_READS, parts, reads, shape_of, shape_with};
use self::tile::LobesJob;
use super::{Kind, Site};
use crate::BakeError;
use crate::candidates::{self, Found, Refusal, choose, cost, locked};
use crate::form::{RowForm, Widths};
use crate::graph::{Graph, Job, Key, Results};
use crate::options::Options;
use crate::plan::Plan;
use crate::settings::{Ask, Settings, Shape};
use crate::tile::apron;

pub use self::fit::fitted;
pub(crate) use self::fit::{FIT, form};
pub(crate) use self::record::record;
pub(crate) use self::rows::has_rows;
pub use self::rows::{VARIED_LAYERS_MAX, has_lone_rows, is_too_deep};
pub(crate) use self::shape::layout;

/// Lobes tables.
pub(crate) struct Table;

impl Kind for Table {
    fn fixed(&self, Ask(materials): Ask<'_>) -> Result<Shape, BakeError> {
        let most = of_model(materials).map(|material| material.bake.lobes.map_or(LOBES, LobesForm::most)).max();
        Ok(shape_with(materials, Widths::of(materials), most.unwrap_or(LOBES), RowLayout::Filtered.format()))
    }

    /// A tile for the first layer, whose lobes contain the light of all layers below.
    fn job(&self, site: &Site<'_>) -> Result<Option<Arc<dyn Job>>, BakeError> {
        let Site { material, layer, shape, lobes: form, .. } = *site;
        let is_first = material.stack.layers.first().is_some_and(|first| std::ptr::eq(first, layer));
        if !is_first {
            return Ok(None);
        }
        let fit = fit(material, form.most.is_some());
        Ok(Some(Arc::new(LobesJob { fit, form, tile: 0, axes: shape.axes(), format: shape.format })))
    }

    /// Tiles for the other nodes over the varying factor, or over the azimuth.
    fn followers(&self, site: &Site<'_>) -> Vec<Arc<dyn Job>> {
        let Site { material, shape, lobes: form, .. } = *site;
        let fit = fit(material, form.most.is_some());
        let (tiles, format) = (1..Varied::tiles_of(&fit.stack, fit.varying_of(form.most)), shape.format);
        let jobs = tiles.map(|tile| LobesJob { fit: fit.clone(), form, tile, axes: shape.axes(), format });
        jobs.map(|job| Arc::new(job) as Arc<dyn Job>).collect()
    }
}

/// A budget that cannot be met, with the error of each material, by number, under the nearest candidate.
pub(crate) type Broken = (Refusal, Vec<(usize, MeasuredError)>);

/// The graph of the fits alone, if there are any.
pub(crate) fn fits(graph: &Graph) -> Option<Graph> {
    graph.of::<FitJob>().next()?;
    Some(graph.only(|job| job.kind() == FIT))
}

/// Decides the shape of the tiles and the form of each material, from the fits of a plan. Without limits on the errors of lobes, the tiles have as
/// many parts as the material with the most lobes needs. With limits, the smallest shape that holds them is taken, and
/// the search is reported; then each material takes the form with the fewest reads that such tiles have. Families have fewer nodes where others have fewer lobes.
///
/// # Errors
/// [`Broken`] where no shape holds the limits.
pub(crate) fn decide(
    settings: &mut Settings,
    plan: &Plan,
    materials: &[Material],
    results: &Results,
    budget: &Budget,
    options: &Options<'_>,
) -> Result<Option<Search>, Broken> {
    let given = settings.fixed(TableKind::Lobes).format;
    // Few reads of textures hide behind arithmetic.
    let format_of = |reads: usize| {
        let hides = options.layout.is_none() && reads <= HIDDEN_READS;
        if hides { RowLayout::Filtered.format() } else { given }
    };
    if settings.lobes.is_none() {
        // Materials of other models may ask for rows, too.
        let sides: Vec<Material> = materials.iter().filter_map(side).collect();
        let fits = materials.iter().chain(&sides).filter_map(|material| {
            let form = form(material, settings);
            let fits: &Fits = results.get(fit(material, form.most.is_some()).key())?;
            Some((fits, form))
        });
        let fits: Vec<(&Fits, RowForm)> = fits.collect();
        let lobes = fits.iter().map(|(fits, form)| fits.of(form.most).lobes()).max().unwrap_or(0);
        let are_short = fits.iter().all(|(fits, _)| fits.of(Some(1)).short.is_some());
        let widths = match Widths::of(materials) {
            Widths::Short if !are_short || !of_model(materials).all(has_lone_rows) => Widths::Two,
            widths => widths,
        };
        settings.take_lobes(shape_with(materials, widths, lobes, format_of(reads(lobes))));
        return Ok(None);
    }
    let members = members(plan, materials, results);
    let most = members.iter().map(|member| member.fits.most()).max().unwrap_or(0);
    let others = [
        (members.iter().all(Member::has_one_width), Widths::One),
        (members.iter().all(Member::is_short), Widths::Short),
    ];
    let steps = (0..=most.min(LOBES_MAX)).map(|most| (most, Widths::Two));
    let steps = steps.chain(others.into_iter().filter(|(are, _)| *are).map(|(_, widths)| (1, widths)));
    let choices = steps
        .flat_map(|(most, widths)| KEPT.map(|rows| (most, widths, rows)))
        .chain((most == FINE).then_some((FINE, Widths::Two, FINE_ROWS)));
    let choices: Vec<Choice> = choices.collect();
    // More lobes may be farther off, so that no form holds for all where each has one.
    let has_most = |(own, widths, _): &&Choice| *own >= most.min(LOBES_MAX) && *widths == Widths::Two;
    let of_each = choices.iter().filter(|_| members.len() > 1).filter(has_most).map(|choice| (*choice, true));
    let picks: Vec<Pick> = choices.iter().map(|choice| (*choice, false)).chain(of_each).collect();
    let formed = |member: &Member<'_>, (choice, is_own): Pick| {
        if is_own { member.cheapest(choice, budget) } else { member.formed(choice, budget) }
    };
    let candidate = |pick: Pick| {
        let (forms, errors): (Vec<RowForm>, Vec<FitError>) = members.iter().map(|member| formed(member, pick)).unzip();
        let fits = || members.iter().zip(&forms).map(|(member, form)| member.fits.of(form.most));
        let lobes = fits().map(Fit::lobes).max().unwrap_or(0);
        let tiles = fits().map(|fit| fit.varied.tiles() as u32).sum();
        let (widths, (_, _, rows)) = (Widths::common(&forms), pick.0);
        let shape = shape_of(widths, parts(materials, lobes), rows, format_of(widths.reads(lobes)));
        let Shape { x, y, base, format } = shape.clone();
        let cost = cost::axis(&x) + y.as_ref().map_or(1.0, |y| f64::from(y.size)) * cost::read(format);
        let apron = apron(std::iter::once(&x).chain(&y));
        let layout = AtlasLayout { x: x.clone(), y: y.clone(), apron, columns: 1, tiles, base };
        let bytes = layout.size().map(u64::from).iter().product::<u64>() * u64::from(format.texel_bytes());
        let error = measured(errors.into_iter().fold(FitError::default(), FitError::max));
        (Candidate { form: CandidateForm::Table { x, y, format, base }, bytes, cost, error }, shape, forms)
    };
    let mut found = Found::new(TableKind::Lobes, 0.0, picks.iter().map(|pick| candidate(*pick).0).collect());
    let one = std::slice::from_ref(&found);
    let chosen = locked(one, options.locked, budget, 0).map_or_else(|| choose(one, budget, 0), Ok);
    let chosen = chosen.map_err(|refusal| {
        let pick = match &refusal {
            Refusal::Error { nearest: (_, nearest), .. } => picks[*nearest],
            Refusal::Whole { .. } => picks[0],
        };
        let error_of = |key: Key| Some(formed(members.iter().find(|member| member.key == key)?, pick).1);
        let errors = materials.iter().enumerate().filter_map(|(number, material)| {
            let fits = [Some(fit(material, true)), side(material).map(|side| fit(&side, true))];
            let errors = fits.into_iter().flatten().filter_map(|job| error_of(job.key()));
            Some((number, measured(errors.reduce(FitError::max)?)))
        });
        (refusal, errors.collect())
    })?[0];
    // Among rows that suffice for all, each material takes those that it needs.
    let (taken, shape, forms) = candidate((picks[chosen].0, true));
    found.candidates[chosen] = taken;
    settings.take_lobes(shape);
    settings.lobes = Some(members.iter().map(|member| member.key).zip(forms).collect());
    Ok(Some(candidates::report(&found, chosen, budget)))
}
