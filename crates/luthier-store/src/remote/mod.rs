//! A store that machines share.

mod address;
mod error;
mod transfers;

use std::fmt;
use std::sync::Arc;
use std::thread::{self, JoinHandle};
use std::time::Duration;

use luthier_bake::{Artefact, Key, Store, Task};
use object_store::ObjectStore;
use object_store::path::Path;
use rayon::prelude::*;
use tokio::runtime::{Builder, Handle};
use tokio::sync::oneshot;

use crate::entry::{pack, unpack};
use address::Address;
pub use error::RemoteError;
use transfers::Transfers;

/// Longest duration of a request with all its retries.
const REQUEST_LIMIT: Duration = Duration::from_secs(30);

/// Most entries that are fetched before they are decoded: more would hold too many bytes in memory.
const FETCHED_AT_ONCE: usize = 256;

/// Results of jobs in a store that machines share: S3 and its compatible services, Google Cloud Storage, Azure, or HTTP
/// with WebDAV.
///
/// An object is an entry as on disk, with its address and the hash of its result. A damaged or misplaced object is
/// refused, and its job runs again. Uploads run beside the bake. A store never makes a bake fail: after the first
/// request that fails or takes too long, it is not used any more, and [`Self::problem`] returns the reason. It belongs
/// below a store on disk, in [`Layers`](crate::Layers).
pub struct RemoteStore {
    transfers: Arc<Transfers>,
    /// Runtime of all requests: one thread.
    runtime: Handle,
    thread: Option<(oneshot::Sender<()>, JoinHandle<()>)>,
}

impl RemoteStore {
    /// Opens the store at an address, without a request: `s3://BUCKET/PREFIX`, `gs://BUCKET/PREFIX`, `az://CONTAINER/PREFIX` or `https://HOST/PREFIX`. Credentials and
    /// endpoints come from the variables that other programs read, too: AWS_ACCESS_KEY_ID, AWS_ENDPOINT_URL, GOOGLE_SERVICE_ACCOUNT, AZURE_STORAGE_ACCOUNT_NAME.
    ///
    /// # Errors
    /// [`RemoteError`] if this is no such address. Unreadable credentials are not an error; the store is then not used.
    pub fn open(url: &str) -> Result<Self, RemoteError> {
        let Address { name, objects, prefix } = Address::parse(url)?;
        match objects {
            Ok(objects) => Self::start(name, objects, prefix, REQUEST_LIMIT),
            Err(reason) => {
                let store = Self::start(name, Arc::new(object_store::memory::InMemory::new()), prefix, REQUEST_LIMIT)?;
                store.transfers.give_up(reason);
                Ok(store)
            }
        }
    }

    /// The store in some objects.
    fn start(
        name: String,
        objects: Arc<dyn ObjectStore>,
        prefix: Path,
        request_limit: Duration,
    ) -> Result<Self, RemoteError> {
        let runtime = Builder::new_current_thread().enable_all().build().map_err(|error| no_thread(&name, &error))?;
        let handle = runtime.handle().clone();
        let (stop, stopped) = oneshot::channel();
        let thread = thread::Builder::new().name("luthier-store".to_owned()).spawn(move || {
            // Returns when the store is told to stop, or is dropped.
            let _ = runtime.block_on(stopped);
            runtime.shutdown_background();
        });
        let thread = thread.map_err(|error| no_thread(&name, &error))?;
        let transfers = Arc::new(Transfers::new(name, objects, prefix, request_limit));
        Ok(Self { transfers, runtime: handle, thread: Some((stop, thread)) })
    }

    /// Waits for uploads.
    pub fn close(&self) {
        self.transfers.wait();
    }

    /// The first problem, returned once: why the store is not used any more, else the first damaged entry.
    pub fn problem(&self) -> Option<RemoteError> {
        self.transfers.take_problem()
    }

    /// The results at some addresses, in their order.
    fn fetch(&self, asked: &[(&str, Key)]) -> Vec<Option<Vec<u8>>> {
        let names: Vec<Path> = asked.iter().map(|&(kind, address)| self.transfers.name(kind, address)).collect();
        let objects = Transfers::fetch_all(&self.transfers, &self.runtime, names);
        let results = asked.par_iter().zip(objects).map(|(&(kind, address), object)| {
            let object = object?;
            let result = unpack(address, &object).map(<[u8]>::to_vec);
            if result.is_none() {
                self.transfers.distrust(kind, address);
            }
            result
        });
        results.collect()
    }

    /// Sends a result.
    fn send(&self, kind: &str, address: Key, result: &[u8]) {
        Transfers::send(&self.transfers, &self.runtime, self.transfers.name(kind, address), pack(address, result));
    }
}

fn no_thread(store: &str, error: &std::io::Error) -> RemoteError {
    RemoteError::Address { store: store.to_owned(), reason: error.to_string() }
}

impl Store for RemoteStore {
    fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>> {
        self.get_all(&[*task]).pop().flatten()
    }

    fn get_all(&self, tasks: &[Task<'_>]) -> Vec<Option<Arc<Artefact>>> {
        let mut found = vec![None; tasks.len()];
        let kept: Vec<usize> = (0..tasks.len()).filter(|&i| tasks[i].is_kept()).collect();
        for part in kept.chunks(FETCHED_AT_ONCE) {
            let asked: Vec<(&str, Key)> = part.iter().map(|&i| (tasks[i].kind().name(), tasks[i].address())).collect();
            let results = part.par_iter().zip(self.fetch(&asked)).map(|(&i, result)| {
                let result = result?;
                let artefact = tasks[i].decode(&result);
                if artefact.is_none() {
                    self.transfers.distrust(tasks[i].kind().name(), tasks[i].address());
                }
                artefact.map(Arc::new)
            });
            let results: Vec<_> = results.collect();
            part.iter().zip(results).for_each(|(&i, result)| found[i] = result);
        }
        found
    }

    fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>) {
        if task.is_kept()
            && self.transfers.is_in_use()
            && let Some(bytes) = artefact.encode()
        {
            self.send(task.kind().name(), task.address(), &bytes);
        }
    }
}

impl Drop for RemoteStore {
    fn drop(&mut self) {
        self.close();
        if let Some((stop, thread)) = self.thread.take() {
            drop(stop);
            // The thread has nothing left to do. A panic of it would have been seen.
            let _ = thread.join();
        }
    }
}

impl fmt::Debug for RemoteStore {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_tuple("RemoteStore").field(&self.transfers.store()).finish()
    }
}

#[cfg(test)]
mod tests;
