//! The graph of operations: equal ones are shared, constants folded, and what no result needs is not counted.

use std::collections::HashMap;

use naga::{BinaryOperator, MathFunction, ScalarKind, UnaryOperator};

use super::StaticCounts;
use super::words::{Constant, Operation};

/// Number of a node.
pub(super) type Id = u32;

/// Number of a region: the code between two branches.
pub(super) type Region = usize;

#[derive(Debug)]
struct Node {
    operation: Operation,
    arguments: Vec<Id>,
    kind: ScalarKind,
    region: Region,
    /// The value that it has for the material on whose path the walk is. No compiler knows it.
    held: Option<Constant>,
}

#[derive(Debug)]
struct Branch {
    condition: Id,
    parent: Region,
    sides: [Region; 2],
    /// Whether the material on whose path the walk is decides the side. The other one is not followed, and the taken one stays in the parent.
    is_decided: bool,
}

/// Operations with the regions where they stand.
#[derive(Debug, Default)]
pub(super) struct Graph {
    nodes: Vec<Node>,
    known: HashMap<(Operation, Vec<Id>), Vec<Id>>,
    /// The parent of each region.
    parents: Vec<Option<Region>>,
    branches: Vec<Branch>,
    /// Region of the operations to come.
    pub(super) here: Region,
}

impl Graph {
    pub(super) fn new() -> Self {
        Self { parents: vec![None], ..Self::default() }
    }

    /// Two regions below the present one, of which a condition chooses.
    pub(super) fn branch(&mut self, condition: Id) -> [Region; 2] {
        let first = self.parents.len();
        self.parents.extend([Some(self.here); 2]);
        let sides = [first, first + 1];
        let is_decided = self.held(condition).is_some();
        self.branches.push(Branch { condition, parent: self.here, sides, is_decided });
        sides
    }

    /// The value of a node for the material on whose path the walk is, if that decides it.
    pub(super) fn held(&self, id: Id) -> Option<Constant> {
        self.as_constant(id).or(self.nodes[id as usize].held)
    }

    /// States the value that a node has for the material on whose path the walk is.
    pub(super) fn hold(&mut self, id: Id, value: Constant) {
        self.nodes[id as usize].held = Some(value);
    }

    /// Whether a node of a region can be used in the present one.
    fn is_seen(&self, region: Region) -> bool {
        let mut at = Some(self.here);
        while let Some(here) = at {
            if here == region {
                return true;
            }
            at = self.parents[here];
        }
        false
    }

    pub(super) fn constant(&mut self, value: Constant) -> Id {
        let key = (Operation::Constant(value), Vec::new());
        if let Some(found) = self.known.get(&key) {
            return found[0];
        }
        let id = self.push(key.0, Vec::new(), value.kind(), 0);
        self.known.insert(key, vec![id]);
        id
    }

    pub(super) fn float(&mut self, value: f32) -> Id {
        self.constant(Constant::float(value))
    }

    pub(super) fn kind(&self, id: Id) -> ScalarKind {
        self.nodes[id as usize].kind
    }

    pub(super) fn as_constant(&self, id: Id) -> Option<Constant> {
        match self.nodes[id as usize].operation {
            Operation::Constant(value) => Some(value),
            _ => None,
        }
    }

    /// The sum that a node is, as its two addends.
    pub(super) fn as_sum(&self, id: Id) -> Option<[Id; 2]> {
        let node = &self.nodes[id as usize];
        (node.operation == Operation::Binary(BinaryOperator::Add)).then(|| [node.arguments[0], node.arguments[1]])
    }

    fn push(&mut self, operation: Operation, arguments: Vec<Id>, kind: ScalarKind, region: Region) -> Id {
        let held = self.value(operation, &arguments);
        self.nodes.push(Node { operation, arguments, kind, region, held });
        (self.nodes.len() - 1) as Id
    }

    /// The value of an operation for the material on whose path the walk is.
    fn value(&self, operation: Operation, arguments: &[Id]) -> Option<Constant> {
        let values = arguments.iter().map(|&id| self.held(id));
        match operation {
            Operation::Constant(_) | Operation::Read(..) | Operation::Component(_) => None,
            Operation::Address => fold(Operation::Binary(BinaryOperator::Add), &values.collect::<Option<Vec<_>>>()?),
            Operation::Select => match self.held(arguments[0])? {
                Constant::Bool(condition) => self.held(arguments[if condition { 1 } else { 2 }]),
                _ => None,
            },
            Operation::Binary(operator) => {
                // One side decides some.
                let decides = match operator {
                    BinaryOperator::LogicalAnd | BinaryOperator::And => Some(Constant::Bool(false)),
                    BinaryOperator::LogicalOr | BinaryOperator::InclusiveOr => Some(Constant::Bool(true)),
                    _ => None,
                };
                let values: Vec<Option<Constant>> = values.collect();
                if decides.is_some() && values.contains(&decides) {
                    return decides;
                }
                fold(operation, &values.into_iter().collect::<Option<Vec<_>>>()?)
            }
            _ => fold(operation, &values.collect::<Option<Vec<_>>>()?),
        }
    }

    /// The node of an operation, an equal one if there is any.
    pub(super) fn node(&mut self, operation: Operation, mut arguments: Vec<Id>, kind: ScalarKind) -> Id {
        if let Some(id) = self.folded(operation, &arguments) {
            return id;
        }
        use BinaryOperator as B;
        if matches!(operation, Operation::Binary(B::Add | B::Multiply | B::Equal | B::NotEqual))
            || matches!(operation, Operation::Math(MathFunction::Min | MathFunction::Max))
        {
            arguments.sort_unstable();
        }
        let key = (operation, arguments);
        let seen = self
            .known
            .get(&key)
            .and_then(|ids| ids.iter().copied().find(|&id| self.is_seen(self.nodes[id as usize].region)));
        if let Some(id) = seen {
            return id;
        }
        let id = self.push(operation, key.1.clone(), kind, self.here);
        self.known.entry(key).or_default().push(id);
        id
    }

    pub(super) fn unary(&mut self, operator: UnaryOperator, a: Id) -> Id {
        let kind = self.kind(a);
        self.node(Operation::Unary(operator), vec![a], kind)
    }

    pub(super) fn binary(&mut self, operator: BinaryOperator, a: Id, b: Id) -> Id {
        use BinaryOperator as B;
        let compares =
            matches!(operator, B::Equal | B::NotEqual | B::Less | B::LessEqual | B::Greater | B::GreaterEqual);
        let kind = if compares { ScalarKind::Bool } else { self.kind(a) };
        if operator == B::Divide && kind == ScalarKind::Float {
            let inverse = self.node(Operation::Reciprocal, vec![b], kind);
            return self.node(Operation::Binary(B::Multiply), vec![a, inverse], kind);
        }
        self.node(Operation::Binary(operator), vec![a, b], kind)
    }

    pub(super) fn math(&mut self, function: MathFunction, arguments: &[Id]) -> Id {
        let kind = self.kind(arguments[0]);
        self.node(Operation::Math(function), arguments.to_vec(), kind)
    }

    /// One of two values by a condition.
    pub(super) fn select(&mut self, condition: Id, accept: Id, reject: Id) -> Id {
        if accept == reject {
            return accept;
        }
        let kind = self.kind(accept);
        self.node(Operation::Select, vec![condition, accept, reject], kind)
    }

    /// A node that an operation comes down to without being carried out.
    fn folded(&mut self, operation: Operation, arguments: &[Id]) -> Option<Id> {
        let constants: Vec<Option<Constant>> = arguments.iter().map(|&id| self.as_constant(id)).collect();
        use BinaryOperator as B;
        match (operation, constants.as_slice()) {
            (Operation::Select, [Some(Constant::Bool(condition)), ..]) => {
                return Some(arguments[if *condition { 1 } else { 2 }]);
            }
            (Operation::Binary(B::Multiply), [a, b]) => {
                let is_one =
                    |c: &Option<Constant>| c.is_some_and(|c| c.is_float(1.0) || matches!(c, Constant::Uint(1)));
                if is_one(b) {
                    return Some(arguments[0]);
                }
                if is_one(a) {
                    return Some(arguments[1]);
                }
            }
            (Operation::Binary(B::Add | B::Subtract), [a, b]) => {
                let is_zero =
                    |c: &Option<Constant>| c.is_some_and(|c| c.is_float(0.0) || matches!(c, Constant::Uint(0)));
                if is_zero(b) {
                    return Some(arguments[0]);
                }
                if is_zero(a) && operation == Operation::Binary(B::Add) {
                    return Some(arguments[1]);
                }
            }
            _ => {}
        }
        let all: Option<Vec<Constant>> = constants.into_iter().collect();
        let value = fold(operation, &all?)?;
        Some(self.constant(value))
    }

    /// Counts of what some results need: of both sides of a branch, or of the dearer one.
    pub(super) fn total(&self, results: &[Id], takes_both: bool) -> StaticCounts {
        let mut uses = vec![0_u32; self.nodes.len()];
        let mut open: Vec<Id> = results.to_vec();
        self.mark(&mut uses, &mut open);
        // Conditions of branches whose sides have work, which may bring more work.
        let mut taken = vec![false; self.branches.len()];
        loop {
            let has_work = self.regions_with_work(&uses);
            let new: Vec<usize> = (0..self.branches.len())
                .filter(|&i| {
                    let branch = &self.branches[i];
                    !taken[i] && (branch.is_decided || branch.sides.iter().any(|&side| has_work[side]))
                })
                .collect();
            if new.is_empty() {
                break;
            }
            for i in new {
                taken[i] = true;
                open.push(self.branches[i].condition);
            }
            self.mark(&mut uses, &mut open);
        }
        let mut own = vec![StaticCounts::default(); self.parents.len()];
        for (node, _) in self.nodes.iter().zip(&uses).filter(|(_, uses)| **uses > 0) {
            if !self.is_fused(node, &uses) {
                own[node.region] = own[node.region].and(&node.operation.counts(node.kind));
            }
        }
        // Regions come after their parents, and branches after those that they stand in.
        for (branch, _) in self.branches.iter().zip(&taken).rev().filter(|(_, taken)| **taken) {
            let [a, b] = branch.sides.map(|side| own[side]);
            let taken = match takes_both {
                true => a.and(&b),
                false if a.operations() >= b.operations() => a,
                false => b,
            };
            let turn = StaticCounts { branches: 1, ..StaticCounts::default() };
            own[branch.parent] = own[branch.parent].and(&taken).and(&turn);
        }
        own[0]
    }

    fn mark(&self, uses: &mut [u32], open: &mut Vec<Id>) {
        while let Some(id) = open.pop() {
            uses[id as usize] += 1;
            if uses[id as usize] == 1 {
                open.extend(&self.nodes[id as usize].arguments);
            }
        }
    }

    /// Regions that have operations, or regions with operations below them.
    fn regions_with_work(&self, uses: &[u32]) -> Vec<bool> {
        let mut has_work = vec![false; self.parents.len()];
        for (node, _) in self.nodes.iter().zip(uses).filter(|(_, uses)| **uses > 0) {
            has_work[node.region] |= node.operation.counts(node.kind) != StaticCounts::default();
        }
        for region in (0..self.parents.len()).rev() {
            if let Some(parent) = self.parents[region] {
                has_work[parent] |= has_work[region];
            }
        }
        has_work
    }

    /// Whether an instruction carries out a sum together with a product that nothing else needs.
    fn is_fused(&self, node: &Node, uses: &[u32]) -> bool {
        let is_sum = matches!(node.operation, Operation::Binary(BinaryOperator::Add | BinaryOperator::Subtract));
        is_sum
            && node.kind == ScalarKind::Float
            && node.arguments.iter().any(|&argument| {
                let argument_of = &self.nodes[argument as usize];
                argument_of.operation == Operation::Binary(BinaryOperator::Multiply) && uses[argument as usize] == 1
            })
    }
}

/// The value of an operation on constants, where it is one that compilers carry out.
fn fold(operation: Operation, constants: &[Constant]) -> Option<Constant> {
    use BinaryOperator as B;
    use Constant as C;
    use MathFunction as F;
    let float = f32::from_bits;
    let (a, b) = match *constants {
        [a] => (a, None),
        [a, b] => (a, Some(b)),
        _ => return None,
    };
    Some(match (operation, a, b) {
        (Operation::Binary(operator), C::Float(a), Some(C::Float(b))) => {
            let (a, b) = (float(a), float(b));
            match operator {
                B::Add => C::float(a + b),
                B::Subtract => C::float(a - b),
                B::Multiply => C::float(a * b),
                B::Divide => C::float(a / b),
                _ => C::Bool(compared(operator, &a, &b)?),
            }
        }
        (Operation::Binary(operator), C::Uint(a), Some(C::Uint(b))) => match operator {
            B::Add => C::Uint(a.wrapping_add(b)),
            B::Subtract => C::Uint(a.wrapping_sub(b)),
            B::Multiply => C::Uint(a.wrapping_mul(b)),
            B::Divide => C::Uint(a.checked_div(b)?),
            B::Modulo => C::Uint(a.checked_rem(b)?),
            B::And => C::Uint(a & b),
            B::InclusiveOr => C::Uint(a | b),
            B::ShiftLeft => C::Uint(a.checked_shl(b)?),
            B::ShiftRight => C::Uint(a.checked_shr(b)?),
            _ => C::Bool(compared(operator, &a, &b)?),
        },
        (Operation::Binary(operator), C::Int(a), Some(C::Int(b))) => match operator {
            B::Add => C::Int(a.wrapping_add(b)),
            B::Subtract => C::Int(a.wrapping_sub(b)),
            B::Multiply => C::Int(a.wrapping_mul(b)),
            _ => C::Bool(compared(operator, &a, &b)?),
        },
        (Operation::Binary(operator), C::Bool(a), Some(C::Bool(b))) => match operator {
            B::LogicalAnd | B::And => C::Bool(a && b),
            B::LogicalOr | B::InclusiveOr => C::Bool(a || b),
            _ => C::Bool(compared(operator, &a, &b)?),
        },
        (Operation::Unary(UnaryOperator::Negate), C::Float(a), None) => C::float(-float(a)),
        (Operation::Unary(UnaryOperator::Negate), C::Int(a), None) => C::Int(a.wrapping_neg()),
        (Operation::Unary(UnaryOperator::LogicalNot), C::Bool(a), None) => C::Bool(!a),
        (Operation::Reciprocal, C::Float(a), None) => C::float(1.0 / float(a)),
        (Operation::Math(function), C::Float(a), None) => C::float(match function {
            F::Abs => float(a).abs(),
            F::Saturate => float(a).clamp(0.0, 1.0),
            F::Floor => float(a).floor(),
            F::Ceil => float(a).ceil(),
            F::Sqrt => float(a).sqrt(),
            F::InverseSqrt => 1.0 / float(a).sqrt(),
            F::Exp => libm::expf(float(a)),
            F::Exp2 => libm::exp2f(float(a)),
            F::Log => libm::logf(float(a)),
            F::Log2 => libm::log2f(float(a)),
            _ => return None,
        }),
        (Operation::Math(F::Min), C::Float(a), Some(C::Float(b))) => C::float(float(a).min(float(b))),
        (Operation::Math(F::Max), C::Float(a), Some(C::Float(b))) => C::float(float(a).max(float(b))),
        (Operation::Math(F::Pow), C::Float(a), Some(C::Float(b))) => C::float(libm::powf(float(a), float(b))),
        (Operation::Convert(ScalarKind::Uint), C::Float(a), None) => C::Uint(float(a) as u32),
        (Operation::Convert(ScalarKind::Sint), C::Float(a), None) => C::Int(float(a) as i32),
        (Operation::Convert(ScalarKind::Float), C::Uint(a), None) => C::float(a as f32),
        (Operation::Convert(ScalarKind::Float), C::Int(a), None) => C::float(a as f32),
        (Operation::Convert(ScalarKind::Uint), C::Int(a), None) => C::Uint(a as u32),
        (Operation::Convert(ScalarKind::Sint), C::Uint(a), None) => C::Int(a as i32),
        (Operation::Bits(ScalarKind::Uint), C::Float(a), None) => C::Uint(a),
        (Operation::Bits(ScalarKind::Float), C::Uint(a), None) => C::Float(a),
        _ => return None,
    })
}

fn compared<T: PartialOrd>(operator: BinaryOperator, a: &T, b: &T) -> Option<bool> {
    use BinaryOperator as B;
    Some(match operator {
        B::Equal => a == b,
        B::NotEqual => a != b,
        B::Less => a < b,
        B::LessEqual => a <= b,
        B::Greater => a > b,
        B::GreaterEqual => a >= b,
        _ => return None,
    })
}
