//! Reads the command line.

use std::process::exit;

use clap::error::{ContextKind, ContextValue, ErrorKind};
use clap::{ColorChoice, CommandFactory, FromArgMatches};

use crate::cli::Cli;
use crate::failure::print_json;
use crate::output::has_colour;

/// Verbs that a cargo feature brings, and the feature.
const OF_FEATURES: [(&str, &str); 8] = [
    ("parity", "gpu"),
    ("stability", "gpu"),
    ("preview", "gpu"),
    ("gallery", "gpu"),
    ("compare", "gpu"),
    ("figures", "gpu"),
    ("bench", "gpu"),
    ("view", "view"),
];

/// The command line of this process; exits where it asks for help or is wrong.
pub(crate) fn parse() -> Cli {
    // The parser's own rule colours a dumb terminal of a build server.
    let colour = if has_colour() { ColorChoice::Auto } else { ColorChoice::Never };
    let matches = Cli::command().color(colour).try_get_matches();
    let cli = matches.and_then(|matches| Cli::from_arg_matches(&matches));
    cli.unwrap_or_else(|error| match left_out(&error) {
        Some((verb, feature)) => {
            print_json(2, "usage", &format!("this build leaves `{verb}` out"), &[]);
            eprintln!("error: this build leaves `{verb}` out\nhint: build with `--features {feature}`");
            exit(2)
        }
        None => {
            // Help and versions are errors to this parser.
            if error.use_stderr() {
                let text = error.render().to_string();
                let sentence = text.lines().next().unwrap_or_default();
                print_json(2, "usage", sentence.trim_start_matches("error: "), &[]);
            }
            error.exit()
        }
    })
}

/// The verb that is unknown only because its feature is off.
fn left_out(error: &clap::Error) -> Option<(&'static str, &'static str)> {
    let Some(ContextValue::String(name)) = error.get(ContextKind::InvalidSubcommand) else { return None };
    let is_verb = error.kind() == ErrorKind::InvalidSubcommand;
    OF_FEATURES.into_iter().find(|(verb, _)| is_verb && verb == name)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The table of features and the attributes of the verbs say the same.
    #[test]
    fn a_verb_is_there_where_its_feature_is() {
        let command = Cli::command();
        for (verb, feature) in OF_FEATURES {
            let is_on = match feature {
                "gpu" => cfg!(feature = "gpu"),
                "view" => cfg!(feature = "view"),
                other => panic!("no feature `{other}`"),
            };
            assert_eq!(command.find_subcommand(verb).is_some(), is_on, "{verb}");
        }
    }
}
