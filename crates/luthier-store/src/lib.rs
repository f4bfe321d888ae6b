//! Results of jobs on disk, by the hash of everything that decides them.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`DiskStore`] is a [`Store`](luthier_bake::Store). An entry is a file `objects/ab/cdef…-kind`, named by its address.
//! It is written beside its place and renamed, so other processes see it whole or not at all. Any number of processes
//! may use a folder at once. A reader compares the hash in the entry with its bytes: a damaged entry is removed, and
//! its job runs again.
//!
//! With the feature `remote`, `RemoteStore` keeps entries in a store that machines share. [`Layers`] stacks stores.
//!
//! Simplifications: two processes that miss one entry at once both compute it. Entries are trusted: a user with write
//! access to the folder can change the results of bakes.

mod disk;
mod entry;
mod layers;
#[cfg(feature = "remote")]
mod remote;
mod usage;

pub use disk::{DiskStore, StoreError};
pub use layers::Layers;
#[cfg(feature = "remote")]
pub use remote::{RemoteError, RemoteStore};
pub use usage::{KindUsage, Usage, Verified};

/// Bytes that a store may hold, unless another limit is given: 4 GiB.
pub const DEFAULT_LIMIT: u64 = 4 << 30;
