//! The `luthier-lab` command: every page that it makes, judged by files, streams and exit codes.

mod command;
mod costs;
mod figures;
mod five_ways;
mod foreign;
mod formats;
mod golden;
mod grammar;
mod judge;
mod ladder;
mod lobes;
mod parity;
mod simulation;
mod stability;
mod textured;
mod workshop;
