//! Runs functions of a naga module in f32 on the CPU: enough of the IR for the shipped functions, so that their
//! arithmetic is tested where there is no GPU.

use std::collections::BTreeMap;

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
    /// Vector, array or structure.
    Many(Vec<Value>),
    /// A place: root, then indices.
    Place(Root, Vec<usize>),
}

#[derive(Debug, Clone, PartialEq)]
pub(crate) enum Root {
    Local(Handle<naga::LocalVariable>),
    Global(String),
}

use Value::{B, F, I, Many, Place, U};

/// A vector of f32.
pub(crate) fn vector(values: &[f32]) -> Value {
    Many(values.iter().map(|&v| F(v)).collect())
}

impl Value {
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
            (Many(parts), [first, rest @ ..]) => parts[*first].at_mut(rest),
            _ => panic!("no member {path:?}"),
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
    values: BTreeMap<Handle<Expression>, Value>,
    locals: BTreeMap<Handle<naga::LocalVariable>, Value>,
}

impl Machine {
    pub(crate) fn new(wgsl: &str, buffer: &[[f32; 4]], textures: BTreeMap<String, Image>) -> Self {
        let module = naga::front::wgsl::parse_str(wgsl).unwrap();
        Self { module, buffer: Many(buffer.iter().map(|word| vector(word)).collect()), textures }
    }

    pub(crate) fn call(&self, name: &str, arguments: Vec<Value>) -> Value {
        let named = |f: &Function| f.name.as_deref() == Some(name);
        let (_, function) = self.module.functions.iter().find(|(_, f)| named(f)).unwrap_or_else(|| panic!("no {name}"));
        self.run(function, arguments)
    }

    fn run(&self, function: &Function, arguments: Vec<Value>) -> Value {
        let mut frame = Frame { function, arguments, values: BTreeMap::new(), locals: BTreeMap::new() };
        for (handle, local) in function.local_variables.iter() {
            let value = local.init.map_or_else(|| self.zero(local.ty), |init| self.get(&mut frame, init));
            frame.locals.insert(handle, value);
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
                        frame.values.insert(handle, value);
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
                    *frame.locals.get_mut(&local).unwrap().at_mut(&path) = value;
                }
                Statement::Call { function, arguments, result } => {
                    let arguments = arguments.iter().map(|a| self.get(frame, *a)).collect();
                    let value = self.run(&self.module.functions[*function], arguments);
                    frame.values.insert(result.unwrap(), value);
                }
                other => panic!("no {other:?} here"),
            }
        }
        Flow::Next
    }

    fn get(&self, frame: &mut Frame<'_>, handle: Handle<Expression>) -> Value {
        match frame.values.get(&handle) {
            Some(value) => value.clone(),
            None => self.expression(frame, handle),
        }
    }

    fn expression(&self, frame: &mut Frame<'_>, handle: Handle<Expression>) -> Value {
        match frame.function.expressions[handle].clone() {
            Expression::FunctionArgument(i) => frame.arguments[i as usize].clone(),
            Expression::LocalVariable(local) => Place(Root::Local(local), Vec::new()),
            Expression::GlobalVariable(global) => {
                Place(Root::Global(self.module.global_variables[global].name.clone().unwrap()), Vec::new())
            }
            Expression::Constant(constant) => self.global(self.module.constants[constant].init),
            Expression::Literal(literal) => self::literal(literal),
            Expression::ZeroValue(ty) => self.zero(ty),
            Expression::Compose { ty, components } => {
                let parts = components.iter().map(|c| self.get(frame, *c)).collect();
                self.compose(ty, parts)
            }
            Expression::Splat { size, value } => Many(vec![self.get(frame, value); size as usize]),
            Expression::Access { base, index } => {
                let U(index) = self.get(frame, index) else { panic!("indices are u32") };
                member(self.get(frame, base), index as usize)
            }
            Expression::AccessIndex { base, index } => member(self.get(frame, base), index as usize),
            Expression::Swizzle { size, vector, pattern } => {
                let Many(parts) = self.get(frame, vector) else { panic!("swizzle of a scalar") };
                Many(pattern[..size as usize].iter().map(|&c| parts[c as usize].clone()).collect())
            }
            Expression::Load { pointer } => match self.get(frame, pointer) {
                Place(Root::Local(local), path) => frame.locals[&local].at(&path).clone(),
                Place(Root::Global(_), path) => self.buffer.at(&path).clone(),
                other => panic!("load from {other:?}"),
            },
            Expression::Unary { op, expr } => each(&[self.get(frame, expr)], &|v| match (op, v[0].clone()) {
                (UnaryOperator::Negate, F(v)) => F(-v),
                (UnaryOperator::LogicalNot, B(v)) => B(!v),
                other => panic!("no {other:?} here"),
            }),
            Expression::Binary { op, left, right } => {
                each(&[self.get(frame, left), self.get(frame, right)], &|v| binary(op, &v[0], &v[1]))
            }
            Expression::Select { condition, accept, reject } => {
                let operands = [condition, accept, reject].map(|h| self.get(frame, h));
                each(&operands, &|v| if v[0] == B(true) { v[1].clone() } else { v[2].clone() })
            }
            Expression::Math { fun, arg, arg1, arg2, .. } => {
                let operands: Vec<Value> =
                    [Some(arg), arg1, arg2].into_iter().flatten().map(|h| self.get(frame, h)).collect();
                math(fun, &operands)
            }
            Expression::As { expr, kind, convert: Some(_) } => each(&[self.get(frame, expr)], &|v| cast(kind, &v[0])),
            Expression::As { expr, kind: ScalarKind::Uint, convert: None } => each(&[self.get(frame, expr)], &|v| {
                if let F(v) = v[0] { U(v.to_bits()) } else { panic!("no bits of {v:?}") }
            }),
            Expression::ImageSample { image, coordinate, .. } => {
                let (image, at) = (self.image(frame, image), self.get(frame, coordinate).floats());
                let position = [f64::from(at[0]) * f64::from(image.width), f64::from(at[1]) * f64::from(image.height)];
                vector(&bilinear(image, position, WeightBits::Exact).map(|v| v as f32))
            }
            Expression::ImageLoad { image, coordinate, .. } => {
                let Many(at) = self.get(frame, coordinate) else { panic!("texels have two coordinates") };
                let (I(x), I(y)) = (&at[0], &at[1]) else { panic!("texel coordinates are i32") };
                let image = self.image(frame, image);
                let mut texel = vec![0.0, 0.0, 0.0, 1.0];
                let channels = image.texel(*x as u32, *y as u32);
                texel[..channels.len()].copy_from_slice(channels);
                vector(&texel)
            }
            Expression::ImageQuery { image, query: ImageQuery::Size { .. } } => {
                let image = self.image(frame, image);
                Many(vec![U(image.width), U(image.height)])
            }
            other => panic!("no {other:?} here"),
        }
    }

    fn image(&self, frame: &mut Frame<'_>, handle: Handle<Expression>) -> &Image {
        let Place(Root::Global(name), _) = self.get(frame, handle) else { panic!("textures are globals") };
        &self.textures[&name]
    }

    fn global(&self, handle: Handle<Expression>) -> Value {
        match &self.module.global_expressions[handle] {
            Expression::Literal(literal) => self::literal(*literal),
            Expression::Constant(constant) => self.global(self.module.constants[*constant].init),
            Expression::Compose { ty, components } => {
                self.compose(*ty, components.iter().map(|c| self.global(*c)).collect())
            }
            other => panic!("no {other:?} here"),
        }
    }

    /// Vectors are made of scalars and vectors, structures of their members.
    fn compose(&self, ty: Handle<naga::Type>, parts: Vec<Value>) -> Value {
        if !matches!(self.module.types[ty].inner, TypeInner::Vector { .. }) {
            return Many(parts);
        }
        let flat = |part| if let Many(inner) = part { inner } else { vec![part] };
        Many(parts.into_iter().flat_map(flat).collect())
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
            TypeInner::Vector { size, scalar: s } => Many(vec![scalar(s); *size as usize]),
            TypeInner::Struct { members, .. } => Many(members.iter().map(|m| self.zero(m.ty)).collect()),
            TypeInner::Array { base, size: naga::ArraySize::Constant(count), .. } => {
                Many(vec![self.zero(*base); count.get() as usize])
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

fn member(base: Value, index: usize) -> Value {
    match base {
        Place(root, mut path) => {
            path.push(index);
            Place(root, path)
        }
        Many(parts) => parts[index].clone(),
        other => panic!("no members in {other:?}"),
    }
}

/// Applies an operation to scalars, or component by component; scalars go with every component.
fn each(operands: &[Value], operation: &dyn Fn(&[Value]) -> Value) -> Value {
    let length = operands.iter().find_map(|v| if let Many(parts) = v { Some(parts.len()) } else { None });
    let Some(length) = length else { return operation(operands) };
    let component = |v: &Value, i: usize| if let Many(parts) = v { parts[i].clone() } else { v.clone() };
    Many((0..length).map(|i| operation(&operands.iter().map(|v| component(v, i)).collect::<Vec<_>>())).collect())
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

fn math(fun: MathFunction, operands: &[Value]) -> Value {
    use MathFunction as M;
    let dot = |a: &Value, b: &Value| a.floats().iter().zip(b.floats()).map(|(a, b)| a * b).sum::<f32>();
    match fun {
        M::Dot => return F(dot(&operands[0], &operands[1])),
        M::Length => return F(dot(&operands[0], &operands[0]).sqrt()),
        M::Normalize => {
            let length = dot(&operands[0], &operands[0]).sqrt();
            return vector(&operands[0].floats().iter().map(|v| v / length).collect::<Vec<_>>());
        }
        _ => {}
    }
    each(operands, &|v| {
        if let I(a) = v[0] {
            let other = |i: usize| if let I(b) = v[i] { b } else { panic!("mixed operands") };
            return match fun {
                M::Min => I(a.min(other(1))),
                M::Clamp => I(a.clamp(other(1), other(2))),
                _ => panic!("no {fun:?} of integers here"),
            };
        }
        let (a, b) = (v[0].float(), || v[1].float());
        F(match fun {
            M::Abs => a.abs(),
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
