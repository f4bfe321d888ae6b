//! What is wrong with files, said before work begins.

mod diagnostics;
mod hostile;
mod refusals;
