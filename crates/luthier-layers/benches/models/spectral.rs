//! Benchmarks of `f cos_theta_i` in full spectral colour.

use divan::Bencher;
use luthier_layers::monochrome::in_color;
use luthier_optics::color::Color;

use crate::inputs::{draws, each};
use crate::{model, names, stacks};

#[divan::bench(args = names(false), sample_size = 4, sample_count = 64, max_time = 0.5)]
fn coated_conductor(bencher: Bencher<'_, '_>, name: &str) {
    let (model, stack, draws) = (model(name), stacks::coated_conductor(), draws());
    let value = |wi, wo| in_color(&stack, &Color::Spectral, |one| model.eval(one, wi, wo));
    // What the model keeps from one value to the next is made here.
    value(draws[0].wi, draws[0].wo);
    each(bencher, &draws, |draw| value(draw.wi, draw.wo));
}
