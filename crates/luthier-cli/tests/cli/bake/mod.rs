//! Bakes: what is written, what is refused, and which tables are made.

mod containers;
mod export;
mod folder;
mod import;
mod lobes;
mod many;
mod maps;
mod misses;
mod output;
mod packages;
mod pictures;
mod plain;
mod refusals;
mod scenes;
mod tables;
mod thickness_map;
