//! Reads the command line of a process.

use std::process::exit;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ColorChoice, CommandFactory, FromArgMatches};

use crate::end::{print_json, tell_failure, usage};
use crate::output::{complain, has_colour, has_events};

/// Parses the command line of this process. Exits if it asks for help or is wrong. `of_features` lists verbs with the cargo features that they need:
/// for a verb that the build lacks, the failure names the feature.
pub fn parse<C: CommandFactory + FromArgMatches>(of_features: &[(&str, &str)]) -> C {
    if has_events() {
        std::panic::set_hook(Box::new(|panic| complain(&format!("error: {panic}"))));
    }
    // The rule of clap would colour the output on a dumb terminal of a build server.
    let colour = if has_colour() { ColorChoice::Auto } else { ColorChoice::Never };
    let matches = C::command().color(colour).try_get_matches();
    let line = matches.and_then(|matches| C::from_arg_matches(&matches));
    line.unwrap_or_else(|error| match left_out(&error, of_features) {
        Some((verb, feature)) => {
            let failed = usage(&format!("this build leaves `{verb}` out"));
            print_json(&failed);
            if has_events() {
                tell_failure(failed);
            } else {
                complain(&format!("error: this build leaves `{verb}` out\nhint: build with `--features {feature}`"));
            }
            exit(2)
        }
        None => {
            // Help and versions are errors to this parser.
            if error.use_stderr() {
                let text = error.render().to_string();
                let sentence = text.lines().next().unwrap_or_default();
                let failed = usage(sentence.trim_start_matches("error: "));
                print_json(&failed);
                if has_events() {
                    tell_failure(failed);
                    exit(2);
                }
            }
            error.exit()
        }
    })
}

/// The verb that is unknown only because its feature is off.
fn left_out<'v>(error: &clap::Error, of_features: &[(&'v str, &'v str)]) -> Option<(&'v str, &'v str)> {
    let Some(ContextValue::String(name)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let is_verb = error.kind() == ErrorKind::InvalidSubcommand;
    of_features.iter().copied().find(|(verb, _)| is_verb && verb == name)
}
