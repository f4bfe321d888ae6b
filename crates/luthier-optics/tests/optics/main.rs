//! Tests of the optics against oracles that share no code with it: brute-force walks, transfer matrices, conservation laws,
//! published colours of metals, histograms.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

mod albedo;
mod brute_force;
mod conservation;
mod crossing;
mod engine;
mod films_on_f0;
mod metals;
mod sampling;
mod transfer_matrix;
mod visible_normals;
