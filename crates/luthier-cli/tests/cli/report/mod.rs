//! Judgement of bakes and of foreign tables.

mod audit;
mod judgement;
mod outdated;
pub(crate) mod page;
pub(crate) mod scene;
