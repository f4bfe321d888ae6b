//! The store of results, which all verbs share.

use std::path::PathBuf;
use std::sync::OnceLock;

use clap::Args;
use luthier::{MemoryStore, Store};
use luthier_store::DiskStore;
use luthier_terminal::{Failure, Outcome, complain};

use crate::shared_store;

/// Variable with the folder of the store; empty for none.
const VARIABLE: &str = "LUTHIER_CACHE";

/// Where results of earlier runs are.
#[derive(Debug, Clone, Default, Args)]
#[command(next_help_heading = "Store of results")]
pub(crate) struct StoreOptions {
    /// Folder of the results of earlier runs. By default that of the variable LUTHIER_CACHE (empty: no store), or `luthier` in the system's folder for caches
    #[arg(long, value_name = "DIR", global = true)]
    pub(crate) cache: Option<PathBuf>,
    /// Compute everything anew, and keep nothing
    #[arg(long, global = true, conflicts_with = "cache")]
    pub(crate) no_cache: bool,
    /// Size of the store in MiB: beyond it, results go that were not used for longest
    #[arg(long, value_name = "MIB", global = true, default_value_t = luthier_store::DEFAULT_LIMIT >> 20, value_parser = clap::value_parser!(u64).range(1..))]
    pub(crate) cache_size: u64,
    /// Store that machines share, below the folder: s3://BUCKET/PREFIX, gs://, az:// or https://. By default that of the variable LUTHIER_STORE. Needs the Cargo feature `remote`
    #[arg(long, value_name = "URL", global = true, conflicts_with = "no_cache", value_parser = shared_store::address)]
    pub(crate) store: Option<String>,
}

/// The options of this process.
static OPTIONS: OnceLock<StoreOptions> = OnceLock::new();

/// The store of this process, made at its first use.
static STORE: OnceLock<Opened> = OnceLock::new();

enum Opened {
    Disk(DiskStore),
    Memory(MemoryStore),
}

/// Takes the options of the command line, before anything asks for the store.
pub(crate) fn configure(options: &StoreOptions) {
    let _ = OPTIONS.set(options.clone());
}

/// The store of this process: on disk, or in memory if there is none on disk, with the store that machines share below it.
///
/// # Errors
/// [`Failure::Usage`] where the address of the shared store is none, or this build has no such stores. [`Failure::Files`] where the folder that was
/// asked for cannot be used. A default folder that cannot be used causes a warning only.
pub(crate) fn store() -> Outcome<&'static dyn Store> {
    let near = near()?;
    match OPTIONS.get() {
        Some(options) if !options.no_cache => shared_store::below(near, options.store.as_deref()),
        _ => Ok(near),
    }
}

/// [`store`] without the one that machines share: for results that are made as fast as they are fetched.
pub(crate) fn near() -> Outcome<&'static dyn Store> {
    Ok(match opened()? {
        Opened::Disk(store) => store,
        Opened::Memory(store) => store,
    })
}

/// The store on disk, if there is one.
pub(crate) fn disk() -> Outcome<Option<&'static DiskStore>> {
    Ok(match opened()? {
        Opened::Disk(store) => Some(store),
        Opened::Memory(_) => None,
    })
}

/// Bytes that the store may have.
pub(crate) fn limit() -> u64 {
    OPTIONS.get().map_or(luthier_store::DEFAULT_LIMIT, |options| options.cache_size << 20)
}

fn opened() -> Outcome<&'static Opened> {
    if let Some(opened) = STORE.get() {
        return Ok(opened);
    }
    let opened = match OPTIONS.get() {
        Some(options) => open(options)?,
        None => Opened::Memory(MemoryStore::default()),
    };
    Ok(STORE.get_or_init(|| opened))
}

fn open(options: &StoreOptions) -> Outcome<Opened> {
    let Some((folder, is_asked)) = folder(options) else { return Ok(Opened::Memory(MemoryStore::default())) };
    match DiskStore::open(&folder, options.cache_size << 20) {
        Ok(store) => Ok(Opened::Disk(store)),
        Err(error) if is_asked => Err(Failure::Files(error.into())),
        Err(error) => {
            complain(&format!(
                "warning: no results are kept: {error}\nhint: name a folder with --cache, or write --no-cache"
            ));
            Ok(Opened::Memory(MemoryStore::default()))
        }
    }
}

/// The folder of the store, and whether the user named it.
pub(crate) fn folder(options: &StoreOptions) -> Option<(PathBuf, bool)> {
    if options.no_cache {
        return None;
    }
    if let Some(folder) = &options.cache {
        return Some((folder.clone(), true));
    }
    if let Some(folder) = std::env::var_os(VARIABLE) {
        return Some((PathBuf::from(folder), true)).filter(|(folder, _)| !folder.as_os_str().is_empty());
    }
    let caches = etcetera::base_strategy::choose_base_strategy().ok()?;
    Some((etcetera::BaseStrategy::cache_dir(&caches).join("luthier"), false))
}

/// Closes the stores, and prints a warning if results could not be kept. Call it when all work is done.
pub(crate) fn close() {
    shared_store::close();
    let Some(Opened::Disk(store)) = STORE.get() else { return };
    let closed = store.close().err();
    if let Some(problem) = store.problem().or(closed) {
        complain(&format!("warning: {problem}"));
    }
}
