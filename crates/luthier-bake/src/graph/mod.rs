//! The graph of jobs and its execution.

mod artefact;
mod job;
mod kept;
mod store;

use std::any::Any;
use std::collections::{BTreeMap, BTreeSet};
use std::sync::Arc;

use rayon::prelude::*;

pub use self::artefact::Artefact;
pub(crate) use self::job::Job;
pub use self::job::{JobKind, Key};
pub(crate) use self::kept::result_of;
pub use self::kept::{Function, kept};
pub use self::store::{MemoryStore, Store, Task};
use crate::error::BakeError;
use crate::tile::TileData;

/// Receiver of progress reports, from any thread. It may end a bake early, and cannot change its results.
///
/// ```
/// # let text = "schema = 1\nname = \"glass\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n";
/// # let read = |_: &str| Err(std::io::ErrorKind::NotFound.into());
/// # let glass = luthier_material::parse("glass.toml", text, &read).unwrap().material;
/// use luthier_bake::{BakeError, JobKind, Observer};
///
/// struct Stop;
/// impl Observer for Stop {
///     fn planned(&self, _: usize) {}
///     fn finished(&self, _: JobKind) {}
///     fn batch(&self, _: JobKind, _: bool) {}
///     fn is_cancelled(&self) -> bool { true }
/// }
/// assert!(matches!(luthier_bake::bake(&[glass], &|_, _| unreachable!(), &Stop), Err(BakeError::Cancelled)));
/// ```
pub trait Observer: Sync {
    /// Reports the number of jobs that will run.
    fn planned(&self, jobs: usize);
    /// Reports a finished job. Jobs of one batch run side by side.
    fn finished(&self, kind: JobKind);
    /// Reports that all jobs of one kind in one batch are about to run (`running`), or have run.
    fn batch(&self, kind: JobKind, running: bool);
    /// Reports jobs of a kind that need not run, because a store has their results.
    fn found(&self, _kind: JobKind, _jobs: usize) {}
    /// Returns true to end the bake with [`BakeError::Cancelled`]. Asked before each job; running jobs are finished,
    /// and the store keeps their results.
    fn is_cancelled(&self) -> bool {
        false
    }
}

/// An observer that does nothing.
#[derive(Debug, Clone, Copy)]
pub struct Silent;

impl Observer for Silent {
    fn planned(&self, _: usize) {}
    fn finished(&self, _: JobKind) {}
    fn batch(&self, _: JobKind, _: bool) {}
}

/// A share of the jobs of a bake.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Share {
    /// Number of the share, from 1.
    pub index: u32,
    /// Number of shares.
    pub count: u32,
}

/// A job in a graph.
#[derive(Debug, Clone)]
struct Entry {
    job: Arc<dyn Job>,
    address: Key,
    /// Place in the graph and key of each job that this one needs.
    needs: Vec<(Place, Key)>,
}

impl Entry {
    fn task(&self) -> Task<'_> {
        Task::of(self.job.as_ref(), self.address)
    }
}

/// Length of the longest chain of dependencies below a job, and its kind. In this order, dependencies come before
/// dependants.
type Place = (u32, JobKind);

/// Distinct jobs, dependencies before dependants.
#[derive(Debug, Default)]
pub(crate) struct Graph {
    jobs: BTreeMap<Place, BTreeMap<Key, Entry>>,
}

/// Results by key.
#[derive(Debug, Default)]
pub(crate) struct Results(BTreeMap<Key, Arc<Artefact>>);

/// The results that a running job may read: its dependencies'.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Inputs<'a>(&'a Results);

/// The hash of a key, the addresses of the jobs that it needs, and the version of this crate.
fn address(key: Key, needed: impl Iterator<Item = Key>) -> Key {
    let mut text = format!("luthier-bake {} {key}", env!("CARGO_PKG_VERSION"));
    needed.for_each(|address| text.push_str(&address.to_string()));
    Key::of(text.as_bytes())
}

impl Graph {
    /// Adds a job and all that it needs; a job that is already there is not added again.
    pub(crate) fn add(&mut self, job: Arc<dyn Job>) -> Key {
        self.insert(job).1
    }

    fn insert(&mut self, job: Arc<dyn Job>) -> (Place, Key) {
        let needs: Vec<(Place, Key)> = job.dependencies().into_iter().map(|needed| self.insert(needed)).collect();
        let place = (needs.iter().map(|((depth, _), _)| depth + 1).max().unwrap_or(0), job.kind());
        let key = job.key();
        if !self.jobs.get(&place).is_some_and(|jobs| jobs.contains_key(&key)) {
            let addresses = needs.iter().filter_map(|(place, needed)| Some(self.jobs.get(place)?.get(needed)?.address));
            let address = address(key, addresses);
            self.jobs.entry(place).or_default().insert(key, Entry { job, address, needs });
        }
        (place, key)
    }

    /// Adds the jobs of another graph.
    pub(crate) fn merge(&mut self, other: Self) {
        for (place, jobs) in other.jobs {
            self.jobs.entry(place).or_default().extend(jobs);
        }
    }

    /// The address of the result of a job.
    pub(crate) fn address(&self, key: Key) -> Option<Key> {
        self.jobs.values().find_map(|jobs| jobs.get(&key)).map(|entry| entry.address)
    }

    /// The graph of some of its jobs, with all that these need.
    pub(crate) fn only(&self, is_one: impl Fn(&dyn Job) -> bool) -> Self {
        self.with_needs(self.entries().filter(|(_, entry)| is_one(entry.job.as_ref())).map(|(at, _)| at))
    }

    /// The graph of a share of its jobs, with all that these need. Shares take turns at the jobs that no other job
    /// needs.
    pub(crate) fn share(&self, share: Share, is_one: impl Fn(&dyn Job) -> bool) -> Self {
        let inner = self.inner();
        let outer = self.entries().filter(|(at, entry)| is_one(entry.job.as_ref()) && !inner.contains(at));
        self.with_needs(outer.map(|(at, _)| at).skip(share.index as usize - 1).step_by(share.count as usize))
    }

    /// The graph of some of its jobs by their places and keys, with all that these need.
    fn with_needs(&self, wanted: impl Iterator<Item = (Place, Key)>) -> Self {
        let mut some = Self::default();
        let mut open: Vec<(Place, Key)> = wanted.collect();
        while let Some((place, key)) = open.pop() {
            let Some(entry) = self.jobs.get(&place).and_then(|jobs| jobs.get(&key)) else { continue };
            if some.jobs.entry(place).or_default().insert(key, entry.clone()).is_none() {
                open.extend(&entry.needs);
            }
        }
        some
    }

    fn entries(&self) -> impl Iterator<Item = ((Place, Key), &Entry)> {
        self.jobs.iter().flat_map(|(&place, jobs)| jobs.iter().map(move |(&key, entry)| ((place, key), entry)))
    }

    /// The jobs that others need.
    fn inner(&self) -> BTreeSet<(Place, Key)> {
        self.entries().flat_map(|(_, entry)| entry.needs.iter().copied()).collect()
    }

    /// The number of jobs that would run, by kind: neither `results` nor the store has their results.
    pub(crate) fn count_missing(&self, store: &dyn Store, results: &mut Results) -> BTreeMap<JobKind, usize> {
        let mut counts = BTreeMap::new();
        for ((_, kind), _) in self.missing(store, results, &Silent) {
            *counts.entry(kind).or_default() += 1;
        }
        counts
    }

    /// The graph of the jobs with intermediate results.
    pub(crate) fn intermediate(&self) -> Self {
        self.with_needs(self.inner().into_iter())
    }

    /// The jobs of a type, in the order of their keys.
    pub(crate) fn of<J: Job>(&self) -> impl Iterator<Item = &J> {
        self.entries().filter_map(|(_, entry)| (entry.job.as_ref() as &dyn Any).downcast_ref())
    }

    /// A job of a type by its key.
    pub(crate) fn get<J: Job>(&self, key: Key) -> Option<&J> {
        let entry = self.jobs.values().find_map(|jobs| jobs.get(&key))?;
        (entry.job.as_ref() as &dyn Any).downcast_ref()
    }

    /// The jobs that must run: no stored result, and needed by another job that must run. Fetches the results that the store has.
    fn missing(&self, store: &dyn Store, results: &mut Results, observer: &dyn Observer) -> BTreeSet<(Place, Key)> {
        let inner = self.inner();
        let mut missing: BTreeSet<(Place, Key)> = BTreeSet::new();
        for (&place, jobs) in self.jobs.iter().rev() {
            let (mut open, idle): (Vec<(Key, &Entry)>, Vec<_>) = (jobs.iter().map(|(key, entry)| (*key, entry)))
                .partition(|(key, _)| !inner.contains(&(place, *key)) || missing.contains(&(place, *key)));
            idle.into_iter().for_each(|(_, entry)| store.touch(&entry.task()));
            open.retain(|(key, _)| !results.0.contains_key(key));
            let tasks: Vec<Task<'_>> = open.iter().map(|(_, entry)| entry.task()).collect();
            let fetched = store.get_all(&tasks);
            missing.retain(|(at, _)| *at != place);
            let mut found = 0;
            for ((key, entry), fetched) in open.into_iter().zip(fetched) {
                if let Some(artefact) = fetched {
                    results.0.insert(key, artefact);
                    found += 1;
                } else {
                    missing.insert((place, key));
                    missing.extend(entry.needs.iter().copied());
                }
            }
            if found > 0 {
                observer.found(place.1, found);
            }
        }
        missing
    }

    /// Runs every job without a result on the rayon pool, except jobs whose dependants are all stored already. Kinds
    /// run in their order, which puts dependencies first; jobs of one kind run side by side.
    ///
    /// # Errors
    /// [`BakeError::Cancelled`].
    pub(crate) fn run(
        mut self,
        observer: &dyn Observer,
        store: &dyn Store,
        mut results: Results,
    ) -> Result<Results, BakeError> {
        let missing = self.missing(store, &mut results, observer);
        for (&place, jobs) in &mut self.jobs {
            jobs.retain(|&key, _| missing.contains(&(place, key)));
        }
        observer.planned(missing.len());
        for ((_, kind), jobs) in self.jobs {
            if jobs.is_empty() {
                continue;
            }
            observer.batch(kind, true);
            let done: Result<Vec<(Key, Arc<Artefact>)>, BakeError> = jobs
                .into_par_iter()
                .map(|(key, entry)| {
                    if observer.is_cancelled() {
                        return Err(BakeError::Cancelled);
                    }
                    let artefact = Arc::new(entry.job.run(&Inputs(&results)));
                    store.put(&entry.task(), &artefact);
                    observer.finished(kind);
                    Ok((key, artefact))
                })
                .collect();
            observer.batch(kind, false);
            results.0.extend(done?);
        }
        Ok(results)
    }
}

impl Results {
    /// The result of a job that has run, if it is of the type `T`.
    pub(crate) fn get<T: Any>(&self, key: Key) -> Option<&T> {
        self.0.get(&key)?.get()
    }

    /// Forgets a result that nothing needs any more.
    pub(crate) fn forget(&mut self, key: Key) {
        self.0.remove(&key);
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
