//! The rooms of a crate, which are the modules at its root, have an order: none uses itself by way of others.

use std::collections::{BTreeMap, BTreeSet};

use super::sources::sources;

/// For each room the rooms that it uses.
type Rooms = BTreeMap<String, BTreeSet<String>>;

/// Code without tests and comments.
fn code(text: &str) -> String {
    let code = text.split("#[cfg(test)]\nmod ").next().unwrap();
    code.lines().filter(|line| !line.trim_start().starts_with("//")).map(|line| format!("{line}\n")).collect()
}

/// Whether a file, by its path below `src`, has tests alone.
fn is_test(path: &str) -> bool {
    let (folder, name) = path.rsplit_once('/').unwrap_or(("", path));
    let stem = name.trim_end_matches(".rs");
    let is_named = ["tests", "fixtures"].contains(&stem) || stem.ends_with("_tests") || stem.starts_with("tests_");
    is_named || folder.split('/').any(|part| part == "tests")
}

/// The room of a file, by its path below `src`.
fn room(path: &str) -> &str {
    path.split('/').next().unwrap().trim_end_matches(".rs")
}

fn is_of_word(c: char) -> bool {
    c.is_alphanumeric() || c == '_'
}

/// The word that a text begins with.
fn word(text: &str) -> &str {
    text.split(|c| !is_of_word(c)).next().unwrap()
}

/// The first names of a tree of imports: one of `a::b`, two of `{a::{b, c}, d}`.
fn first_names(tree: &str) -> Vec<&str> {
    let Some(branches) = tree.strip_prefix('{') else { return vec![word(tree)] };
    let (mut names, mut depth, mut is_next) = (Vec::new(), 0, true);
    for (at, c) in branches.char_indices() {
        match c {
            '}' if depth == 0 => break,
            '}' => depth -= 1,
            '{' => depth += 1,
            ',' if depth == 0 => is_next = true,
            c if is_next && is_of_word(c) => {
                names.push(word(&branches[at..]));
                is_next = false;
            }
            _ => {}
        }
    }
    names
}

/// The first names of all paths that begin with `crate::`.
fn names_in_crate(code: &str) -> impl Iterator<Item = &str> {
    let begins = |at: &usize| !code[..*at].ends_with(is_of_word);
    let paths = code.match_indices("crate::").map(|(at, _)| at).filter(begins);
    paths.flat_map(|at| first_names(&code[at + "crate::".len()..]))
}

/// Names that the root of a crate takes from its modules, each with its room.
fn aliases(root: &str) -> BTreeMap<&str, &str> {
    let mut found = BTreeMap::new();
    for (_, path) in root.split(';').filter_map(|statement| statement.rsplit_once("use ")) {
        let path = path.trim_start_matches("self::").trim_start_matches("crate::");
        let names = path.split_once('{').or_else(|| path.rsplit_once("::")).map_or("", |(_, names)| names);
        found.extend(names.split(|c| !is_of_word(c)).map(|name| (name, word(path))));
    }
    found
}

/// The rooms of a crate, from its files by their paths below `src`. A name of the root counts as the room that it is taken from.
fn rooms(files: &[(String, String)]) -> Rooms {
    let files: Vec<(&str, String)> =
        files.iter().filter(|(path, _)| !is_test(path)).map(|(path, text)| (path.as_str(), code(text))).collect();
    let is_root = |path: &str| ["lib", "main"].contains(&room(path));
    let mut rooms: Rooms = files
        .iter()
        .filter(|(path, _)| !is_root(path))
        .map(|(path, _)| (room(path).to_owned(), BTreeSet::new()))
        .collect();
    let root =
        files.iter().find(|(path, _)| *path == "lib.rs").or_else(|| files.iter().find(|(path, _)| *path == "main.rs"));
    let aliases = root.map_or_else(BTreeMap::new, |(_, code)| aliases(code));
    for (path, code) in files.iter().filter(|(path, _)| !is_root(path)) {
        for name in names_in_crate(code) {
            let used = if rooms.contains_key(name) { name } else { aliases.get(name).copied().unwrap_or_default() };
            if used != room(path) && rooms.contains_key(used) {
                rooms.get_mut(room(path)).unwrap().insert(used.to_owned());
            }
        }
    }
    rooms
}

/// The rooms that have no order, and those between these.
fn tied(mut rooms: Rooms) -> Rooms {
    loop {
        let used: BTreeSet<String> = rooms.values().flatten().cloned().collect();
        let count = rooms.len();
        rooms.retain(|room, uses| used.contains(room) && !uses.is_empty());
        let left: BTreeSet<String> = rooms.keys().cloned().collect();
        rooms.values_mut().for_each(|uses| uses.retain(|room| left.contains(room)));
        if rooms.len() == count {
            return rooms;
        }
    }
}

#[test]
fn rooms_have_an_order() {
    let mut crates: BTreeMap<String, Vec<(String, String)>> = BTreeMap::new();
    for (name, text) in sources().into_iter().filter(|(name, _)| name.ends_with(".rs")) {
        let (owner, path) = name.trim_start_matches("crates/").split_once("/src/").unwrap();
        crates.entry(owner.to_owned()).or_default().push((path.to_owned(), text));
    }
    let mut found: BTreeMap<String, Rooms> =
        crates.iter().map(|(owner, files)| (owner.clone(), tied(rooms(files)))).collect();
    found.retain(|_, tied| !tied.is_empty());
    assert!(found.is_empty(), "rooms that use each other: {found:#?}");
}

#[test]
fn uses_are_read_from_paths() {
    let files = [
        ("lib.rs", "mod a;\nmod b;\nmod c;\nmod d;\npub use a::{First, Second};\n#[cfg(unix)]\npub use self::b::inner::Third;\n"),
        ("a.rs", "// crate::d\nuse crate::{Third, c::{d, e}};\n#[cfg(test)]\nmod tests { use crate::d; }\n"),
        ("b/inner.rs", "fn f() -> crate::c::C {}\n"),
        ("b/tests/one.rs", "use crate::a;\n"),
        ("c.rs", "use crate::Second;\nuse my_crate::d;\n"),
        ("d.rs", "use crate::a;\n"),
    ]
    .map(|(path, text)| (path.to_owned(), text.to_owned()));
    let uses = |rooms: &Rooms, room: &str| rooms[room].iter().cloned().collect::<Vec<_>>().join(" ");
    let rooms = rooms(&files);
    assert_eq!(["a", "b", "c", "d"].map(|room| uses(&rooms, room)), ["b c", "c", "a", "a"]);
    assert_eq!(tied(rooms).into_keys().collect::<Vec<_>>(), ["a", "b", "c"]);
}
