//! Options of `completions` and `man`, which tell shells and people what this definition says.

use std::path::PathBuf;

use clap::Args;
use clap_complete::Shell;

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  \
                  luthier completions bash > ~/.local/share/bash-completion/completions/luthier\n  \
                  luthier completions zsh > ~/.zfunc/_luthier\n  \
                  luthier completions fish > ~/.config/fish/completions/luthier.fish\n  \
                  luthier completions powershell >> $PROFILE\n  \
                  luthier completions elvish >> ~/.config/elvish/rc.elv")]
pub(crate) struct CompletionsOptions {
    /// The shell
    #[arg(value_name = "SHELL", value_enum)]
    pub(crate) shell: Shell,
}

#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  luthier man | man -l -\n  luthier man --out ~/.local/share/man/man1\n  \
                  luthier man --markdown > docs/reference.md")]
pub(crate) struct ManOptions {
    /// Folder to write all pages to: luthier.1, and one for each verb, such as luthier-bake.1
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Print the reference of all verbs and options instead, as a page in Markdown
    #[arg(long, conflicts_with = "out")]
    pub(crate) markdown: bool,
}
