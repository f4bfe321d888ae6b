//! Commands on a terminal.

use std::path::Path;
use std::process::{Command, Stdio};

/// All that a command says on a terminal, escape sequences included: a program and its words, with some variables. Needs the program
/// `script` of Linux.
pub fn on_terminal(program: &str, words: &str, folder: &Path, variables: &[(&str, &str)]) -> String {
    let mut script = Command::new("script");
    script.args(["-q", "-c", &format!("{program} {words}"), "/dev/null"]).current_dir(folder).stdin(Stdio::null());
    script.env_remove("NO_COLOR").env("TERM", "xterm").envs(variables.iter().copied());
    String::from_utf8_lossy(&script.output().unwrap().stdout).into_owned()
}

/// Whether a text has escape sequences of colours.
pub fn has_colours(text: &str) -> bool {
    text.split('\u{1b}')
        .skip(1)
        .any(|rest| rest.split(char::is_alphabetic).next().is_some_and(|p| rest[p.len()..].starts_with('m')))
}
