//! The walk through functions: statements one by one, both sides of a branch whose condition is not known.

use std::collections::HashMap;

use luthier_manifest::{MATERIAL_WORDS, MaterialConstants};
use naga::{
    AddressSpace, ArraySize, Block, Expression, Function, Handle, Literal, Module, ScalarKind, Statement, StructMember,
    SwitchValue, Type, TypeInner,
};

use super::graph::{Graph, Id};
use super::value::{Step, Value};
use super::words::{Constant, Memory, Operation};
use super::{Sides, StaticCounts};

/// Reason why a text cannot be counted.
pub(super) type Reason = &'static str;

/// The most turns of a loop with a constant bound that are followed.
const TURNS: usize = 256;

/// State of the walk.
pub(super) struct Walk<'a> {
    pub(super) module: &'a Module,
    pub(super) graph: Graph,
    /// Names of textures with more than 4 bytes a texel.
    pub(super) wide: &'a [String],
    sides: Sides<'a>,
    /// Variables of functions, and private ones.
    slots: Vec<Value>,
    privates: HashMap<usize, usize>,
    inputs: u32,
}

/// A call: its arguments, its variables, and the values of expressions so far.
pub(super) struct Frame<'a> {
    pub(super) function: &'a Function,
    arguments: Vec<Value>,
    locals: HashMap<usize, usize>,
    pub(super) values: HashMap<usize, Value>,
}

/// Statements that come after a block.
#[derive(Clone, Copy)]
struct Rest<'a, 'r> {
    statements: &'a [Statement],
    next: Option<&'r Rest<'a, 'r>>,
}

/// Way in which a block is left.
#[derive(Debug, Clone, PartialEq)]
enum Flow {
    /// At its end. `is_cut` if a side that leaves the loop was not followed.
    Through {
        is_cut: bool,
    },
    Return(Option<Value>),
    Break,
    Continue,
}

const THROUGH: Flow = Flow::Through { is_cut: false };

impl<'a> Walk<'a> {
    pub(super) fn new(module: &'a Module, wide: &'a [String], sides: Sides<'a>) -> Self {
        Self { module, graph: Graph::new(), wide, sides, slots: Vec::new(), privates: HashMap::new(), inputs: 0 }
    }

    /// Counts of one evaluation under some lights.
    pub(super) fn evaluation(mut self, lights: u32) -> Result<StaticCounts, Reason> {
        let function = |name: &str| {
            self.module.functions.iter().map(|(_, f)| f).find(|function| function.name.as_deref() == Some(name))
        };
        for (handle, variable) in self.module.global_variables.iter().filter(|(_, v)| v.space == AddressSpace::Private)
        {
            let value = match variable.init {
                Some(init) => self.constant_expression(init)?,
                None => self.zero(variable.ty)?,
            };
            self.privates.insert(handle.index(), self.slots.len());
            self.slots.push(value);
        }
        let at_place = |name: &str| function(&format!("{name}_at")).or_else(|| function(name));
        let prepared = at_place("luthier_prepare").zip(function("luthier_light")).filter(|_| lights > 1);
        let eval = at_place("luthier_eval");
        let mut results = Vec::new();
        let material = self.input(ScalarKind::Uint);
        if let Sides::Of(on) = self.sides {
            self.graph.hold(material, Constant::Uint(on.material));
        }
        let material = Value::Scalar(material);
        let wo = self.direction();
        if let Some((prepare, light)) = prepared {
            let mut arguments = self.place(prepare, 2)?;
            arguments.extend([material, wo]);
            let prepared = self.call(prepare, arguments)?.ok_or("`luthier_prepare` returns nothing")?;
            for _ in 0..lights {
                let wi = self.direction();
                let value = self.call(light, vec![prepared.clone(), wi])?.ok_or("`luthier_light` returns nothing")?;
                value.scalars(&mut results);
            }
        } else {
            let eval = eval.ok_or("there is no function `luthier_eval`")?;
            let place = self.place(eval, 3)?;
            for _ in 0..lights {
                let wi = self.direction();
                let mut arguments = place.clone();
                arguments.extend([material.clone(), wi, wo.clone()]);
                let value = self.call(eval, arguments)?;
                value.ok_or("`luthier_eval` returns nothing")?.scalars(&mut results);
            }
        }
        Ok(self.graph.total(&results, self.sides == Sides::Both))
    }

    fn input(&mut self, kind: ScalarKind) -> Id {
        self.inputs += 1;
        self.graph.node(Operation::Input(self.inputs), Vec::new(), kind)
    }

    /// The place that a function takes before so many other arguments, if it takes one: what textures decide is not known, but for normals, whose frame a program
    /// may make.
    fn place(&mut self, function: &'a Function, others: usize) -> Result<Vec<Value>, Reason> {
        let Some(place) = function.arguments.first().filter(|_| function.arguments.len() > others) else {
            return Ok(Vec::new());
        };
        let TypeInner::Struct { members, .. } = &self.module.types[place.ty].inner else {
            return Err("a place is a structure");
        };
        Ok(vec![Value::Parts(members.iter().map(|member| self.unknown(member)).collect::<Result<_, _>>()?)])
    }

    /// A member of a place: +z where it is a normal.
    fn unknown(&mut self, member: &StructMember) -> Result<Value, Reason> {
        let is_level = match member.name.as_deref() {
            Some("normal") => true,
            Some("flake_normal") => self.has_no_flakes(),
            _ => false,
        };
        if !is_level {
            return self.of_inputs(member.ty);
        }
        let up = [0.0, 0.0, 1.0].map(|x: f32| Value::Scalar(self.graph.constant(Constant::float(x))));
        Ok(Value::Parts(up.to_vec()))
    }

    /// Whether a material is known, and has no flakes.
    fn has_no_flakes(&self) -> bool {
        let Sides::Of(on) = self.sides else { return false };
        let word = on.material as usize * MATERIAL_WORDS + MaterialConstants::FLAKES_WORD;
        on.words.get(word).is_some_and(|flakes| *flakes == [0.0; 4])
    }

    /// A value of a type, of which nothing is known but normals.
    fn of_inputs(&mut self, ty: Handle<Type>) -> Result<Value, Reason> {
        let module = self.module;
        Ok(match &module.types[ty].inner {
            TypeInner::Scalar(scalar) => Value::Scalar(self.input(scalar.kind)),
            TypeInner::Vector { size, scalar } => {
                Value::Parts((0..*size as usize).map(|_| Value::Scalar(self.input(scalar.kind))).collect())
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                Value::Parts((0..count.get()).map(|_| self.of_inputs(*base)).collect::<Result<_, _>>()?)
            }
            TypeInner::Struct { members, .. } => {
                Value::Parts(members.iter().map(|member| self.unknown(member)).collect::<Result<_, _>>()?)
            }
            _ => return Err("a place with a member of another type"),
        })
    }

    fn direction(&mut self) -> Value {
        Value::Parts((0..3).map(|_| Value::Scalar(self.input(ScalarKind::Float))).collect())
    }

    fn call(&mut self, function: &'a Function, arguments: Vec<Value>) -> Result<Option<Value>, Reason> {
        let mut frame = Frame { function, arguments, locals: HashMap::new(), values: HashMap::new() };
        let first = self.slots.len();
        for (handle, variable) in function.local_variables.iter() {
            let value = match variable.init {
                Some(init) => self.value(&mut frame, init)?,
                None => self.zero(variable.ty)?,
            };
            frame.locals.insert(handle.index(), self.slots.len());
            self.slots.push(value);
        }
        let flow = self.run(&mut frame, &function.body, None)?;
        self.slots.truncate(first);
        match flow {
            Flow::Return(value) => Ok(value),
            Flow::Through { .. } => Ok(None),
            Flow::Break | Flow::Continue => Err("a loop is left where there is none"),
        }
    }

    /// Runs statements, and then those that follow their block.
    fn run(
        &mut self,
        frame: &mut Frame<'a>,
        statements: &'a [Statement],
        rest: Option<&Rest<'a, '_>>,
    ) -> Result<Flow, Reason> {
        let mut is_cut = false;
        for (i, statement) in statements.iter().enumerate() {
            let after = &statements[i + 1..];
            match statement {
                Statement::Emit(range) => {
                    for handle in range.clone() {
                        let value = self.expression(frame, handle)?;
                        frame.values.insert(handle.index(), value);
                    }
                }
                Statement::Block(block) => {
                    let rest = Rest { statements: after, next: rest };
                    return self.run(frame, block, Some(&rest));
                }
                Statement::If { condition, accept, reject } => {
                    let condition = self.value(frame, *condition)?.scalar()?;
                    let known = self.graph.as_constant(condition);
                    if let Some(Constant::Bool(known)) = known {
                        let rest = Rest { statements: after, next: rest };
                        return self.run(frame, if known { accept } else { reject }, Some(&rest));
                    }
                    if let Some(Constant::Bool(held)) = self.graph.held(condition) {
                        let rest = Rest { statements: after, next: rest };
                        self.graph.branch(condition);
                        return self.run(frame, if held { accept } else { reject }, Some(&rest));
                    }
                    match self.branch(frame, condition, [accept, reject], after, rest)? {
                        Flow::Through { is_cut: cut } if !leaves(accept) && !leaves(reject) => is_cut |= cut,
                        flow => return Ok(flow),
                    }
                }
                Statement::Switch { selector, cases } => {
                    let selector = self.value(frame, *selector)?.scalar()?;
                    let rest = Rest { statements: after, next: rest };
                    return self.switch(frame, selector, cases, &rest);
                }
                Statement::Loop { body, continuing, break_if } => {
                    match self.turns(frame, body, continuing, *break_if)? {
                        Flow::Return(value) => return Ok(Flow::Return(value)),
                        _ => continue,
                    }
                }
                Statement::Break => return Ok(Flow::Break),
                Statement::Continue => return Ok(Flow::Continue),
                Statement::Return { value } => {
                    let value = value.map(|value| self.value(frame, value)).transpose()?;
                    return Ok(Flow::Return(value));
                }
                Statement::Store { pointer, value } => {
                    let value = self.value(frame, *value)?;
                    let Value::Place { slot, path } = self.value(frame, *pointer)? else {
                        return Err("an evaluation writes to a buffer");
                    };
                    let mut held = std::mem::replace(&mut self.slots[slot], Value::Resource(0));
                    let put = held.put(&mut self.graph, &path, &value);
                    self.slots[slot] = held;
                    put?;
                }
                Statement::Call { function, arguments, result } => {
                    let arguments =
                        arguments.iter().map(|&argument| self.value(frame, argument)).collect::<Result<Vec<_>, _>>()?;
                    let value = self.call(&self.module.functions[*function], arguments)?;
                    if let (Some(result), Some(value)) = (result, value) {
                        frame.values.insert(result.index(), value);
                    }
                }
                _ => return Err("a statement that no evaluation has"),
            }
        }
        match rest {
            Some(rest) => self.run(frame, rest.statements, rest.next),
            None => Ok(Flow::Through { is_cut }),
        }
    }

    /// Both sides of a branch. If a side returns or leaves a loop, what follows the branch belongs to the other.
    fn branch(
        &mut self,
        frame: &mut Frame<'a>,
        condition: Id,
        sides: [&'a Block; 2],
        after: &'a [Statement],
        rest: Option<&Rest<'a, '_>>,
    ) -> Result<Flow, Reason> {
        let takes_rest = sides.iter().any(|side| leaves(side));
        let rest = Rest { statements: after, next: rest };
        let (here, regions) = (self.graph.here, self.graph.branch(condition));
        let before = self.slots.clone();
        let mut ends = Vec::new();
        for (side, region) in sides.into_iter().zip(regions) {
            self.slots.clone_from(&before);
            self.graph.here = region;
            let flow = self.run(frame, side, takes_rest.then_some(&rest))?;
            self.graph.here = here;
            ends.push((flow, std::mem::take(&mut self.slots)));
        }
        let [(first, accepted), (second, rejected)] = <[_; 2]>::try_from(ends).map_err(|_| "a branch has two sides")?;
        let is_alike = std::mem::discriminant(&first) == std::mem::discriminant(&second);
        if !is_alike {
            // A side that leaves a loop is not taken: the other one goes on.
            let stays = |flow: &Flow| matches!(flow, Flow::Through { .. } | Flow::Continue);
            let (flow, slots) = if stays(&first) || !stays(&second) { (first, accepted) } else { (second, rejected) };
            self.slots = slots;
            return Ok(if flow == Flow::Continue { flow } else { Flow::Through { is_cut: true } });
        }
        // Variables of calls inside the sides are gone.
        let merged = (0..before.len()).map(|i| {
            if accepted[i] == rejected[i] {
                return Ok(accepted[i].clone());
            }
            Value::chosen(&mut self.graph, condition, &accepted[i], &rejected[i])
        });
        self.slots = merged.collect::<Result<_, _>>()?;
        Ok(match (first, second) {
            (Flow::Return(Some(a)), Flow::Return(Some(b))) => {
                Flow::Return(Some(Value::chosen(&mut self.graph, condition, &a, &b)?))
            }
            (Flow::Through { is_cut: a }, Flow::Through { is_cut: b }) => Flow::Through { is_cut: a || b },
            (flow, _) => flow,
        })
    }

    /// A choice among cases, as a chain of branches.
    fn switch(
        &mut self,
        frame: &mut Frame<'a>,
        selector: Id,
        cases: &'a [naga::SwitchCase],
        rest: &Rest<'a, '_>,
    ) -> Result<Flow, Reason> {
        if cases.iter().any(|case| case.fall_through && !case.body.is_empty()) {
            return Err("a case that falls through into the next");
        }
        // Values of one body: cases without a body of their own belong to the next.
        let mut groups: Vec<(Vec<SwitchValue>, &'a Block)> = Vec::new();
        let mut values = Vec::new();
        for case in cases {
            values.push(case.value);
            if !case.fall_through {
                groups.push((std::mem::take(&mut values), &case.body));
            }
        }
        groups.sort_by_key(|(values, _)| values.contains(&SwitchValue::Default));
        self.cases(frame, selector, &groups, rest)
    }

    fn cases(
        &mut self,
        frame: &mut Frame<'a>,
        selector: Id,
        groups: &[(Vec<SwitchValue>, &'a Block)],
        rest: &Rest<'a, '_>,
    ) -> Result<Flow, Reason> {
        let Some(((values, body), others)) = groups.split_first() else { return self.run(frame, &[], Some(rest)) };
        let mut condition = None;
        for value in values {
            let value = match value {
                SwitchValue::I32(value) => Constant::Int(*value),
                SwitchValue::U32(value) => Constant::Uint(*value),
                SwitchValue::Default => return self.case(frame, body, rest),
            };
            let value = self.graph.constant(value);
            let equal = self.graph.binary(naga::BinaryOperator::Equal, selector, value);
            condition = Some(match condition {
                None => equal,
                Some(other) => self.graph.binary(naga::BinaryOperator::LogicalOr, other, equal),
            });
        }
        let condition = condition.ok_or("a case without a value")?;
        if let Some(Constant::Bool(known)) = self.graph.as_constant(condition) {
            return if known { self.case(frame, body, rest) } else { self.cases(frame, selector, others, rest) };
        }
        if let Some(Constant::Bool(held)) = self.graph.held(condition) {
            self.graph.branch(condition);
            return if held { self.case(frame, body, rest) } else { self.cases(frame, selector, others, rest) };
        }
        let (here, regions) = (self.graph.here, self.graph.branch(condition));
        let before = self.slots.clone();
        self.graph.here = regions[0];
        let first = self.case(frame, body, rest)?;
        let accepted = std::mem::replace(&mut self.slots, before.clone());
        self.graph.here = regions[1];
        let second = self.cases(frame, selector, others, rest)?;
        let rejected = std::mem::take(&mut self.slots);
        self.graph.here = here;
        let merged = (0..before.len()).map(|i| Value::chosen(&mut self.graph, condition, &accepted[i], &rejected[i]));
        self.slots = merged.collect::<Result<_, _>>()?;
        match (first, second) {
            (Flow::Return(Some(a)), Flow::Return(Some(b))) => {
                Ok(Flow::Return(Some(Value::chosen(&mut self.graph, condition, &a, &b)?)))
            }
            (first, second) if std::mem::discriminant(&first) == std::mem::discriminant(&second) => Ok(first),
            _ => Err("cases of which only some return"),
        }
    }

    /// A case, and what follows its switch.
    fn case(&mut self, frame: &mut Frame<'a>, body: &'a Block, rest: &Rest<'a, '_>) -> Result<Flow, Reason> {
        match self.run(frame, body, None)? {
            Flow::Break | Flow::Through { .. } => self.run(frame, rest.statements, rest.next),
            flow => Ok(flow),
        }
    }

    fn turns(
        &mut self,
        frame: &mut Frame<'a>,
        body: &'a Block,
        continuing: &'a Block,
        break_if: Option<Handle<Expression>>,
    ) -> Result<Flow, Reason> {
        for _ in 0..TURNS {
            let is_cut = match self.run(frame, body, None)? {
                Flow::Return(value) => return Ok(Flow::Return(value)),
                Flow::Break => return Ok(THROUGH),
                Flow::Continue => false,
                Flow::Through { is_cut } => is_cut,
            };
            self.run(frame, continuing, None)?;
            let ends = match break_if {
                None => None,
                Some(condition) => {
                    let condition = self.value(frame, condition)?.scalar()?;
                    Some(self.graph.held(condition) != Some(Constant::Bool(false)))
                }
            };
            if ends == Some(true) || is_cut {
                return Ok(THROUGH);
            }
        }
        Ok(THROUGH)
    }

    /// The value of an expression that a statement uses.
    pub(super) fn value(&mut self, frame: &mut Frame<'a>, handle: Handle<Expression>) -> Result<Value, Reason> {
        if let Some(value) = frame.values.get(&handle.index()) {
            return Ok(value.clone());
        }
        let value = self.expression(frame, handle)?;
        Ok(value)
    }

    pub(super) fn argument(&self, frame: &Frame<'a>, number: u32) -> Result<Value, Reason> {
        frame.arguments.get(number as usize).cloned().ok_or("an argument is missing")
    }

    pub(super) fn local(&self, frame: &Frame<'a>, handle: Handle<naga::LocalVariable>) -> Result<Value, Reason> {
        let slot = *frame.locals.get(&handle.index()).ok_or("a variable is missing")?;
        Ok(Value::Place { slot, path: Vec::new() })
    }

    pub(super) fn global(&mut self, handle: Handle<naga::GlobalVariable>) -> Result<Value, Reason> {
        let variable = &self.module.global_variables[handle];
        Ok(match variable.space {
            AddressSpace::Storage { .. } | AddressSpace::Uniform => {
                Value::Memory { variable: handle.index(), path: Vec::new() }
            }
            AddressSpace::Handle => Value::Resource(handle.index()),
            AddressSpace::Private => {
                let slot = *self.privates.get(&handle.index()).ok_or("a variable is missing")?;
                Value::Place { slot, path: Vec::new() }
            }
            _ => return Err("a variable of a kind that no evaluation has"),
        })
    }

    /// The value at a place.
    pub(super) fn load(&mut self, pointer: &Value) -> Result<Value, Reason> {
        match pointer {
            Value::Place { slot, path } => {
                let held = std::mem::replace(&mut self.slots[*slot], Value::Resource(0));
                let value = held.at(&mut self.graph, path);
                self.slots[*slot] = held;
                value
            }
            Value::Memory { variable, path } => {
                let global = self.module.global_variables.iter().nth(*variable).ok_or("a buffer is missing")?.1;
                let memory = match global.space {
                    AddressSpace::Uniform => Memory::Uniform,
                    _ if global.name.as_deref() == Some("luthier_materials") => Memory::Record,
                    _ => Memory::Buffer,
                };
                let (mut ty, mut steps) = (global.ty, Vec::new());
                for (i, &step) in path.iter().enumerate() {
                    ty = match &self.module.types[ty].inner {
                        TypeInner::Array { base, .. } => *base,
                        TypeInner::Struct { members, .. } => members[self.known(step)?].ty,
                        // A component of a vector is read with the vector.
                        TypeInner::Vector { .. } => {
                            let whole = self.read(memory, *variable, ty, &steps)?;
                            let rest = path[i..].iter().map(|&id| self.step(id)).collect::<Vec<_>>();
                            return whole.at(&mut self.graph, &rest);
                        }
                        _ => return Err("a buffer of a type that no evaluation has"),
                    };
                    steps.push(step);
                }
                self.read(memory, *variable, ty, &steps)
            }
            _ => Err("a place is expected"),
        }
    }

    /// Reads a value of a type from a buffer: a scalar or a vector at a time.
    fn read(&mut self, memory: Memory, variable: usize, ty: Handle<Type>, path: &[Id]) -> Result<Value, Reason> {
        let parts: Vec<Handle<Type>> = match &self.module.types[ty].inner {
            TypeInner::Scalar(scalar) => {
                let addresses = self.addresses(path);
                return Ok(Value::Scalar(self.graph.node(Operation::Read(memory, variable), addresses, scalar.kind)));
            }
            TypeInner::Vector { size, scalar } => {
                let addresses = self.addresses(path);
                let word = match (self.sides, memory, addresses.as_slice()) {
                    (Sides::Of(on), Memory::Record, [address]) => match self.graph.held(*address) {
                        Some(Constant::Uint(index)) => Some(*on.words.get(index as usize).ok_or("a word is missing")?),
                        _ => None,
                    },
                    _ => None,
                };
                let whole = self.graph.node(Operation::Read(memory, variable), addresses, scalar.kind);
                let parts = self.spread(whole, *size as usize, scalar.kind);
                for (part, value) in parts.parts()?.iter().zip(word.iter().flatten()) {
                    let id = part.scalar()?;
                    self.graph.hold(id, Constant::float(*value));
                }
                return Ok(parts);
            }
            TypeInner::Struct { members, .. } => members.iter().map(|member| member.ty).collect(),
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => vec![*base; count.get() as usize],
            _ => return Err("a buffer of a type that no evaluation has"),
        };
        let mut values = Vec::new();
        for (i, part) in (0..).zip(parts) {
            let mut path = path.to_vec();
            path.push(self.graph.constant(Constant::Uint(i)));
            values.push(self.read(memory, variable, part, &path)?);
        }
        Ok(Value::Parts(values))
    }

    /// Components of what a read gives.
    pub(super) fn spread(&mut self, whole: Id, count: usize, kind: ScalarKind) -> Value {
        let parts =
            (0..count as u32).map(|i| Value::Scalar(self.graph.node(Operation::Component(i), vec![whole], kind)));
        Value::Parts(parts.collect())
    }

    /// Numbers of a path; a constant that is added to one is part of the instruction that reads.
    fn addresses(&mut self, path: &[Id]) -> Vec<Id> {
        let mut found = Vec::new();
        for &step in path {
            let offset =
                self.graph.as_sum(step).filter(|sum| sum.iter().any(|&id| self.graph.as_constant(id).is_some()));
            found.push(match offset {
                Some(sum) => self.graph.node(Operation::Address, sum.to_vec(), ScalarKind::Uint),
                None => step,
            });
        }
        found
    }

    pub(super) fn known(&self, id: Id) -> Result<usize, Reason> {
        match self.graph.as_constant(id) {
            Some(Constant::Uint(value)) => Ok(value as usize),
            Some(Constant::Int(value)) => usize::try_from(value).map_err(|_| "a negative index"),
            _ => Err("an index of a structure is not known"),
        }
    }

    pub(super) fn step(&self, id: Id) -> Step {
        self.known(id).map_or(Step::Unknown(id), Step::Known)
    }

    /// The zero of a type.
    pub(super) fn zero(&mut self, ty: Handle<Type>) -> Result<Value, Reason> {
        let module = self.module;
        Ok(match &module.types[ty].inner {
            TypeInner::Scalar(scalar) => Value::Scalar(self.graph.constant(Constant::zero(scalar.kind))),
            TypeInner::Vector { size, scalar } => {
                let zero = self.graph.constant(Constant::zero(scalar.kind));
                Value::Parts(vec![Value::Scalar(zero); *size as usize])
            }
            TypeInner::Matrix { columns, rows, scalar } => {
                let zero = self.graph.constant(Constant::zero(scalar.kind));
                Value::Parts(vec![Value::Parts(vec![Value::Scalar(zero); *rows as usize]); *columns as usize])
            }
            TypeInner::Array { base, size: ArraySize::Constant(count), .. } => {
                Value::Parts(vec![self.zero(*base)?; count.get() as usize])
            }
            TypeInner::Struct { members, .. } => {
                Value::Parts(members.iter().map(|member| self.zero(member.ty)).collect::<Result<_, _>>()?)
            }
            _ => return Err("a type without a zero"),
        })
    }

    pub(super) fn literal(&mut self, literal: Literal) -> Result<Value, Reason> {
        let constant = match literal {
            Literal::F32(value) => Constant::float(value),
            Literal::AbstractFloat(value) => Constant::float(value as f32),
            Literal::F16(value) => Constant::float(value.to_f32()),
            Literal::U32(value) => Constant::Uint(value),
            Literal::I32(value) => Constant::Int(value),
            Literal::AbstractInt(value) => Constant::Int(value as i32),
            Literal::Bool(value) => Constant::Bool(value),
            _ => return Err("a literal of 16 or 64 bits"),
        };
        Ok(Value::Scalar(self.graph.constant(constant)))
    }
}

/// Whether a block may return, or leave the loop that it stands in.
fn leaves(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Return { .. } | Statement::Break | Statement::Continue => true,
        Statement::Block(block) => leaves(block),
        Statement::If { accept, reject, .. } => leaves(accept) || leaves(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| returns(&case.body)),
        Statement::Loop { body, .. } => returns(body),
        _ => false,
    })
}

/// Whether a block may return.
fn returns(block: &Block) -> bool {
    block.iter().any(|statement| match statement {
        Statement::Return { .. } => true,
        Statement::Block(block) => returns(block),
        Statement::If { accept, reject, .. } => returns(accept) || returns(reject),
        Statement::Switch { cases, .. } => cases.iter().any(|case| returns(&case.body)),
        Statement::Loop { body, .. } => returns(body),
        _ => false,
    })
}
