//! The store that machines share, below the store of the process.

use std::env::{self, VarError};

use luthier::Store;
use luthier_terminal::{Failure, Outcome};

#[cfg(feature = "remote")]
pub(crate) use self::remote::{below, close};

/// Variable with the address of the store; empty for none.
const VARIABLE: &str = "LUTHIER_STORE";

/// The address that an option or the variable states. A build without such stores refuses every address.
pub(crate) fn address(text: &str) -> Result<String, String> {
    if cfg!(feature = "remote") {
        Ok(text.to_owned())
    } else {
        Err("this build has no shared stores: build it with `--features remote`".to_owned())
    }
}

/// The address that is asked for.
fn asked(url: Option<&str>) -> Outcome<Option<String>> {
    let found = match url {
        Some(url) => Ok(Some(url.to_owned())),
        None => match env::var(VARIABLE) {
            Ok(url) if !url.is_empty() => address(&url).map(Some),
            Ok(_) | Err(VarError::NotPresent) => Ok(None),
            Err(error) => Err(error.to_string()),
        },
    };
    found.map_err(|reason| Failure::Usage(anyhow::anyhow!("variable {VARIABLE}: {reason}")))
}

/// The store of the process, because this build has no other.
#[cfg(not(feature = "remote"))]
pub(crate) fn below(near: &'static dyn Store, url: Option<&str>) -> Outcome<&'static dyn Store> {
    asked(url).map(|_| near)
}

/// Nothing: this build has no shared stores.
#[cfg(not(feature = "remote"))]
pub(crate) fn close() {}

#[cfg(feature = "remote")]
mod remote {
    use std::sync::{Arc, OnceLock};

    use luthier_bake::{Artefact, Task};
    use luthier_store::{Layers, RemoteStore};
    use luthier_terminal::complain;

    use super::*;

    /// The two stores, made at their first use.
    static BOTH: OnceLock<Both> = OnceLock::new();

    /// The store of the process, and the shared one.
    struct Both {
        near: &'static dyn Store,
        far: RemoteStore,
    }

    impl Store for Both {
        fn get(&self, task: &Task<'_>) -> Option<Arc<Artefact>> {
            Layers(&[self.near, &self.far]).get(task)
        }

        fn get_all(&self, tasks: &[Task<'_>]) -> Vec<Option<Arc<Artefact>>> {
            Layers(&[self.near, &self.far]).get_all(tasks)
        }

        fn put(&self, task: &Task<'_>, artefact: &Arc<Artefact>) {
            Layers(&[self.near, &self.far]).put(task, artefact);
        }

        fn touch(&self, task: &Task<'_>) {
            Layers(&[self.near, &self.far]).touch(task);
        }
    }

    /// The store of the process, with the shared store below it where that is asked for.
    pub(crate) fn below(near: &'static dyn Store, url: Option<&str>) -> Outcome<&'static dyn Store> {
        if let Some(both) = BOTH.get() {
            return Ok(both);
        }
        let Some(url) = asked(url)? else { return Ok(near) };
        let far = RemoteStore::open(&url).map_err(|error| Failure::Usage(error.into()))?;
        Ok(BOTH.get_or_init(|| Both { near, far }))
    }

    /// Waits for uploads, and prints a warning for those that failed.
    pub(crate) fn close() {
        let Some(Both { far, .. }) = BOTH.get() else { return };
        far.close();
        if let Some(problem) = far.problem() {
            complain(&format!("warning: {problem}"));
        }
    }
}
