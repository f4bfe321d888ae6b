//! The book: links, samples, and the tutorial as a reader follows it.

mod links;
mod models;
mod pages;
mod samples;
#[cfg(all(unix, feature = "gpu"))]
mod tutorial;
