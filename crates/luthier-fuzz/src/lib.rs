//! Bytes from outside, fed to every parser of luthier.
//!
#![doc = include_str!("../README.md")]
//! # In detail
//!
//! [`TARGETS`] lists the targets. [`corpus`] returns the checked-in inputs of one. The crate's allocator refuses more
//! than [`MEMORY_MAX`] for the whole program, and the program aborts.
//!
//! Out of scope: computations on a valid input (fits, tables, shaders), values of single options of a command line, and
//! messages between a command and its own child processes.

mod corpus;
mod targets;

pub use corpus::{Input, corpus, folders};
pub use targets::{TARGETS, Target, target, with_sums};

/// Most bytes that a program of this crate may hold at once.
pub const MEMORY_MAX: usize = 512 << 20;

#[global_allocator]
static ALLOCATOR: cap::Cap<std::alloc::System> = cap::Cap::new(std::alloc::System, MEMORY_MAX);

/// Calls a function that may hold `bytes` more than the program holds now. If it asks for more, the program aborts.
/// Other threads count too.
pub fn holding<T>(bytes: usize, call: impl FnOnce() -> T) -> T {
    let limit = ALLOCATOR.limit();
    let narrowed = ALLOCATOR.set_limit(ALLOCATOR.allocated().saturating_add(bytes));
    assert!(narrowed.is_ok(), "the program holds more than the limit");
    let returned = call();
    assert!(ALLOCATOR.set_limit(limit).is_ok(), "the limit is that of before");
    returned
}
