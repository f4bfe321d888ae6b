//! Reads the command line.

use std::process::exit;

use clap::Parser;
use clap::error::{ContextKind, ContextValue, ErrorKind};

use crate::cli::Cli;

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
    Cli::try_parse().unwrap_or_else(|error| match left_out(&error) {
        Some((verb, feature)) => {
            eprintln!("error: this build leaves `{verb}` out\nhint: build with `--features {feature}`");
            exit(2)
        }
        None => error.exit(),
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
    use clap::CommandFactory;

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
