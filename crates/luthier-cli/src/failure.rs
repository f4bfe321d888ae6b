use std::fmt;
use std::io;
use std::process::ExitCode;

/// Why a command ends with another code than 0. The codes are documented in `luthier --help`.
#[derive(Debug)]
pub(crate) enum Failure {
    /// Exit code 1: the command did its work, and the verdict is no. What there is to say has been said.
    Verdict,
    /// Exit code 1: an input is not usable.
    Input(anyhow::Error),
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

    pub(crate) fn exit(&self) -> ExitCode {
        let (code, error) = match self {
            Self::BrokenPipe => (0, None),
            Self::Verdict => (1, None),
            Self::Input(error) => (1, Some(error)),
            Self::Files(error) => (3, Some(error)),
            #[cfg(feature = "gpu")]
            Self::Device(error) => (4, Some(error)),
        };
        if let Some(error) = error {
            eprintln!("error: {error:#}");
        }
        ExitCode::from(code)
    }
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
