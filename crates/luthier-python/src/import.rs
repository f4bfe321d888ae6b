//! Imports of other formats.

use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

use luthier_export::{GENERATOR, input, label};
use luthier_import::{Source, import, report, together};
use pyo3::prelude::*;

use crate::fault::{file, value};

/// The files that an import writes by relative path, and the report on it as JSON.
#[pyfunction]
pub(crate) fn import_files(
    py: Python<'_>,
    paths: Vec<PathBuf>,
    root: Option<PathBuf>,
) -> PyResult<(BTreeMap<String, Vec<u8>>, String)> {
    py.detach(|| {
        let mut read = Vec::new();
        for path in &paths {
            let of_path = |error: &dyn std::fmt::Display| format!("{}: {error}", path.display());
            let bytes = input::mesh(path).map_err(|error| file(of_path(&error)))?;
            let folder = path.parent().unwrap_or(Path::new("")).to_owned();
            let label = label(path);
            let name = path.file_name().map_or_else(|| label.clone(), |name| name.to_string_lossy().into_owned());
            let root = root.as_deref().unwrap_or(&folder);
            let import = import(&name, &bytes, &|beside| input::beside(root, &folder, beside));
            read.push(Source { label, import: import.map_err(|error| value(of_path(&error)))? });
        }
        let files = together(&mut read);
        Ok((files, report(&read, GENERATOR).to_string()))
    })
}
