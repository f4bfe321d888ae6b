//! The reference: a page in Markdown with every verb, argument and option. It follows the definition of the command line, not the width of a
//! terminal.

use clap::builder::StyledStr;
use clap::{Arg, ArgAction, Command};

use super::text::{Block, blocks, sentence};

const HEAD: &str = "\
# Verbs and options

All verbs of the command `luthier`, with their arguments and options. The definition of the command line is the source of this page, as it is of
`luthier help`, of the completions (`luthier completions`) and of the manual pages (`luthier man`); `luthier man --markdown` prints it.

`[X]` may be left out, `<X>` is to be replaced by a value, and `...` stands behind what may be given again. Every verb takes `-h` and `--help`.

";

/// The page of a command. `of_features` lists verbs of cargo features.
pub(super) fn page(command: Command, of_features: &[(&str, &str)]) -> String {
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut page = HEAD.to_owned();
    contents(&verbs(&command), &mut page);
    section(&command, of_features, &mut page);
    page.truncate(page.trim_end().len());
    page.push('\n');
    page
}

/// Verbs sorted by name, so that their order does not depend on features.
fn verbs(command: &Command) -> Vec<&Command> {
    let mut verbs: Vec<&Command> = command.get_subcommands().filter(|verb| !verb.is_hide_set()).collect();
    verbs.sort_by_key(|verb| verb.get_name());
    verbs
}

/// Appends a list of verbs that leads to their sections.
fn contents(verbs: &[&Command], page: &mut String) {
    for verb in verbs {
        let name = name(verb);
        page.push_str(&format!("- [`{name}`](#{}): {}\n", name.replace(' ', "-"), about(verb)));
    }
}

fn name(command: &Command) -> &str {
    command.get_bin_name().unwrap_or(command.get_name())
}

fn about(command: &Command) -> String {
    prose(&sentence(&command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default()))
}

/// Appends a command and its verbs.
fn section(command: &Command, of_features: &[(&str, &str)], page: &mut String) {
    page.push_str(&format!("\n## {}\n\n{}", name(command), about(command)));
    if let Some((_, feature)) = of_features.iter().find(|(verb, _)| *verb == command.get_name()) {
        page.push_str(&format!(" Builds with the cargo feature `{feature}` have this verb."));
    }
    let usage = command.clone().render_usage().to_string();
    page.push_str(&format!("\n\n    {}\n", usage.trim_start_matches("Usage: ").trim()));
    let has_help = command.get_version().is_some();
    let shown = command.get_arguments().filter(|arg| !arg.is_hide_set() && (arg.get_id() != "help" || has_help));
    let (positional, options): (Vec<&Arg>, Vec<&Arg>) = shown.partition(|arg| arg.is_positional());
    let mut headings: Vec<Option<&str>> = options.iter().map(|arg| arg.get_help_heading()).collect();
    headings.sort_by_key(Option::is_some);
    headings.dedup();
    list("Arguments", &positional, command, page);
    for heading in headings {
        let of_heading: Vec<&Arg> = options.iter().copied().filter(|arg| arg.get_help_heading() == heading).collect();
        list(heading.unwrap_or("Options"), &of_heading, command, page);
    }
    for line in groups(command) {
        page.push_str(&format!("\n{line}\n"));
    }
    // The page begins with the verbs of the command itself.
    let verbs = verbs(command);
    if name(command).contains(' ') && !verbs.is_empty() {
        page.push_str("\nVerbs:\n\n");
        contents(&verbs, page);
    }
    let after =
        command.get_after_long_help().or(command.get_after_help()).map(StyledStr::to_string).unwrap_or_default();
    for block in blocks(&after) {
        match block {
            Block::Title(title) => page.push_str(&format!("\n{title}:\n")),
            Block::Paragraph(text) => page.push_str(&format!("\n{}\n", prose(&text))),
            Block::Lines(lines) => {
                page.push('\n');
                lines.iter().for_each(|line| page.push_str(&format!("    {line}\n")));
            }
        }
    }
    for verb in verbs {
        section(verb, of_features, page);
    }
}

/// Appends arguments or options under a title.
fn list(title: &str, args: &[&Arg], command: &Command, page: &mut String) {
    if args.is_empty() {
        return;
    }
    page.push_str(&format!("\n{title}:\n\n"));
    for arg in args {
        page.push_str(&format!("- {}: {}\n", signature(arg), facts(arg, command)));
        for value in arg.get_possible_values().iter().filter(|_| has_explained_values(arg)) {
            let help =
                value.get_help().map_or(String::new(), |help| format!(": {}", prose(&sentence(&help.to_string()))));
            page.push_str(&format!("  - `{}`{help}\n", value.get_name()));
        }
    }
}

/// True where values of an argument have texts of their own.
fn has_explained_values(arg: &Arg) -> bool {
    arg.get_possible_values().iter().any(|value| value.get_help().is_some())
}

/// An argument as one types it.
fn signature(arg: &Arg) -> String {
    let range = arg.get_num_args().expect("the command is built");
    let names = arg.get_value_names().unwrap_or_default().join("> <");
    let is_repeated = matches!(arg.get_action(), ArgAction::Append) && arg.get_value_delimiter().is_none();
    let again = if is_repeated { "..." } else { "" };
    if arg.is_positional() {
        let named = if arg.is_required_set() { format!("<{names}>") } else { format!("[{names}]") };
        return format!("`{named}{again}`");
    }
    let short = arg.get_short().map_or(String::new(), |short| format!("-{short}, "));
    let long = arg.get_long().map_or(String::new(), |long| format!("--{long}"));
    let value = match (range.takes_values(), range.min_values() == 0, arg.is_require_equals_set()) {
        (false, _, _) => String::new(),
        (true, true, true) => format!("[=<{names}>]"),
        (true, true, false) => format!(" [<{names}>]"),
        (true, false, true) => format!("=<{names}>"),
        (true, false, false) => format!(" <{names}>"),
    };
    format!("`{short}{long}{value}{again}`")
}

/// The help and the facts of an argument, in sentences.
fn facts(arg: &Arg, command: &Command) -> String {
    let help = arg.get_long_help().or(arg.get_help()).map(StyledStr::to_string).unwrap_or_default();
    let mut facts = vec![prose(&sentence(&help))];
    if arg.is_required_set() && !arg.is_positional() {
        facts.push("Required.".to_owned());
    }
    let values = arg.get_possible_values();
    if !values.is_empty() && !has_explained_values(arg) {
        facts.push(format!("Values: {}.", quoted(values.iter().map(|value| value.get_name().to_owned()).collect())));
    }
    let defaults = arg.get_default_values();
    if arg.get_num_args().is_some_and(|range| range.takes_values()) && !defaults.is_empty() {
        let defaults = defaults.iter().map(|value| value.to_string_lossy().into_owned()).collect();
        facts.push(format!("Default: {}.", quoted(defaults)));
    }
    let conflicts = conflicts(arg, command);
    if !conflicts.is_empty() {
        facts.push(format!("Not together with {}.", quoted(conflicts.into_iter().map(label).collect())));
    }
    if has_explained_values(arg) {
        facts.push("Values:".to_owned());
    }
    facts.join(" ")
}

fn quoted(names: Vec<String>) -> String {
    names.iter().map(|name| format!("`{name}`")).collect::<Vec<_>>().join(", ")
}

/// Arguments that exclude an argument, whichever of the two states it.
fn conflicts<'c>(arg: &Arg, command: &'c Command) -> Vec<&'c Arg> {
    let excluded =
        |by: &Arg, other: &Arg| command.get_arg_conflicts_with(by).iter().any(|c| c.get_id() == other.get_id());
    command.get_arguments().filter(|other| excluded(arg, other) || excluded(other, arg)).collect()
}

/// An argument in a sentence about others.
fn label(arg: &Arg) -> String {
    arg.get_long().map_or_else(|| arg.get_value_names().unwrap_or_default().join(" "), |long| format!("--{long}"))
}

/// Sentences on groups of arguments that require one of their members.
fn groups(command: &Command) -> Vec<String> {
    let required = command.get_groups().filter(|group| group.is_required_set());
    let sentences = required.map(|group| {
        let members = group.get_args().filter_map(|id| command.get_arguments().find(|arg| arg.get_id() == id));
        let labels: Vec<String> = members.map(|arg| format!("`{}`", label(arg))).collect();
        format!("One of {} is required.", labels.join(", "))
    });
    sentences.collect()
}

/// Prose as Markdown: options are set as code, pages beside this one are linked, and marks of Markdown outside of code stand for
/// themselves.
fn prose(text: &str) -> String {
    let parts = text.split('`').enumerate().map(|(index, part)| match index % 2 {
        1 => format!("`{part}`"),
        _ => part.split(' ').map(word).collect::<Vec<_>>().join(" "),
    });
    parts.collect()
}

fn word(word: &str) -> String {
    let start = word.len() - word.trim_start_matches('(').len();
    let end = word.trim_end_matches(['.', ',', ';', ':', ')']).len();
    let inner = word.get(start..end).unwrap_or_default();
    let set = match inner.strip_prefix("docs/").filter(|path| path.ends_with(".md")) {
        Some(path) => Some(format!("[{inner}]({path})")),
        None => inner.starts_with("--").then(|| format!("`{inner}`")),
    };
    if let Some(set) = set {
        return format!("{}{set}{}", &word[..start], &word[end..]);
    }
    word.replace('\\', "\\\\").replace('*', "\\*").replace('<', "\\<")
}

#[cfg(test)]
mod tests {
    use clap::ArgGroup;

    use super::*;

    #[test]
    fn prose_is_no_markup() {
        assert_eq!(prose("there (docs/a.md)."), "there ([docs/a.md](a.md)).");
        assert_eq!(prose("see `a*b` (--tone), 2 * 3 < 7"), "see `a*b` (`--tone`), 2 \\* 3 \\< 7");
    }

    #[test]
    fn a_page_says_what_the_definition_says() {
        let short = Arg::new("tone").long("tone").short('t').value_name("NAME").value_parser(["red", "blue"]);
        let verb = Command::new("paint")
            .about("Paint a wall")
            .arg(Arg::new("wall").value_name("WALL").required(true).help("The wall"))
            .arg(short.default_value("red").help("Colour of the paint"))
            .arg(Arg::new("bare").long("bare").action(ArgAction::SetTrue).conflicts_with("tone").help("No paint"))
            .arg(Arg::new("dot").long("dot").action(ArgAction::Append).value_name("X").help("A dot"))
            .group(ArgGroup::new("aim").required(true).args(["bare", "dot"]))
            .after_help("Examples:\n  house paint north");
        let page = page(Command::new("house").about("A house").subcommand(verb), &[("paint", "brush")]);
        let expected = "\
## house paint

Paint a wall. Builds with the cargo feature `brush` have this verb.

    house paint [OPTIONS] <--bare|--dot <X>> <WALL>

Arguments:

- `<WALL>`: The wall.

Options:

- `-t, --tone <NAME>`: Colour of the paint. Values: `red`, `blue`. Default: `red`. Not together with `--bare`.
- `--bare`: No paint. Not together with `--tone`.
- `--dot <X>...`: A dot.

One of `--bare`, `--dot` is required.

Examples:

    house paint north
";
        assert_eq!(page.split_once("## house paint\n").unwrap().1, expected.split_once("## house paint\n").unwrap().1);
        assert!(page.contains("- [`house paint`](#house-paint): Paint a wall.\n"), "{page}");
    }
}
