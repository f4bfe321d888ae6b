//! Operations of the graph, and their counts.

use naga::{BinaryOperator, MathFunction, ScalarKind, UnaryOperator};

use super::StaticCounts;

/// A constant.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Constant {
    /// Bits of a single-precision number.
    Float(u32),
    Int(i32),
    Uint(u32),
    Bool(bool),
}

impl Constant {
    pub(super) fn float(value: f32) -> Self {
        Self::Float(value.to_bits())
    }

    pub(super) fn kind(self) -> ScalarKind {
        match self {
            Self::Float(_) => ScalarKind::Float,
            Self::Int(_) => ScalarKind::Sint,
            Self::Uint(_) => ScalarKind::Uint,
            Self::Bool(_) => ScalarKind::Bool,
        }
    }

    pub(super) fn zero(kind: ScalarKind) -> Self {
        match kind {
            ScalarKind::Sint => Self::Int(0),
            ScalarKind::Uint => Self::Uint(0),
            ScalarKind::Bool => Self::Bool(false),
            _ => Self::float(0.0),
        }
    }

    pub(super) fn is_float(self, value: f32) -> bool {
        matches!(self, Self::Float(bits) if f32::from_bits(bits) == value)
    }
}

/// Kind of memory that is read.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Memory {
    Filtered,
    /// Through a sampler, with more than 4 bytes a texel.
    Wide,
    Texel,
    Record,
    Buffer,
    /// Uniform buffers and sizes of resources: in registers before a shader starts.
    Uniform,
}

/// Operation of a node; with its arguments it decides the value.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
pub(super) enum Operation {
    Constant(Constant),
    /// An argument of the evaluation.
    Input(u32),
    /// A read of a resource, by its number among the variables of the module.
    Read(Memory, usize),
    /// A component of what a read gives.
    Component(u32),
    /// An address, part of a read.
    Address,
    Unary(UnaryOperator),
    Binary(BinaryOperator),
    Reciprocal,
    Math(MathFunction),
    Convert(ScalarKind),
    /// Bits as another type.
    Bits(ScalarKind),
    /// A condition and two values.
    Select,
    /// A value of an array, by a number that is not known.
    Element,
}

impl Operation {
    /// Counts of one operation; those of sums of products are corrected by the graph.
    pub(super) fn counts(self, kind: ScalarKind) -> StaticCounts {
        let of = |special, plain| StaticCounts { special, plain, ..StaticCounts::default() };
        match self {
            Self::Constant(_) | Self::Input(_) | Self::Component(_) | Self::Address | Self::Bits(_) => of(0, 0),
            Self::Read(memory, _) => {
                let mut counts = StaticCounts::default();
                match memory {
                    Memory::Filtered => counts.filtered_reads = 1,
                    Memory::Wide => counts.wide_reads = 1,
                    Memory::Texel => counts.texel_fetches = 1,
                    Memory::Record => counts.record_reads = 1,
                    Memory::Buffer => counts.buffer_reads = 1,
                    Memory::Uniform => {}
                }
                counts
            }
            Self::Unary(UnaryOperator::Negate) => of(0, 0),
            Self::Unary(_) | Self::Convert(_) | Self::Select | Self::Element => of(0, 1),
            Self::Binary(BinaryOperator::Divide | BinaryOperator::Modulo) if kind != ScalarKind::Float => of(1, 8),
            Self::Binary(BinaryOperator::Modulo) => of(1, 3),
            Self::Binary(_) => of(0, 1),
            Self::Reciprocal => of(1, 0),
            Self::Math(function) => {
                use MathFunction as F;
                match function {
                    F::Abs | F::Saturate => of(0, 0),
                    F::Sqrt | F::InverseSqrt | F::Exp2 | F::Log2 => of(1, 0),
                    F::Exp | F::Log | F::Sin | F::Cos => of(1, 1),
                    F::Pow => of(2, 1),
                    F::Tan => of(3, 2),
                    F::Asin | F::Acos => of(1, 8),
                    F::Atan | F::Atan2 => of(1, 12),
                    F::Sinh | F::Cosh | F::Tanh | F::Asinh | F::Acosh | F::Atanh => of(2, 4),
                    F::Sign => of(0, 2),
                    _ => of(0, 1),
                }
            }
        }
    }
}
