//! Judgement of bakes and of foreign tables.

mod audit;
mod judgement;
mod outdated;
mod page;
