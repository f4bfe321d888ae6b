//! Values of expressions: scalars, and what is made of them.

use super::graph::{Graph, Id};

/// Value of an expression.
#[derive(Debug, Clone, PartialEq)]
pub(super) enum Value {
    Scalar(Id),
    /// A vector, a matrix by columns, an array or a structure.
    Parts(Vec<Value>),
    /// A place in a variable of functions.
    Place {
        slot: usize,
        path: Vec<Step>,
    },
    /// A place in a buffer: the number of its variable, and the numbers on the way.
    Memory {
        variable: usize,
        path: Vec<Id>,
    },
    /// A texture or a sampler.
    Resource(usize),
}

/// Step into a part.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Step {
    Known(usize),
    Unknown(Id),
}

impl Value {
    pub(super) fn scalar(&self) -> Result<Id, &'static str> {
        match self {
            Self::Scalar(id) => Ok(*id),
            _ => Err("a scalar is expected"),
        }
    }

    pub(super) fn parts(&self) -> Result<&[Self], &'static str> {
        match self {
            Self::Parts(parts) => Ok(parts),
            _ => Err("a vector, an array or a structure is expected"),
        }
    }

    /// All scalars, in order.
    pub(super) fn scalars(&self, out: &mut Vec<Id>) {
        match self {
            Self::Scalar(id) => out.push(*id),
            Self::Parts(parts) => parts.iter().for_each(|part| part.scalars(out)),
            Self::Memory { path, .. } => out.extend(path),
            Self::Place { .. } | Self::Resource(_) => {}
        }
    }

    pub(super) fn is_matrix(&self) -> bool {
        matches!(self, Self::Parts(parts) if matches!(parts.first(), Some(Self::Parts(_))))
    }

    /// The parts of a vector with a scalar in each, or the scalar itself so many times.
    pub(super) fn components(&self, count: usize) -> Result<Vec<Id>, &'static str> {
        match self {
            Self::Scalar(id) => Ok(vec![*id; count]),
            _ => self.parts()?.iter().map(Self::scalar).collect(),
        }
    }

    /// Number of components of a vector; `None` for a scalar.
    pub(super) fn width(&self) -> Option<usize> {
        match self {
            Self::Parts(parts) => Some(parts.len()),
            _ => None,
        }
    }

    /// One of two values by a condition.
    pub(super) fn chosen(graph: &mut Graph, condition: Id, accept: &Self, reject: &Self) -> Result<Self, &'static str> {
        Ok(match (accept, reject) {
            (Self::Scalar(a), Self::Scalar(b)) => Self::Scalar(graph.select(condition, *a, *b)),
            (Self::Parts(a), Self::Parts(b)) if a.len() == b.len() => {
                let parts = a.iter().zip(b).map(|(a, b)| Self::chosen(graph, condition, a, b));
                Self::Parts(parts.collect::<Result<_, _>>()?)
            }
            _ if accept == reject => accept.clone(),
            _ => return Err("two sides of a branch do not agree on a value"),
        })
    }

    /// The value at the end of a path.
    pub(super) fn at(&self, graph: &mut Graph, path: &[Step]) -> Result<Self, &'static str> {
        let Some((step, rest)) = path.split_first() else { return Ok(self.clone()) };
        let parts = self.parts()?;
        match step {
            Step::Known(i) => parts.get(*i).ok_or("an index is out of range")?.at(graph, rest),
            Step::Unknown(index) => {
                let found = parts.iter().map(|part| part.at(graph, rest)).collect::<Result<Vec<_>, _>>()?;
                Self::element(graph, *index, &found)
            }
        }
    }

    /// One of several values by a number that is not known.
    pub(super) fn element(graph: &mut Graph, index: Id, values: &[Self]) -> Result<Self, &'static str> {
        match values.first().ok_or("an array is empty")? {
            Self::Scalar(first) => {
                let kind = graph.kind(*first);
                let mut arguments = vec![index];
                for value in values {
                    arguments.push(value.scalar()?);
                }
                if arguments[2..].iter().all(|id| *id == arguments[1]) {
                    return Ok(Self::Scalar(*first));
                }
                Ok(Self::Scalar(graph.node(super::words::Operation::Element, arguments, kind)))
            }
            Self::Parts(parts) => {
                let parts = (0..parts.len()).map(|i| {
                    let column: Vec<Self> = values.iter().map(|value| Ok(value.parts()?[i].clone())).collect::<Result<
                        _,
                        &'static str,
                    >>(
                    )?;
                    Self::element(graph, index, &column)
                });
                Ok(Self::Parts(parts.collect::<Result<_, _>>()?))
            }
            _ => Err("an array of places"),
        }
    }

    /// Puts a value at the end of a path.
    pub(super) fn put(&mut self, graph: &mut Graph, path: &[Step], value: &Self) -> Result<(), &'static str> {
        let Some((step, rest)) = path.split_first() else {
            *self = value.clone();
            return Ok(());
        };
        let Self::Parts(parts) = self else { return Err("a place has no parts") };
        match step {
            Step::Known(i) => parts.get_mut(*i).ok_or("an index is out of range")?.put(graph, rest, value),
            Step::Unknown(index) => {
                for (i, part) in parts.iter_mut().enumerate() {
                    let here = graph.constant(super::words::Constant::Uint(i as u32));
                    let is_here = graph.binary(naga::BinaryOperator::Equal, *index, here);
                    let mut changed = part.clone();
                    changed.put(graph, rest, value)?;
                    *part = Self::chosen(graph, is_here, &changed, part)?;
                }
                Ok(())
            }
        }
    }
}
