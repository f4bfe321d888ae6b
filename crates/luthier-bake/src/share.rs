//! A bake on many machines: each computes a share of the jobs into a store, and the final bake finds the results there.

use std::collections::BTreeMap;

use luthier_lut::TableKind;
use luthier_material::Material;

use crate::graph::{Graph, Job, JobKind, Observer, Results, Share, Silent, Store};
use crate::kinds::lobes;
use crate::options::Options;
use crate::relief::ImageReader;
use crate::search::{Fixed, plan};
use crate::{BakeError, planner};

/// Jobs that a bake would run.
///
/// ```
/// # let text = "schema = 1\nname = \"glass\"\n[bake]\nmodel = \"elek\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n";
/// # let read = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// # let glass = luthier_material::parse("glass.toml", text, &read).unwrap().material;
/// use luthier_bake::{MemoryStore, Options, missing};
///
/// let missing = missing(&[glass], &Options::default(), &|_, _| unreachable!(), &MemoryStore::default())?;
/// assert!(missing.is_all && missing.jobs.keys().any(|kind| kind.name() == "fresnel"));
/// # Ok::<(), luthier_bake::BakeError>(())
/// ```
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Missing {
    /// Number of jobs by kind.
    pub jobs: BTreeMap<JobKind, usize>,
    /// Whether the counts are complete. Trials of a search under a stated budget, and tiles of lobes that are not
    /// fitted yet, cannot be counted beforehand.
    pub is_all: bool,
}

/// Whether a job neither is a fit nor depends on one.
fn is_apart(job: &dyn Job) -> bool {
    job.kind() != JobKind::tile(TableKind::Lobes) && job.kind() != lobes::FIT
}

/// The jobs that a bake runs whatever the fits return: with the shapes that a search tries first, or under a stated
/// budget the truths that all candidates need.
fn certain(
    fixed: &Fixed,
    materials: &[Material],
    options: &Options<'_>,
    read_image: ImageReader<'_>,
    store: &dyn Store,
) -> Result<Graph, BakeError> {
    let (_, is_asked) = fixed.budget();
    Ok(match (options.search, is_asked) {
        (true, true) => fixed.plan.graph.intermediate(),
        (true, false) => planner::plan(materials, fixed.first_choice(options, store), read_image)?.graph,
        (false, _) => fixed.plan.graph.only(|_| true),
    })
}

/// Runs a share of the jobs of a bake, and keeps their results in the store alone.
///
/// The shares together are all jobs but two kinds: jobs that a search adds under a stated budget, and tiles of lobes,
/// which take next to no time.
///
/// # Errors
/// See [`BakeError`].
pub fn bake_share(
    materials: &[Material],
    options: &Options<'_>,
    read_image: ImageReader<'_>,
    observer: &dyn Observer,
    store: &dyn Store,
    share: Share,
) -> Result<(), BakeError> {
    let fixed = Fixed::new(materials, options, read_image)?;
    if let Some(fits) = lobes::fits(&fixed.plan.graph) {
        fits.share(share, |_| true).run(observer, store, Results::default())?;
    }
    let graph = certain(&fixed, materials, options, read_image, store)?;
    graph.share(share, is_apart).run(observer, store, Results::default())?;
    Ok(())
}

/// Counts the jobs that a bake would run, because the store lacks their results.
///
/// # Errors
/// See [`BakeError`].
pub fn missing(
    materials: &[Material],
    options: &Options<'_>,
    read_image: ImageReader<'_>,
    store: &dyn Store,
) -> Result<Missing, BakeError> {
    let fixed = Fixed::new(materials, options, read_image)?;
    let mut results = Results::default();
    let fits = lobes::fits(&fixed.plan.graph).map(|fits| fits.count_missing(store, &mut results)).unwrap_or_default();
    let mut jobs =
        certain(&fixed, materials, options, read_image, store)?.only(is_apart).count_missing(store, &mut results);
    if jobs.is_empty() && fits.is_empty() {
        // All truths are stored, so the search computes nothing large: this plan is the bake's own.
        let planned = plan(materials, options, read_image, &Silent, store)?;
        let mut results = planned.results;
        return Ok(Missing { jobs: planned.plan.graph.count_missing(store, &mut results), is_all: true });
    }
    let is_all = fits.is_empty() && !(options.search && fixed.budget().1);
    jobs.extend(fits);
    Ok(Missing { jobs, is_all })
}
