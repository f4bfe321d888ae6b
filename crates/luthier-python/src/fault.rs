//! Errors of Python.

use luthier::{Diagnostic, Error};
use luthier_material::did_you_mean;
use pyo3::create_exception;
use pyo3::exceptions::{PyOSError, PyValueError};
use pyo3::prelude::*;

create_exception!(
    luthier,
    MaterialError,
    PyValueError,
    "A material that cannot be used, with the text that `luthier check` prints."
);

/// A value that a function does not take.
pub(crate) fn value(error: impl ToString) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// A file that cannot be read or written.
pub(crate) fn file(error: impl ToString) -> PyErr {
    PyOSError::new_err(error.to_string())
}

/// A name that is none of those known.
pub(crate) fn unknown(what: &str, name: &str, known: &[impl AsRef<str>]) -> PyErr {
    let known: Vec<&str> = known.iter().map(AsRef::as_ref).collect();
    let near = did_you_mean(name, known.iter().copied());
    let near = near.map_or(String::new(), |near| format!("did you mean `{near}`? "));
    value(format!("no {what} `{name}`; {near}known: {}", known.join(", ")))
}

/// A refusal of a material: the diagnostics as the command prints them, and as the attribute `diagnostics`.
pub(crate) fn refused(py: Python<'_>, diagnostics: &[Diagnostic], text: &str) -> PyErr {
    let rendered: Vec<String> = diagnostics.iter().map(|diagnostic| diagnostic.render(text)).collect();
    with_diagnostics(py, rendered.join("\n\n"), diagnostics)
}

fn with_diagnostics(py: Python<'_>, text: String, diagnostics: &[Diagnostic]) -> PyErr {
    let error = MaterialError::new_err(text);
    let listed: PyResult<Vec<Py<PyAny>>> = diagnostics.iter().map(|one| listed(py, one)).collect();
    match listed.and_then(|listed| error.value(py).setattr("diagnostics", listed)) {
        Ok(()) => error,
        Err(other) => other,
    }
}

/// A diagnostic as a dict.
pub(crate) fn listed(py: Python<'_>, of: &Diagnostic) -> PyResult<Py<PyAny>> {
    let dict = pyo3::types::PyDict::new(py);
    dict.set_item("file", &of.label)?;
    dict.set_item("severity", of.severity.name())?;
    dict.set_item("line", of.line)?;
    dict.set_item("column", of.column)?;
    dict.set_item("message", &of.message)?;
    dict.set_item("hint", &of.hint)?;
    Ok(dict.into_any().unbind())
}

/// An error of the front door.
pub(crate) fn of(py: Python<'_>, error: &Error) -> PyErr {
    match error {
        Error::File { .. } | Error::NoFiles { .. } => file(error),
        Error::Package(luthier::PackageError::Write { .. } | luthier::PackageError::Read { .. }) => file(error),
        _ => with_diagnostics(py, error.to_string(), error.diagnostics()),
    }
}
