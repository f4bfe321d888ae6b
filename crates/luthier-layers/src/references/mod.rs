//! References that judge the models: closed forms of smooth stacks, and random walks through rough ones.

pub mod closed_form;
pub mod layered_mc;
pub mod random_walk;
