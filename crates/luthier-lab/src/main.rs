//! The `luthier-lab` command: makes the pages and measurements of this repository. A user of luthier needs none of it.
//!
//! The command line (`cli`) uses no other room. Every verb is a room, which uses the command line. Some also use `maps`, and `lobes`, `papers` or `parity`,
//! whose numbers they share.

mod anisotropic;
mod budgets;
mod cli;
mod coats;
mod devices;
mod environment;
mod families;
mod figures;
mod five_ways;
mod foreign;
mod formats;
mod grammar;
mod judge;
mod ladder;
mod layouts;
mod lobes;
mod maps;
mod papers;
mod parity;
mod places;
mod sets;
mod shapes;
mod simulation;
mod stability;
mod texels;
mod textured;
mod textures;
mod throughput;
mod varying;

use std::process::ExitCode;

use crate::cli::{Cli, Verb};

fn main() -> ExitCode {
    // This may be the process that asks the driver's compiler.
    if let Some(code) = luthier_cost::answer() {
        return code;
    }
    let outcome = match &luthier_terminal::parse::<Cli>(&[]).verb {
        Verb::Figures(options) => figures::run(options),
        Verb::Grammar(options) => grammar::run(options),
        Verb::Parity(options) => parity::run(options),
        Verb::Places(options) => places::run(options),
        Verb::Textured(options) => textured::run(options),
        Verb::Stability(options) => stability::run(options),
        Verb::Judge(options) => judge::run(options),
        Verb::Varying(options) => varying::run(options),
        Verb::Families(options) => families::run(options),
        Verb::Coats(options) => coats::run(options),
        Verb::FiveWays(options) => five_ways::run(options),
        Verb::Formats(options) => formats::run(options),
        Verb::Anisotropic(options) => anisotropic::run(options),
        Verb::Environment(options) => environment::run(options),
        Verb::Simulation(options) => simulation::run(options),
        Verb::Lobes(options) => lobes::run(options),
        Verb::Budgets(options) => budgets::run(options),
        Verb::Papers(options) => papers::run(options),
        Verb::Throughput(options) => throughput::run(options),
        Verb::Devices(options) => devices::run(options),
        Verb::Layouts(options) => layouts::run(options),
        Verb::Ladder(options) => ladder::run(options),
        Verb::LadderChart(options) => ladder::redraw(options),
        Verb::Sets(options) => sets::run(options),
        Verb::Shapes(options) => shapes::run(options),
        Verb::Foreign(options) => foreign::run(options),
        Verb::Texels(options) => texels::run(options),
        Verb::Textures(options) => textures::run(options),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.exit(),
    }
}
