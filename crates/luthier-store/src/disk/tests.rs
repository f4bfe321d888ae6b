//! Entries that are kept, damaged, used at once, and too many.

use std::time::Duration;

use tempfile::TempDir;

use super::*;
use crate::DEFAULT_LIMIT;

fn store() -> (TempDir, DiskStore) {
    let folder = tempfile::tempdir().unwrap();
    let store = DiskStore::open(folder.path(), DEFAULT_LIMIT).unwrap();
    (folder, store)
}

fn address(number: u32) -> Key {
    Key::of(&number.to_le_bytes())
}

#[test]
fn what_was_kept_is_found_by_another_process() {
    let (folder, store) = store();
    assert_eq!(store.bytes("row", address(0)), None);
    store.put_bytes("row", address(0), b"abc");
    store.put_bytes("row", address(1), b"");
    store.close().unwrap();
    let again = DiskStore::open(folder.path(), DEFAULT_LIMIT).unwrap();
    assert_eq!(again.bytes("row", address(0)).unwrap(), b"abc");
    assert_eq!(again.bytes("row", address(1)).unwrap(), b"");
    assert_eq!(again.bytes("fit", address(0)), None);
    let usage = again.usage().unwrap();
    assert_eq!((usage.kinds["row"].entries, usage.kinds.len()), (2, 1));
    assert!(again.problem().is_none() && store.problem().is_none());
    assert_eq!(again.clear().unwrap(), usage);
    assert_eq!(again.bytes("row", address(0)), None);
    // Who empties a store does not hinder those that use it.
    store.put_bytes("row", address(0), b"abc");
    assert_eq!(store.bytes("row", address(0)), None);
    assert!(store.problem().is_some());
}

/// Oracle: the bytes that were kept.
#[test]
fn damaged_entries_are_removed() {
    let (_folder, store) = store();
    store.put_bytes("row", address(0), b"abc");
    store.put_bytes("row", address(1), b"abc");
    let path = store.path("row", address(0));
    let whole = fs::read(&path).unwrap();
    for damaged in [&whole[..whole.len() - 1], b"", &[&whole[..], b"d"].concat()] {
        fs::write(&path, damaged).unwrap();
        assert_eq!(store.bytes("row", address(0)), None);
        assert!(!path.exists());
        let problem = store.problem().unwrap().to_string();
        assert!(problem.contains("damaged") && problem.contains(path.to_str().unwrap()), "{problem}");
    }
    // An entry in the place of another one is no result of it.
    fs::write(&path, fs::read(store.path("row", address(1))).unwrap()).unwrap();
    assert_eq!(store.bytes("row", address(0)), None);
    fs::write(&path, "damaged").unwrap();
    let verified = store.verify().unwrap();
    assert_eq!((verified.whole, verified.damaged), (1, vec![path.clone()]));
    assert!(!path.exists() && store.verify().unwrap().damaged.is_empty());
}

#[test]
fn a_full_store_forgets_first_what_was_not_used_for_longest() {
    let folder = tempfile::tempdir().unwrap();
    let result = [7; 1000 - 72];
    let store = DiskStore::open(folder.path(), 10_000).unwrap();
    let day = Duration::from_secs(86_400);
    for number in 0..10 {
        store.put_bytes("row", address(number), &result);
        let file = File::options().append(true).open(store.path("row", address(number))).unwrap();
        file.set_modified(SystemTime::now() - day * (20 - number)).unwrap();
    }
    store.close().unwrap();
    assert_eq!(store.usage().unwrap().all().entries, 10);
    // The oldest is used once more; the one after it is the oldest then.
    assert!(store.bytes("row", address(0)).is_some());
    store.put_bytes("row", address(10), &result);
    store.close().unwrap();
    let left: Vec<u32> = (0..11).filter(|&number| store.bytes("row", address(number)).is_some()).collect();
    assert_eq!(left, [0, 3, 4, 5, 6, 7, 8, 9, 10]);
    // The count of another process is taken over.
    let other = DiskStore::open(folder.path(), 10_000).unwrap();
    other.put_bytes("row", address(11), &result);
    other.close().unwrap();
    assert_eq!(other.usage().unwrap().all().entries, 10);
}

#[test]
fn writers_side_by_side_leave_whole_entries() {
    let (folder, _) = store();
    std::thread::scope(|scope| {
        for _ in 0..4 {
            scope.spawn(|| {
                let store = DiskStore::open(folder.path(), DEFAULT_LIMIT).unwrap();
                for number in 0..50 {
                    store.put_bytes("row", address(number % 10), &[number as u8 % 10; 4096]);
                    let bytes = store.bytes("row", address(number % 10)).unwrap();
                    assert_eq!(bytes, [number as u8 % 10; 4096]);
                }
                store.close().unwrap();
                assert!(store.problem().is_none());
            });
        }
    });
    let store = DiskStore::open(folder.path(), DEFAULT_LIMIT).unwrap();
    assert_eq!(store.verify().unwrap().whole, 10);
    assert_eq!(fs::read_dir(folder.path().join(TEMPORARY)).unwrap().count(), 0);
}

#[test]
fn files_of_killed_writers_are_swept() {
    let (folder, store) = store();
    let left = folder.path().join(TEMPORARY).join("1-0");
    for (age, stays) in [(0, true), (7200, false)] {
        fs::write(&left, "half").unwrap();
        let file = File::options().append(true).open(&left).unwrap();
        file.set_modified(SystemTime::now() - Duration::from_secs(age)).unwrap();
        drop(DiskStore::open(store.root(), DEFAULT_LIMIT).unwrap());
        assert_eq!(left.exists(), stays, "{age}");
    }
}

#[test]
fn a_folder_that_is_a_file_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("file");
    fs::write(&path, "").unwrap();
    let error = DiskStore::open(&path, DEFAULT_LIMIT).unwrap_err().to_string();
    assert!(error.starts_with("cannot make the folder"), "{error}");
}
