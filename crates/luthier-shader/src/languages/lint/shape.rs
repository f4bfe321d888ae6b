//! Shapes of expressions: numbers of components.

use std::collections::BTreeMap;

use super::tokens::Token;
use super::vocabulary::Vocabulary;
use crate::identifiers::is_of_word;

/// Shape of a value: its components.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Shape {
    Scalar,
    Vector(u8),
    /// Columns and rows.
    Matrix(u8, u8),
    Array(Box<Shape>),
    Struct(String),
    /// A texture, a sampler or a buffer of bytes.
    Resource(String),
    /// Not known to the lint.
    Unknown,
}

impl Shape {
    /// The shape of a type of numbers by its name: `float3`, `uint`, `float3x3`.
    pub(super) fn of_numbers(name: &str) -> Option<Self> {
        let size = ["bool", "float", "uint", "int"].iter().find_map(|base| name.strip_prefix(base))?;
        match size.split_once('x') {
            _ if size.is_empty() => Some(Self::Scalar),
            None => count(size).map(Self::Vector),
            Some((columns, rows)) => Some(Self::Matrix(count(columns)?, count(rows)?)),
        }
    }

    fn rank(&self) -> u8 {
        match self {
            Self::Scalar => 1,
            Self::Vector(size) => *size,
            Self::Matrix(..) => 16,
            _ => 0,
        }
    }

    /// The shape of an operation on two values.
    fn with(self, other: Self) -> Self {
        match (&self, &other) {
            (Self::Unknown, _) | (_, Self::Unknown) => Self::Unknown,
            // `matrix * vector` in MSL.
            (Self::Matrix(_, rows), Self::Vector(_)) => Self::Vector(*rows),
            (Self::Vector(_), Self::Matrix(columns, _)) => Self::Vector(*columns),
            _ if other.rank() > self.rank() => other,
            _ => self,
        }
    }
}

/// Shapes by name.
#[derive(Debug, Default)]
pub(super) struct Names {
    /// Members of structures.
    pub(super) structs: BTreeMap<String, BTreeMap<String, Shape>>,
    /// Other names for types.
    pub(super) aliases: BTreeMap<String, Shape>,
    /// Shapes that functions return.
    pub(super) functions: BTreeMap<String, Shape>,
    /// Variables; those of functions lie above those of the file.
    pub(super) variables: Vec<(String, Shape)>,
}

impl Names {
    /// The shape of a type by its name.
    pub(super) fn of_type(&self, name: &str, vocabulary: Vocabulary) -> Option<Shape> {
        if let Some(numbers) = Shape::of_numbers(name) {
            return Some(numbers);
        }
        match self.aliases.get(name) {
            _ if self.structs.contains_key(name) => Some(Shape::Struct(name.to_owned())),
            Some(alias) => Some(alias.clone()),
            None if name == "packed_float3" => Some(Shape::Vector(3)),
            None => vocabulary.has_type(name).then(|| Shape::Resource(name.to_owned())),
        }
    }

    fn of_variable(&self, name: &str) -> Shape {
        let found = self.variables.iter().rev().find(|(variable, _)| variable == name);
        found.map_or(Shape::Unknown, |(_, shape)| shape.clone())
    }
}

/// The shape of an expression.
pub(super) fn of(tokens: &[Token<'_>], names: &Names, vocabulary: Vocabulary) -> Shape {
    let mut reader = Reader { tokens, at: 0, names, vocabulary };
    let shape = reader.expression();
    if reader.at == tokens.len() { shape } else { Shape::Unknown }
}

struct Reader<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
    names: &'a Names,
    vocabulary: Vocabulary,
}

impl<'a> Reader<'a> {
    fn peek(&self, ahead: usize) -> &'a str {
        self.tokens.get(self.at + ahead).map_or("", |token| token.text)
    }

    fn take(&mut self, text: &str) -> bool {
        let is_there = self.peek(0) == text;
        self.at += usize::from(is_there);
        is_there
    }

    /// Reads operands and operators. Precedence does not matter: it does not change the shape.
    fn expression(&mut self) -> Shape {
        let mut shape = self.unary();
        while is_operator(self.peek(0)) {
            self.at += 1;
            let right = self.unary();
            shape = shape.with(right);
        }
        if self.take("?") {
            let first = self.expression();
            if !self.take(":") {
                return Shape::Unknown;
            }
            let second = self.expression();
            // A vector as condition chooses component by component.
            return shape.with(first).with(second);
        }
        shape
    }

    fn unary(&mut self) -> Shape {
        while ["-", "+", "!", "~"].contains(&self.peek(0)) {
            self.at += 1;
        }
        let mut shape = self.primary();
        loop {
            if self.take(".") {
                let member = self.peek(0).to_owned();
                self.at += 1;
                shape = if self.peek(0) == "(" { self.method(&shape, &member) } else { self.member(&shape, &member) };
            } else if self.take("[") {
                self.expression();
                self.take("]");
                shape = match shape {
                    Shape::Array(of) => *of,
                    Shape::Vector(_) => Shape::Scalar,
                    Shape::Matrix(_, rows) => Shape::Vector(rows),
                    _ => Shape::Unknown,
                };
            } else {
                return shape;
            }
        }
    }

    fn primary(&mut self) -> Shape {
        let Some(token) = self.tokens.get(self.at) else { return Shape::Unknown };
        self.at += 1;
        let name = token.text;
        if token.is("(") {
            // A cast, `(float)x` or `(Record)0`.
            if let Some(shape) = self.names.of_type(self.peek(0), self.vocabulary)
                && self.peek(1) == ")"
                && self.peek(2).starts_with(|c| is_of_word(c) || c == '(' || c == '{')
            {
                self.at += 2;
                self.unary();
                return shape;
            }
            let shape = self.expression();
            return if self.take(")") { shape } else { Shape::Unknown };
        }
        if !token.is_word() {
            return if name.starts_with(|c: char| c.is_ascii_digit() || c == '.') {
                Shape::Scalar
            } else {
                Shape::Unknown
            };
        }
        if name == "true" || name == "false" {
            return Shape::Scalar;
        }
        // `static_cast<float>(x)`.
        if self.peek(0) == "<" && ["static_cast", "as_type"].contains(&name) {
            let shape = self.names.of_type(self.peek(1), self.vocabulary).unwrap_or(Shape::Unknown);
            self.at += 3;
            self.arguments();
            return shape;
        }
        if self.peek(0) == "(" || self.peek(0) == "{" {
            let constructed = self.names.of_type(name, self.vocabulary);
            let returned = self.names.functions.get(name).cloned();
            let arguments = self.arguments();
            return constructed.or(returned).unwrap_or_else(|| self.intrinsic(name, arguments));
        }
        self.names.of_variable(name)
    }

    /// Shapes of the arguments in brackets.
    fn arguments(&mut self) -> Vec<Shape> {
        let close = if self.peek(0) == "{" { "}" } else { ")" };
        self.at += 1;
        let mut found = Vec::new();
        while !self.take(close) {
            let before = self.at;
            found.push(self.expression());
            self.take(",");
            if self.at == before {
                return vec![Shape::Unknown];
            }
        }
        found
    }

    fn intrinsic(&self, name: &str, arguments: Vec<Shape>) -> Shape {
        match name {
            "cross" => Shape::Vector(3),
            "transpose" => match arguments.first() {
                Some(Shape::Matrix(columns, rows)) => Shape::Matrix(*rows, *columns),
                _ => Shape::Unknown,
            },
            _ if self.vocabulary.gives_scalar(name) => Shape::Scalar,
            _ if name == "mul" || self.vocabulary.gives_widest(name) => {
                arguments.into_iter().reduce(Shape::with).unwrap_or(Shape::Unknown)
            }
            _ => Shape::Unknown,
        }
    }

    fn method(&mut self, of: &Shape, name: &str) -> Shape {
        self.arguments();
        let is_buffer = matches!(of, Shape::Resource(kind) if kind.ends_with("ByteAddressBuffer"));
        match self.vocabulary.method(name) {
            Some(0) if is_buffer => Shape::Scalar,
            Some(1) => Shape::Scalar,
            Some(0) => Shape::Vector(4),
            Some(numbers) => Shape::Vector(numbers),
            None => Shape::Unknown,
        }
    }

    fn member(&self, of: &Shape, name: &str) -> Shape {
        match of {
            Shape::Struct(kind) => {
                self.names.structs.get(kind).and_then(|members| members.get(name)).cloned().unwrap_or(Shape::Unknown)
            }
            Shape::Scalar | Shape::Vector(_) if name.chars().all(|c| "xyzwrgba".contains(c)) => {
                if name.len() == 1 {
                    Shape::Scalar
                } else {
                    Shape::Vector(name.len() as u8)
                }
            }
            _ => Shape::Unknown,
        }
    }
}

/// How many numbers a type has along a side.
fn count(text: &str) -> Option<u8> {
    text.parse().ok().filter(|count| (2..=4).contains(count))
}

fn is_operator(text: &str) -> bool {
    const OPERATORS: [&str; 18] =
        ["+", "-", "*", "/", "%", "<", ">", "<=", ">=", "==", "!=", "&&", "||", "&", "|", "^", "<<", ">>"];
    OPERATORS.contains(&text)
}
