//! The layered model against closed forms, values computed by other programs, and what must hold everywhere.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

mod directions;
mod elek;
mod everywhere;
mod oren_nayar;
