//! Tests of the classic models against closed forms and published numbers.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

mod claims;
mod energy;
mod everywhere;
mod films_on_f0;
mod granier_heidrich;
mod random;
mod sampling;
mod sampling_shares;
mod schlick;
mod smooth_coats;
mod sphere;
mod stacks;
