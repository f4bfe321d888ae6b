//! The command as a whole: help, failures, streams, schemas, manual pages, and the crates that it is made of.

mod crate_graph;
mod destinations;
mod failures;
mod help;
mod kinds;
mod manual;
mod models;
mod new;
#[cfg(unix)]
mod nightly;
mod oldest_rust;
mod pipes;
mod rooms;
mod schema;
mod shared_store;
mod sources;
#[cfg(unix)]
mod suite;
mod table;
