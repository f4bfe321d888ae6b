//! The judge against bakes and devices whose errors are known.

mod exceptions;
mod fixture;
mod judgement;
mod limits;
mod page;
mod parity;
mod places;
mod schema;
mod stability;
mod tables;
