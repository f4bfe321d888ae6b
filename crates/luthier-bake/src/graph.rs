//! The graph of jobs and its execution.

use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

use crate::facet_grid::{CrossedGrid, FacetGrid};
use crate::fgd::FgdTruth;
use crate::job::{Job, JobKind, Key, Output, TileData};
use crate::store::{Artefact, Store};

/// Told what happens, from any thread. It cannot change what is computed.
pub trait Observer: Sync {
    /// The number of jobs is known.
    fn planned(&self, jobs: usize);
    /// A job is done. Jobs of one batch run side by side.
    fn finished(&self, kind: JobKind);
    /// All jobs of one kind in one batch are about to run, or have run.
    fn batch(&self, kind: JobKind, running: bool);
}

/// An observer that does nothing.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Observer for Silent {
    fn planned(&self, _: usize) {}
    fn finished(&self, _: JobKind) {}
    fn batch(&self, _: JobKind, _: bool) {}
}

/// Distinct jobs, dependencies before dependants.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    jobs: BTreeMap<JobKind, BTreeMap<Key, Job>>,
}

/// Results by key.
#[derive(Debug, Default)]
pub(crate) struct Results(BTreeMap<Key, Arc<Artefact>>);

/// The results that a running job may read: those of its dependencies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inputs<'a>(&'a Results);

impl Graph {
    /// Adds a job and all that it needs; a job that is already there is not added again.
    pub(crate) fn add(&mut self, job: Job) -> Key {
        for dependency in job.dependencies() {
            self.add(dependency);
        }
        let key = job.key();
        self.jobs.entry(job.kind()).or_default().entry(key).or_insert(job);
        key
    }

    /// The graph of the jobs of some kinds, with all that these need.
    pub(crate) fn only(&self, kinds: &[JobKind]) -> Self {
        let mut some = Self::default();
        for job in kinds.iter().flat_map(|&kind| self.of_kind(kind)) {
            some.add(job.clone());
        }
        some
    }

    /// The jobs of a kind, in the order of their keys.
    pub(crate) fn of_kind(&self, kind: JobKind) -> impl Iterator<Item = &Job> {
        self.jobs.get(&kind).into_iter().flat_map(BTreeMap::values)
    }

    /// A job by its key.
    pub(crate) fn get(&self, kind: JobKind, key: Key) -> Option<&Job> {
        self.jobs.get(&kind)?.get(&key)
    }

    /// Runs everything that has no result yet on the rayon pool. Kinds run in their order, which puts dependencies first; jobs of one
    /// kind run side by side.
    pub(crate) fn run(mut self, observer: &dyn Observer, store: &dyn Store, mut results: Results) -> Results {
        for jobs in self.jobs.values_mut() {
            jobs.retain(|&key, _| {
                if let Some(artefact) = store.get(key) {
                    results.0.entry(key).or_insert(artefact);
                }
                !results.0.contains_key(&key)
            });
        }
        observer.planned(self.jobs.values().map(BTreeMap::len).sum());
        for (kind, jobs) in self.jobs {
            if jobs.is_empty() {
                continue;
            }
            observer.batch(kind, true);
            let done: Vec<(Key, Arc<Artefact>)> = jobs
                .into_par_iter()
                .map(|(key, job)| {
                    let artefact = Arc::new(Artefact(job.run(&Inputs(&results))));
                    store.put(key, &artefact);
                    observer.finished(kind);
                    (key, artefact)
                })
                .collect();
            results.0.extend(done);
            observer.batch(kind, false);
        }
        results
    }
}

impl Results {
    fn output(&self, key: Key) -> Option<&Output> {
        self.0.get(&key).map(|artefact| &artefact.0)
    }

    /// The tile of a planned job.
    pub(crate) fn tile(&self, key: Key) -> &TileData {
        match self.output(key) {
            Some(Output::Tile(tile)) => tile,
            _ => unreachable!("every planned tile job has run"),
        }
    }

    /// The values of an FGD tile.
    pub(crate) fn fgd_truth(&self, job: &Job) -> &FgdTruth {
        match self.output(job.key()) {
            Some(Output::FgdTruth(truth)) => truth,
            _ => unreachable!("values run before the tiles that hold them"),
        }
    }

    /// The tile of a job, if it has run.
    pub(crate) fn find(&self, key: Key) -> Option<&TileData> {
        match self.output(key) {
            Some(Output::Tile(tile)) => Some(tile),
            _ => None,
        }
    }
}

impl<'a> Inputs<'a> {
    pub(crate) fn facet_grid(self, job: &Job) -> &'a FacetGrid {
        match self.0.output(job.key()) {
            Some(Output::FacetGrid(grid)) => grid,
            _ => unreachable!("facet grids run before the tiles that need them"),
        }
    }

    pub(crate) fn fgd_truth(self, job: &Job) -> &'a FgdTruth {
        self.0.fgd_truth(job)
    }

    pub(crate) fn crossed(self, job: &Job) -> &'a CrossedGrid {
        match self.0.output(job.key()) {
            Some(Output::Crossed(grid)) => grid,
            _ => unreachable!("crossed grids run before the tiles that need them"),
        }
    }
}
