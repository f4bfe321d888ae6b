//! Reads the command line of a process.

use std::process::exit;

use anyhow::anyhow;
use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ColorChoice, CommandFactory, FromArgMatches};

use crate::end::{print_json, tell_failure, usage};
use crate::failure::Failure;
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
        Some((verb, feature)) => exit(without(verb, feature).told().into()),
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

/// The failure of a verb that this build lacks. All of these need the library of a graphics driver.
fn without(verb: &str, feature: &str) -> Failure {
    Failure::device(anyhow!(
        "this build leaves `{verb}` out, which needs a graphics driver: build with `--features {feature}`"
    ))
}

/// The verb that is unknown only because its feature is off.
fn left_out<'v>(error: &clap::Error, of_features: &[(&'v str, &'v str)]) -> Option<(&'v str, &'v str)> {
    let Some(ContextValue::String(name)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let is_verb = error.kind() == ErrorKind::InvalidSubcommand;
    of_features.iter().copied().find(|(verb, _)| is_verb && verb == name)
}

#[cfg(test)]
mod tests {
    use clap::{Arg, Command};

    use super::*;

    #[test]
    fn a_verb_of_a_feature_is_told_as_a_missing_driver() {
        let command = || Command::new("luthier").subcommand(Command::new("bake").arg(Arg::new("file")));
        let features = [("preview", "gpu"), ("view", "view")];
        let of = |line: &[&str]| left_out(&command().try_get_matches_from(line).unwrap_err(), &features);
        assert_eq!(of(&["luthier", "view", "gold.toml"]), Some(("view", "view")));
        assert_eq!((of(&["luthier", "prevew"]), of(&["luthier", "bake", "a", "preview"])), (None, None));
        let failed = without("view", "view").as_json().unwrap();
        assert_eq!((&failed["code"], &failed["kind"]), (&4.into(), &"device".into()));
        assert!(failed["message"].as_str().unwrap().contains("--features view"));
    }
}
