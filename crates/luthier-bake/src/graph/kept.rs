//! Results that are asked for one by one, without a graph.

use std::iter;
use std::sync::Arc;

use super::{Artefact, Inputs, Job, Results, Store, Task, address};

/// The result of a job that needs no other: the store's, or one that is made now and kept.
pub(crate) fn result_of(job: &dyn Job, store: &dyn Store) -> Arc<Artefact> {
    let task = Task::of(job, address(job.key(), iter::empty()));
    store.get(&task).unwrap_or_else(|| {
        let artefact = Arc::new(job.run(&Inputs(&Results::default())));
        store.put(&task, &artefact);
        artefact
    })
}
