//! Look-ups of engines' tables: in every language, and reading what the table says.

use std::collections::BTreeMap;

use luthier_lut::{Image, WeightBits, bilinear};
use luthier_optics::split_sum::Masking;
use luthier_optics::stack::Distribution;
use luthier_shader::{Target, library, library_spirv};
use luthier_table::{
    Base, Bindings, ClosedForm, DfgTable, FresnelLayout, FresnelTable, LOOKUP, Layout, Nodes, Preset, REFLECTANCE,
    REFLECTANCE_TEXTURE, SAMPLER, Stored, TEXTURE, Value,
};

use crate::judges::{accept_glsl_es, compile, is_installed, validate_spirv};
use crate::machine::Machine;
use crate::machine::Value::F;

const BINDINGS: Bindings = Bindings { group: 1, texture: 5, sampler: 6 };

/// The tables of engines, and layouts with all mappings, quantities and positions of nodes.
fn tables() -> Vec<DfgTable> {
    let layouts = [
        ("cos_theta=0.01..1^1.5,alpha=0.01..1^3", Nodes::Ends, [12, 10]),
        ("-cos_theta^2,alpha^4", Nodes::Ends, [9, 7]),
        ("alpha=0.01..1@log,-theta", Nodes::CENTRES, [8, 11]),
        ("theta,-alpha_sq", Nodes::Offset(0.0), [8, 8]),
        ("sqrt_roughness,cos_theta_sq", Nodes::Ends, [6, 5]),
        ("-sqrt_cos_theta,roughness=0.1..1", Nodes::Offset(1.0), [10, 6]),
        ("cos_theta", Nodes::CENTRES, [16, 1]),
    ];
    let values: [&[Value]; 3] =
        [&[Value::Bias, Value::Loss], &[Value::Zero, Value::Albedo, Value::Scale], &[Value::Scale, Value::Bias]];
    let custom = layouts.into_iter().zip(values.into_iter().cycle()).map(|((axes, nodes, size), values)| DfgTable {
        distribution: Distribution::Ggx,
        masking: Masking::SmithCorrelated,
        layout: Layout::parse(axes, nodes).unwrap(),
        values: values.to_vec(),
        size,
        stored: Stored::Half,
        base: None,
    });
    Preset::ALL.iter().map(Preset::table).chain(custom).collect()
}

fn in_every_language(wgsl: &str, has_table: bool) {
    for target in Target::TEXT {
        let text = library(wgsl, target).unwrap();
        let kind = match target {
            Target::Hlsl => "float2",
            Target::Msl => "metal::float2",
            Target::Wgsl => "fn",
            _ => "vec2",
        };
        assert!(text.contains(&format!("{kind} {LOOKUP}(")), "{target}:\n{text}");
        assert_eq!(text.contains(TEXTURE), has_table, "{target}:\n{text}");
        let is_glsl = matches!(target, Target::Glsl450 | Target::GlslEs300);
        assert_eq!(text.contains(SAMPLER), has_table && !is_glsl, "{target}:\n{text}");
    }
    let spirv = library_spirv(wgsl).unwrap();
    assert_eq!(spirv[..4], 0x0723_0203_u32.to_le_bytes());
}

/// The Khronos compiler reads GLSL and HLSL around the look-ups, and the validator the libraries in SPIR-V.
#[test]
fn khronos_tools_accept_look_ups() {
    if !is_installed("glslangValidator", "glslang-tools") || !is_installed("spirv-val", "spirv-tools") {
        return;
    }
    let folder = tempfile::TempDir::new().unwrap();
    let form = ClosedForm::fit(Distribution::Ggx, Masking::SmithCorrelated, 0.1, 0.01, 0.01).form;
    let tables = tables();
    let texts = tables.iter().map(|table| table.wgsl(Bindings { group: 0, ..BINDINGS }).unwrap());
    let beside = beside_form("cos_theta^4,alpha^2", &[Value::Bias, Value::Loss]);
    let beside = beside.wgsl(Bindings { group: 0, ..BINDINGS }).unwrap();
    for wgsl in texts.chain([form.wgsl(), beside]) {
        let glsl = |target, head: &str| {
            let body = library(&wgsl, target).unwrap();
            let out = "layout(location = 0) out vec4 color;\nvoid main() {\n    color = vec4(luthier_dfg(0.5, 0.5), 0.0, 1.0);\n}";
            format!("{head}\n{body}\n{out}\n")
        };
        compile(&glsl(Target::Glsl450, "#version 450 core"), folder.path(), "look-up", &["-G"]);
        let es = glsl(Target::GlslEs300, "#version 300 es\nprecision highp float;\nprecision highp int;");
        accept_glsl_es("look-up", &es, folder.path());
        let body = library(&wgsl, Target::Hlsl).unwrap();
        let hlsl =
            format!("{body}\nfloat4 main() : SV_Target {{\n    return float4(luthier_dfg(0.5, 0.5), 0.0, 1.0);\n}}\n");
        compile(&hlsl, folder.path(), "look-up", &["-D", "-V", "-e", "main"]);
        let module = folder.path().join("library.spv");
        std::fs::write(&module, library_spirv(&wgsl).unwrap()).unwrap();
        // No Vulkan environment has libraries.
        validate_spirv(&module, "spv1.3", "look-up", &wgsl);
    }
}

/// Texels that differ from neighbour to neighbour, so that a wrong position shows.
fn uneven(table: &DfgTable) -> Image {
    let mut image = Image::zeros(table.size[0], table.size[1], table.values.len() as u32);
    let mut state = 1_u32;
    for value in &mut image.data {
        state = state.wrapping_mul(747_796_405).wrapping_add(2_891_336_453);
        *value = (state >> 8) as f32 / 16_777_216.0;
    }
    image
}

/// Scale and bias of a texel.
fn scale_and_bias(values: &[Value], texel: [f64; 4]) -> [f64; 2] {
    let channel = |value: Value| values.iter().position(|v| *v == value).map(|i| texel[i]);
    let albedo = || channel(Value::Albedo).unwrap_or_else(|| 1.0 - channel(Value::Loss).unwrap());
    let bias = channel(Value::Bias).unwrap_or_else(|| albedo() - channel(Value::Scale).unwrap());
    [channel(Value::Scale).unwrap_or_else(|| albedo() - bias), bias]
}

#[test]
fn look_ups_exist_in_every_language() {
    for table in tables() {
        in_every_language(&table.wgsl(BINDINGS).unwrap(), true);
    }
}

/// The text, run in single precision, reads where the layout says: as the judge of tables does in double precision.
#[test]
fn look_ups_read_as_tables_are_judged() {
    for table in tables() {
        let texels = uneven(&table);
        let textures = BTreeMap::from([(TEXTURE.to_owned(), texels.clone())]);
        let machine = Machine::new(&table.wgsl(BINDINGS).unwrap(), &[], textures);
        for (i, j) in (0..=12).flat_map(|i| (0..=12).map(move |j| (i, j))) {
            let [cos_theta, alpha] = [i, j].map(|k| (f64::from(k) / 12.0 + 0.003).min(1.0));
            let arguments = [cos_theta, alpha].map(|v| F(v as f32));
            let found = machine.call(LOOKUP, arguments.to_vec()).floats();
            let position = table.layout.position(table.size, [cos_theta.acos(), alpha]);
            let expected = scale_and_bias(&table.values, bilinear(&texels, position, WeightBits::Exact));
            for (found, expected) in found.iter().zip(expected) {
                // Single precision: some units in the last place of a coordinate, times the texels across.
                let limit = 1e-6 * f64::from(table.size[0].max(table.size[1])).max(50.0);
                let off = (f64::from(*found) - expected).abs();
                assert!(off < limit, "{} at {cos_theta} {alpha}: {found} {expected}", table.layout);
            }
        }
    }
}

/// The look-up of a table of three axes, run in single precision: at nodes it gives Fresnel's equations, between them what the judge of the table
/// reads, within its weights of 8 bits, and beyond an axis its end.
#[test]
fn reflectances_are_read_in_their_slices() {
    for (axes, nodes) in [
        ("cos_theta,ior_n,ior_k", Nodes::Ends),
        ("ior_k=0..8^2,-theta,ior_n=0.1..4@log", Nodes::CENTRES),
        ("ior_n=0.5..3,cos_theta_sq,-ior_k=1..4", Nodes::Ends),
    ] {
        let layout = FresnelLayout::parse(axes, nodes).unwrap();
        let table = FresnelTable { layout, size: [12, 9, 7], stored: Stored::Float };
        let texels = table.bake();
        let wgsl = table.wgsl(BINDINGS).unwrap();
        for target in Target::TEXT {
            assert!(library(&wgsl, target).unwrap().contains(&format!("{REFLECTANCE}(")), "{target}");
        }
        let machine = Machine::new(&wgsl, &[], BTreeMap::from([(REFLECTANCE_TEXTURE.to_owned(), texels.clone())]));
        let read = |place: [f64; 3]| {
            let found = machine.call(REFLECTANCE, place.map(|v| F(v as f32)).to_vec());
            f64::from(found.floats()[0])
        };
        let mut largest: f64 = 0.0;
        for i in 0..9 * 9 * 9 {
            let [c, n, k] = [i % 9, i / 9 % 9, i / 81].map(|v| f64::from(v) / 8.0);
            let place = [0.02 + 0.98 * c, 0.5 + 2.5 * n, 1.0 + 3.0 * k];
            let (found, expected) = (read(place), table.sample(&texels, place));
            // Half a step of a weight on each axis, of texels that differ by less than 1.
            assert!((found - expected).abs() < 1.5 / 256.0, "{axes} at {place:?}: {found} {expected}");
            largest = largest.max((found - FresnelTable::exact(place)).abs());
        }
        assert!(largest > 1e-4, "{axes}: a table so small errs");
        assert_eq!(
            read([0.5, 500.0, 2.0]),
            read([0.5, layout.axes().iter().find(|a| a.quantity.name() == "ior_n").unwrap().max, 2.0])
        );
    }
    // Nodes alone: the corners of the default layout.
    let layout = FresnelLayout::parse("cos_theta,ior_n=1..3,ior_k=0..4", Nodes::Ends).unwrap();
    let table = FresnelTable { layout, size: [5, 5, 5], stored: Stored::Float };
    let textures = BTreeMap::from([(REFLECTANCE_TEXTURE.to_owned(), table.bake())]);
    let machine = Machine::new(&table.wgsl(BINDINGS).unwrap(), &[], textures);
    for i in 0..125 {
        let [c, n, k] = [i % 5, i / 5 % 5, i / 25].map(f64::from);
        let place = [c / 4.0, 1.0 + n / 2.0, k];
        let found = machine.call(REFLECTANCE, place.map(|v| F(v as f32)).to_vec()).floats()[0];
        let expected = FresnelTable::exact(place);
        assert!((f64::from(found) - expected).abs() < 2e-6, "{place:?}: {found} {expected}");
    }
}

/// A table of bytes beside a form.
fn beside_form(axes: &str, values: &[Value]) -> DfgTable {
    let form = ClosedForm::fit(Distribution::Ggx, Masking::SmithCorrelated, 0.1, 0.01, 0.01).form;
    DfgTable {
        distribution: Distribution::Ggx,
        masking: Masking::SmithCorrelated,
        layout: Layout::parse(axes, Nodes::Ends).unwrap(),
        values: values.to_vec(),
        size: [9, 7],
        stored: Stored::Unorm8,
        base: Some(Base::normalised(form, 0.06)),
    }
}

/// Scale and bias are the form's and what the texels add; a bias below 0 is 0 at the same albedo.
#[test]
fn tables_are_added_to_forms() {
    let layouts = [
        ("cos_theta=0.01..1^4,alpha=0.01..1^2", &[Value::Bias, Value::Loss][..]),
        ("theta,-roughness", &[Value::Albedo, Value::Zero, Value::Scale]),
        ("alpha,-cos_theta", &[Value::Scale, Value::Bias]),
    ];
    let mut clamped = 0;
    for (axes, values) in layouts {
        let table = beside_form(axes, values);
        let wgsl = table.wgsl(BINDINGS).unwrap();
        in_every_language(&wgsl, true);
        let texels = uneven(&table);
        let textures = BTreeMap::from([(TEXTURE.to_owned(), texels.clone())]);
        let machine = Machine::new(&wgsl, &[], textures);
        let Base { form, scale: factor, offset } = table.base.as_ref().unwrap();
        for (i, j) in (0..=12).flat_map(|i| (0..=12).map(move |j| (i, j))) {
            let [cos_theta, alpha] = [i, j].map(|k| (f64::from(k) / 12.0 + 0.003).min(1.0));
            let found = machine.call(LOOKUP, [cos_theta, alpha].map(|v| F(v as f32)).to_vec()).floats();
            let position = table.layout.position(table.size, [cos_theta.acos(), alpha]);
            let rests = bilinear(&texels, position, WeightBits::Exact).map(|texel| texel * factor + offset);
            let rest = |value: Value| values.iter().position(|v| *v == value).map(|c| rests[c]);
            let albedo = || rest(Value::Albedo).or_else(|| Some(-rest(Value::Loss)?)).unwrap();
            let [scale, bias] = match (rest(Value::Scale), rest(Value::Bias)) {
                (Some(scale), Some(bias)) => [scale, bias],
                (Some(scale), None) => [scale, albedo() - scale],
                (_, bias) => [albedo() - bias.unwrap(), bias.unwrap()],
            };
            let of_form = form.eval_f32(cos_theta as f32, alpha as f32).map(f64::from);
            let [scale, bias] = [of_form[0] + scale, of_form[1] + bias];
            clamped += u32::from(bias < 0.0);
            let expected = [(scale + bias.min(0.0)).max(0.0), bias.max(0.0)];
            for (found, expected) in found.iter().zip(expected) {
                assert!(
                    (f64::from(*found) - expected).abs() < 1e-5,
                    "{axes} at {cos_theta} {alpha}: {found} {expected}"
                );
            }
        }
    }
    assert!(clamped > 0, "no bias below 0");
}

#[test]
fn closed_forms_compute_what_was_measured() {
    for (distribution, max_abs) in [(Distribution::Ggx, 0.1), (Distribution::Ggx, 5e-3), (Distribution::Beckmann, 0.01)]
    {
        let form = ClosedForm::fit(distribution, Masking::SmithCorrelated, max_abs, 0.01, 0.01).form;
        let wgsl = form.wgsl();
        in_every_language(&wgsl, false);
        let machine = Machine::new(&wgsl, &[], BTreeMap::new());
        for (i, j) in (0..=20).flat_map(|i| (0..=20).map(move |j| (i, j))) {
            let [cos_theta, alpha] = [i, j].map(|k| k as f32 / 20.0);
            let found = machine.call(LOOKUP, vec![F(cos_theta), F(alpha)]).floats();
            for (found, expected) in found.iter().zip(form.eval_f32(cos_theta, alpha)) {
                assert!((found - expected).abs() < 1e-6, "{cos_theta} {alpha}: {found} {expected}\n{wgsl}");
            }
        }
    }
}
