//! Stores one above the other, the nearest first.

use std::sync::Arc;

use luthier_bake::{Artefact, Store, Task};

/// Stores one above the other, the nearest first. A result found in one store is kept by those above it; a new result
/// is kept by all.
///
/// ```
/// use luthier_bake::{Function, MemoryStore, Store};
/// use luthier_store::Layers;
///
/// let (near, far) = (MemoryStore::default(), MemoryStore::default());
/// let (answer, inputs) = (Function { kind: "answer", revision: 1 }, Default::default());
/// answer.keep(&inputs, &far, 42_u32);
/// let stores: [&dyn Store; 2] = [&near, &far];
/// assert_eq!(answer.recall::<u32>(&inputs, &Layers(&stores)), Some(42));
/// assert_eq!(near.len(), 1); // kept by the nearer store too
/// ```
#[derive(Clone, Copy)]
pub struct Layers<'a>(pub &'a [&'a dyn Store]);

impl Store for Layers<'_> {
    fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>> {
        let (depth, found) = self.0.iter().enumerate().find_map(|(depth, store)| Some((depth, store.get(task)?)))?;
        self.0[..depth].iter().for_each(|store| store.put(task, &found));
        Some(found)
    }

    fn get_all(&self, tasks: &[Task<'_>]) -> Vec<Option<Arc<Artefact>>> {
        let mut found: Vec<Option<Arc<Artefact>>> = vec![None; tasks.len()];
        for (depth, store) in self.0.iter().enumerate() {
            let open: Vec<usize> = (0..tasks.len()).filter(|&i| found[i].is_none()).collect();
            let asked: Vec<Task<'_>> = open.iter().map(|&i| tasks[i]).collect();
            for (i, artefact) in open.into_iter().zip(store.get_all(&asked)) {
                if let Some(artefact) = &artefact {
                    self.0[..depth].iter().for_each(|above| above.put(&tasks[i], artefact));
                }
                found[i] = artefact;
            }
        }
        found
    }

    fn touch(&self, task: &Task<'_>) {
        self.0.iter().for_each(|store| store.touch(task));
    }

    fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>) {
        self.0.iter().for_each(|store| store.put(task, artefact));
    }
}
