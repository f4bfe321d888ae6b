//! The extension module of the Python package `luthier`: thin functions over NumPy arrays.
//!
//! Names, defaults, docstrings and broadcasting are in `python/luthier/__init__.py`; `_luthier.pyi` describes what is here. Functions that compute release
//! the interpreter's lock, and their values do not depend on the number of threads.

mod arrays;
mod audit;
mod bake;
mod evaluate;
mod fault;
mod import;
mod interrupt;
mod material;
mod models;
mod store;
mod table;

use pyo3::prelude::*;

/// The module `luthier._luthier`.
#[pymodule]
mod _luthier {
    #[pymodule_export]
    use crate::audit::audit;
    #[pymodule_export]
    use crate::bake::{Baked, bake};
    #[pymodule_export]
    use crate::evaluate::{Function, directions, prepare};
    #[pymodule_export]
    use crate::fault::MaterialError;
    #[pymodule_export]
    use crate::import::import_files;
    #[pymodule_export]
    use crate::material::{Material, load, parse};
    #[pymodule_export]
    use crate::models::models;
    #[pymodule_export]
    use crate::store::cache;
    #[pymodule_export]
    use crate::table::{table_cloth, table_dfg, table_energy, table_film, table_fresnel, table_ltc, table_sheen};

    /// The version of luthier.
    #[pymodule_export]
    #[expect(non_upper_case_globals, reason = "the name in Python")]
    const __version__: &str = env!("CARGO_PKG_VERSION");
}
