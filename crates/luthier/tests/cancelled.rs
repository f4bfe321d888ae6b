//! A bake that its observer cancels, as an editor does when the file changes.

use std::sync::atomic::{AtomicUsize, Ordering};

use luthier::{Bake, Error, Material, MemoryStore, Observer};
use luthier_bake::{BakeError, JobKind};

const COAT: &str = "schema = 1\nname = \"coat\"\n[[layer]]\ntype = \"dielectric\"\nior = 1.5\nalpha = 0.1\n\
                    [[layer]]\ntype = \"conductor\"\nior = \"au\"\nalpha = 0.3\n[bake]\nmodel = \"elek\"\n";

/// Cancels once so many jobs are done.
struct Until {
    jobs: usize,
    done: AtomicUsize,
}

impl Observer for Until {
    fn planned(&self, _: usize) {}
    fn batch(&self, _: JobKind, _: bool) {}
    fn finished(&self, _: JobKind) {
        self.done.fetch_add(1, Ordering::Relaxed);
    }
    fn is_cancelled(&self) -> bool {
        self.done.load(Ordering::Relaxed) >= self.jobs
    }
}

fn materials() -> Vec<Material> {
    vec![luthier::parse("coat.toml", COAT).unwrap()]
}

#[test]
fn work_ends_and_what_is_done_is_kept() {
    let store = MemoryStore::default();
    let until = Until { jobs: 1, done: AtomicUsize::new(0) };
    let bake = Bake { observer: &until, ..Bake::default() };
    let error = bake.package(&materials(), &store).unwrap_err();
    assert!(matches!(error, Error::Bake(BakeError::Cancelled)), "{error}");
    assert!(!store.is_empty(), "finished jobs are in the store");

    let all = Until { jobs: usize::MAX, done: AtomicUsize::new(0) };
    let fresh = Bake { observer: &all, ..Bake::default() }.package(&materials(), &MemoryStore::default()).unwrap();
    let rest = Until { jobs: usize::MAX, done: AtomicUsize::new(0) };
    let resumed = Bake { observer: &rest, ..Bake::default() }.package(&materials(), &store).unwrap();
    assert_eq!(resumed, fresh);
    assert!(rest.done.into_inner() < all.done.into_inner(), "the finished jobs are not run again");
}
