//! Manual pages in roff: one of the command, and one of each verb.

use clap::Command;
use clap_mangen::Man;
use clap_mangen::roff::{Roff, roman};

use super::text::{Block, blocks, sentence};

/// A page and its file.
pub(super) struct Page {
    /// Name of the file, such as `luthier-bake.1`.
    pub(super) name: String,
    /// The page.
    pub(super) roff: Vec<u8>,
}

/// The pages of a command and of all its verbs; that of the command comes first.
pub(super) fn pages(command: Command) -> Vec<Page> {
    let source = format!("{} {}", command.get_name(), command.get_version().unwrap_or_default());
    let mut command = command.disable_help_subcommand(true);
    command.build();
    let mut pages = Vec::new();
    collect(&command, None, &source, &mut pages);
    pages
}

fn collect(command: &Command, above: Option<&str>, source: &str, pages: &mut Vec<Page>) {
    let name = command.get_display_name().unwrap_or(command.get_name());
    pages.push(Page { name: format!("{name}.1"), roff: page(command, above, source) });
    for verb in command.get_subcommands().filter(|verb| !verb.is_hide_set()) {
        collect(verb, Some(name), source, pages);
    }
}

/// The page of a command. Prose behind the options belongs to the description, up to the first title.
fn page(command: &Command, above: Option<&str>, source: &str) -> Vec<u8> {
    let name = command.get_display_name().unwrap_or(command.get_name());
    let after = command.get_after_long_help().or(command.get_after_help()).map(ToString::to_string).unwrap_or_default();
    let mut parts = blocks(&after);
    let sections = parts.split_off(parts.iter().position(|b| matches!(b, Block::Title(_))).unwrap_or(parts.len()));
    let about = command.get_long_about().or(command.get_about()).map(ToString::to_string).unwrap_or_default();
    let mut description = Roff::new();
    description.control("SH", ["DESCRIPTION"]).text([roman(sentence(&about))]);
    set(&parts, &mut description);
    let mut rest = Roff::new();
    set(&sections, &mut rest);
    if let Some(above) = above {
        rest.control("SH", ["SEE ALSO"]).text([roman(format!("{above}(1)"))]);
    }

    let man = Man::new(command.clone());
    // The title is written here, because clap_mangen puts the fields in the wrong places if there is no date, and a date would differ from day to
    // day.
    let mut page = format!(".TH {name} 1 \"\" \"{source}\" \"luthier manual\"\n").into_bytes();
    let mut write = || -> std::io::Result<()> {
        man.render_name_section(&mut page)?;
        man.render_synopsis_section(&mut page)?;
        description.to_writer(&mut page)?;
        man.render_options_section(&mut page)?;
        if command.has_subcommands() {
            man.render_subcommands_section(&mut page)?;
        }
        rest.to_writer(&mut page)
    };
    write().expect("memory takes all that is written");
    page
}

/// Adds the parts of a text to a page.
fn set(blocks: &[Block<'_>], page: &mut Roff) {
    let mut is_behind_title = false;
    for block in blocks {
        if !is_behind_title && !matches!(block, Block::Title(_)) {
            page.control("PP", []);
        }
        is_behind_title = matches!(block, Block::Title(_));
        match block {
            Block::Title(title) => {
                page.control("SH", [title.to_uppercase().as_str()]);
            }
            Block::Paragraph(prose) => {
                page.text([roman(prose)]);
            }
            Block::Lines(lines) => {
                page.control("RS", ["4"]).control("nf", []);
                for line in lines {
                    page.text([roman(*line)]);
                }
                page.control("fi", []).control("RE", []);
            }
        }
    }
}
