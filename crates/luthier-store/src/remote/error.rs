//! Faults of a shared store, each in one line.

use std::error::Error as StdError;

use object_store::Error;
use thiserror::Error;

/// Letters of a reason that are printed: some servers answer with whole pages.
const REASON: usize = 200;

/// The reason for a request beyond its time.
pub(super) const NO_ANSWER: &str = "it takes too long to answer";

/// Reason why a shared store, or an entry of it, is not used.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum RemoteError {
    /// The address names no store.
    #[error("no shared store can be opened at {store}: {reason}")]
    Address {
        /// The address, without what may be secret.
        store: String,
        /// The reason in words.
        reason: String,
    },
    /// A request failed.
    #[error("the shared store {store} is not used any more: {reason}")]
    OutOfUse {
        /// The address, without what may be secret.
        store: String,
        /// The reason in words.
        reason: String,
    },
    /// An entry does not match its address.
    #[error("the shared store {store} has damaged entries, which are made anew; the first is {name}")]
    Damaged {
        /// The address, without what may be secret.
        store: String,
        /// The name of the object.
        name: String,
    },
}

/// The reason of a failure in one line.
pub(super) fn reason(error: &Error) -> String {
    let deepest = deepest(error);
    match error {
        Error::PermissionDenied { .. } | Error::Unauthenticated { .. } => "access is denied".to_owned(),
        Error::NotFound { .. } => "its bucket or folder does not exist".to_owned(),
        _ if deepest.contains("timed out") => NO_ANSWER.to_owned(),
        _ => one_line(&deepest),
    }
}

/// The text of the first cause.
fn deepest(error: &Error) -> String {
    let mut cause: &dyn StdError = error;
    while let Some(source) = cause.source() {
        cause = source;
    }
    cause.to_string()
}

fn one_line(text: &str) -> String {
    let words = text.split_whitespace().collect::<Vec<_>>().join(" ");
    match words.char_indices().nth(REASON) {
        Some((end, _)) => format!("{}…", &words[..end]),
        None => words,
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn reasons_are_one_short_line() {
        let page = format!("Internal\n  Server\tError {}", "é".repeat(1000));
        let generic = |text: &str| Error::Generic { store: "S3", source: text.into() };
        let text = reason(&generic(&page));
        assert!(text.starts_with("Internal Server Error é") && text.chars().count() == REASON + 1, "{text}");
        assert_eq!(reason(&generic("operation timed out")), NO_ANSWER);
        assert_eq!(reason(&Error::PermissionDenied { path: String::new(), source: "403".into() }), "access is denied");
    }
}
