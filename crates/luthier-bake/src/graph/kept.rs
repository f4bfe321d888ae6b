//! Results that are asked for one by one, without a graph.

use std::any::Any;
use std::iter;
use std::sync::Arc;

use serde::Serialize;
use serde::de::DeserializeOwned;
use serde_json::Value;

use super::{Artefact, Inputs, Job, JobKind, Key, Results, Store, Task, address};

/// A pure function outside the graph. A store keeps its values by their inputs.
///
/// `revision` changes whenever equal inputs give another value than before.
///
/// ```
/// use luthier_bake::{Function, MemoryStore, kept};
/// use serde_json::json;
///
/// let (square, store) = (Function { kind: "square", revision: 1 }, MemoryStore::default());
/// assert_eq!(kept(square, &json!(3), &store, || 9_u32), 9);
/// assert_eq!(kept::<u32>(square, &json!(3), &store, || unreachable!("the store has it")), 9);
/// ```
#[derive(Debug, Clone, Copy)]
pub struct Function {
    /// Kind of its values in stores.
    pub kind: &'static str,
    /// Number of the version of the function.
    pub revision: u32,
}

impl Function {
    /// The value for some inputs that a store has.
    pub fn recall<T>(self, inputs: &Value, store: &dyn Store) -> Option<T>
    where
        T: Any + Clone + Send + Sync + Serialize + DeserializeOwned,
    {
        store.get(&self.task::<T>(inputs)).and_then(|artefact| artefact.get::<T>().cloned())
    }

    /// Keeps the value for some inputs.
    pub fn keep<T>(self, inputs: &Value, store: &dyn Store, value: T)
    where
        T: Any + Clone + Send + Sync + Serialize + DeserializeOwned,
    {
        store.put(&self.task::<T>(inputs), &Arc::new(Artefact::new(value)));
    }

    fn task<T>(self, inputs: &Value) -> Task<'static>
    where
        T: Any + Clone + Send + Sync + Serialize + DeserializeOwned,
    {
        let kind = JobKind::part(self.kind);
        Task::new(kind, address(Key::of_inputs(kind, self.revision, inputs), iter::empty()), Artefact::decode::<T>)
    }
}

/// The value of a function: the store's, or one that is computed now and kept.
pub fn kept<T>(function: Function, inputs: &Value, store: &dyn Store, compute: impl FnOnce() -> T) -> T
where
    T: Any + Clone + Send + Sync + Serialize + DeserializeOwned,
{
    function.recall(inputs, store).unwrap_or_else(|| {
        let value = compute();
        function.keep(inputs, store, value.clone());
        value
    })
}

/// The result of a job that needs no other: the store's, or one that is made now and kept.
pub(crate) fn result_of(job: &dyn Job, store: &dyn Store) -> Arc<Artefact> {
    let task = Task::of(job, address(job.key(), iter::empty()));
    store.get(&task).unwrap_or_else(|| {
        let artefact = Arc::new(job.run(&Inputs(&Results::default())));
        store.put(&task, &artefact);
        artefact
    })
}

#[cfg(test)]
mod tests {
    use std::cell::Cell;

    use serde_json::json;

    use super::*;
    use crate::MemoryStore;

    #[test]
    fn values_are_computed_once_for_all_that_decides_them() {
        let (store, calls) = (MemoryStore::default(), Cell::new(0));
        let value = |kind, revision, input: f64| {
            kept(Function { kind, revision }, &json!([input]), &store, || {
                calls.set(calls.get() + 1);
                (input, calls.get())
            })
        };
        for _ in 0..2 {
            assert_eq!(value("one", 1, 0.1), (0.1, 1));
        }
        assert_eq!(value("one", 1, 0.2), (0.2, 2));
        assert_eq!(value("one", 2, 0.1), (0.1, 3));
        assert_eq!(value("two", 1, 0.1), (0.1, 4));
        assert_eq!(value("one", 1, 0.1), (0.1, 1));
        assert_eq!(store.len(), 4);
    }
}
