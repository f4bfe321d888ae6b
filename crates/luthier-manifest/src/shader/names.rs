//! Names and numbers of a package in the program that it is linked into.

use serde::{Deserialize, Serialize};

use super::Interface;

/// First word of the names of a package, and its place among the bindings of a program: two packages with different ones link into one program.
///
/// ```
/// use luthier_manifest::{Interface, Names};
///
/// let names = Names { prefix: "car".to_owned(), first_binding: 16, ..Names::default() };
/// let text = "var<storage> luthier_materials: array<f32>; // of luthier: LuthierPlace, LUTHIER_MATERIAL_GOLD, my_luthier_x";
/// let named = names.named(text);
/// assert_eq!(named, "var<storage> car_materials: array<f32>; // of luthier: CarPlace, CAR_MATERIAL_GOLD, my_luthier_x");
/// assert_eq!(names.own(&named), text);
/// assert!(names.check().is_ok() && !names.is_default());
/// // Another name of the text would be taken for one of the package.
/// assert_eq!(names.clash("let car_wheel = 1;"), Some("car_wheel"));
///
/// let wgsl = "@group(2) @binding(3) var car_sampler: sampler;";
/// let apart = Names { group: 2, ..names.clone() };
/// assert_eq!(apart.own_wgsl(wgsl), "@group(0) @binding(3) var luthier_sampler: sampler;");
/// let mut interface = Interface::read(wgsl);
/// apart.in_interface(Names::own, &mut interface);
/// assert!(interface.binds("luthier_sampler"));
/// ```
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Names {
    /// First word of names in shaders, in lower case: `luthier` of `luthier_eval`, `LuthierPlace` and `LUTHIER_MATERIAL_GOLD`.
    pub prefix: String,
    /// Bind group of all resources.
    pub group: u32,
    /// Number of the first of luthier's sixteen bindings in it.
    pub first_binding: u32,
}

impl Default for Names {
    fn default() -> Self {
        Self { prefix: OWN.to_owned(), group: 0, first_binding: 0 }
    }
}

/// The prefix by default.
const OWN: &str = "luthier";

/// Longest prefix.
const LONGEST: usize = 32;

/// The largest number of a group: devices have fewer.
const LAST_GROUP: u32 = 31;

/// The largest number of a first binding: sixteen numbers from there are those of bytes.
const LAST_FIRST_BINDING: u32 = 240;

impl Names {
    /// Whether they are those by default.
    pub fn is_default(&self) -> bool {
        *self == Self::default()
    }

    /// Refuses a prefix that gives no names in all languages, and numbers that no device has.
    ///
    /// # Errors
    /// The prefix or the number that is refused, and why.
    pub fn check(&self) -> Result<(), String> {
        let Self { prefix, group, first_binding } = self;
        let is_word = |word: &str| {
            word.starts_with(|c: char| c.is_ascii_lowercase())
                && word.chars().all(|c| c.is_ascii_lowercase() || c.is_ascii_digit())
        };
        if prefix.len() > LONGEST || !prefix.split('_').all(is_word) {
            return Err(format!(
                "the prefix {prefix:?} is none: it has lower case letters, digits and single underscores, at most {LONGEST}, and every word of it begins with a letter"
            ));
        }
        if TAKEN.contains(&prefix.as_str()) {
            return Err(format!("the prefix {prefix:?} begins words of shading languages: take another"));
        }
        if *group > LAST_GROUP {
            return Err(format!("no device has a bind group of number {group}: the last here is {LAST_GROUP}"));
        }
        if *first_binding > LAST_FIRST_BINDING {
            return Err(format!(
                "bindings cannot begin at {first_binding}: the last number here is {LAST_FIRST_BINDING}"
            ));
        }
        Ok(())
    }

    /// The text with these names in place of luthier's own.
    pub fn named(&self, text: &str) -> String {
        renamed(text, OWN, &self.prefix)
    }

    /// The text with luthier's own names in place of these.
    pub fn own(&self, text: &str) -> String {
        renamed(text, &self.prefix, OWN)
    }

    /// A word of a text with luthier's own names that would be mistaken for one with the prefix.
    pub fn clash<'t>(&self, text: &'t str) -> Option<&'t str> {
        let words = text.split(|c: char| !(c.is_ascii_alphanumeric() || c == '_')).filter(|_| self.prefix != OWN);
        words.into_iter().find(|word| self.own(word) != *word)
    }

    /// WGSL with luthier's own names and group; bindings keep their numbers.
    pub fn own_wgsl(&self, wgsl: &str) -> String {
        let group = format!("@group({}) @binding(", self.group);
        self.own(wgsl).replace(&group, "@group(0) @binding(")
    }

    /// An interface with names changed by [`Self::named`] or [`Self::own`].
    pub fn in_interface(&self, change: impl Fn(&Self, &str) -> String, interface: &mut Interface) {
        for function in &mut interface.functions {
            let types = function.parameters.iter_mut().chain([&mut function.value]);
            types.chain([&mut function.name]).for_each(|name| *name = change(self, name));
        }
        let structures = interface.structures.iter_mut().map(|structure| &mut structure.name);
        structures.chain(&mut interface.bindings).for_each(|name| *name = change(self, name));
    }
}

/// Beginnings of words that shading languages or emitted texts have.
const TAKEN: [&str; 12] = ["gl", "vk", "sk", "sv", "texture", "sampler", "spv", "naga", "metal", "webgl", "main", "dx"];

/// The beginning of naga's name for the function that makes a value of a type.
const CONSTRUCT: &str = "Construct";

/// The text with every name that begins with one prefix beginning with another.
fn renamed(text: &str, from: &str, to: &str) -> String {
    if from == to {
        return text.to_owned();
    }
    let pairs = [lower, camel, upper].map(|of| (of(from), of(to)));
    let mut out = String::with_capacity(text.len());
    let is_of_word = |c: char| c.is_ascii_alphanumeric() || c == '_';
    let mut rest = text;
    while let Some(start) = rest.find(is_of_word) {
        let (before, word) = rest.split_at(start);
        out.push_str(before);
        let (word, after) = word.split_at(word.find(|c| !is_of_word(c)).unwrap_or(word.len()));
        // Constructors of types in HLSL are functions.
        let (head, name) = word.strip_prefix(CONSTRUCT).map_or(("", word), |name| (CONSTRUCT, name));
        let found = pairs.iter().enumerate().find_map(|(i, (from, to))| {
            let rest = name.strip_prefix(from.as_str())?;
            // Names of types go on with a capital: the name of the program is none.
            let is_name = if i == 1 { rest.starts_with(|c: char| c.is_ascii_uppercase()) } else { !rest.is_empty() };
            is_name.then_some((to, rest))
        });
        match found {
            Some((to, rest)) => out.extend([head, to.as_str(), rest]),
            None => out.push_str(word),
        }
        rest = after;
    }
    out + rest
}

/// The beginning of names of functions and resources.
fn lower(prefix: &str) -> String {
    format!("{prefix}_")
}

/// The beginning of names of types.
fn camel(prefix: &str) -> String {
    let words = prefix.split('_').map(|word| {
        let (first, rest) = word.split_at(1.min(word.len()));
        first.to_ascii_uppercase() + rest
    });
    words.collect()
}

/// The beginning of names of constants.
fn upper(prefix: &str) -> String {
    format!("{}_", prefix.to_ascii_uppercase())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn of(prefix: &str) -> Names {
        Names { prefix: prefix.to_owned(), ..Names::default() }
    }

    #[test]
    fn prefixes_are_words() {
        for prefix in ["luthier", "car", "car_2nd", "a1"] {
            let good = !prefix.contains("2nd");
            assert_eq!(of(prefix).check().is_ok(), good, "{prefix}");
        }
        for prefix in ["", "_", "Car", "car-paint", "car__b", "car_", "2car", "gl", &"x".repeat(33)] {
            assert!(of(prefix).check().is_err(), "{prefix}");
        }
        assert!(Names { group: 32, ..Names::default() }.check().is_err());
        assert!(Names { first_binding: 241, ..Names::default() }.check().is_err());
    }

    #[test]
    fn every_kind_of_name_begins_with_the_prefix() {
        let names = of("my_car");
        let text = "luthier_a LuthierB LUTHIER_C ConstructLuthierB( luthier Luthier luthiers xluthier_a _luthier";
        let expected = "my_car_a MyCarB MY_CAR_C ConstructMyCarB( luthier Luthier luthiers xluthier_a _luthier";
        assert_eq!(names.named(text), expected);
        assert_eq!(names.own(&names.named(text)), text);
        assert_eq!(of("luthier").named(text), text);
    }
}
