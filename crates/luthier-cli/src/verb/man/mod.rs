//! `man`: the manual pages, and the reference of all options, from the one definition of the command line.

mod pages;
mod reference;
mod text;

use clap::CommandFactory;
use luthier_terminal::{Failure, Outcome, files, print, print_bytes};

use crate::cli::{Cli, ManOptions, OF_FEATURES, with_all_verbs};

/// Prints the manual page of the command or the reference, or writes the pages of all verbs into a folder.
pub(crate) fn run(options: &ManOptions) -> Outcome {
    if options.markdown {
        return reference();
    }
    let pages = pages::pages(Cli::command());
    let Some(folder) = &options.out else {
        return print_bytes(&pages[0].roff, true);
    };
    std::fs::create_dir_all(folder).map_err(files(folder, "create"))?;
    for page in &pages {
        let path = folder.join(&page.name);
        std::fs::write(&path, &page.roff).map_err(files(&path, "write"))?;
    }
    print(&format!("{} pages into {}", pages.len(), folder.display()))
}

/// Prints the reference of all verbs. A build that lacks some of them cannot.
fn reference() -> Outcome {
    let command = with_all_verbs();
    let mut missing: Vec<&str> = OF_FEATURES
        .iter()
        .filter(|(verb, _)| command.find_subcommand(verb).is_none())
        .map(|(_, feature)| *feature)
        .collect();
    missing.dedup();
    if missing.is_empty() {
        return print(&reference::page(command, &OF_FEATURES));
    }
    let features = missing.join(",");
    Err(Failure::Usage(anyhow::anyhow!(
        "the reference is about all verbs, and this build leaves some out: build with `--features {features}`"
    )))
}
