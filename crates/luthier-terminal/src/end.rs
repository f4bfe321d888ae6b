//! The end of a command: its failure in words, and its exit code.

use std::process::ExitCode;

use serde_json::{Value, json};

use crate::failure::Failure;
use crate::output::{asks_for, complain, has_events, print, tell};

impl Failure {
    /// Prints the failure, also as JSON if that was asked for, and returns the exit code.
    pub fn exit(&self) -> ExitCode {
        ExitCode::from(self.told())
    }

    /// Prints the failure as [`Failure::exit`] does, and returns the exit code as a number.
    pub(crate) fn told(&self) -> u8 {
        let Some(failed) = self.as_json() else { return u8::from(matches!(self, Self::Verdict)) };
        print_json(&failed);
        self.tell();
        failed["code"].as_u64().map_or(1, |code| code as u8)
    }

    /// Prints the failure on standard error.
    pub fn tell(&self) {
        match self.as_json() {
            Some(failed) if has_events() => tell_failure(failed),
            Some(_) => complain(&format!("error: {}", self.sentence())),
            None => {}
        }
    }
}

/// A command line that is wrong, for programs.
pub(crate) fn usage(message: &str) -> Value {
    json!({"code": 2, "kind": "usage", "message": message, "diagnostics": []})
}

/// Writes a failure to standard output as JSON if the command line asks for JSON. A reader that is gone is no error here.
pub(crate) fn print_json(failed: &Value) {
    if asks_for("--json") {
        let _ = print(&format!("{:#}", json!({ "error": failed })));
    }
}

/// Writes a failure to standard error as an event, where the command line asks for events.
pub(crate) fn tell_failure(mut failed: Value) {
    failed["event"] = json!("failed");
    tell(&failed);
}
