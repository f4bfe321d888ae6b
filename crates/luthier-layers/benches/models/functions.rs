//! Benchmarks of `f cos_theta_i` for one pair of directions at one wavelength.

use divan::Bencher;
use luthier_optics::stack::Stack;

use crate::inputs::{SAMPLES, SOME, draws, each};
use crate::{model, names, stacks};

#[divan::bench(args = names(false), sample_size = SOME, sample_count = SAMPLES, max_time = 0.5)]
fn bare_conductor(bencher: Bencher<'_, '_>, name: &str) {
    value(bencher, name, &stacks::bare_conductor());
}

#[divan::bench(args = names(false), sample_size = SOME, sample_count = SAMPLES, max_time = 0.5)]
fn coated_conductor(bencher: Bencher<'_, '_>, name: &str) {
    value(bencher, name, &stacks::coated_conductor());
}

#[divan::bench(args = names(false), sample_size = SOME, sample_count = SAMPLES, max_time = 0.5)]
fn film_slab_diffuse(bencher: Bencher<'_, '_>, name: &str) {
    value(bencher, name, &stacks::film_slab_diffuse());
}

fn value(bencher: Bencher<'_, '_>, name: &str, stack: &Stack) {
    let (model, stack, draws) = (model(name), stacks::green(stack), draws());
    // What the model keeps from one value to the next is made here.
    model.eval(&stack, draws[0].wi, draws[0].wo);
    each(bencher, &draws, |draw| model.eval(&stack, draw.wi, draw.wo));
}
