//! The layered model against closed forms, values computed by other programs, and what must hold everywhere.

mod directions;
mod elek;
mod everywhere;
mod oren_nayar;
