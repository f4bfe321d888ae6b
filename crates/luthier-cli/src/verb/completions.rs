//! `completions`: a script for a shell.

use clap::CommandFactory;
use luthier_terminal::{Outcome, print_bytes};

use crate::cli::{Cli, CompletionsOptions};

/// Prints the script that completes verbs and options in a shell.
pub(crate) fn run(options: &CompletionsOptions) -> Outcome {
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut Cli::command(), "luthier", &mut script);
    print_bytes(&script, true)
}
