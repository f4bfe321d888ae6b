//! `check`: faults of material files, named before any table is computed.

mod assets;
mod diagnostics;
mod files_of_others;
mod hostile;
mod refusals;
