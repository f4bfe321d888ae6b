//! The judge against bakes and devices whose errors are known.

mod fixture;
mod judgement;
mod page;
