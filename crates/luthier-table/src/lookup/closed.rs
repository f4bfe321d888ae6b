//! WGSL of a closed form.

use std::fmt::Write as _;

use super::{LOOKUP, float};
use crate::closed::STRETCH;
use crate::{ClosedForm, Polynomial, Rational};

impl ClosedForm {
    /// WGSL of `fn luthier_dfg(cos_theta: f32, alpha: f32) -> vec2<f32>`, which computes scale and bias as [`Self::eval_f32`] does.
    pub fn wgsl(&self) -> String {
        self.wgsl_named(LOOKUP)
    }

    /// As [`Self::wgsl`], with another name of the function.
    pub(super) fn wgsl_named(&self, name: &str) -> String {
        let Self { distribution, masking, floor, .. } = self;
        let mut out = format!(
            "/// Scale and bias of the split sum: a rough surface reflects f0 * scale + bias of light from all around (f90 = 1).\n\
             /// {}, masking {}. Closed form over cos_theta >= {} and alpha >= {}; lower ones are read as these.\n\
             fn {name}(cos_theta: f32, alpha: f32) -> vec2<f32> {{\n",
            distribution.name(),
            masking.name(),
            floor[0],
            floor[1],
        );
        let [min_cos, min_alpha] = floor.map(float);
        let _ = write!(
            out,
            "    let c = clamp(cos_theta, {min_cos}, 1.0);\n    \
             let a = clamp(alpha, {min_alpha}, 1.0);\n    \
             let r_sq = c * c + {} * a * a;\n    \
             let inverse = inverseSqrt(r_sq);\n    \
             let t = c * inverse;\n    \
             let r = r_sq * inverse;\n",
            float(STRETCH)
        );
        quotient(&mut out, "loss", &self.loss, "a");
        quotient(&mut out, "cosine", &self.cosine, "r");
        out.push_str(
            "    let albedo = saturate(1.0 - loss);\n    \
             let rest = saturate(1.0 - cosine);\n    \
             let square = rest * rest;\n    \
             let bias = albedo * (square * square * rest);\n    \
             return vec2<f32>(albedo - bias, bias);\n}\n",
        );
        out
    }
}

/// `let NAME = ...;` of a quotient in t and another variable.
fn quotient(out: &mut String, name: &str, quotient: &Rational, y: &str) {
    if quotient.is_polynomial() {
        let _ = writeln!(out, "    let {name} = {};", horner(&quotient.numerator, y));
    } else {
        let _ = writeln!(out, "    let {name}_above = {};", horner(&quotient.numerator, y));
        let _ = writeln!(out, "    let {name}_below = {};", horner(&quotient.denominator, y));
        let _ = writeln!(out, "    let {name} = {name}_above / {name}_below;");
    }
}

/// A polynomial by Horner's rule, one line for every power of t.
fn horner(polynomial: &Polynomial, y: &str) -> String {
    let lines = polynomial.coefficients.chunks_exact(polynomial.degrees[1] + 1).map(|line| {
        let terms = line.iter().map(|c| float(f64::from(*c))).collect();
        if line.len() > 1 { format!("({})", nested(terms, y, " ")) } else { nested(terms, y, " ") }
    });
    nested(lines.collect(), "t", "\n        ")
}

/// A sum of terms times powers of a variable, the last term innermost.
fn nested(terms: Vec<String>, variable: &str, space: &str) -> String {
    let mut terms = terms.into_iter().rev().enumerate();
    let last = terms.next().map(|(_, last)| last).unwrap_or_default();
    terms.fold(last, |sum, (i, term)| {
        let sum = if i > 1 { format!("({sum})") } else { sum };
        match term.strip_prefix('-') {
            Some(term) => format!("{sum} * {variable}{space}- {term}"),
            None => format!("{sum} * {variable}{space}+ {term}"),
        }
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn polynomials_are_nested() {
        let plane = Polynomial { degrees: [2, 0], coefficients: vec![1.0, -2.0, 0.5] };
        assert_eq!(horner(&plane, "a"), "(0.5 * t\n        - 2.0) * t\n        + 1.0");
        let both = Polynomial { degrees: [1, 2], coefficients: vec![1.0, 2.0, 3.0, 4.0, 5.0, 6.0] };
        assert_eq!(horner(&both, "a"), "((6.0 * a + 5.0) * a + 4.0) * t\n        + ((3.0 * a + 2.0) * a + 1.0)");
    }
}
