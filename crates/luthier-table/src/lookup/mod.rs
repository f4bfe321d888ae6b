//! Look-ups as WGSL: the text of a function that returns scale and bias.

mod axis;
mod closed;
mod fresnel;

use std::fmt::Write as _;

use crate::{Base, Cost, DfgTable, Nodes, Value};

pub use fresnel::{REFLECTANCE, REFLECTANCE_SAMPLER, REFLECTANCE_TEXTURE};

/// Name of the function.
pub const LOOKUP: &str = "luthier_dfg";
/// Name of the texture.
pub const TEXTURE: &str = "luthier_dfg_table";
/// Name of the sampler.
pub const SAMPLER: &str = "luthier_dfg_sampler";

/// Name of the function of a table's base.
const FORM: &str = "luthier_dfg_form";

/// Bindings of a table and its sampler in a shader.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Bindings {
    /// Bind group, or register space, or descriptor set.
    pub group: u32,
    /// Number of the texture.
    pub texture: u32,
    /// Number of the sampler.
    pub sampler: u32,
}

impl Default for Bindings {
    /// Texture 0 and sampler 1 of group 0.
    fn default() -> Self {
        Self { group: 0, texture: 0, sampler: 1 }
    }
}

impl DfgTable {
    /// WGSL of `fn luthier_dfg(cos_theta: f32, alpha: f32) -> vec2<f32>`, which reads this table and returns scale and
    /// bias. None if the channels do not determine them, or an axis is periodic.
    ///
    /// The text declares the texture [`TEXTURE`] and the sampler [`SAMPLER`], which must filter linearly and clamp to
    /// the edge. Inputs are clamped to 0..1. Channels that are not stored follow from the others: albedo = scale + bias
    /// = 1 - loss. A base is a function of its own, `luthier_dfg_form`. After the texels are added, neither scale nor
    /// bias falls below 0, and the albedo stays.
    pub fn wgsl(&self, bindings: Bindings) -> Option<String> {
        let result = result(&self.values, self.base.is_some())?;
        let Bindings { group, texture, sampler } = bindings;
        let mut out = format!(
            "@group({group}) @binding({texture}) var {TEXTURE}: texture_2d<f32>;\n\
             @group({group}) @binding({sampler}) var {SAMPLER}: sampler;\n\n"
        );
        if let Some(base) = &self.base {
            out.push_str(&base.form.wgsl_named(FORM));
            out.push('\n');
        }
        for line in self.comment() {
            let _ = writeln!(out, "/// {line}");
        }
        let _ = writeln!(out, "fn {LOOKUP}(cos_theta: f32, alpha: f32) -> vec2<f32> {{");
        let [angles, slopes] = self.layout.order();
        let names = ["x", "y"];
        let angle = &self.layout.angle;
        axis::write(&mut out, names[angles], angle, "cos_theta", self.size[angles])?;
        match &self.layout.slope {
            Some(slope) => axis::write(&mut out, names[slopes], slope, "alpha", self.size[slopes])?,
            None => {
                let _ = writeln!(out, "    let {} = 0.5;", names[slopes]);
            }
        }
        let _ = write!(out, "    let texel = textureSampleLevel({TEXTURE}, {SAMPLER}, vec2<f32>(x, y), 0.0)");
        if let Some(base) = &self.base {
            if !base.is_plain() {
                let _ = write!(out, " * {} + {}", float(base.scale), float(base.offset));
            }
            out.push_str(";\n");
            let _ = writeln!(out, "    let sum = {FORM}(cos_theta, alpha) + {result};");
            out.push_str("    return vec2<f32>(max(sum.x + min(sum.y, 0.0), 0.0), max(sum.y, 0.0));\n}\n");
        } else {
            let _ = writeln!(out, ";\n    return {result};\n}}");
        }
        Some(out)
    }

    /// Operations of a read beside the texture fetch; none without a look-up.
    pub fn cost(&self) -> Option<Cost> {
        result(&self.values, false)?;
        let axes = [Some(&self.layout.angle), self.layout.slope.as_ref()];
        let mut cost =
            axes.into_iter().flatten().try_fold(Cost::default(), |sum, axis| Some(sum + axis::cost(axis)?))?;
        let [scale, bias, albedo] =
            [Value::Scale, Value::Bias, Value::Albedo].map(|value| self.values.contains(&value));
        cost.multiply_adds += match (scale && bias, albedo) {
            (true, _) => 0,
            (false, true) => 1,
            (false, false) => 2,
        };
        if let Some(base) = &self.base {
            // Each channel times the factor, scale and bias added to the form's, and the clamp that takes a negative
            // bias from the scale.
            let channels = self.values.iter().filter(|value| value.is_split_sum()).count() as u32;
            let multiply_adds = 3 + if base.is_plain() { 0 } else { channels };
            cost = cost + base.form.cost() + Cost { multiply_adds, clamps: 3, specials: 0 };
        }
        Some(cost)
    }

    fn comment(&self) -> Vec<String> {
        let Self { distribution, masking, layout, values, size: [width, height], stored, base } = self;
        let values: Vec<&str> = values.iter().map(|value| value.name()).collect();
        let nodes = match layout.angle.nodes {
            Nodes::Ends => "ends".to_owned(),
            Nodes::CENTRES => "centres".to_owned(),
            Nodes::Offset(offset) => format!("offset {offset}"),
        };
        let mut lines = vec![
            "Scale and bias of the split sum: a rough surface reflects f0 * scale + bias of light from all around (f90 = 1).".to_owned(),
            format!("{}, masking {}. Linear filter, clamp to edge.", distribution.name(), masking.name()),
            format!("Table: {} over {layout}, nodes at {nodes}; {width} x {height}, {}.", values.join(", "), stored.name()),
        ];
        if let Some(base) = base {
            let Base { scale, offset, .. } = base;
            lines.push(format!("Texels times {scale} and {offset} are what {FORM} lacks."));
        }
        lines
    }
}

/// Scale and bias as an expression of a texel, or of the sums with the base.
fn result(values: &[Value], is_rest: bool) -> Option<String> {
    let [scale, bias, albedo, loss] = [Value::Scale, Value::Bias, Value::Albedo, Value::Loss].map(|value| {
        values.iter().zip(["r", "g", "b", "a"]).find(|(v, _)| **v == value).map(|(_, name)| format!("texel.{name}"))
    });
    let albedo = albedo.or_else(|| loss.map(|loss| format!("{}{loss}", if is_rest { "-" } else { "1.0 - " })));
    Some(match (scale, bias, albedo) {
        (Some(scale), Some(bias), _) => format!("vec2<f32>({scale}, {bias})"),
        (None, Some(bias), Some(albedo)) => format!("vec2<f32>({albedo} - {bias}, {bias})"),
        (Some(scale), None, Some(albedo)) => format!("vec2<f32>({scale}, {albedo} - {scale})"),
        _ => return None,
    })
}

/// A number as a WGSL literal that reads back as the same f32.
fn float(value: f64) -> String {
    format!("{:?}", value as f32)
}

#[cfg(test)]
mod tests {
    use luthier_optics::split_sum::Masking;
    use luthier_optics::stack::Distribution;

    use super::*;
    use crate::{ClosedForm, Layout, Preset};

    #[test]
    fn a_plain_table_has_a_plain_look_up() {
        let text = Preset::named("bevy").unwrap().table().wgsl(Bindings { group: 2, texture: 3, sampler: 4 }).unwrap();
        let code: Vec<&str> = text.lines().filter(|line| !line.starts_with("///") && !line.is_empty()).collect();
        let expected = [
            "@group(2) @binding(3) var luthier_dfg_table: texture_2d<f32>;",
            "@group(2) @binding(4) var luthier_dfg_sampler: sampler;",
            "fn luthier_dfg(cos_theta: f32, alpha: f32) -> vec2<f32> {",
            "    let x = saturate(cos_theta);",
            "    let y = sqrt(saturate(alpha));",
            "    let texel = textureSampleLevel(luthier_dfg_table, luthier_dfg_sampler, vec2<f32>(x, y), 0.0);",
            "    return vec2<f32>(texel.r, texel.g);",
            "}",
        ];
        assert_eq!(code, expected);
    }

    #[test]
    fn channels_that_say_too_little_have_no_look_up() {
        let table = |values: &[Value]| DfgTable { values: values.to_vec(), ..Preset::named("bevy").unwrap().table() };
        for values in [&[Value::Scale][..], &[Value::Albedo, Value::Loss], &[Value::Bias, Value::Zero], &[]] {
            assert_eq!(table(values).wgsl(Bindings::default()), None);
        }
        for (values, expected) in [
            (&[Value::Bias, Value::Loss][..], "vec2<f32>(1.0 - texel.g - texel.r, texel.r)"),
            (&[Value::Zero, Value::Albedo, Value::Scale], "vec2<f32>(texel.b, texel.g - texel.b)"),
        ] {
            assert!(table(values).wgsl(Bindings::default()).unwrap().contains(expected));
        }
    }

    #[test]
    fn a_base_is_added_to() {
        let form = ClosedForm::fit(Distribution::Ggx, Masking::SmithCorrelated, 0.1, 0.01, 0.01).form;
        let bevy = Preset::named("bevy").unwrap().table();
        let values = vec![Value::Bias, Value::Loss];
        let base = Some(Base::normalised(form.clone(), 0.125));
        let table = DfgTable { values: values.clone(), base, ..bevy.clone() };
        let text = table.wgsl(Bindings::default()).unwrap();
        for line in [
            "fn luthier_dfg_form(cos_theta: f32, alpha: f32) -> vec2<f32> {",
            "    let texel = textureSampleLevel(luthier_dfg_table, luthier_dfg_sampler, vec2<f32>(x, y), 0.0) * 0.25 + -0.125;",
            "    let sum = luthier_dfg_form(cos_theta, alpha) + vec2<f32>(-texel.g - texel.r, texel.r);",
        ] {
            assert!(text.contains(&format!("{line}\n")), "{line}\n{text}");
        }
        let plain = DfgTable { values, ..bevy };
        let [both, alone] = [&table, &plain].map(|table| table.cost().unwrap());
        assert_eq!(both, alone + form.cost() + Cost { multiply_adds: 5, clamps: 3, specials: 0 });
    }

    #[test]
    fn a_row_is_read_in_its_middle() {
        let layout = Layout::parse("theta", Nodes::CENTRES).unwrap();
        let row = DfgTable { layout, size: [16, 1], ..Preset::named("bevy").unwrap().table() };
        assert!(row.wgsl(Bindings::default()).unwrap().contains("    let y = 0.5;\n"));
    }
}
