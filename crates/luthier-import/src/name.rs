//! Names that files may have.

use std::collections::BTreeSet;

/// Most characters of a name.
const LENGTH_MAX: usize = 80;

/// Names that are taken.
#[derive(Debug, Default)]
pub(crate) struct Names(BTreeSet<String>);

impl Names {
    /// A name of letters, digits and hyphens from any text, which no other has; `fallback` where nothing is left of it.
    pub(crate) fn unique(&mut self, text: &str, fallback: &str) -> String {
        let mut name = String::new();
        for letter in text.chars() {
            if letter.is_ascii_alphanumeric() {
                name.push(letter.to_ascii_lowercase());
            } else if !name.is_empty() && !name.ends_with('-') {
                name.push('-');
            }
        }
        name.truncate(LENGTH_MAX);
        let name = name.trim_end_matches('-');
        let name = if name.is_empty() { fallback } else { name };
        let numbered = (2..).map(|number| format!("{name}-{number}"));
        let found = std::iter::once(name.to_owned()).chain(numbered).find(|name| !self.0.contains(name));
        let found = found.unwrap_or_else(|| unreachable!("numbers do not end"));
        self.0.insert(found.clone());
        found
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn names_are_valid_and_unique() {
        let mut names = Names::default();
        let found = ["Red Lacquer", "red_lacquer", "Été 1", "---", "", "a/b\\c"];
        let found = found.map(|name| names.unique(name, "material-0"));
        assert_eq!(found, ["red-lacquer", "red-lacquer-2", "t-1", "material-0", "material-0-2", "a-b-c"]);
    }
}
