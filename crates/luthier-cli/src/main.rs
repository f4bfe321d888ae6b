//! The `luthier` command: sole owner of paths, standard streams and exit codes.

mod cli;
mod command_line;
mod cost_page;
mod cost_papers;
#[cfg(feature = "gpu")]
mod device;
mod directions;
mod failure;
#[cfg(feature = "gpu")]
mod grid;
mod input;
mod interrupt;
mod materials;
#[cfg(feature = "gpu")]
mod memory_bake;
mod misses;
mod model_inputs;
mod output;
#[cfg(feature = "gpu")]
mod picture;
mod progress;
mod reradiation;
#[cfg(feature = "gpu")]
mod sheet;
mod verb;
#[cfg(feature = "view")]
mod view_host;

use std::process::ExitCode;

use crate::cli::Verb;

fn main() -> ExitCode {
    let cli = command_line::parse();
    interrupt::watch();
    let outcome = match &cli.verb {
        Verb::Bake(options) => verb::bake::run(options),
        Verb::Budgets(options) => verb::budgets::run(options),
        Verb::Check(options) => verb::check::run(options),
        Verb::Report(options) => verb::report::run(options),
        Verb::Audit(options) => verb::audit::run(options),
        #[cfg(feature = "gpu")]
        Verb::Parity(options) => verb::parity::run(options),
        #[cfg(feature = "gpu")]
        Verb::Stability(options) => verb::stability::run(options),
        #[cfg(feature = "gpu")]
        Verb::Preview(options) => verb::preview::run(options),
        #[cfg(feature = "gpu")]
        Verb::Gallery(options) => verb::gallery::run(options),
        #[cfg(feature = "gpu")]
        Verb::Compare(options) => verb::compare::run(options),
        #[cfg(feature = "gpu")]
        Verb::Bench(options) => verb::bench::run(options),
        Verb::Cost(options) => verb::cost::run(options),
        Verb::CostProbe { family, assembly } => verb::cost::probe(family.0, *assembly),
        #[cfg(feature = "view")]
        Verb::View(options) => verb::view::run(options),
        #[cfg(feature = "gpu")]
        Verb::Figures(options) => verb::figures::run(options),
        Verb::Shader(options) => verb::shader::run(options),
        Verb::Models(options) => verb::models::run(options),
        Verb::Eval(options) => verb::eval::run(options),
        Verb::Ior(options) => verb::ior::run(options),
        Verb::Schema { scene } => verb::schema::run(*scene),
    };
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.exit(),
    }
}
