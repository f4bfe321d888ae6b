//! Build pipelines: the store of results, stamps, locks, shares, dependencies, watching.

#[cfg(unix)]
mod depfile;
mod events;
mod lock;
mod readers;
mod shares;
mod store;
mod up_to_date;
mod watch;
