//! Threads behind the window, each with the latest order only.

pub(crate) mod baker;
pub(crate) mod crop;
pub(crate) mod gathering;
pub(crate) mod latest;
pub(crate) mod painter;
pub(crate) mod stages;
pub(crate) mod view;
pub(crate) mod watcher;

#[cfg(test)]
mod tests;
