//! Baked tables against closed forms and brute force, and what a bake promises about bytes, sharing and refusals.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

mod albedo;
mod blocks;
// The oracle of the optics, which uses nothing of the workspace.
#[expect(dead_code, reason = "the tests of the optics use all of it")]
#[path = "../../../luthier-optics/tests/optics/brute_force.rs"]
mod brute_force;
mod budgets;
mod closed_forms;
mod effects;
mod film_table;
mod films;
mod lean;
// Materials by number, which the tests of the command bake too.
#[path = "../../../luthier-material/examples/library/library.rs"]
mod library;
mod lobes;
mod many;
mod materials;
mod sharing;
mod statistics;
mod total_reflection;
