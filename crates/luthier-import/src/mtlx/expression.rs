//! Values that may depend on the place of a surface.

use std::collections::BTreeMap;
use std::sync::Arc;

use super::value::{Space, Value};

/// An affine map of texture coordinates: rows of a matrix, whose last column moves.
pub(super) type Affine = [[f64; 3]; 2];

/// Most steps of an expression.
const STEPS_MAX: usize = 4096;

/// A value at a place.
#[derive(Debug, Clone)]
pub(super) enum Expression {
    Constant(Value),
    Image(Arc<Image>),
    /// Texture coordinates. v grows upwards.
    Texcoord,
    /// A function of others; the number is the length of the longest way to a value without inputs.
    Apply(Op, Vec<Arc<Expression>>, usize),
}

/// A function of values.
#[derive(Clone)]
pub(super) enum Op {
    Product,
    Channel(usize),
    /// Normals of the texels of a normal map, and a factor on their slope.
    Normals,
    Other(Function),
}

pub(super) type Function = Arc<dyn Fn(&[Value]) -> Value + Send + Sync>;

impl std::fmt::Debug for Op {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Product => f.write_str("Product"),
            Self::Channel(channel) => write!(f, "Channel({channel})"),
            Self::Normals => f.write_str("Normals"),
            Self::Other(_) => f.write_str("Other"),
        }
    }
}

impl Op {
    fn apply(&self, values: &[Value]) -> Value {
        match self {
            Self::Product => values.iter().copied().reduce(|a, b| a.zip(b, |a, b| a * b)).unwrap_or(Value::number(1.0)),
            Self::Channel(channel) => Value::number(values[0].channels[*channel]),
            Self::Normals => {
                let texel = values[0].three();
                if texel == [0.0; 3] {
                    return Value::rgb([0.0, 0.0, 1.0]);
                }
                let [x, y, z] = texel.map(|c| 2.0 * c - 1.0);
                let [x, y] = [x * values[1].first(), y * values[1].first()];
                let length = (x * x + y * y + z * z).sqrt().max(f64::MIN_POSITIVE);
                Value::rgb([x / length, y / length, z / length])
            }
            Self::Other(of) => of(values),
        }
    }
}

/// A picture on a surface.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Image {
    /// Path relative to the document.
    pub(super) path: String,
    /// Numbers of a texel.
    pub(super) count: usize,
    pub(super) space: Space,
    /// From texture coordinates to those of the picture. v grows upwards in both.
    pub(super) placement: Affine,
    /// Whether it is repeated beyond its edges.
    pub(super) repeats: bool,
}

impl Expression {
    pub(super) fn number(value: f64) -> Arc<Self> {
        Arc::new(Self::Constant(Value::number(value)))
    }

    pub(super) fn rgb(value: [f64; 3]) -> Arc<Self> {
        Arc::new(Self::Constant(Value::rgb(value)))
    }

    /// A function of others; a constant where all of them are.
    pub(super) fn apply(op: Op, inputs: Vec<Arc<Self>>) -> Arc<Self> {
        let constants: Option<Vec<Value>> = inputs.iter().map(|input| input.constant()).collect();
        Arc::new(match constants {
            // As in computed pictures, what is no number is 0.
            Some(values) => Self::Constant(op.apply(&values).map(|v| if v.is_finite() { v } else { 0.0 })),
            None => {
                let height = 1 + inputs.iter().map(|input| input.height()).max().unwrap_or(0);
                Self::Apply(op, inputs, height)
            }
        })
    }

    /// A function of others that is none of the special ones.
    pub(super) fn of(inputs: &[&Arc<Self>], of: impl Fn(&[Value]) -> Value + Send + Sync + 'static) -> Arc<Self> {
        Self::apply(Op::Other(Arc::new(of)), inputs.iter().map(|input| Arc::clone(input)).collect())
    }

    /// The product of two.
    pub(super) fn times(self: &Arc<Self>, other: &Arc<Self>) -> Arc<Self> {
        let one = |of: &Arc<Self>| of.constant().is_some_and(|value| value.all().iter().all(|v| *v == 1.0));
        if one(other) && self.count_hint() >= other.count_hint() {
            return Arc::clone(self);
        }
        if one(self) && other.count_hint() >= self.count_hint() {
            return Arc::clone(other);
        }
        Self::apply(Op::Product, vec![Arc::clone(self), Arc::clone(other)])
    }

    /// Its numbers as far as they are known: 1 where they are not.
    fn count_hint(&self) -> usize {
        match self {
            Self::Constant(value) => value.count,
            Self::Image(image) => image.count,
            _ => 1,
        }
    }

    /// Length of the longest way to a value without inputs.
    pub(super) fn height(&self) -> usize {
        if let Self::Apply(_, _, height) = self { *height } else { 0 }
    }

    pub(super) fn constant(&self) -> Option<Value> {
        match self {
            Self::Constant(value) => Some(*value),
            _ => None,
        }
    }

    /// A picture times a constant, with the channel that counts; `None` for anything else.
    pub(super) fn scaled(&self) -> Option<(Value, &Arc<Image>, Option<usize>)> {
        match self {
            Self::Image(image) => Some((Value::number(1.0), image, None)),
            Self::Apply(Op::Channel(channel), inputs, _) => {
                let (factor, image, of) = inputs[0].scaled()?;
                (of.is_none() && factor.count == 1).then_some((factor, image, Some(*channel)))
            }
            Self::Apply(Op::Product, inputs, _) => {
                let [a, b] = inputs.as_slice() else { return None };
                let (value, other) = a.constant().map(|value| (value, b)).or(b.constant().map(|value| (value, a)))?;
                let (factor, image, channel) = other.scaled()?;
                Some((factor.zip(value, |a, b| a * b), image, channel))
            }
            _ => None,
        }
    }
}

/// An expression in steps, each of which is done once.
pub(super) struct Program {
    steps: Vec<Step>,
    pub(super) images: Vec<Arc<Image>>,
    /// Whether a step takes texture coordinates that are none of a picture.
    pub(super) has_texcoord: bool,
}

enum Step {
    Constant(Value),
    Image(usize),
    Texcoord,
    Apply(Op, Vec<usize>),
}

impl Program {
    /// `None` for expressions of too many steps.
    pub(super) fn new(expression: &Arc<Expression>) -> Option<Self> {
        let mut program = Self { steps: Vec::new(), images: Vec::new(), has_texcoord: false };
        program.add(expression, &mut BTreeMap::new())?;
        Some(program)
    }

    fn add(&mut self, expression: &Arc<Expression>, known: &mut BTreeMap<*const Expression, usize>) -> Option<usize> {
        let address = Arc::as_ptr(expression);
        if let Some(step) = known.get(&address) {
            return Some(*step);
        }
        let step = match &**expression {
            Expression::Constant(value) => Step::Constant(*value),
            Expression::Texcoord => {
                self.has_texcoord = true;
                Step::Texcoord
            }
            Expression::Image(image) => {
                let found = self.images.iter().position(|known| known == image);
                Step::Image(found.unwrap_or_else(|| {
                    self.images.push(Arc::clone(image));
                    self.images.len() - 1
                }))
            }
            Expression::Apply(op, inputs, _) => {
                let inputs = inputs.iter().map(|input| self.add(input, known)).collect::<Option<_>>()?;
                Step::Apply(op.clone(), inputs)
            }
        };
        self.steps.push(step);
        known.insert(address, self.steps.len() - 1);
        (self.steps.len() <= STEPS_MAX).then_some(self.steps.len() - 1)
    }

    /// How many values are computed for each place.
    pub(super) fn len(&self) -> usize {
        self.steps.len()
    }

    /// The value at texture coordinates; `image` has the texels of pictures there, `room` is for what lies between.
    pub(super) fn at(&self, uv: [f64; 2], image: impl Fn(usize) -> Value, room: &mut [Vec<Value>; 2]) -> Value {
        let [values, given] = room;
        values.clear();
        for step in &self.steps {
            let value = match step {
                Step::Constant(value) => *value,
                Step::Image(number) => image(*number),
                Step::Texcoord => Value::new(&uv),
                Step::Apply(op, inputs) => {
                    given.clear();
                    given.extend(inputs.iter().map(|input| values[*input]));
                    op.apply(given)
                }
            };
            values.push(value);
        }
        values.pop().unwrap_or(Value::number(0.0))
    }
}

/// Whether two expressions are one: normal maps of one picture, or one computed value.
pub(super) fn same(a: &Arc<Expression>, b: &Arc<Expression>) -> bool {
    match (&**a, &**b) {
        (Expression::Constant(a), Expression::Constant(b)) => a == b,
        (Expression::Image(a), Expression::Image(b)) => a == b,
        (Expression::Apply(Op::Normals, a, _), Expression::Apply(Op::Normals, b, _)) => {
            a.iter().zip(b).all(|(a, b)| same(a, b))
        }
        _ => Arc::ptr_eq(a, b),
    }
}

/// Moves and turns nothing.
pub(super) const UNPLACED: Affine = [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];

pub(super) fn placed(matrix: &Affine, [u, v]: [f64; 2]) -> [f64; 2] {
    matrix.map(|[a, b, c]| a * u + b * v + c)
}

/// The affine map that an expression of texture coordinates is; `None` where it is none.
pub(super) fn affine(expression: &Arc<Expression>) -> Option<Affine> {
    let program = Program::new(expression).filter(|program| program.images.is_empty())?;
    let at = |uv: [f64; 2]| {
        let [u, v, ..] = program.at(uv, |_| Value::number(0.0), &mut Default::default()).fitted(2).channels;
        [u, v]
    };
    let [origin, right, up] = [[0.0, 0.0], [1.0, 0.0], [0.0, 1.0]].map(at);
    let row = |c: usize| [right[c] - origin[c], up[c] - origin[c], origin[c]];
    let matrix = [row(0), row(1)];
    let is_affine = [[0.37, 0.81], [-3.1, 2.7], [12.3, -7.9]].iter().all(|uv| {
        let ([a, b], [c, d]) = (at(*uv), placed(&matrix, *uv));
        (a - c).abs().max((b - d).abs()) < 1e-9 * (1.0 + c.abs().max(d.abs()))
    });
    (is_affine && matrix.iter().flatten().all(|v| v.is_finite())).then_some(matrix)
}
