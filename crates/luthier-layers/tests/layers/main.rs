//! Tests of Elek's and of Oren and Nayar's models and of twins of shaders against closed forms, other programs and general laws.

#![expect(clippy::disallowed_methods, reason = "oracles: nothing that ships depends on them")]

mod bounces;
mod bumps;
mod directions;
mod elek;
mod everywhere;
mod fluorescent;
mod oren_nayar;
