//! Benchmarks of Monte Carlo estimates of one value, at the registered number of samples.

use divan::Bencher;
use luthier_optics::stack::Stack;

use crate::inputs::{draws, each};
use crate::{model, names, stacks};

#[divan::bench(args = names(true), sample_size = 1, sample_count = 64)]
fn bare_conductor(bencher: Bencher<'_, '_>, name: &str) {
    value(bencher, name, &stacks::bare_conductor());
}

#[divan::bench(args = names(true), sample_size = 1, sample_count = 64)]
fn coated_conductor(bencher: Bencher<'_, '_>, name: &str) {
    value(bencher, name, &stacks::coated_conductor());
}

#[divan::bench(args = names(true), sample_size = 1, sample_count = 64)]
fn film_slab_diffuse(bencher: Bencher<'_, '_>, name: &str) {
    value(bencher, name, &stacks::film_slab_diffuse());
}

fn value(bencher: Bencher<'_, '_>, name: &str, stack: &Stack) {
    let (model, stack) = (model(name), stacks::green(stack));
    let estimator = model.estimator().expect("an estimate");
    each(bencher, &draws(), |draw| estimator.eval_with_error(&stack, draw.wi, draw.wo));
}
