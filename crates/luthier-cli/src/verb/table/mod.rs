//! `table`: tables that engines read beside a material.

mod container;
mod dfg;
mod product;

use luthier_terminal::Outcome;

use crate::cli::{Function, TableOptions};

/// Bakes a table, writes it and says what it is.
pub(crate) fn run(options: &TableOptions) -> Outcome {
    match &options.function {
        Function::Dfg(options) => product::deliver(dfg::product(options)?, &options.delivery),
    }
}
