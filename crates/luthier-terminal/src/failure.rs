//! Failures of a command, and the exit codes that they have.

use std::fmt;
use std::io;

use luthier::Error;
use luthier_export::PackageError;
use luthier_material::{Diagnostic, did_you_mean};
use serde_json::{Value, json};

/// A reason for another exit code than 0. `luthier --help` documents the codes.
#[derive(Debug)]
pub enum Failure {
    /// Exit code 1: the command did its work, and the verdict is negative. The command has printed it.
    Verdict,
    /// Exit code 1: an input is not usable.
    Input(anyhow::Error),
    /// Exit code 2: the command line asks for something that does not exist.
    Usage(anyhow::Error),
    /// Exit code 3: a file cannot be read or written.
    Files(anyhow::Error),
    /// Exit code 4: no usable graphics adapter or driver, or it failed.
    Device(anyhow::Error),
    /// Exit code 0: the reader of the output has closed it.
    BrokenPipe,
}

/// Result of a verb.
pub type Outcome<T = ()> = Result<T, Failure>;

impl Failure {
    /// An input that is not usable.
    pub fn input(error: impl Into<anyhow::Error>) -> Self {
        Self::Input(error.into())
    }

    /// An adapter or driver that is not usable.
    pub fn device(error: impl Into<anyhow::Error>) -> Self {
        Self::Device(error.into())
    }

    /// A name on the command line that is none of those known.
    pub fn unknown(what: &str, name: &str, known: &[&str]) -> Self {
        let hint =
            did_you_mean(name, known.iter().copied()).map_or(String::new(), |near| format!("did you mean `{near}`? "));
        Self::Usage(anyhow::anyhow!("no {what} `{name}`; {hint}known: {}", known.join(", ")))
    }

    /// The failure in a sentence, for people.
    pub fn sentence(&self) -> String {
        match self {
            Self::Input(error) | Self::Usage(error) | Self::Files(error) | Self::Device(error) => sentence(error),
            Self::Verdict | Self::BrokenPipe => self.to_string(),
        }
    }

    /// The failure for programs; `None` where there is nothing more to say.
    pub(crate) fn as_json(&self) -> Option<Value> {
        let (code, kind, error) = match self {
            Self::BrokenPipe | Self::Verdict => return None,
            Self::Input(error) => (1, "input", error),
            Self::Usage(error) => (2, "usage", error),
            Self::Files(error) => (3, "files", error),
            Self::Device(error) => (4, "device", error),
        };
        let broken = error.downcast_ref::<Broken>().map(|broken| &broken.diagnostics);
        let refused = error.downcast_ref::<Error>().map(Error::diagnostics);
        let diagnostics = broken.map(Vec::as_slice).or(refused).unwrap_or_default();
        let diagnostics: Vec<Value> = diagnostics.iter().map(diagnostic).collect();
        Some(json!({"code": code, "kind": kind, "message": sentence(error), "diagnostics": diagnostics}))
    }
}

/// A diagnostic for programs.
pub fn diagnostic(d: &Diagnostic) -> Value {
    json!({
        "file": d.label,
        "severity": d.severity.name(),
        "line": d.line,
        "column": d.column,
        "span": [d.span.start, d.span.end],
        "message": d.message,
        "hint": d.hint,
    })
}

/// Files that cannot be used, and what is wrong with each.
#[derive(Debug)]
pub struct Broken {
    /// The sentence with the number of files that cannot be used.
    pub sentence: String,
    /// Diagnostics that were printed on standard error.
    pub diagnostics: Vec<Diagnostic>,
}

impl fmt::Display for Broken {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence)
    }
}

impl std::error::Error for Broken {}

/// An error and its causes. A cause that the error already quotes is left out.
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
pub fn files(path: &std::path::Path, what: &str) -> impl FnOnce(io::Error) -> Failure {
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

impl From<Error> for Failure {
    fn from(error: Error) -> Self {
        match error {
            Error::Package(error) => error.into(),
            Error::File { .. } => Self::Files(error.into()),
            _ => Self::Input(error.into()),
        }
    }
}

impl From<PackageError> for Failure {
    /// A missing file or one that cannot be written is a failure of files; other errors are defects of the bake.
    fn from(error: PackageError) -> Self {
        match error {
            PackageError::NoBake { .. } | PackageError::Read { .. } | PackageError::Write { .. } => {
                Self::Files(error.into())
            }
            _ => Self::Input(error.into()),
        }
    }
}

#[cfg(feature = "gpu")]
impl From<luthier_gpu::GpuError> for Failure {
    /// A defect of a bake is not the adapter's fault.
    fn from(error: luthier_gpu::GpuError) -> Self {
        use luthier_gpu::GpuError;
        match error {
            GpuError::Package(error) => error.into(),
            GpuError::NoReflectance { .. } | GpuError::NoTextureCoordinates { .. } | GpuError::Binding { .. } => {
                Self::Input(error.into())
            }
            _ => Self::Device(error.into()),
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
