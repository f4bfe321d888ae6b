//! Nodes of graphs that are functions of their inputs.

use super::value::Value;

/// An input of a node, and its value where nothing is given.
type Given = (&'static str, f64);

/// Inputs of a node, and its function.
type Node = (&'static [Given], fn(&[Value]) -> Value);

/// The luminance of ACEScg, which is the default of the format.
const LUMA: [f64; 3] = [0.2722287, 0.6740818, 0.0536895];

/// Stands for coefficients that are not given.
const NONE: f64 = -1.0;

/// Coefficients of a luminance: those of the format where none are given.
fn luma(given: Value) -> [f64; 3] {
    if given.count == 1 && given.first() == NONE { LUMA } else { given.three() }
}

fn each(of: fn(f64) -> f64) -> impl Fn(&[Value]) -> Value {
    move |v| v[0].map(of)
}

fn mix(bg: Value, fg: Value, mix: Value) -> Value {
    bg.zip(mix, |bg, mix| bg * (1.0 - mix)).zip(fg.zip(mix, |fg, mix| fg * mix), |a, b| a + b)
}

fn compared(v: &[Value], holds: bool) -> Value {
    if holds { v[2] } else { v[3] }
}

fn divided(a: f64, b: f64) -> f64 {
    if b == 0.0 { 0.0 } else { a / b }
}

fn remapped(v: &[Value]) -> Value {
    let share = v[0].zip(v[1], |a, b| a - b).zip(v[2].zip(v[1], |a, b| a - b), divided);
    share.zip(v[4].zip(v[3], |a, b| a - b), |a, b| a * b).zip(v[3], |a, b| a + b)
}

fn smooth(v: &[Value]) -> Value {
    let share = v[0].zip(v[1], |a, b| a - b).zip(v[2].zip(v[1], |a, b| a - b), divided);
    let curved = share.map(|t| {
        let t = t.clamp(0.0, 1.0);
        t * t * (3.0 - 2.0 * t)
    });
    // Where both ends are one, it is a step.
    let is_beyond = v[0].zip(v[2], |value, high| f64::from(value >= high));
    curved.zip(is_beyond, f64::max)
}

/// Fits values into a range with a gamma between.
fn ranged(v: &[Value]) -> Value {
    let [value, in_low, in_high, gamma, out_low, out_high] = [v[0], v[1], v[2], v[3], v[4], v[5]];
    let share = value.zip(in_low, |a, b| a - b).zip(in_high.zip(in_low, |a, b| a - b), divided);
    let curved = share.zip(gamma, |a, g| a.signum() * libm::pow(a.abs(), divided(1.0, g)));
    let all = curved.zip(out_high.zip(out_low, |a, b| a - b), |a, b| a * b).zip(out_low, |a, b| a + b);
    if v[6].first() > 0.5 { all.zip(out_low, f64::max).zip(out_high, f64::min) } else { all }
}

fn dot(a: Value, b: Value) -> f64 {
    let count = a.count.max(b.count);
    let product = a.zip(b, |a, b| a * b);
    product.channels[..count].iter().sum()
}

/// Hue, saturation and value of a colour.
fn hsv([r, g, b]: [f64; 3]) -> [f64; 3] {
    let [least, most] = [r.min(g).min(b), r.max(g).max(b)];
    let chroma = most - least;
    if most <= 0.0 || chroma <= 0.0 {
        return [0.0, 0.0, most];
    }
    let hue = if r >= most {
        (g - b) / chroma
    } else if g >= most {
        2.0 + (b - r) / chroma
    } else {
        4.0 + (r - g) / chroma
    };
    [(hue / 6.0).rem_euclid(1.0), chroma / most, most]
}

/// The colour of a hue, a saturation and a value.
fn rgb([hue, saturation, value]: [f64; 3]) -> [f64; 3] {
    [5.0, 3.0, 1.0].map(|offset| {
        let k = (offset + hue * 6.0).rem_euclid(6.0);
        value - value * saturation * k.min(4.0 - k).clamp(0.0, 1.0)
    })
}

fn color(of: impl Fn([f64; 3]) -> [f64; 3], value: Value) -> Value {
    let [r, g, b] = of(value.three());
    Value { channels: [r, g, b, value.channels[3]], ..value.fitted(value.count.max(3)) }
}

fn saturated(value: Value, amount: f64, luma: [f64; 3]) -> Value {
    color(
        |rgb| {
            let grey: f64 = rgb.iter().zip(luma).map(|(c, l)| c * l).sum();
            rgb.map(|c| grey + (c - grey) * amount)
        },
        value,
    )
}

fn corrected(v: &[Value]) -> Value {
    let [hue, saturation, gamma, lift, gain, contrast, pivot, exposure] =
        [1, 2, 3, 4, 5, 6, 7, 8].map(|c: usize| v[c].first());
    let turned = color(
        |c| {
            let [h, s, v] = hsv(c);
            rgb([h + hue, s, v])
        },
        v[0],
    );
    let value = saturated(turned, saturation, LUMA);
    color(
        |rgb| {
            rgb.map(|c| {
                let c = c.signum() * libm::pow(c.abs(), divided(1.0, gamma));
                let c = (c * (1.0 - lift) + lift) * gain;
                ((c - pivot) * contrast + pivot) * libm::exp2(exposure)
            })
        },
        value,
    )
}

fn turned(v: &[Value]) -> Value {
    let [x, y, ..] = v[0].channels;
    let (sin, cos) = libm::sincos(v[1].first().to_radians());
    Value::new(&[cos * x + sin * y, cos * y - sin * x])
}

fn placed(v: &[Value]) -> Value {
    let [uv, pivot, scale, rotate, offset, order] = [v[0], v[1], v[2], v[3], v[4], v[5]];
    let plus = |a: Value, b: Value| a.zip(b, |a, b| a + b);
    let minus = |a: Value, b: Value| a.zip(b, |a, b| a - b);
    let about = minus(uv, pivot);
    if order.first() < 0.5 {
        plus(minus(turned(&[about.zip(scale, divided), rotate]), offset), pivot)
    } else {
        plus(turned(&[minus(about, offset), rotate]).zip(scale, divided), pivot)
    }
}

fn checkered(v: &[Value]) -> Value {
    let [u, w, ..] = v[2].zip(v[3], |a, b| a * b).zip(v[4], |a, b| a - b).channels;
    let odd = (u.floor() + w.floor()).rem_euclid(2.0) >= 1.0;
    if odd { v[0] } else { v[1] }
}

/// The function of a node of a category with its inputs; `None` for nodes that are none.
pub(super) fn node(category: &str) -> Option<Node> {
    const IN: &[Given] = &[("in", 0.0)];
    const PAIR: &[Given] = &[("in1", 0.0), ("in2", 0.0)];
    const BLEND: &[Given] = &[("fg", 0.0), ("bg", 0.0), ("mix", 1.0)];
    const CHOICE: &[Given] = &[("value1", 1.0), ("value2", 0.0), ("in1", 0.0), ("in2", 0.0)];
    Some(match category {
        "constant" => (&[("value", 0.0)], |v| v[0]),
        "dot" | "convert" => (IN, |v| v[0]),
        "add" => (PAIR, |v| v[0].zip(v[1], |a, b| a + b)),
        "subtract" => (PAIR, |v| v[0].zip(v[1], |a, b| a - b)),
        "divide" => (&[("in1", 0.0), ("in2", 1.0)], |v| v[0].zip(v[1], divided)),
        "modulo" => (&[("in1", 0.0), ("in2", 1.0)], |v| {
            v[0].zip(v[1], |a, b| if b == 0.0 { 0.0 } else { a - b * (a / b).floor() })
        }),
        "power" => (&[("in1", 0.0), ("in2", 1.0)], |v| v[0].zip(v[1], libm::pow)),
        "safepower" => (&[("in1", 0.0), ("in2", 1.0)], |v| v[0].zip(v[1], |a, b| a.signum() * libm::pow(a.abs(), b))),
        "min" => (PAIR, |v| v[0].zip(v[1], f64::min)),
        "max" => (PAIR, |v| v[0].zip(v[1], f64::max)),
        "invert" => (&[("in", 0.0), ("amount", 1.0)], |v| v[1].zip(v[0], |amount, v| amount - v)),
        "absval" => (IN, |v| each(f64::abs)(v)),
        "sign" => (IN, |v| each(|v| if v == 0.0 { 0.0 } else { v.signum() })(v)),
        "floor" => (IN, |v| each(f64::floor)(v)),
        "ceil" => (IN, |v| each(f64::ceil)(v)),
        "round" => (IN, |v| each(libm::round)(v)),
        "fract" => (IN, |v| each(|v| v - v.floor())(v)),
        "sqrt" => (IN, |v| each(|v| v.max(0.0).sqrt())(v)),
        "exp" => (IN, |v| each(libm::exp)(v)),
        "ln" => (&[("in", 1.0)], |v| each(|v| libm::log(v.max(f64::MIN_POSITIVE)))(v)),
        "sin" => (IN, |v| each(libm::sin)(v)),
        "cos" => (IN, |v| each(libm::cos)(v)),
        "tan" => (IN, |v| each(libm::tan)(v)),
        "asin" => (IN, |v| each(|v| libm::asin(v.clamp(-1.0, 1.0)))(v)),
        "acos" => (IN, |v| each(|v| libm::acos(v.clamp(-1.0, 1.0)))(v)),
        "atan2" => (&[("iny", 0.0), ("inx", 1.0)], |v| v[0].zip(v[1], libm::atan2)),
        "clamp" => (&[("in", 0.0), ("low", 0.0), ("high", 1.0)], |v| v[0].zip(v[1], f64::max).zip(v[2], f64::min)),
        "mix" => (&[("bg", 0.0), ("fg", 0.0), ("mix", 0.0)], |v| mix(v[0], v[1], v[2])),
        "remap" => (&[("in", 0.0), ("inlow", 0.0), ("inhigh", 1.0), ("outlow", 0.0), ("outhigh", 1.0)], remapped),
        "range" => (
            &[
                ("in", 0.0),
                ("inlow", 0.0),
                ("inhigh", 1.0),
                ("gamma", 1.0),
                ("outlow", 0.0),
                ("outhigh", 1.0),
                ("doclamp", 0.0),
            ],
            ranged,
        ),
        "smoothstep" => (&[("in", 0.0), ("low", 0.0), ("high", 1.0)], smooth),
        "contrast" => (&[("in", 0.0), ("amount", 1.0), ("pivot", 0.5)], |v| {
            v[0].zip(v[2], |a, b| a - b).zip(v[1], |a, b| a * b).zip(v[2], |a, b| a + b)
        }),
        "dotproduct" => (PAIR, |v| Value::number(dot(v[0], v[1]))),
        "magnitude" => (IN, |v| Value::number(dot(v[0], v[0]).sqrt())),
        "distance" => (PAIR, |v| {
            let way = v[0].zip(v[1], |a, b| a - b);
            Value::number(dot(way, way).sqrt())
        }),
        "normalize" => (IN, |v| {
            let length = dot(v[0], v[0]).sqrt();
            v[0].map(|c| divided(c, length))
        }),
        "luminance" => (&[("in", 0.0), ("lumacoeffs", NONE)], |v| saturated(v[0], 0.0, luma(v[1]))),
        "saturate" => {
            (&[("in", 0.0), ("amount", 1.0), ("lumacoeffs", NONE)], |v| saturated(v[0], v[1].first(), luma(v[2])))
        }
        "mincomponent" => (IN, |v| Value::number(v[0].all().iter().copied().fold(f64::INFINITY, f64::min))),
        "maxcomponent" => (IN, |v| Value::number(v[0].all().iter().copied().fold(f64::NEG_INFINITY, f64::max))),
        "rgbtohsv" => (IN, |v| color(hsv, v[0])),
        "hsvtorgb" => (IN, |v| color(rgb, v[0])),
        "hsvadjust" => (&[("in", 0.0), ("amount", 1.0)], |v| {
            let [turn, saturation, value] = v[1].three();
            color(
                |c| {
                    let [h, s, v] = hsv(c);
                    rgb([h + turn, s * saturation, v * value])
                },
                v[0],
            )
        }),
        "colorcorrect" => (
            &[
                ("in", 1.0),
                ("hue", 0.0),
                ("saturation", 1.0),
                ("gamma", 1.0),
                ("lift", 0.0),
                ("gain", 1.0),
                ("contrast", 1.0),
                ("contrastpivot", 0.5),
                ("exposure", 0.0),
            ],
            corrected,
        ),
        "combine2" => (PAIR, |v| {
            let all: Vec<f64> = v.iter().flat_map(|value| value.all().to_vec()).take(4).collect();
            Value::new(&all)
        }),
        "combine3" => {
            (&[("in1", 0.0), ("in2", 0.0), ("in3", 0.0)], |v| Value::new(&[v[0].first(), v[1].first(), v[2].first()]))
        }
        "combine4" => (&[("in1", 0.0), ("in2", 0.0), ("in3", 0.0), ("in4", 0.0)], |v| {
            Value::new(&[v[0].first(), v[1].first(), v[2].first(), v[3].first()])
        }),
        "ifgreater" => (CHOICE, |v| compared(v, v[0].first() > v[1].first())),
        "ifgreatereq" => (CHOICE, |v| compared(v, v[0].first() >= v[1].first())),
        "ifequal" => (&[("value1", 0.0), ("value2", 0.0), ("in1", 0.0), ("in2", 0.0)], |v| {
            compared(v, v[0].first() == v[1].first())
        }),
        "and" => (PAIR, |v| Value::number(f64::from(v[0].first() > 0.5 && v[1].first() > 0.5))),
        "or" => (PAIR, |v| Value::number(f64::from(v[0].first() > 0.5 || v[1].first() > 0.5))),
        "not" => (IN, |v| Value::number(f64::from(v[0].first() <= 0.5))),
        "switch" => (
            &[
                ("which", 0.0),
                ("in1", 0.0),
                ("in2", 0.0),
                ("in3", 0.0),
                ("in4", 0.0),
                ("in5", 0.0),
                ("in6", 0.0),
                ("in7", 0.0),
                ("in8", 0.0),
                ("in9", 0.0),
                ("in10", 0.0),
            ],
            |v| if v[0].first() < 10.0 { v[1 + v[0].first().max(0.0) as usize] } else { Value::number(0.0) },
        ),
        "plus" => (BLEND, |v| mix(v[1], v[1].zip(v[0], |a, b| a + b), v[2])),
        "minus" => (BLEND, |v| mix(v[1], v[1].zip(v[0], |a, b| a - b), v[2])),
        "difference" => (BLEND, |v| mix(v[1], v[1].zip(v[0], |a, b| (a - b).abs()), v[2])),
        "screen" => (BLEND, |v| mix(v[1], v[1].zip(v[0], |a, b| 1.0 - (1.0 - a) * (1.0 - b)), v[2])),
        "overlay" => (BLEND, |v| {
            let all = v[1].zip(v[0], |b, f| if b < 0.5 { 2.0 * f * b } else { 1.0 - 2.0 * (1.0 - f) * (1.0 - b) });
            mix(v[1], all, v[2])
        }),
        "inside" => (&[("in", 0.0), ("mask", 1.0)], |v| v[0].zip(v[1], |a, b| a * b)),
        "outside" => (&[("in", 0.0), ("mask", 0.0)], |v| v[0].zip(v[1], |a, b| a * (1.0 - b))),
        "UsdTransform2d" => (&[("in", 0.0), ("rotation", 0.0), ("scale", 1.0), ("translation", 0.0)], |v| {
            let turn = Value::number(-v[1].first());
            turned(&[v[0].zip(v[2], |a, b| a * b), turn]).zip(v[3], |a, b| a + b)
        }),
        "rotate2d" => (&[("in", 0.0), ("amount", 0.0)], turned),
        "place2d" => (
            &[
                ("texcoord", 0.0),
                ("pivot", 0.0),
                ("scale", 1.0),
                ("rotate", 0.0),
                ("offset", 0.0),
                ("operationorder", 0.0),
            ],
            placed,
        ),
        "ramplr" => (&[("valuel", 0.0), ("valuer", 0.0), ("texcoord", 0.0)], |v| {
            mix(v[0], v[1], Value::number(v[2].channels[0].clamp(0.0, 1.0)))
        }),
        "ramptb" => (&[("valuet", 0.0), ("valueb", 0.0), ("texcoord", 0.0)], |v| {
            mix(v[1], v[0], Value::number(v[2].channels[1].clamp(0.0, 1.0)))
        }),
        "ramp4" => {
            (&[("valuetl", 0.0), ("valuetr", 0.0), ("valuebl", 0.0), ("valuebr", 0.0), ("texcoord", 0.0)], |v| {
                let [x, y] = [0, 1].map(|c: usize| Value::number(v[4].channels[c].clamp(0.0, 1.0)));
                mix(mix(v[2], v[3], x), mix(v[0], v[1], x), y)
            })
        }
        "splitlr" => (&[("valuel", 0.0), ("valuer", 0.0), ("center", 0.5), ("texcoord", 0.0)], |v| {
            if v[3].channels[0] < v[2].first() { v[0] } else { v[1] }
        }),
        "splittb" => (&[("valuet", 0.0), ("valueb", 0.0), ("center", 0.5), ("texcoord", 0.0)], |v| {
            if v[3].channels[1] > v[2].first() { v[0] } else { v[1] }
        }),
        "checkerboard" => {
            (&[("color1", 1.0), ("color2", 0.0), ("texcoord", 0.0), ("uvtiling", 8.0), ("uvoffset", 0.0)], checkered)
        }
        _ => return None,
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn apply(category: &str, inputs: &[Value]) -> Value {
        node(category).unwrap().1(inputs)
    }

    #[test]
    fn hues_go_round() {
        for c in [[0.7, 0.2, 0.1], [0.1, 0.9, 0.3], [0.2, 0.1, 0.4], [0.5; 3]] {
            let back = rgb(hsv(c));
            assert!(back.iter().zip(c).all(|(a, b)| (a - b).abs() < 1e-12), "{c:?} {back:?}");
        }
        // A third of a turn makes green of red.
        assert!(rgb([1.0 / 3.0, 1.0, 1.0]).iter().zip([0.0, 1.0, 0.0]).all(|(a, b)| (a - b).abs() < 1e-12));
    }

    #[test]
    fn nodes_are_their_formulas() {
        let [a, b] = [Value::rgb([0.2, 0.4, 0.6]), Value::number(0.5)];
        assert_eq!(apply("mix", &[a, Value::rgb([1.0; 3]), b]).three(), [0.6, 0.7, 0.8]);
        assert_eq!(apply("invert", &[a, Value::number(1.0)]).three(), [0.8, 0.6, 0.4]);
        let remapped =
            apply("remap", &[b, Value::number(0.25), Value::number(0.75), Value::number(2.0), Value::number(4.0)]);
        assert_eq!(remapped.first(), 3.0);
        assert_eq!(apply("switch", &[Value::number(1.0), a, b]), b);
        // A quarter turn takes the first axis to minus the second.
        let [x, y, ..] = turned(&[Value::new(&[1.0, 0.0]), Value::number(90.0)]).channels;
        assert!(x.abs() < 1e-15 && (y + 1.0).abs() < 1e-15);
    }
}
