//! Lobes tiles: the simulated light from below the first interface of a material.
//!
//! # Rooms
//!
//! Each uses those before it: `rows`, `shape`, `fit`, `tile`, `record`.

mod fit;
mod record;
mod rows;
mod shape;
mod tile;

use std::sync::Arc;

use luthier_layers::models::lobes::{FitError, LOBES, LOBES_MAX, Varied};
use luthier_lut::{AtlasLayout, RowLayout, TableKind};
use luthier_manifest::{Budget, Candidate, CandidateForm, LobesForm, MeasuredError, Search};
use luthier_material::Material;

use self::fit::{FINE, FitJob, Fits, fit};
use self::rows::{FINE_ROWS, KEPT, of_model, side};
use self::shape::{Form, HIDDEN_READS, Widths, parts, reads, shape_of, shape_with};
use self::tile::LobesJob;
use super::{Kind, Site};
use crate::BakeError;
use crate::candidates::{self, Found, Refusal, choose, cost, locked};
use crate::graph::{Graph, Job, Results};
use crate::options::Options;
use crate::plan::Plan;
use crate::settings::{Ask, Settings, Shape};
use crate::tile::apron;

pub(crate) use self::fit::FIT;
pub use self::fit::fitted;
pub(crate) use self::record::record;
pub use self::rows::{VARIED_LAYERS_MAX, has_lone_rows, is_too_deep};
pub(crate) use self::rows::{has_rows, most};
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
        let Site { material, layer, shape, .. } = site;
        let is_first = material.stack.layers.first().is_some_and(|first| std::ptr::eq(first, *layer));
        if !is_first {
            return Ok(None);
        }
        let (fit, axes, format) = (fit(material, site.lobes.is_some()), shape.axes(), shape.format);
        let is_curved = site.is_curved;
        Ok(Some(Arc::new(LobesJob { fit, most: site.lobes, is_curved, tile: 0, axes, format })))
    }

    /// Tiles for the other nodes over the varying factor, or over the azimuth.
    fn followers(&self, site: &Site<'_>) -> Vec<Arc<dyn Job>> {
        let Site { material, shape, lobes: most, is_curved, .. } = *site;
        let fit = fit(material, most.is_some());
        let (tiles, format) = (1..Varied::tiles_of(&fit.stack, fit.varying_of(most)), shape.format);
        let jobs = tiles.map(|tile| LobesJob { fit: fit.clone(), most, is_curved, tile, axes: shape.axes(), format });
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

/// Decides the shape of the tiles, from the fits of a plan. Without limits on the errors of lobes, the tiles have as
/// many parts as the material with the most lobes needs. With limits, the smallest shape that holds them is taken, and
/// the search is reported. Families have fewer nodes where others have fewer lobes.
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
    let fits: Vec<&Fits> = plan.graph.of::<FitJob>().filter_map(|job| results.get(job.key())).collect();
    let given = settings.fixed(TableKind::Lobes).format;
    let are_short = fits.iter().all(|fits| fits.of(Some(1)).short.is_some()) && of_model(materials).all(has_lone_rows);
    // Few reads of textures hide behind arithmetic.
    let format_of = |reads: usize| {
        let hides = options.layout.is_none() && reads <= HIDDEN_READS;
        if hides { RowLayout::Filtered.format() } else { given }
    };
    if settings.lobes.is_none() {
        // Materials of other models may ask for rows, too.
        let sides: Vec<Material> = materials.iter().filter_map(side).collect();
        let lobes = materials.iter().chain(&sides).filter_map(|material| {
            let most = most(material, settings);
            Some(results.get::<Fits>(fit(material, most.is_some()).key())?.of(most).lobes())
        });
        let lobes = lobes.max().unwrap_or(0);
        let widths = match Widths::of(materials) {
            Widths::Short if !are_short => Widths::Two,
            widths => widths,
        };
        settings.take_lobes(shape_with(materials, widths, lobes, format_of(reads(lobes))));
        return Ok(None);
    }
    let have_one_width = fits.iter().all(|fits| fits.of(Some(1)).own.of_one_width.is_some());
    // Rows over a factor, or of layers below a coat, leave a polynomial no place in the words of a material.
    let are_alone = materials.iter().filter_map(side).next().is_none() && of_model(materials).all(has_lone_rows);
    let is_curved = are_alone && fits.iter().all(|fits| fits.of(Some(0)).curved.is_some());
    let most = fits.iter().map(|fits| fits.most()).max().unwrap_or(0);
    let others = [(have_one_width, Widths::One), (are_short, Widths::Short)];
    let steps = (0..=most.min(LOBES_MAX)).map(|most| (most, Widths::Two));
    let steps = steps.chain(others.into_iter().filter(|(are, _)| *are).map(|(_, widths)| (1, widths)));
    let choices: Vec<(usize, Widths, usize)> = steps
        .flat_map(|(most, widths)| KEPT.map(|rows| (most, widths, rows)))
        .chain((most == FINE).then_some((FINE, Widths::Two, FINE_ROWS)))
        .collect();
    let shape_of = |(most, widths, rows): (usize, Widths, usize)| {
        let lobes = lobes_of(&fits, most);
        shape_of(widths, parts(materials, lobes), rows, format_of(widths.reads(lobes)))
    };
    let candidates = choices.iter().map(|&(most, widths, rows)| {
        let errors = fits.iter().map(|fits| fits.of(Some(most)).error(Form { widths, is_curved }, rows));
        let error = errors.fold(FitError::default(), FitError::max);
        let tiles = fits.iter().map(|fits| fits.of(Some(most)).varied.tiles() as u32).sum();
        let Shape { x, y, base, format } = shape_of((most, widths, rows));
        let cost = cost::axis(&x) + y.as_ref().map_or(1.0, |y| f64::from(y.size)) * cost::read(format);
        let apron = apron(std::iter::once(&x).chain(&y));
        let layout = AtlasLayout { x: x.clone(), y: y.clone(), apron, columns: 1, tiles, base };
        let bytes = layout.size().map(u64::from).iter().product::<u64>() * u64::from(format.texel_bytes());
        let form = CandidateForm::Table { x, y, format, base };
        Candidate { form, bytes, cost, error: measured(error) }
    });
    let found = Found::new(TableKind::Lobes, 0.0, candidates.collect());
    let found = std::slice::from_ref(&found);
    let chosen = locked(found, options.locked, budget, 0).map_or_else(|| choose(found, budget, 0), Ok);
    let chosen = chosen.map_err(|refusal| {
        let (most, widths, rows) = match &refusal {
            Refusal::Error { nearest: (_, nearest), .. } => choices[*nearest],
            Refusal::Whole { .. } => choices[0],
        };
        let errors = materials.iter().enumerate().filter_map(|(number, material)| {
            let fits = [Some(fit(material, true)), side(material).map(|side| fit(&side, true))];
            let fits = fits.into_iter().flatten().filter_map(|job| results.get::<Fits>(job.key()));
            let errors = fits.map(|fits| fits.of(Some(most)).error(Form { widths, is_curved }, rows));
            Some((number, measured(errors.reduce(FitError::max)?)))
        });
        (refusal, errors.collect())
    })?[0];
    (settings.lobes, settings.is_curved) = (Some(choices[chosen].0), is_curved);
    settings.take_lobes(shape_of(choices[chosen]));
    Ok(Some(candidates::report(&found[0], chosen, budget)))
}

/// The most lobes of any fit, if each has at most `most`.
fn lobes_of(fits: &[&Fits], most: usize) -> usize {
    fits.iter().map(|fits| fits.of(Some(most)).lobes()).max().unwrap_or(0)
}

fn measured(error: FitError) -> MeasuredError {
    MeasuredError { lobe: Some(error.lobe), albedo: Some(error.albedo), ..MeasuredError::default() }
}
