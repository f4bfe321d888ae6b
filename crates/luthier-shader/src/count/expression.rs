//! Expressions: each becomes operations on scalars.

use naga::{
    BinaryOperator, Expression, Handle, ImageDimension, MathFunction, RelationalFunction, SampleLevel, ScalarKind,
    TypeInner,
};

use super::graph::Id;
use super::value::Value;
use super::walk::{Frame, Reason, Walk};
use super::words::{Constant, Memory, Operation};

impl<'a> Walk<'a> {
    /// The value of an expression of no function.
    pub(super) fn constant_expression(&mut self, handle: Handle<Expression>) -> Result<Value, Reason> {
        match &self.module.global_expressions[handle] {
            Expression::Literal(literal) => self.literal(*literal),
            Expression::Constant(constant) => self.constant_expression(self.module.constants[*constant].init),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|&part| self.constant_expression(part)).collect::<Result<_, _>>()?;
                Ok(self.composed(*ty, parts))
            }
            Expression::Splat { size, value } => {
                let value = self.constant_expression(*value)?;
                Ok(Value::Parts(vec![value; *size as usize]))
            }
            _ => Err("a constant of an unexpected shape"),
        }
    }

    fn composed(&self, ty: Handle<naga::Type>, parts: Vec<Value>) -> Value {
        if !matches!(self.module.types[ty].inner, TypeInner::Vector { .. }) {
            return Value::Parts(parts);
        }
        let flat = parts.into_iter().flat_map(|part| match part {
            Value::Parts(parts) => parts,
            part => vec![part],
        });
        Value::Parts(flat.collect())
    }

    /// The value of an expression of a function.
    pub(super) fn expression(&mut self, frame: &mut Frame<'a>, handle: Handle<Expression>) -> Result<Value, Reason> {
        let function = frame.function;
        match &function.expressions[handle] {
            Expression::Literal(literal) => self.literal(*literal),
            Expression::Constant(constant) => self.constant_expression(self.module.constants[*constant].init),
            Expression::ZeroValue(ty) => self.zero(*ty),
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|&part| self.value(frame, part)).collect::<Result<_, _>>()?;
                Ok(self.composed(*ty, parts))
            }
            Expression::Access { base, index } => {
                let (base, index) = (self.value(frame, *base)?, self.value(frame, *index)?.scalar()?);
                self.part(base, index)
            }
            Expression::AccessIndex { base, index } => {
                let base = self.value(frame, *base)?;
                let index = self.graph.constant(Constant::Uint(*index));
                self.part(base, index)
            }
            Expression::Splat { size, value } => Ok(Value::Parts(vec![self.value(frame, *value)?; *size as usize])),
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.value(frame, *vector)?;
                let parts = vector.parts()?;
                Ok(Value::Parts(pattern[..*size as usize].iter().map(|&i| parts[i as usize].clone()).collect()))
            }
            Expression::FunctionArgument(number) => self.argument(frame, *number),
            Expression::GlobalVariable(variable) => self.global(*variable),
            Expression::LocalVariable(variable) => self.local(frame, *variable),
            Expression::Load { pointer } => {
                let pointer = self.value(frame, *pointer)?;
                self.load(&pointer)
            }
            Expression::ImageSample { image, sampler, gather, coordinate, array_index, offset, level, .. } => {
                let mut arguments = Vec::new();
                let level = match level {
                    SampleLevel::Auto | SampleLevel::Zero => None,
                    SampleLevel::Exact(level) | SampleLevel::Bias(level) => Some(*level),
                    SampleLevel::Gradient { x, .. } => Some(*x),
                };
                for part in [Some(*coordinate), *array_index, *offset, level].into_iter().flatten() {
                    self.value(frame, part)?.scalars(&mut arguments);
                }
                // Another sampler or another gathered component is another read.
                let Value::Resource(sampler) = self.value(frame, *sampler)? else {
                    return Err("a sampler is expected");
                };
                let mark = sampler as u32 * 8 + gather.map_or(0, |component| 1 + component as u32);
                arguments.push(self.graph.constant(Constant::Uint(mark)));
                let image = self.value(frame, *image)?;
                let name = self.name(&image)?;
                let is_wide = self.wide.iter().any(|wide| wide == name);
                self.texels(&image, if is_wide { Memory::Wide } else { Memory::Filtered }, arguments)
            }
            Expression::ImageLoad { image, coordinate, array_index, level, .. } => {
                let mut arguments = Vec::new();
                for part in [Some(*coordinate), *array_index, *level].into_iter().flatten() {
                    self.value(frame, part)?.scalars(&mut arguments);
                }
                let image = self.value(frame, *image)?;
                self.texels(&image, Memory::Texel, arguments)
            }
            Expression::ImageQuery { image, .. } => {
                let Value::Resource(image) = self.value(frame, *image)? else { return Err("a texture is expected") };
                let TypeInner::Image { dim, .. } = self.image(image)? else { return Err("a texture is expected") };
                let width = if *dim == ImageDimension::D3 { 3 } else { 2 };
                let whole = self.graph.node(Operation::Read(Memory::Uniform, image), Vec::new(), ScalarKind::Uint);
                Ok(self.spread(whole, width, ScalarKind::Uint))
            }
            Expression::Unary { op, expr } => {
                let value = self.value(frame, *expr)?;
                self.each(&[value], |walk, ids| walk.graph.unary(*op, ids[0]))
            }
            Expression::Binary { op, left, right } => {
                let (left, right) = (self.value(frame, *left)?, self.value(frame, *right)?);
                self.operate(*op, left, right)
            }
            Expression::Select { condition, accept, reject } => {
                let condition = self.value(frame, *condition)?;
                let (accept, reject) = (self.value(frame, *accept)?, self.value(frame, *reject)?);
                self.each(&[condition, accept, reject], |walk, ids| walk.graph.select(ids[0], ids[1], ids[2]))
            }
            Expression::Derivative { expr, .. } => self.value(frame, *expr),
            Expression::Relational { fun, argument } => {
                let value = self.value(frame, *argument)?;
                let joined = match fun {
                    RelationalFunction::All => BinaryOperator::LogicalAnd,
                    RelationalFunction::Any => BinaryOperator::LogicalOr,
                    _ => return Err("a test for infinite numbers"),
                };
                let ids = value.components(1)?;
                let first = ids[0];
                Ok(Value::Scalar(ids[1..].iter().fold(first, |all, &id| self.graph.binary(joined, all, id))))
            }
            Expression::Math { fun, arg, arg1, arg2, arg3 } => {
                let mut values = vec![self.value(frame, *arg)?];
                for part in [arg1, arg2, arg3].into_iter().copied().flatten() {
                    values.push(self.value(frame, part)?);
                }
                self.math(*fun, &values)
            }
            Expression::As { expr, kind, convert } => {
                let value = self.value(frame, *expr)?;
                let operation = if convert.is_some() { Operation::Convert(*kind) } else { Operation::Bits(*kind) };
                self.each(&[value], |walk, ids| {
                    if walk.graph.kind(ids[0]) == *kind {
                        ids[0]
                    } else {
                        walk.graph.node(operation, ids.to_vec(), *kind)
                    }
                })
            }
            Expression::ArrayLength(base) => {
                let Value::Memory { variable, .. } = self.value(frame, *base)? else {
                    return Err("a buffer is expected");
                };
                Ok(Value::Scalar(self.graph.node(
                    Operation::Read(Memory::Uniform, variable),
                    Vec::new(),
                    ScalarKind::Uint,
                )))
            }
            _ => Err("an expression that no evaluation has"),
        }
    }

    fn image(&self, variable: usize) -> Result<&'a TypeInner, Reason> {
        let (_, variable) = self.module.global_variables.iter().nth(variable).ok_or("a texture is missing")?;
        Ok(&self.module.types[variable.ty].inner)
    }

    fn name(&self, image: &Value) -> Result<&'a str, Reason> {
        let Value::Resource(image) = image else { return Err("a texture is expected") };
        let (_, variable) = self.module.global_variables.iter().nth(*image).ok_or("a texture is missing")?;
        Ok(variable.name.as_deref().unwrap_or_default())
    }

    fn texels(&mut self, image: &Value, memory: Memory, arguments: Vec<Id>) -> Result<Value, Reason> {
        let Value::Resource(image) = image else { return Err("a texture is expected") };
        let kind = match self.image(*image)? {
            TypeInner::Image { class: naga::ImageClass::Sampled { kind, .. }, .. } => *kind,
            TypeInner::Image { class: naga::ImageClass::Depth { .. }, .. } => {
                return Ok(Value::Scalar(self.graph.node(
                    Operation::Read(memory, *image),
                    arguments,
                    ScalarKind::Float,
                )));
            }
            _ => return Err("a texture of a kind that no evaluation has"),
        };
        let whole = self.graph.node(Operation::Read(memory, *image), arguments, kind);
        Ok(self.spread(whole, 4, kind))
    }

    /// A part of a value, or the place of a part.
    fn part(&mut self, base: Value, index: Id) -> Result<Value, Reason> {
        match base {
            Value::Place { slot, mut path } => {
                path.push(self.step(index));
                Ok(Value::Place { slot, path })
            }
            Value::Memory { variable, mut path } => {
                path.push(index);
                Ok(Value::Memory { variable, path })
            }
            value => {
                let step = self.step(index);
                value.at(&mut self.graph, &[step])
            }
        }
    }

    /// An operation component by component; scalars stand for vectors of equal components.
    fn each(&mut self, values: &[Value], mut operation: impl FnMut(&mut Self, &[Id]) -> Id) -> Result<Value, Reason> {
        let Some(width) = values.iter().find_map(Value::width) else {
            let ids = values.iter().map(Value::scalar).collect::<Result<Vec<_>, _>>()?;
            return Ok(Value::Scalar(operation(self, &ids)));
        };
        if values.iter().any(Value::is_matrix) {
            let mut columns = Vec::new();
            for i in 0..width {
                let column = values.iter().map(|value| match value {
                    Value::Parts(parts) if value.is_matrix() => parts[i].clone(),
                    value => value.clone(),
                });
                let column: Vec<Value> = column.collect();
                columns.push(self.each(&column, &mut operation as &mut dyn FnMut(&mut Self, &[Id]) -> Id)?);
            }
            return Ok(Value::Parts(columns));
        }
        let columns = values.iter().map(|value| value.components(width)).collect::<Result<Vec<_>, _>>()?;
        let parts = (0..width).map(|i| {
            let ids: Vec<Id> = columns.iter().map(|column| column[i]).collect();
            Value::Scalar(operation(self, &ids))
        });
        Ok(Value::Parts(parts.collect()))
    }

    fn operate(&mut self, operator: BinaryOperator, left: Value, right: Value) -> Result<Value, Reason> {
        let is_product = operator == BinaryOperator::Multiply;
        match (left.is_matrix(), right.is_matrix()) {
            (true, true) if is_product => {
                let columns = right.parts()?.to_vec();
                let columns = columns.into_iter().map(|column| self.operate(operator, left.clone(), column));
                Ok(Value::Parts(columns.collect::<Result<_, _>>()?))
            }
            // The sum of columns, each times a component.
            (true, false) if is_product && right.width().is_some() => {
                let (columns, weights) = (left.parts()?.to_vec(), right.parts()?.to_vec());
                let mut sum: Option<Value> = None;
                for (column, weight) in columns.into_iter().zip(weights) {
                    let term = self.operate(operator, column, weight)?;
                    sum = Some(match sum {
                        None => term,
                        Some(sum) => self.operate(BinaryOperator::Add, sum, term)?,
                    });
                }
                sum.ok_or("a matrix without columns")
            }
            (false, true) if is_product && left.width().is_some() => {
                let columns = right.parts()?.to_vec();
                let products = columns.into_iter().map(|column| self.math(MathFunction::Dot, &[left.clone(), column]));
                Ok(Value::Parts(products.collect::<Result<_, _>>()?))
            }
            _ => self.each(&[left, right], |walk, ids| walk.graph.binary(operator, ids[0], ids[1])),
        }
    }

    fn math(&mut self, function: MathFunction, values: &[Value]) -> Result<Value, Reason> {
        use BinaryOperator::{Add, Multiply, Subtract};
        use MathFunction as F;
        let first = || values[0].clone();
        Ok(match function {
            F::Dot => {
                let products = self.operate(Multiply, first(), values[1].clone())?.components(1)?;
                let [head, tail @ ..] = products.as_slice() else { return Err("a vector without components") };
                Value::Scalar(tail.iter().fold(*head, |sum, &id| self.graph.binary(Add, sum, id)))
            }
            F::Cross => {
                let (a, b) = (values[0].components(3)?, values[1].components(3)?);
                let part = |walk: &mut Self, i: usize, j: usize| {
                    let [x, y] = [(a[i], b[j]), (a[j], b[i])].map(|(a, b)| walk.graph.binary(Multiply, a, b));
                    Value::Scalar(walk.graph.binary(Subtract, x, y))
                };
                Value::Parts(vec![part(self, 1, 2), part(self, 2, 0), part(self, 0, 1)])
            }
            F::Length => {
                let square = self.math(F::Dot, &[first(), first()])?;
                self.math(F::Sqrt, &[square])?
            }
            F::Distance => {
                let apart = self.operate(Subtract, first(), values[1].clone())?;
                self.math(F::Length, &[apart])?
            }
            F::Normalize => {
                let square = self.math(F::Dot, &[first(), first()])?;
                let inverse = self.math(F::InverseSqrt, &[square])?;
                self.operate(Multiply, first(), inverse)?
            }
            F::Reflect => {
                let along = self.math(F::Dot, &[values[1].clone(), first()])?;
                let twice = self.operate(Add, along.clone(), along)?;
                let back = self.operate(Multiply, values[1].clone(), twice)?;
                self.operate(Subtract, first(), back)?
            }
            F::Fma => {
                let product = self.operate(Multiply, first(), values[1].clone())?;
                self.operate(Add, product, values[2].clone())?
            }
            F::Mix => {
                let apart = self.operate(Subtract, values[1].clone(), first())?;
                let part = self.operate(Multiply, apart, values[2].clone())?;
                self.operate(Add, part, first())?
            }
            F::Clamp => {
                let above = self.math(F::Max, &[first(), values[1].clone()])?;
                self.math(F::Min, &[above, values[2].clone()])?
            }
            F::SmoothStep => {
                let [low, high, x] = [0, 1, 2].map(|i| values[i].clone());
                let (above, span) = (self.operate(Subtract, x, low.clone())?, self.operate(Subtract, high, low)?);
                let ratio = self.operate(BinaryOperator::Divide, above, span)?;
                let t = self.math(F::Saturate, &[ratio])?;
                let [three, minus_two] = [3.0, -2.0].map(|c| Value::Scalar(self.graph.float(c)));
                let product = self.operate(Multiply, t.clone(), minus_two)?;
                let sum = self.operate(Add, product, three)?;
                let square = self.operate(Multiply, t.clone(), t)?;
                self.operate(Multiply, square, sum)?
            }
            F::Unpack2x16float | F::Unpack2x16unorm | F::Unpack2x16snorm => self.unpacked(function, &values[0], 2)?,
            F::Unpack4x8unorm | F::Unpack4x8snorm => self.unpacked(function, &values[0], 4)?,
            F::Transpose
            | F::Inverse
            | F::Determinant
            | F::Outer
            | F::Refract
            | F::FaceForward
            | F::Modf
            | F::Frexp => {
                return Err("a function that no evaluation has");
            }
            _ => self.each(values, |walk, ids| walk.graph.math(function, ids))?,
        })
    }

    /// Components of a word: one operation each.
    fn unpacked(&mut self, function: MathFunction, word: &Value, count: u32) -> Result<Value, Reason> {
        let word = word.scalar()?;
        let parts = (0..count).map(|i| {
            let number = self.graph.constant(Constant::Uint(i));
            Value::Scalar(self.graph.node(Operation::Math(function), vec![word, number], ScalarKind::Float))
        });
        Ok(Value::Parts(parts.collect()))
    }
}
