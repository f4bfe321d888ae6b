//! `check`: faults of material files, named before any table is computed.

mod diagnostics;
mod hostile;
mod refusals;
