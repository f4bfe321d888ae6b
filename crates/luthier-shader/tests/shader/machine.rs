//! Runs functions of a naga module in f32 on the CPU: enough of the IR for the shipped functions, so that their
//! arithmetic is tested where there is no GPU.

use std::collections::BTreeMap;
use std::iter;
use std::sync::Arc;

use luthier_lut::{Image, WeightBits, bilinear};
use naga::{
    BinaryOperator, Expression, Function, Handle, Literal, MathFunction, Module, Scalar, ScalarKind, Statement,
};
use naga::{ImageQuery, TypeInner, UnaryOperator};

/// A value of the shader.
#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Value {
    F(f32),
    U(u32),
    I(i32),
    B(bool),
    /// Vector, array or structure. Shared, for structures are passed from function to function.
    Many(Arc<[Value]>),
    /// A place: root, then indices.
    Place(Root, Box<[usize]>),
}

#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Root {
    Local(Handle<naga::LocalVariable>),
    Global(Handle<naga::GlobalVariable>),
}

use Value::{B, F, I, Many, Place, U};

/// A vector of f32.
pub(crate) fn vector(values: &[f32]) -> Value {
    values.iter().map(|&v| F(v)).collect()
}

impl FromIterator<Value> for Value {
    fn from_iter<T: IntoIterator<Item = Value>>(parts: T) -> Self {
        Many(parts.into_iter().collect())
    }
}

impl Value {
    /// The members of a structure, the parts of a vector or an array.
    pub(crate) fn members(&self) -> &[Value] {
        if let Many(parts) = self { parts } else { panic!("{self:?} has no members") }
    }

    /// The members, to be changed.
    pub(crate) fn members_mut(&mut self) -> &mut [Value] {
        if let Many(parts) = self { Arc::make_mut(parts) } else { panic!("no members") }
    }

    pub(crate) fn floats(&self) -> Vec<f32> {
        match self {
            F(v) => vec![*v],
            Many(parts) => parts.iter().flat_map(Value::floats).collect(),
            other => panic!("{other:?} is not made of floats"),
        }
    }

    fn float(&self) -> f32 {
        let F(v) = self else { panic!("{self:?} is not a float") };
        *v
    }

    fn at(&self, path: &[usize]) -> &Value {
        match (self, path) {
            (_, []) => self,
            (Many(parts), [first, rest @ ..]) => parts[*first].at(rest),
            _ => panic!("no member {path:?} in {self:?}"),
        }
    }

    fn at_mut(&mut self, path: &[usize]) -> &mut Value {
        match (self, path) {
            (value, []) => value,
            (value, [first, rest @ ..]) => value.members_mut()[*first].at_mut(rest),
        }
    }
}

/// A module with its material buffer and textures.
pub(crate) struct Machine {
    module: Module,
    buffer: Value,
    textures: BTreeMap<String, Image>,
}

/// Where to go on after a statement.
enum Flow {
    Next,
    Break,
    Return(Option<Value>),
}

struct Frame<'f> {
    function: &'f Function,
    arguments: Vec<Value>,
    /// By number of the expression, once it was emitted.
    values: Vec<Option<Value>>,
    /// By number of the variable.
    locals: Vec<Value>,
}

impl Frame<'_> {
    /// What needs no evaluation any more.
    fn known(&self, handle: Handle<Expression>) -> Option<&Value> {
        match self.function.expressions[handle] {
            Expression::FunctionArgument(i) => Some(&self.arguments[i as usize]),
            _ => self.values[handle.index()].as_ref(),
        }
    }
}

impl Machine {
    pub(crate) fn new(wgsl: &str, buffer: &[[f32; 4]], textures: BTreeMap<String, Image>) -> Self {
        let module = naga::front::wgsl::parse_str(wgsl).unwrap();
        Self { module, buffer: buffer.iter().map(|word| vector(word)).collect(), textures }
    }

    pub(crate) fn call(&self, name: &str, arguments: Vec<Value>) -> Value {
        let named = |f: &Function| f.name.as_deref() == Some(name);
        let (_, function) = self.module.functions.iter().find(|(_, f)| named(f)).unwrap_or_else(|| panic!("no {name}"));
        self.run(function, arguments)
    }

    fn run(&self, function: &Function, arguments: Vec<Value>) -> Value {
        let values = vec![None; function.expressions.len()];
        let mut frame = Frame { function, arguments, values, locals: Vec::new() };
        for (_, local) in function.local_variables.iter() {
            let value = local.init.map_or_else(|| self.zero(local.ty), |init| self.get(&frame, init));
            frame.locals.push(value);
        }
        let Flow::Return(Some(value)) = self.block(&mut frame, &function.body) else {
            panic!("functions return a value")
        };
        value
    }

    fn block(&self, frame: &mut Frame<'_>, block: &naga::Block) -> Flow {
        for statement in block.iter() {
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        let value = self.expression(frame, handle);
                        frame.values[handle.index()] = Some(value);
                    }
                }
                Statement::Block(inner) => match self.block(frame, inner) {
                    Flow::Next => {}
                    other => return other,
                },
                Statement::If { condition, accept, reject } => {
                    let is_met = self.get(frame, *condition) == B(true);
                    match self.block(frame, if is_met { accept } else { reject }) {
                        Flow::Next => {}
                        other => return other,
                    }
                }
                Statement::Loop { body, continuing, break_if: None } => loop {
                    match self.block(frame, body) {
                        Flow::Next => {}
                        Flow::Break => break,
                        Flow::Return(value) => return Flow::Return(value),
                    }
                    self.block(frame, continuing);
                },
                Statement::Break => return Flow::Break,
                Statement::Return { value } => return Flow::Return(value.map(|v| self.get(frame, v))),
                Statement::Store { pointer, value } => {
                    let value = self.get(frame, *value);
                    let Place(Root::Local(local), path) = self.get(frame, *pointer) else {
                        panic!("store to a global")
                    };
                    *frame.locals[local.index()].at_mut(&path) = value;
                }
                Statement::Call { function, arguments, result } => {
                    let arguments = arguments.iter().map(|a| self.get(frame, *a)).collect();
                    let value = self.run(&self.module.functions[*function], arguments);
                    frame.values[result.unwrap().index()] = Some(value);
                }
                other => panic!("no {other:?} here"),
            }
        }
        Flow::Next
    }

    fn get(&self, frame: &Frame<'_>, handle: Handle<Expression>) -> Value {
        frame.known(handle).cloned().unwrap_or_else(|| self.expression(frame, handle))
    }

    fn member(&self, frame: &Frame<'_>, base: Handle<Expression>, index: usize) -> Value {
        match frame.known(base) {
            Some(base) => member(base, index),
            None => member(&self.expression(frame, base), index),
        }
    }

    fn expression(&self, frame: &Frame<'_>, handle: Handle<Expression>) -> Value {
        match frame.function.expressions[handle] {
            Expression::FunctionArgument(i) => frame.arguments[i as usize].clone(),
            Expression::LocalVariable(local) => Place(Root::Local(local), Box::default()),
            Expression::GlobalVariable(global) => Place(Root::Global(global), Box::default()),
            Expression::Constant(constant) => self.global(self.module.constants[constant].init),
            Expression::Literal(literal) => self::literal(literal),
            Expression::ZeroValue(ty) => self.zero(ty),
            Expression::Compose { ty, ref components } => {
                self.compose(ty, components.iter().map(|c| self.get(frame, *c)))
            }
            Expression::Splat { size, value } => iter::repeat_n(self.get(frame, value), size as usize).collect(),
            Expression::Access { base, index } => {
                let U(index) = self.get(frame, index) else { panic!("indices are u32") };
                self.member(frame, base, index as usize)
            }
            Expression::AccessIndex { base, index } => self.member(frame, base, index as usize),
            Expression::Swizzle { size, vector, pattern } => {
                let vector = self.get(frame, vector);
                pattern[..size as usize].iter().map(|&c| vector.members()[c as usize].clone()).collect()
            }
            Expression::Load { pointer } => match self.get(frame, pointer) {
                Place(Root::Local(local), path) => frame.locals[local.index()].at(&path).clone(),
                Place(Root::Global(_), path) => self.buffer.at(&path).clone(),
                other => panic!("load from {other:?}"),
            },
            Expression::Unary { op, expr } => each([self.get(frame, expr)], |[v]| match (op, v) {
                (UnaryOperator::Negate, F(v)) => F(-v),
                (UnaryOperator::LogicalNot, B(v)) => B(!v),
                other => panic!("no {other:?} here"),
            }),
            Expression::Binary { op, left, right } => {
                each([left, right].map(|h| self.get(frame, h)), |[a, b]| binary(op, a, b))
            }
            Expression::Select { condition, accept, reject } => {
                let operands = [condition, accept, reject].map(|h| self.get(frame, h));
                each(
                    operands,
                    |[condition, accept, reject]| {
                        if *condition == B(true) { accept.clone() } else { reject.clone() }
                    },
                )
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                // What a function of fewer does not read is the first once more.
                math(fun, [arg, arg1.unwrap_or(arg), arg2.unwrap_or(arg)].map(|h| self.get(frame, h)))
            }
            Expression::As { expr, kind, convert: Some(_) } => each([self.get(frame, expr)], |[v]| cast(kind, v)),
            Expression::As { expr, kind: ScalarKind::Uint, convert: None } => {
                each(
                    [self.get(frame, expr)],
                    |[v]| {
                        if let F(v) = v { U(v.to_bits()) } else { panic!("no bits of {v:?}") }
                    },
                )
            }
            Expression::ImageSample { image, coordinate, .. } => {
                let (image, at) = (self.image(frame, image), self.get(frame, coordinate).floats());
                // Of a cube, the left half of an image stands for directions of negative x, the right one for the others.
                if let [x, _, _] = at[..] {
                    let texel = image.texel(if x < 0.0 { 0 } else { image.width - 1 }, 0);
                    return vector(&[texel[0], texel[1], texel[2], 1.0]);
                }
                let position = [f64::from(at[0]) * f64::from(image.width), f64::from(at[1]) * f64::from(image.height)];
                vector(&bilinear(image, position, WeightBits::Exact).map(|v| v as f32))
            }
            Expression::ImageLoad { image, coordinate, .. } => {
                let at = self.get(frame, coordinate);
                let [I(x), I(y)] = at.members() else { panic!("texels have two coordinates in i32") };
                let image = self.image(frame, image);
                let mut texel = vec![0.0, 0.0, 0.0, 1.0];
                let channels = image.texel(*x as u32, *y as u32);
                texel[..channels.len()].copy_from_slice(channels);
                vector(&texel)
            }
            Expression::ImageQuery { image, query: ImageQuery::Size { .. } } => {
                let image = self.image(frame, image);
                [image.width, image.height].into_iter().map(U).collect()
            }
            ref other => panic!("no {other:?} here"),
        }
    }

    fn image(&self, frame: &Frame<'_>, handle: Handle<Expression>) -> &Image {
        let Place(Root::Global(global), _) = self.get(frame, handle) else { panic!("textures are globals") };
        &self.textures[self.module.global_variables[global].name.as_deref().unwrap()]
    }

    fn global(&self, handle: Handle<Expression>) -> Value {
        match &self.module.global_expressions[handle] {
            Expression::Literal(literal) => self::literal(*literal),
            Expression::Constant(constant) => self.global(self.module.constants[*constant].init),
            Expression::Compose { ty, components } => self.compose(*ty, components.iter().map(|c| self.global(*c))),
            other => panic!("no {other:?} here"),
        }
    }

    /// Vectors are made of scalars and vectors, structures of their members.
    fn compose(&self, ty: Handle<naga::Type>, parts: impl Iterator<Item = Value>) -> Value {
        if !matches!(self.module.types[ty].inner, TypeInner::Vector { .. }) {
            return parts.collect();
        }
        let mut flat = Vec::with_capacity(4);
        for part in parts {
            match part {
                Many(inner) => flat.extend_from_slice(&inner),
                scalar => flat.push(scalar),
            }
        }
        Many(flat.into())
    }

    fn zero(&self, ty: Handle<naga::Type>) -> Value {
        let scalar = |s: &Scalar| match s.kind {
            ScalarKind::Float => F(0.0),
            ScalarKind::Uint => U(0),
            ScalarKind::Sint => I(0),
            _ => B(false),
        };
        match &self.module.types[ty].inner {
            TypeInner::Scalar(s) => scalar(s),
            TypeInner::Vector { size, scalar: s } => iter::repeat_n(scalar(s), *size as usize).collect(),
            TypeInner::Struct { members, .. } => members.iter().map(|m| self.zero(m.ty)).collect(),
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                iter::repeat_n(self.zero(*base), count.get() as usize).collect()
            }
            other => panic!("no zero of {other:?}"),
        }
    }
}

fn literal(literal: Literal) -> Value {
    match literal {
        Literal::F32(v) => F(v),
        Literal::U32(v) => U(v),
        Literal::I32(v) => I(v),
        Literal::Bool(v) => B(v),
        other => panic!("no {other:?} here"),
    }
}

fn member(base: &Value, index: usize) -> Value {
    match base {
        Place(root, path) => Place(*root, path.iter().copied().chain([index]).collect()),
        many => many.members()[index].clone(),
    }
}

/// Applies an operation to scalars, or component by component; scalars go with every component.
fn each<const N: usize>(operands: [Value; N], operation: impl Fn([&Value; N]) -> Value) -> Value {
    let length = operands.iter().find_map(|v| if let Many(parts) = v { Some(parts.len()) } else { None });
    let Some(length) = length else { return operation(operands.each_ref()) };
    let component = |i: usize| operands.each_ref().map(|v| if let Many(parts) = v { &parts[i] } else { v });
    (0..length).map(|i| operation(component(i))).collect()
}

fn cast(kind: ScalarKind, value: &Value) -> Value {
    match (kind, value) {
        (ScalarKind::Uint, F(v)) => U(*v as u32),
        (ScalarKind::Sint, F(v)) => I(*v as i32),
        (ScalarKind::Sint, U(v)) => I(*v as i32),
        (ScalarKind::Uint, I(v)) => U(v.cast_unsigned()),
        (ScalarKind::Float, U(v)) => F(*v as f32),
        (ScalarKind::Float, I(v)) => F(*v as f32),
        other => panic!("no cast {other:?} here"),
    }
}

fn binary(op: BinaryOperator, left: &Value, right: &Value) -> Value {
    use BinaryOperator as Op;
    match (op, left, right) {
        (Op::Add, F(a), F(b)) => F(a + b),
        (Op::Subtract, F(a), F(b)) => F(a - b),
        (Op::Multiply, F(a), F(b)) => F(a * b),
        (Op::Divide, F(a), F(b)) => F(a / b),
        (Op::Equal, F(a), F(b)) => B(a == b),
        (Op::NotEqual, F(a), F(b)) => B(a != b),
        (Op::Add, U(a), U(b)) => U(a.wrapping_add(*b)),
        (Op::Subtract, U(a), U(b)) => U(a.wrapping_sub(*b)),
        (Op::Multiply, U(a), U(b)) => U(a.wrapping_mul(*b)),
        (Op::ShiftRight, U(a), U(b)) => U(a >> b),
        (Op::ExclusiveOr, U(a), U(b)) => U(a ^ b),
        (Op::And, U(a), U(b)) => U(a & b),
        (Op::Add, I(a), I(b)) => I(a + b),
        (Op::Divide, I(a), I(b)) => I(a / b),
        (Op::Modulo, I(a), I(b)) => I(a % b),
        (Op::Less, I(a), I(b)) => B(a < b),
        (Op::Subtract, I(a), I(b)) => I(a - b),
        (Op::Less, U(a), U(b)) => B(a < b),
        (Op::Less, F(a), F(b)) => B(a < b),
        (Op::LessEqual, F(a), F(b)) => B(a <= b),
        (Op::Greater, F(a), F(b)) => B(a > b),
        (Op::GreaterEqual, F(a), F(b)) => B(a >= b),
        (Op::Greater, U(a), U(b)) => B(a > b),
        (Op::Equal, U(a), U(b)) => B(a == b),
        (Op::NotEqual, U(a), U(b)) => B(a != b),
        (Op::And | Op::LogicalAnd, B(a), B(b)) => B(*a && *b),
        other => panic!("no {other:?} here"),
    }
}

/// The sum over the components, first to last.
fn dot(a: &Value, b: &Value) -> f32 {
    a.members().iter().zip(b.members()).map(|(a, b)| a.float() * b.float()).sum()
}

fn math(fun: MathFunction, operands: [Value; 3]) -> Value {
    use MathFunction as M;
    match fun {
        M::Dot => return F(dot(&operands[0], &operands[1])),
        M::Length => return F(dot(&operands[0], &operands[0]).sqrt()),
        M::Normalize => {
            let length = dot(&operands[0], &operands[0]).sqrt();
            return operands[0].members().iter().map(|v| F(v.float() / length)).collect();
        }
        _ => {}
    }
    each(operands, |v| {
        if let [I(a), I(b), I(c)] = v {
            return match fun {
                M::Min => I(*a.min(b)),
                M::Clamp => I(*a.clamp(b, c)),
                _ => panic!("no {fun:?} of integers here"),
            };
        }
        let (a, b) = (v[0].float(), || v[1].float());
        F(match fun {
            M::Abs => a.abs(),
            M::Sign => {
                if a == 0.0 {
                    0.0
                } else {
                    a.signum()
                }
            }
            M::Min => a.min(b()),
            M::Max => a.max(b()),
            M::Clamp => a.max(b()).min(v[2].float()),
            M::Saturate => a.clamp(0.0, 1.0),
            M::Cos => a.cos(),
            M::Sin => a.sin(),
            M::Atan2 => a.atan2(b()),
            M::Floor => a.floor(),
            M::Fract => a - a.floor(),
            M::Round => a.round_ties_even(),
            M::Exp => a.exp(),
            M::Exp2 => a.exp2(),
            M::Log => a.ln(),
            M::Log2 => a.log2(),
            M::InverseSqrt => 1.0 / a.sqrt(),
            M::Pow => a.powf(b()),
            M::Sqrt => a.sqrt(),
            M::Mix => a * (1.0 - v[2].float()) + b() * v[2].float(),
            other => panic!("no {other:?} here"),
        })
    })
}
