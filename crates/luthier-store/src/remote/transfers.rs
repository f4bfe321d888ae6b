//! Requests to a shared store: many at once, each limited in time, none after the first failure.

use std::sync::atomic::{AtomicBool, Ordering};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError, mpsc};
use std::time::Duration;

use luthier_bake::Key;
use object_store::path::Path;
use object_store::{Error, ObjectStore, ObjectStoreExt};
use tokio::runtime::Handle;
use tokio::sync::Semaphore;
use tokio::task::JoinSet;
use tokio::time::timeout;

use super::RemoteError;
use super::error::{NO_ANSWER, reason};

/// Objects that are fetched at once.
const FETCHES: usize = 64;

/// Objects that are sent at once, beside the fetched ones.
const UPLOADS: usize = 32;

/// Most bytes that wait for their upload. A bake that is faster than the network waits.
const WAITING: usize = 64 << 20;

/// Size of the largest object that is fetched or sent.
const LARGEST: usize = 64 << 20;

/// Requests of one store.
pub(super) struct Transfers {
    /// The address in messages.
    store: String,
    objects: Arc<dyn ObjectStore>,
    prefix: Path,
    request_limit: Duration,
    fetches: Semaphore,
    uploads: Semaphore,
    is_out: AtomicBool,
    problem: Mutex<Option<RemoteError>>,
    /// Bytes of unfinished uploads.
    waiting: Mutex<usize>,
    /// Signals that these bytes have become fewer, or that the store is not used any more.
    fewer: Condvar,
}

impl Transfers {
    pub(super) fn new(store: String, objects: Arc<dyn ObjectStore>, prefix: Path, request_limit: Duration) -> Self {
        let (fetches, uploads) = (Semaphore::new(FETCHES), Semaphore::new(UPLOADS));
        let (is_out, problem) = (AtomicBool::new(false), Mutex::new(None));
        let (waiting, fewer) = (Mutex::new(0), Condvar::new());
        Self { store, objects, prefix, request_limit, fetches, uploads, is_out, problem, waiting, fewer }
    }

    /// The address in messages.
    pub(super) fn store(&self) -> &str {
        &self.store
    }

    /// The name of an object.
    pub(super) fn name(&self, kind: &str, address: Key) -> Path {
        let hex = address.to_string();
        self.prefix.clone().join(&hex[..2]).join(format!("{}-{kind}", &hex[2..]))
    }

    pub(super) fn is_in_use(&self) -> bool {
        !self.is_out.load(Ordering::SeqCst)
    }

    pub(super) fn take_problem(&self) -> Option<RemoteError> {
        lock(&self.problem).take()
    }

    /// Takes the store out of use.
    pub(super) fn give_up(&self, reason: String) {
        let mut problem = lock(&self.problem);
        if !self.is_out.swap(true, Ordering::SeqCst) {
            *problem = Some(RemoteError::OutOfUse { store: self.store.clone(), reason });
        }
        drop(problem);
        // Taken between the flag and the signal: a waiting thread has seen the flag already, or gets the signal.
        drop(lock(&self.waiting));
        self.fewer.notify_all();
    }

    /// Records that an entry does not match its address.
    pub(super) fn distrust(&self, kind: &str, address: Key) {
        lock(&self.problem).get_or_insert_with(|| RemoteError::Damaged {
            store: self.store.clone(),
            name: self.name(kind, address).to_string(),
        });
    }

    /// Waits for uploads.
    pub(super) fn wait(&self) {
        drop(self.wait_for(0));
    }

    /// Waits until at most this many bytes wait for their upload, or uploads have ended.
    fn wait_for(&self, bytes: usize) -> MutexGuard<'_, usize> {
        let waited = self.fewer.wait_while(lock(&self.waiting), |waiting| *waiting > bytes && self.is_in_use());
        waited.unwrap_or_else(PoisonError::into_inner)
    }

    /// The objects of some names, in their order; `None` for missing ones. Blocks.
    pub(super) fn fetch_all(this: &Arc<Self>, runtime: &Handle, names: Vec<Path>) -> Vec<Option<Vec<u8>>> {
        let mut found = vec![None; names.len()];
        if names.is_empty() || !this.is_in_use() {
            return found;
        }
        let (reply, replies) = mpsc::channel();
        let transfers = Arc::clone(this);
        runtime.spawn(async move {
            let mut requests = JoinSet::new();
            for (i, name) in names.into_iter().enumerate() {
                let transfers = Arc::clone(&transfers);
                requests.spawn(async move { (i, transfers.fetch(&name).await) });
            }
            while let Some(Ok(fetched)) = requests.join_next().await {
                // Requests that run end with the set.
                if reply.send(fetched).is_err() || !transfers.is_in_use() {
                    break;
                }
            }
        });
        // Ends when the task does.
        replies.into_iter().for_each(|(i, object)| found[i] = object);
        found
    }

    async fn fetch(&self, name: &Path) -> Option<Vec<u8>> {
        let request = async {
            let object = self.objects.get(name).await?;
            // Not one of our results.
            if object.meta.size > LARGEST as u64 {
                return Ok(Vec::new());
            }
            Ok(Vec::from(object.bytes().await?))
        };
        match self.request(&self.fetches, request).await? {
            Ok(bytes) => Some(bytes),
            Err(Error::NotFound { .. }) => None,
            Err(error) => {
                self.give_up(reason(&error));
                None
            }
        }
    }

    /// Sends an object. Blocks only while too many bytes wait.
    pub(super) fn send(this: &Arc<Self>, runtime: &Handle, name: Path, object: Vec<u8>) {
        if object.len() > LARGEST {
            return;
        }
        let mut waiting = this.wait_for(WAITING);
        if !this.is_in_use() {
            return;
        }
        *waiting += object.len();
        drop(waiting);
        let upload = Upload { transfers: Arc::clone(this), bytes: object.len() };
        runtime.spawn(async move { upload.run(&name, object).await });
    }

    /// The outcome of a request, after waiting for a slot. `None` if the store is not used, or is given up because the
    /// time is up.
    async fn request<T>(
        &self,
        slots: &Semaphore,
        request: impl Future<Output = Result<T, Error>>,
    ) -> Option<Result<T, Error>> {
        let _slot = slots.acquire().await.ok()?;
        if !self.is_in_use() {
            return None;
        }
        let outcome = timeout(self.request_limit, request).await;
        outcome.inspect_err(|_| self.give_up(NO_ANSWER.to_owned())).ok()
    }
}

/// An upload. Its bytes wait until it is gone.
struct Upload {
    transfers: Arc<Transfers>,
    bytes: usize,
}

impl Upload {
    async fn run(self, name: &Path, object: Vec<u8>) {
        let Self { transfers, .. } = &self;
        let payload = object_store::PutPayload::from(object);
        let request = async {
            match transfers.objects.put(name, payload.clone()).await {
                // With WebDAV, another upload may have made the folder at the same time.
                Err(Error::Generic { .. }) => transfers.objects.put(name, payload).await,
                put => put,
            }
        };
        if let Some(Err(error)) = transfers.request(&transfers.uploads, request).await {
            transfers.give_up(reason(&error));
        }
    }
}

impl Drop for Upload {
    fn drop(&mut self) {
        *lock(&self.transfers.waiting) -= self.bytes;
        self.transfers.fewer.notify_all();
    }
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}
