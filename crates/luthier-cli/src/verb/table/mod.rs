//! `table`: tables that engines read beside a material.

mod cloth;
mod container;
mod dfg;
mod energy;
mod film;
mod fresnel;
mod look_up;
mod ltc;
mod product;
mod sheen;

use luthier_terminal::Outcome;

use crate::cli::{Function, TableOptions};

/// Bakes a table, writes it and says what it is.
pub(crate) fn run(options: &TableOptions) -> Outcome {
    let (product, delivery) = match &options.function {
        Function::Dfg(options) => (dfg::product(options)?, &options.delivery),
        Function::Cloth(options) => (cloth::product(options)?, &options.delivery),
        Function::Energy(options) => (energy::product(options)?, &options.delivery),
        Function::Film(options) => (film::product(options)?, &options.delivery),
        Function::Fresnel(options) => (fresnel::product(options)?, &options.delivery),
        Function::Ltc(options) => (ltc::product(options)?, &options.delivery),
        Function::Sheen(options) => (sheen::product(options)?, &options.delivery),
    };
    product::deliver(product, delivery)
}
