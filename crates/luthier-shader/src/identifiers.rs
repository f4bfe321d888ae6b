//! Identifiers of a text: cut out, renamed.

/// The text with some of its words replaced. Words after a dot are members, and stay.
pub(crate) fn rename<N: AsRef<str>>(text: &str, name: impl Fn(&str) -> Option<N>) -> String {
    let mut out = String::with_capacity(text.len());
    for word in words(text) {
        let is_member = out.ends_with('.');
        match name(word).filter(|_| !is_member) {
            Some(name) => out.push_str(name.as_ref()),
            None => out.push_str(word),
        }
    }
    out
}

/// `LuthierMaterials` for `luthier_materials`: the name of a block of a binding.
pub(crate) fn camel_case(name: &str) -> String {
    let capital = |word: &str| {
        word.chars().enumerate().map(|(i, c)| if i == 0 { c.to_ascii_uppercase() } else { c }).collect::<String>()
    };
    name.split('_').map(capital).collect()
}

/// Whether a character may stand in a word.
pub(crate) fn is_of_word(c: char) -> bool {
    c.is_ascii_alphanumeric() || c == '_'
}

/// The words of a text (identifiers and numbers) and the pieces between them. Joined, they are the text again.
pub(crate) fn words(text: &str) -> impl Iterator<Item = &str> {
    let mut rest = text;
    std::iter::from_fn(move || {
        let first = rest.chars().next()?;
        let end = rest.find(|c| is_of_word(c) != is_of_word(first)).unwrap_or(rest.len());
        let (word, tail) = rest.split_at(end);
        rest = tail;
        Some(word)
    })
}
