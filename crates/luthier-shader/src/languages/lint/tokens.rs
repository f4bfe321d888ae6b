//! Words and signs of a text in HLSL or MSL, without comments, preprocessor lines, attributes and qualifiers.

use crate::identifiers::is_of_word;

/// Qualifiers: words before a type that do not change its shape.
const PLACES: [&str; 12] = [
    "static",
    "const",
    "constexpr",
    "inout",
    "in",
    "out",
    "thread",
    "threadgroup",
    "device",
    "constant",
    "groupshared",
    "inline",
];

/// Signs of more than one character, the longer ones first.
const SIGNS: [&str; 21] = [
    "<<=", ">>=", "::", "<=", ">=", "==", "!=", "&&", "||", "<<", ">>", "+=", "-=", "*=", "/=", "%=", "&=", "|=", "^=",
    "++", "--",
];

/// Kind of a token.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    Word,
    Number,
    Sign,
}

/// A word, a number or a sign, with its line, from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    pub(super) kind: Kind,
    pub(super) line: usize,
}

impl Token<'_> {
    pub(super) fn is(&self, text: &str) -> bool {
        self.text == text
    }

    pub(super) fn is_word(&self) -> bool {
        self.kind == Kind::Word
    }

    pub(super) fn is_number(&self) -> bool {
        self.kind == Kind::Number
    }
}

/// The tokens of a text.
pub(super) fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut found = Vec::new();
    for (line, content) in text.lines().enumerate() {
        let content = content.split("//").next().unwrap_or_default();
        if content.trim_start().starts_with('#') {
            continue;
        }
        let mut rest = content.trim_start();
        while let Some(first) = rest.chars().next() {
            let (kind, length) = read(rest, first);
            let (token, after) = rest.split_at(length);
            found.push(Token { text: token, kind, line: line + 1 });
            rest = after.trim_start();
        }
    }
    without_ceremony(&found)
}

/// Kind and length of the token at the beginning of a text.
fn read(rest: &str, first: char) -> (Kind, usize) {
    if first.is_ascii_digit() || (first == '.' && rest[1..].starts_with(|c: char| c.is_ascii_digit())) {
        // A sign behind the e of an exponent belongs to the number. Behind a hexadecimal number, whose e is a digit, it would be an operator.
        let mut length = rest.find(|c| !is_of_word(c) && c != '.').unwrap_or(rest.len());
        if rest[..length].ends_with(['e', 'E']) && !rest.starts_with("0x") && rest[length..].starts_with(['+', '-']) {
            length += 1 + rest[length + 1..].find(|c| !is_of_word(c)).unwrap_or(rest.len() - length - 1);
        }
        return (Kind::Number, length);
    }
    if is_of_word(first) {
        return (Kind::Word, rest.find(|c| !is_of_word(c)).unwrap_or(rest.len()));
    }
    let sign = SIGNS.iter().find(|sign| rest.starts_with(**sign));
    (Kind::Sign, sign.map_or(first.len_utf8(), |sign| sign.len()))
}

/// The tokens without attributes `[[...]]`, the namespace `metal::`, and qualifiers.
fn without_ceremony<'a>(tokens: &[Token<'a>]) -> Vec<Token<'a>> {
    let mut kept: Vec<Token<'a>> = Vec::new();
    let mut i = 0;
    while let Some(token) = tokens.get(i) {
        let next = tokens.get(i + 1).map_or("", |next| next.text);
        if token.is("[") && next == "[" {
            while i < tokens.len() && !(tokens[i].is("]") && tokens.get(i + 1).is_some_and(|next| next.is("]"))) {
                i += 1;
            }
            i += 2;
        } else if token.is("metal") && next == "::" {
            i += 2;
        } else if PLACES.contains(&token.text) {
            i += 1;
        } else {
            kept.push(*token);
            i += 1;
        }
    }
    kept
}
