//! The `luthier` command: everything that a user of luthier runs. Code that `luthier-lab` needs, too, is in luthier-terminal.

mod cli;
mod directions;
#[cfg(feature = "gpu")]
mod grid;
mod input;
mod interrupt;
mod materials;
#[cfg(feature = "gpu")]
mod memory_bake;
mod meshes;
mod model_inputs;
mod numbers;
#[cfg(feature = "gpu")]
mod picture;
mod progress;
mod reradiation;
mod shared_store;
#[cfg(feature = "gpu")]
mod simulated;
mod store;
mod surroundings;
#[cfg(feature = "gpu")]
mod variations;
mod verb;
#[cfg(feature = "view")]
mod view_host;
mod watched;

use std::process::ExitCode;

use crate::cli::{Cli, OF_FEATURES, Verb};

fn main() -> ExitCode {
    // This may be the process that asks the driver's compiler.
    #[cfg(feature = "cost")]
    if let Some(code) = luthier_cost::answer() {
        return code;
    }
    interrupt::watch();
    let line = luthier_terminal::parse::<Cli>(&OF_FEATURES);
    #[cfg(feature = "gpu")]
    if let Verb::Preview(_) | Verb::Gallery(_) | Verb::Compare(_) | Verb::Bench(_) | Verb::Report(_) = &line.verb {
        luthier_terminal::without_display();
    }
    store::configure(&line.store);
    let outcome = line.verb.refuse_destinations().and_then(|()| match &line.verb {
        Verb::Bake(options) => verb::bake::run(options),
        Verb::Merge(options) => verb::bake::merge(options),
        Verb::Cache(verb) => verb::cache::run(verb),
        Verb::New(options) => verb::new::run(options),
        Verb::Check(options) => verb::check::run(options),
        Verb::Report(options) => verb::report::run(options),
        Verb::Audit(options) => verb::audit::run(options),
        Verb::Table(options) => verb::table::run(options),
        #[cfg(feature = "gpu")]
        Verb::Preview(options) => verb::preview::run(options),
        Verb::Gallery(options) => verb::gallery::run(options),
        #[cfg(feature = "gpu")]
        Verb::Compare(options) => verb::compare::run(options),
        #[cfg(feature = "gpu")]
        Verb::Bench(options) => verb::bench::run(options),
        #[cfg(feature = "cost")]
        Verb::Cost(options) => verb::cost::run(options),
        #[cfg(feature = "view")]
        Verb::View(options) => verb::view::run(options),
        Verb::Shader(options) => verb::shader::run(options),
        Verb::Environment(options) => verb::environment::run(options),
        Verb::Models(options) => verb::models::run(options),
        Verb::Eval(options) => verb::eval::run(options),
        Verb::Fit(options) => verb::fit::run(options),
        Verb::Import(options) => verb::import::run(options),
        Verb::Export(options) => verb::export::run(options),
        Verb::Ior(options) => verb::ior::run(options),
        Verb::Schema { scene, surface } => verb::schema::run(*scene, *surface),
        Verb::Completions(options) => verb::completions::run(options),
        Verb::Man(options) => verb::man::run(options),
    });
    store::close();
    match outcome {
        Ok(()) => ExitCode::SUCCESS,
        Err(failure) => failure.exit(),
    }
}
