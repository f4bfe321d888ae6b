//! Tests of the Monte Carlo reference against closed forms, other formulations and laws of physics.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

mod adding;
mod closed_forms;
mod furnace;
mod independent;
mod integrals;
mod one_facet;
mod rough_coat;
mod scenes;
mod single_interface;
mod symmetry;
