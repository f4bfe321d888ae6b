//! `foreign`: tries files that others wrote with the reader of their kind.

mod kinds;
mod page;
mod record;

use std::panic::{AssertUnwindSafe, catch_unwind, set_hook, take_hook};
use std::path::{Path, PathBuf};
use std::time::Instant;

use luthier_export::label;
use luthier_terminal::{Bar, Failure, Outcome, deliver, files};

use self::kinds::Read;
use self::record::{Collection, Data, Tried};
use crate::cli::{ForeignKind, ForeignOptions};

/// Tries the files of a collection, adds the outcome to the records of all collections, and writes their page.
pub(crate) fn run(options: &ForeignOptions) -> Outcome {
    let mut data = options.data.as_deref().map_or(Ok(Data::default()), Data::read)?;
    if let Some(name) = &options.collection {
        let collection = data.collection(name);
        describe(collection, options)?;
        let kinds = if options.kind.is_empty() { ForeignKind::ALL.to_vec() } else { options.kind.clone() };
        for kind in kinds {
            collection.put(kind.name(), &tried(kind, &options.folders)?);
        }
        if let Some(path) = &options.data {
            data.write(path)?;
        }
    }
    deliver(&page::of(&data), options.page.as_deref())
}

/// Address and licence of a collection, from the options or from an earlier run.
fn describe(collection: &mut Collection, options: &ForeignOptions) -> Outcome {
    for (known, said) in [(&mut collection.from, &options.from), (&mut collection.licence, &options.licence)] {
        if let Some(said) = said {
            known.clone_from(said);
        }
    }
    if collection.from.is_empty() || collection.licence.is_empty() {
        let text =
            format!("the collection `{}` is new: say where it is with --from, and its --licence", collection.name);
        return Err(Failure::Usage(anyhow::anyhow!(text)));
    }
    Ok(())
}

/// Outcomes of every file of a kind below the folders, in the order of the folders and of names.
fn tried(kind: ForeignKind, folders: &[PathBuf]) -> Outcome<Vec<Tried>> {
    let mut all = Vec::new();
    for folder in folders {
        let mut found = Vec::new();
        below(folder, kind, &mut found)?;
        found.sort();
        all.extend(found.into_iter().map(|path| (label(path.strip_prefix(folder).unwrap_or(&path)), path, folder)));
    }
    let bar = Bar::new(kind.name());
    let hook = take_hook();
    set_hook(Box::new(|_| {}));
    let tried = all.iter().zip(1..).map(|((name, path, folder), number)| {
        let started = Instant::now();
        let read = caught(|| kind.read(path, folder));
        bar.set(number, all.len() as u64);
        Tried { name: name.clone(), seconds: started.elapsed().as_secs_f64(), read }
    });
    let tried = tried.collect();
    set_hook(hook);
    Ok(tried)
}

/// Outcome of a reader; a panic is one, too.
fn caught(read: impl FnOnce() -> Result<Vec<String>, String>) -> Read {
    match catch_unwind(AssertUnwindSafe(read)) {
        Ok(Ok(notes)) => Read::Whole(notes),
        Ok(Err(reason)) => Read::Refused(reason),
        Err(payload) => {
            let text = payload.downcast_ref::<String>().map(String::as_str).or(payload.downcast_ref::<&str>().copied());
            Read::Panicked(text.unwrap_or("no words").to_owned())
        }
    }
}

/// The files of a kind below a folder. Links are not followed.
fn below(folder: &Path, kind: ForeignKind, found: &mut Vec<PathBuf>) -> Outcome {
    for entry in std::fs::read_dir(folder).map_err(files(folder, "list"))? {
        let entry = entry.map_err(files(folder, "list"))?;
        let (path, is) = (entry.path(), entry.file_type().map_err(files(&entry.path(), "read"))?);
        if is.is_dir() {
            below(&path, kind, found)?;
        } else if is.is_file() && kind.has(&path) {
            found.push(path);
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_panic_is_an_outcome() {
        assert_eq!(caught(|| Ok(vec!["a".to_owned()])), Read::Whole(vec!["a".to_owned()]));
        assert_eq!(caught(|| Err("no".to_owned())), Read::Refused("no".to_owned()));
        assert_eq!(caught(|| panic!("index {}", 3)), Read::Panicked("index 3".to_owned()));
    }
}
