//! A lint for mistakes in HLSL and MSL that tests on Linux would miss: glslang reads HLSL, but is laxer than Microsoft's compilers, and no compiler
//! there reads MSL.
//!
//! The lint reads the tokens of a text that naga wrote and this crate arranged. It finds
//!
//! - vectors as conditions of `?:`, `if`, `while`, `&&` and `||`: HLSL 2021 refuses them, and C++ lacks them;
//! - reserved words as names;
//! - types and functions that the stated version of the language lacks;
//! - loops without a counter that is stepped by a constant and compared at an end of the loop.
//!
//! It follows the shapes of values through declarations. A condition of unknown shape is a finding, too, so that silence means that everything
//! was read. It is no compiler: it does not check arguments, assignments or the order of declarations.

mod shape;
mod tokens;
mod vocabulary;

use std::ops::Range;

use self::shape::{Names, Shape};
use self::tokens::{Token, tokens};
use self::vocabulary::Vocabulary;
use crate::{ShaderError, Target};

/// Words that may stand before a type, or before something that is no declaration.
const BEFORE_TYPES: [&str; 18] = [
    "return",
    "else",
    "case",
    "struct",
    "using",
    "typedef",
    "linear",
    "nointerpolation",
    "centroid",
    "noperspective",
    "precise",
    "row_major",
    "column_major",
    "fragment",
    "vertex",
    "kernel",
    "flat",
    "do",
];
/// Words before brackets that are no functions.
const CONTROL: [&str; 8] = ["if", "while", "for", "switch", "return", "register", "case", "packoffset"];

/// A mistake that a compiler would refuse.
#[derive(Debug, PartialEq, Eq)]
struct Finding {
    line: usize,
    what: String,
}

/// Refuses a text with a finding.
pub(super) fn check(text: &str, target: Target) -> Result<(), ShaderError> {
    let Some(Finding { line, what }) = findings(text, target).into_iter().next() else { return Ok(()) };
    let code = text.lines().nth(line - 1).unwrap_or_default().trim();
    Err(ShaderError::untranslatable(target, format!("{what}, in `{code}`")))
}

/// All findings in a text, from the top.
fn findings(text: &str, target: Target) -> Vec<Finding> {
    let tokens = tokens(text);
    let mut lint =
        Lint { tokens: &tokens, names: Names::default(), vocabulary: Vocabulary::of(target), found: Vec::new() };
    lint.structs();
    lint.functions();
    lint.bodies();
    lint.found.sort_by_key(|finding| finding.line);
    lint.found
}

/// A declared name: its token, and the shape of its value.
struct Declaration {
    name: usize,
    shape: Shape,
}

struct Lint<'a> {
    tokens: &'a [Token<'a>],
    names: Names,
    vocabulary: Vocabulary,
    found: Vec<Finding>,
}

impl<'a> Lint<'a> {
    fn text(&self, at: usize) -> &'a str {
        self.tokens.get(at).map_or("", |token| token.text)
    }

    fn find(&mut self, at: usize, what: String) {
        self.found.push(Finding { line: self.tokens[at].line, what });
    }

    /// The declaration that begins here, if one does.
    fn declaration(&self, at: usize) -> Option<Declaration> {
        if at > 0 && self.text(at - 1) == "." {
            return None;
        }
        let is_auto = self.text(at) == "auto" && self.text(at + 2) == "=";
        let mut shape = match self.names.of_type(self.text(at), self.vocabulary) {
            None if is_auto => shape::of(&self.tokens[at + 3..self.end(at + 3)], &self.names, self.vocabulary),
            known => known?,
        };
        let mut name = at + 1;
        if self.text(name) == "<" {
            name += 1 + self.tokens[name..].iter().position(|token| token.is(">"))?;
        }
        name += usize::from(["&", "*"].contains(&self.text(name)));
        let is_name = self.tokens.get(name).is_some_and(Token::is_word);
        if !is_name || !["=", ";", ",", ")", "[", ":", "("].contains(&self.text(name + 1)) {
            return None;
        }
        if self.text(name + 1) == "[" {
            shape = Shape::Array(Box::new(shape));
        }
        Some(Declaration { name, shape })
    }

    /// A declared name. It is a finding if it is a reserved word.
    fn declare(&mut self, name: usize) -> String {
        let word = self.text(name);
        if self.vocabulary.keeps(word) {
            self.find(name, format!("`{word}` is a word of {}", self.vocabulary.name()));
        }
        word.to_owned()
    }

    /// The index behind the bracket that closes the one here.
    fn behind(&self, open: usize) -> usize {
        let mut depth = 0;
        for (i, token) in self.tokens.iter().enumerate().skip(open) {
            match token.text {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" => depth -= 1,
                _ => {}
            }
            if depth == 0 {
                return i + 1;
            }
        }
        self.tokens.len()
    }

    /// Reads structures with their members, and other names of types.
    fn structs(&mut self) {
        for i in 0..self.tokens.len() {
            if self.text(i) == "typedef" {
                if let Some(Declaration { name, shape }) = self.declaration(i + 1) {
                    let name = self.declare(name);
                    self.names.aliases.insert(name, shape);
                }
            } else if self.text(i) == "struct" && self.text(i + 2) == "{" {
                let name = self.declare(i + 1);
                let end = self.behind(i + 2);
                let mut at = i + 3;
                while at + 1 < end {
                    at += usize::from(BEFORE_TYPES.contains(&self.text(at)));
                    if let Some(Declaration { name: member, shape }) = self.declaration(at) {
                        let member = self.declare(member);
                        self.names.structs.entry(name.clone()).or_default().insert(member, shape);
                    } else {
                        self.words(at);
                    }
                    // To the next member.
                    at += 1 + self.tokens[at..end].iter().position(|token| token.is(";")).unwrap_or(end - at);
                }
                self.names.structs.entry(name).or_default();
            }
        }
    }

    /// Reads the types that functions return.
    fn functions(&mut self) {
        let mut depth = 0;
        for i in 0..self.tokens.len() {
            depth += usize::from(self.text(i) == "{");
            depth -= usize::from(self.text(i) == "}" && depth > 0);
            if depth == 0
                && let Some(Declaration { name, shape }) = self.declaration(i)
                && self.text(name + 1) == "("
            {
                let name = self.declare(name);
                self.names.functions.insert(name, shape);
            }
        }
    }

    /// Reads variables, conditions, loops and words.
    fn bodies(&mut self) {
        let (mut depth, mut of_file) = (0, 0);
        let mut i = 0;
        while i < self.tokens.len() {
            match self.text(i) {
                // Structures and other names of types have been read.
                "struct" if self.text(i + 2) == "{" => {
                    i = self.behind(i + 2);
                    continue;
                }
                "typedef" => {
                    i += self.tokens[i..].iter().position(|token| token.is(";")).unwrap_or(1);
                    continue;
                }
                "{" => depth += 1,
                "}" => {
                    depth -= usize::from(depth > 0);
                    if depth == 0 {
                        self.names.variables.truncate(of_file);
                    }
                }
                "?" => self.condition(self.beginning(i, &[]), i),
                "&&" | "||" => {
                    self.condition(self.beginning(i, &["&&", "||"]), i);
                    self.condition(i + 1, self.end(i + 1));
                }
                "if" | "while" if self.text(i + 1) == "(" => self.condition(i + 2, self.behind(i + 1) - 1),
                _ => {}
            }
            if ["while", "for"].contains(&self.text(i)) && self.text(i + 2) != "false" {
                self.repeats(i);
            }
            if let Some(Declaration { name, shape }) = self.declaration(i) {
                if self.text(name + 1) != "(" {
                    // A local variable may have the name of one of the file.
                    let name = self.declare(name);
                    self.names.variables.push((name, shape));
                    // Parameters stand before the first brace of a function, and end with it.
                    if depth == 0 && !self.is_parameter(i) {
                        of_file = self.names.variables.len();
                    }
                }
            } else {
                self.words(i);
            }
            i += 1;
        }
    }

    /// Whether a token lies in round brackets.
    fn is_parameter(&self, at: usize) -> bool {
        let mut depth = 0;
        for token in self.tokens[..at].iter().rev() {
            match token.text {
                ")" => depth += 1,
                "(" if depth == 0 => return true,
                "(" => depth -= 1,
                ";" | "}" | "{" if depth == 0 => return false,
                _ => {}
            }
        }
        false
    }

    /// Finds a type or a function that the language lacks.
    fn words(&mut self, at: usize) {
        let (word, next) = (self.tokens[at], self.text(at + 1));
        if !word.is_word() || CONTROL.contains(&word.text) {
            return;
        }
        let before = at.checked_sub(1).map_or("", |before| self.text(before));
        let version = self.vocabulary.name();
        if next == "(" && before == "." {
            if self.vocabulary.method(word.text).is_none() {
                self.find(at, format!("`.{}` is no function of {version}", word.text));
            }
            return;
        }
        if next == "(" {
            let is_own = self.names.functions.contains_key(word.text);
            let is_type = self.names.of_type(word.text, self.vocabulary).is_some();
            if !is_own && !is_type && !self.vocabulary.has_function(word.text) {
                self.find(at, format!("`{}` is no function of {version}", word.text));
            }
            return;
        }
        // `float a`, or in MSL `= record {`.
        let is_declared = self.tokens.get(at + 1).is_some_and(Token::is_word) && !BEFORE_TYPES.contains(&word.text);
        let is_made = next == "{" && ["=", "return", "(", ","].contains(&before);
        let is_known = self.names.of_type(word.text, self.vocabulary).is_some();
        if !is_known && (is_made || is_declared && before != ".") {
            self.find(at, format!("`{}` is no type of {version}", word.text));
        }
    }

    /// First token of the operand before a sign. It stands behind an open bracket, or behind a sign that binds less.
    fn beginning(&self, sign: usize, stops: &[&str]) -> usize {
        let mut depth = 0;
        for i in (0..sign).rev() {
            match self.text(i) {
                ")" | "]" | "}" => depth += 1,
                "(" | "[" | "{" if depth == 0 => return i + 1,
                "(" | "[" | "{" => depth -= 1,
                "," | ";" | ":" | "?" | "return" | "=" | "+=" | "-=" | "*=" | "/=" if depth == 0 => return i + 1,
                text if depth == 0 && stops.contains(&text) => return i + 1,
                _ => {}
            }
        }
        0
    }

    /// The token behind the operand that begins here.
    fn end(&self, start: usize) -> usize {
        let mut depth = 0;
        for i in start..self.tokens.len() {
            match self.text(i) {
                "(" | "[" | "{" => depth += 1,
                ")" | "]" | "}" if depth == 0 => return i,
                ")" | "]" | "}" => depth -= 1,
                "," | ";" | ":" | "?" | "&&" | "||" if depth == 0 => return i,
                _ => {}
            }
        }
        self.tokens.len()
    }

    /// Finds a condition, from one token to another, that is not one number.
    fn condition(&mut self, start: usize, end: usize) {
        let what = match shape::of(&self.tokens[start..end], &self.names, self.vocabulary) {
            Shape::Scalar => return,
            Shape::Vector(size) => format!("a condition of {size} numbers: choose component by component"),
            _ => "a condition whose type is not known".to_owned(),
        };
        self.find(start, what);
    }

    /// Finds a loop without a counter that is stepped by a constant and compared in its head or before a `break`.
    fn repeats(&mut self, at: usize) {
        let head_end = self.behind(at + 1);
        let end = if self.text(head_end) == "{" { self.behind(head_end) } else { head_end };
        let loops = at..end;
        let has_bound = self.compares(at + 2..head_end - 1, &loops)
            || (head_end..end).any(|i| {
                if self.text(i) != "if" {
                    return false;
                }
                let behind = self.behind(i + 1);
                let then = self.behind(behind);
                let last = if self.text(then) == "else" { self.behind(then + 1) } else { then };
                (behind..last).any(|j| self.text(j) == "break") && self.compares(i + 2..behind - 1, &loops)
            });
        if !has_bound {
            self.find(at, "a loop without a bound".to_owned());
        }
    }

    /// Whether a condition compares a name that the loop around it steps.
    fn compares(&self, mut condition: Range<usize>, loops: &Range<usize>) -> bool {
        condition.clone().any(|i| ["<", "<=", ">", ">=", "!="].contains(&self.text(i)))
            && condition.any(|i| self.tokens[i].is_word() && self.steps(loops.clone(), self.text(i)))
    }

    /// Whether a loop adds a number to a name, or subtracts it.
    fn steps(&self, mut loops: Range<usize>, name: &str) -> bool {
        let end = loops.end;
        loops.any(|i| match self.text(i + 1) {
            _ if self.text(i) != name => false,
            "++" | "--" => true,
            "+=" | "-=" => self.is_number(i + 2),
            "=" => {
                let statement_end = (i..end).find(|&j| self.text(j) == ";").unwrap_or(end);
                (i..statement_end).any(|j| ["+", "-"].contains(&self.text(j)) && self.is_number(j + 1))
            }
            _ => false,
        })
    }

    /// Whether a number begins here, in casts or not: `1u`, `asuint(int(1))`, `as_type<uint>(1)`.
    fn is_number(&self, at: usize) -> bool {
        let mut inside = self.tokens[at..].iter().skip_while(|t| t.is_word() || ["(", "<", ">"].contains(&t.text));
        inside.next().is_some_and(Token::is_number)
    }
}

#[cfg(test)]
mod tests;
