//! Decisions of a search, and numbers of materials, that stay.

use luthier_lut::TableKind;
use serde::{Deserialize, Serialize};

use crate::manifest::Manifest;
use crate::search::Candidate;

/// The decision of a search for one kind of table.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Decision {
    /// The kind.
    pub kind: TableKind,
    /// The candidate taken, with its bytes and the largest error of its tiles at that time.
    pub candidate: Candidate,
}

/// A lock file: the sizes, axes and formats that bakes of a folder keep until a budget breaks, and the order of its materials.
///
/// ```
/// use luthier_manifest::{Lock, Manifest};
///
/// // A bake without a search locks nothing.
/// let lock = Lock::of(&Manifest::new("example", Vec::new(), Vec::new()));
/// let text = lock.to_json().unwrap();
/// assert!(lock.decisions.is_empty() && Lock::from_json(&text).unwrap().decides_as(&lock));
/// assert!(Lock::from_json(&text.replace("\"schema\": 1", "\"schema\": 0")).is_err());
/// ```
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct Lock {
    /// Number of the form of the file: [`Lock::SCHEMA`].
    pub schema: u32,
    /// Decisions in the order of their kinds.
    pub decisions: Vec<Decision>,
    /// Names of materials in the order of their numbers: one that is added comes last, and the others keep theirs. Empty in a lock of an earlier version.
    #[serde(default)]
    pub materials: Vec<String>,
}

impl Default for Lock {
    fn default() -> Self {
        Self { schema: Self::SCHEMA, decisions: Vec::new(), materials: Vec::new() }
    }
}

impl Lock {
    /// The form of the file that this crate reads and writes.
    pub const SCHEMA: u32 = 1;

    /// The decisions of the searches of a bake, and its materials.
    pub fn of(manifest: &Manifest) -> Self {
        let decisions = manifest.searches.iter().filter_map(|search| {
            let mut candidate = search.front.get(search.chosen)?.clone();
            // A search leaves out tiles that no candidate serves; a lock takes them as they are.
            let tiles = manifest.table(search.kind).map_or(&[][..], |table| &table.tiles);
            candidate.error.max_abs = tiles.iter().map(|t| t.error.max_abs_err).fold(candidate.error.max_abs, f64::max);
            Some(Decision { kind: search.kind, candidate })
        });
        let mut decisions: Vec<Decision> = decisions.collect();
        decisions.sort_by_key(|decision| decision.kind);
        let materials = manifest.materials.iter().map(|material| material.name.clone()).collect();
        Self { schema: Self::SCHEMA, decisions, materials }
    }

    /// The lock with materials of an earlier one first, in their order, whether they are in this bake or not.
    ///
    /// ```
    /// use luthier_manifest::Lock;
    ///
    /// let of = |names: [&str; 2]| Lock { materials: names.map(str::to_owned).into(), ..Lock::default() };
    /// assert_eq!(of(["brass", "gold"]).after(&of(["gold", "tin"]).materials).materials, ["gold", "tin", "brass"]);
    /// ```
    #[must_use]
    pub fn after(mut self, names: &[String]) -> Self {
        let added = self.materials.into_iter().filter(|name| !names.contains(name));
        self.materials = names.iter().cloned().chain(added).collect();
        self
    }

    /// The lock of a text.
    ///
    /// # Errors
    /// In words: the text is not JSON, not a lock, or of another schema.
    pub fn from_json(text: &str) -> Result<Self, String> {
        let lock: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        if lock.schema == Self::SCHEMA {
            Ok(lock)
        } else {
            Err(format!("its schema is {}, and this program reads {}", lock.schema, Self::SCHEMA))
        }
    }

    /// The text of the lock file.
    ///
    /// # Errors
    /// In words: numbers that are not finite.
    pub fn to_json(&self) -> Result<String, String> {
        let text = serde_json::to_string_pretty(self).map_err(|error| error.to_string())?;
        Ok(text + "\n")
    }

    /// Whether two locks hold equal decisions and materials; errors measured at the time do not count.
    pub fn decides_as(&self, other: &Self) -> bool {
        self.serves_as(other) && self.materials == other.materials
    }

    /// Whether two locks hold equal sizes, axes and formats.
    pub fn serves_as(&self, other: &Self) -> bool {
        let [ours, theirs] = [self, other].map(|lock| lock.decisions.iter().map(|d| (d.kind, &d.candidate.form)));
        ours.eq(theirs)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Budget, CandidateForm, MeasuredError, Search};

    #[test]
    fn a_lock_reads_what_it_wrote() {
        let candidate = |bytes| Candidate {
            form: CandidateForm::ClosedForm,
            bytes,
            cost: 18.0,
            error: MeasuredError { max_abs: 0.1 + 0.2, ..MeasuredError::default() },
        };
        let search = |kind, chosen| Search {
            kind,
            budget: Budget::default(),
            chosen,
            front: vec![candidate(0), candidate(1)],
            measured: 2,
        };
        let searches = vec![search(TableKind::Distribution, 0), search(TableKind::Fresnel, 1)];
        let manifest = Manifest { searches, ..Manifest::new("luthier test", Vec::new(), Vec::new()) };
        let lock = Lock::of(&manifest);
        assert_eq!(lock.decisions.iter().map(|d| d.candidate.bytes).collect::<Vec<_>>(), [1, 0]);
        let text = lock.to_json().unwrap();
        assert_eq!(Lock::from_json(&text), Ok(lock.clone()));
        assert!(Lock::from_json(&text.replace("\"schema\": 1", "\"schema\": 9")).unwrap_err().contains("schema is 9"));
        assert!(Lock::from_json("[]").is_err());
        let mut other = lock.clone();
        other.decisions[0].candidate.error.max_abs = 1.0;
        assert!(lock.decides_as(&other));
        other.decisions.pop();
        assert!(!lock.decides_as(&other));
    }
}
