//! Standard output and standard error.

use std::io::{self, IsTerminal, Write};
use std::path::Path;
use std::sync::OnceLock;

use serde_json::{Value, json};

use crate::failure::{Failure, Outcome, files};

/// Writes a text to standard output, with a final newline.
///
/// # Errors
/// [`Failure::Files`], [`Failure::BrokenPipe`].
pub fn print(text: &str) -> Outcome {
    let mut out = io::stdout().lock();
    out.write_all(text.as_bytes())?;
    if !text.ends_with('\n') {
        out.write_all(b"\n")?;
    }
    out.flush()?;
    Ok(())
}

/// The name of standard output where a file is asked for.
pub const STDOUT: &str = "-";

/// Writes a text to a file, or to standard output where none is named or `-`.
///
/// # Errors
/// [`Failure::Files`], [`Failure::BrokenPipe`].
pub fn deliver(text: &str, file: Option<&Path>) -> Outcome {
    match file.filter(|path| *path != Path::new(STDOUT)) {
        Some(path) => std::fs::write(path, text).map_err(files(path, "write")),
        None => print(text),
    }
}

/// Writes bytes unchanged. Bytes that are no text are refused if standard output is a terminal.
///
/// # Errors
/// [`Failure::Input`] where a terminal cannot show them; [`Failure::Files`], [`Failure::BrokenPipe`].
pub fn print_bytes(bytes: &[u8], is_text: bool) -> Outcome {
    let mut out = io::stdout().lock();
    if !is_text && out.is_terminal() {
        return Err(Failure::Input(anyhow::anyhow!("a terminal cannot show bytes: name a file with -o")));
    }
    out.write_all(bytes)?;
    out.flush()?;
    Ok(())
}

/// Writes a text to standard error. It begins with its severity, `error: ` or `warning: `, or is a note. If the command line asks for events, it is
/// written as an event of that name. A closed standard error is ignored.
pub fn complain(text: &str) {
    if !has_events() {
        say(text);
        return;
    }
    let (severity, message) = match text.split_once(": ") {
        Some((severity @ ("error" | "warning" | "note"), message)) => (severity, message),
        _ => ("note", text),
    };
    tell(&json!({ "event": severity, "message": message.trim_end() }));
}

/// Writes an event to standard error as a line of JSON, where the command line asks for events.
pub fn tell(event: &Value) {
    if has_events() {
        say(&event.to_string());
    }
}

fn say(line: &str) {
    // In one piece: another process may write to the same file.
    let _ = io::stderr().lock().write_all(format!("{line}\n").as_bytes());
}

/// True where the command line asks for events. Standard error then has only lines of JSON, even if the command line is wrong.
pub fn has_events() -> bool {
    static IS_ASKED: OnceLock<bool> = OnceLock::new();
    *IS_ASKED.get_or_init(|| asks_for("--events"))
}

/// True where a word is among the options of the command line, even if others are wrong.
pub(crate) fn asks_for(option: &str) -> bool {
    std::env::args_os().skip(1).take_while(|word| word != "--").any(|word| word == option)
}

/// Whether standard error is a terminal that can move its cursor, for progress bars, and has no events.
pub fn has_cursor() -> bool {
    !has_events() && io::stderr().is_terminal() && std::env::var_os("TERM").is_none_or(|term| term != "dumb")
}

/// True where standard error takes colours. If `NO_COLOR` has a value, it does not (no-color.org).
pub fn has_colour() -> bool {
    has_cursor() && std::env::var_os("NO_COLOR").is_none_or(|value| value.is_empty())
}

/// A number of things, by their name in the singular: `1 table`, `2 tables`.
pub fn counted(count: usize, name: &str) -> String {
    if count == 1 { format!("1 {name}") } else { format!("{count} {name}s") }
}

/// Bytes for people.
pub fn bytes(count: u64) -> String {
    match count {
        0..1024 => format!("{count} B"),
        1024..1_048_576 => format!("{:.1} KiB", count as f64 / 1024.0),
        _ => format!("{:.1} MiB", count as f64 / 1_048_576.0),
    }
}
