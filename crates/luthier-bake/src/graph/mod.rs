//! The graph of jobs and its execution.

mod job;
mod store;

use std::any::Any;
use std::collections::BTreeMap;
use std::sync::Arc;

use rayon::prelude::*;

pub(crate) use self::job::{Job, Output};
pub use self::job::{JobKind, Key};
pub use self::store::{Artefact, MemoryStore, Store};
use crate::tile::TileData;

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

/// Distinct jobs, dependencies before dependants: by the longest way down to a job without dependencies, then by kind.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    jobs: BTreeMap<(u32, JobKind), BTreeMap<Key, Arc<dyn Job>>>,
}

/// Results by key.
#[derive(Debug, Default)]
pub(crate) struct Results(BTreeMap<Key, Arc<Artefact>>);

/// The results that a running job may read: those of its dependencies.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inputs<'a>(&'a Results);

impl Graph {
    /// Adds a job and all that it needs; a job that is already there is not added again.
    pub(crate) fn add(&mut self, job: Arc<dyn Job>) -> Key {
        self.insert(job).1
    }

    fn insert(&mut self, job: Arc<dyn Job>) -> (u32, Key) {
        let depth = job.dependencies().into_iter().map(|needed| 1 + self.insert(needed).0).max().unwrap_or(0);
        let key = job.key();
        self.jobs.entry((depth, job.kind())).or_default().entry(key).or_insert(job);
        (depth, key)
    }

    fn all(&self) -> impl Iterator<Item = (Key, &Arc<dyn Job>)> {
        self.jobs.values().flatten().map(|(key, job)| (*key, job))
    }

    /// The graph of some of its jobs, with all that these need.
    pub(crate) fn only(&self, is_one: impl Fn(&dyn Job) -> bool) -> Self {
        let mut some = Self::default();
        for (_, job) in self.all().filter(|(_, job)| is_one(job.as_ref())) {
            some.add(job.clone());
        }
        some
    }

    /// The graph of the jobs whose results are intermediate.
    pub(crate) fn intermediate(&self) -> Self {
        let mut some = Self::default();
        for job in self.all().flat_map(|(_, job)| job.dependencies()) {
            some.add(job);
        }
        some
    }

    /// The jobs of a type, in the order of their keys.
    pub(crate) fn of<J: Job>(&self) -> impl Iterator<Item = &J> {
        self.all().filter_map(|(_, job)| (job.as_ref() as &dyn Any).downcast_ref())
    }

    /// A job of a type by its key.
    pub(crate) fn get<J: Job>(&self, key: Key) -> Option<&J> {
        let job = self.jobs.values().find_map(|jobs| jobs.get(&key))?;
        (job.as_ref() as &dyn Any).downcast_ref()
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
        for ((_, kind), jobs) in self.jobs {
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
    /// The result of a job of which it has the type, if the job has run.
    pub(crate) fn get<T: Any>(&self, key: Key) -> Option<&T> {
        self.0.get(&key)?.0.downcast_ref()
    }

    /// The tile of a planned job.
    pub(crate) fn tile(&self, key: Key) -> &TileData {
        self.find(key).unwrap_or_else(|| unreachable!("every planned tile job has run"))
    }

    /// The tile of a job, if it has run.
    pub(crate) fn find(&self, key: Key) -> Option<&TileData> {
        self.get(key)
    }

    /// The intermediate result of a job that has run, of its type.
    pub(crate) fn part<T: Any>(&self, job: &dyn Job) -> &T {
        self.get(job.key()).unwrap_or_else(|| unreachable!("dependencies run before the jobs that need them"))
    }
}

impl<'a> Inputs<'a> {
    /// The result of a dependency, of its type.
    pub(crate) fn part<T: Any>(self, job: &dyn Job) -> &'a T {
        self.0.part(job)
    }
}
