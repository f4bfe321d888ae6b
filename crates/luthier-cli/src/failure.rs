use std::fmt;
use std::io;
use std::process::ExitCode;

use luthier_material::did_you_mean;

use crate::output::complain;

/// Why a command ends with another code than 0. The codes are documented in `luthier --help`.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Exit code 1: the command did its work, and the verdict is no. What there is to say has been said.
    Verdict,
    /// Exit code 1: an input is not usable.
    Input(anyhow::Error),
    /// Exit code 2: the command line asks for what there is not.
    Usage(anyhow::Error),
    /// Exit code 3: a file cannot be read or written.
    Files(anyhow::Error),
    /// Exit code 4: no usable graphics adapter, or it failed.
    #[cfg(feature = "gpu")]
    Device(anyhow::Error),
    /// Exit code 0: whoever reads our output has had enough.
    BrokenPipe,
}

/// What verbs return.
pub(crate) type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    pub(crate) fn input(error: impl Into<anyhow::Error>) -> Self {
        Self::Input(error.into())
    }

    /// A name on the command line that is none of those known.
    pub(crate) fn unknown(what: &str, name: &str, known: &[&str]) -> Self {
        let hint =
            did_you_mean(name, known.iter().copied()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        Self::Usage(anyhow::anyhow!("no {what} `{name}`; {hint}known: {}", known.join(", ")))
    }

    /// What it is, for people.
    #[cfg(feature = "view")]
    pub(crate) fn sentence(&self) -> String {
        match self {
            Self::Input(error) | Self::Usage(error) | Self::Files(error) | Self::Device(error) => sentence(error),
            Self::Verdict | Self::BrokenPipe => self.to_string(),
        }
    }

    pub(crate) fn exit(&self) -> ExitCode {
        let (code, error) = match self {
            Self::BrokenPipe => (0, None),
            Self::Verdict => (1, None),
            Self::Input(error) => (1, Some(error)),
            Self::Usage(error) => (2, Some(error)),
            Self::Files(error) => (3, Some(error)),
            #[cfg(feature = "gpu")]
            Self::Device(error) => (4, Some(error)),
        };
        if let Some(error) = error {
            complain(&format!("error: {}", sentence(error)));
        }
        ExitCode::from(code)
    }
}

/// An error and its causes. Many errors quote their cause already; what was said is not said again.
fn sentence(error: &anyhow::Error) -> String {
    let mut text = String::new();
    for cause in error.chain().map(ToString::to_string) {
        if text.is_empty() {
            text = cause;
        } else if !text.ends_with(&cause) {
            text = format!("{text}: {cause}");
        }
    }
    text
}

/// An input/output error and the path that it is about.
pub(crate) fn files(path: &std::path::Path, what: &str) -> impl FnOnce(io::Error) -> Failure {
    let message = format!("cannot {what} {}", path.display());
    move |source| Failure::Files(anyhow::Error::new(source).context(message))
}

impl From<io::Error> for Failure {
    /// Errors of standard output.
    fn from(source: io::Error) -> Self {
        if source.kind() == io::ErrorKind::BrokenPipe {
            Self::BrokenPipe
        } else {
            Self::Files(anyhow::Error::new(source).context("cannot write to standard output"))
        }
    }
}

impl fmt::Display for Failure {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        write!(f, "{self:?}")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn causes_are_named_once() {
        let cause = || io::Error::other("disc on fire");
        let quoting = anyhow::Error::new(cause()).context("cannot read a.toml: disc on fire");
        assert_eq!(sentence(&quoting), "cannot read a.toml: disc on fire");
        let silent = anyhow::Error::new(cause()).context("cannot read a.toml").context("cannot judge");
        assert_eq!(sentence(&silent), "cannot judge: cannot read a.toml: disc on fire");
    }
}
