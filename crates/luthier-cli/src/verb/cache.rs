//! `cache`: the store of results.

use luthier_store::{DiskStore, KindUsage};
use luthier_terminal::{Failure, Outcome, bytes, print};
use serde_json::{Value, json};

use crate::cli::CacheVerb;
use crate::store::{disk, limit};

pub(crate) fn run(verb: &CacheVerb) -> Outcome {
    let Some(store) = disk()? else {
        return Err(Failure::Usage(anyhow::anyhow!("there is no store: name its folder with --cache")));
    };
    match verb {
        CacheVerb::Stats { json } => stats(store, *json),
        CacheVerb::Verify => verify(store),
        CacheVerb::Clear => {
            let KindUsage { entries, bytes: size } = store.clear().map_err(file)?.all();
            print(&format!("removed {entries} results, {}", bytes(size)))
        }
    }
}

fn stats(store: &DiskStore, is_json: bool) -> Outcome {
    let usage = store.usage().map_err(file)?;
    let (all, folder) = (usage.all(), store.root().display());
    if is_json {
        let kinds = usage
            .kinds
            .iter()
            .map(|(kind, usage)| (kind.clone(), json!({ "entries": usage.entries, "bytes": usage.bytes })));
        let kinds: Value = kinds.collect();
        let (entries, bytes) = (all.entries, all.bytes);
        let folder = folder.to_string();
        let stats = json!({ "folder": folder, "entries": entries, "bytes": bytes, "limit": limit(), "kinds": kinds });
        return print(&format!("{stats:#}"));
    }
    let mut text = format!("{folder}\n");
    for (kind, KindUsage { entries, bytes: size }) in &usage.kinds {
        text.push_str(&format!("{kind:<13} {entries:>8} {:>12}\n", bytes(*size)));
    }
    text.push_str(&format!("{:<13} {:>8} {:>12} of {}\n", "all", all.entries, bytes(all.bytes), bytes(limit())));
    print(&text)
}

fn verify(store: &DiskStore) -> Outcome {
    let verified = store.verify().map_err(file)?;
    let lines = verified.damaged.iter().map(|path| format!("removed a damaged result: {}", path.display()));
    let last = format!("{} results are whole, {} were damaged", verified.whole, verified.damaged.len());
    print(&lines.chain([last]).collect::<Vec<_>>().join("\n"))?;
    if verified.damaged.is_empty() { Ok(()) } else { Err(Failure::Verdict) }
}

fn file(error: luthier_store::StoreError) -> Failure {
    Failure::Files(error.into())
}
