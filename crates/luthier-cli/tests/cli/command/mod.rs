//! The command as a whole: help, failures, streams, schemas, and the crates that it is made of.

mod crate_graph;
mod failures;
mod help;
mod kinds;
mod pipes;
mod schema;
mod shared_store;
mod sources;
mod table;
