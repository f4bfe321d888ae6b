//! Everything that can be emitted passes naga; what a set does not need is not in its text.

use crate::arithmetic::{directions, eval, full};
use crate::machine::Machine;
use crate::scenes::{
    Part, clear, conductor, dielectric, diffuse, filmed, forms, material, sets, stepped_tables, tables, text,
};
use luthier_lut::{Mapping, RowBase, TableKind, TexelFormat};
use luthier_manifest::{
    BUFFER_WORDS_MAX, CellsRecord, FunctionGroup, LAYER_WORDS, LayerKind, SurfaceEntry, material_buffer,
};
use luthier_shader::{
    Form, MaterialSet, ShaderError, TableFace, Target, bindings, complete, complete_spirv, emit, emit_constant,
    emit_spirv, validate,
};

/// Emits in all forms and languages; each is validated on the way.
fn emit_all(materials: &[luthier_manifest::MaterialEntry], tables: &[TableFace]) {
    let set = MaterialSet::new(materials, tables.to_vec());
    for form in forms(materials) {
        for target in Target::TEXT {
            complete(&set, form, target).unwrap_or_else(|e| panic!("{form} {target}: {e}"));
        }
        emit_spirv(&set, form).unwrap_or_else(|e| panic!("{form} library: {e}"));
        complete_spirv(&set, form).unwrap_or_else(|e| panic!("{form} shader: {e}"));
    }
}

fn richest() -> Vec<luthier_manifest::MaterialEntry> {
    sets().pop().unwrap().1
}

#[test]
fn every_set_passes() {
    for (name, materials) in sets() {
        let set = MaterialSet::new(&materials, tables());
        for form in forms(&materials) {
            for target in Target::TEXT {
                text((name, &set), form, target, Part::Complete);
            }
            emit_spirv(&set, form).unwrap_or_else(|e| panic!("{name} {form} library: {e}"));
            complete_spirv(&set, form).unwrap_or_else(|e| panic!("{name} {form} shader: {e}"));
        }
    }
}

/// HLSL and MSL are read by a lint as they are emitted: with all functions for each set and form, with each group alone for the sets of several
/// models, and with the numbers of a material in the code.
#[test]
fn every_function_passes_the_lint() {
    let alone = FunctionGroup::ALL.into_iter().map(|group| vec![group]);
    let groups: Vec<Vec<FunctionGroup>> = std::iter::once(FunctionGroup::ALL.to_vec()).chain(alone).collect();
    for (name, materials) in sets() {
        let has_several = ["models", "lobes-mixed", "everything"].contains(&name);
        let groups = if has_several { &groups[..] } else { &groups[..1] };
        for (form, target) in forms(&materials).flat_map(|form| [(form, Target::Hlsl), (form, Target::Msl)]) {
            for functions in groups {
                let functions = functions.iter().copied().collect();
                let set = MaterialSet { functions, ..MaterialSet::new(&materials, tables()) };
                text((name, &set), form, target, Part::Complete);
            }
            if materials.len() == 1 {
                text((name, &MaterialSet::new(&materials, tables())), form, target, Part::Constant);
            }
        }
    }
}

#[test]
fn every_format_passes() {
    for format in TexelFormat::ALL.into_iter().filter(|format| !format.has_steps()) {
        let tables: Vec<_> = tables().into_iter().map(|t| TableFace { format, ..t }).collect();
        emit_all(&richest(), &tables);
    }
    // Texels with steps are those of rows.
    let steps = TexelFormat::Rgba16FloatSteps;
    let is_row = |table: &TableFace| table.layout.y.is_none() || table.layout.abreast().is_some();
    let face = |table: TableFace| if is_row(&table) { TableFace { format: steps, ..table } } else { table };
    let (rows, all) = (tables().into_iter().map(face), tables().into_iter().map(|t| TableFace { format: steps, ..t }));
    emit_all(&richest(), &rows.collect::<Vec<_>>());
    let refused = emit(&MaterialSet::new(&richest(), all.collect()), Form::Baked, Target::Wgsl).unwrap_err();
    assert!(refused.to_string().contains("texels with steps are those of rows"), "{refused}");
    for (_, materials) in sets().into_iter().filter(|(name, _)| name.starts_with("lobes")) {
        emit_all(&materials, &stepped_tables());
    }
    // Rows over Schlick's form, side by side or not; and D computed.
    for format in [TexelFormat::Rgba8Unorm, TexelFormat::Rgb10a2Unorm] {
        for columns in [1, 3] {
            let mut tables = tables();
            (tables[0].format, tables[0].layout.base, tables[0].layout.columns) = (format, RowBase::Schlick, columns);
            emit_all(&richest(), &tables);
        }
    }
    // One table filtered, one not.
    let mut mixed = tables();
    mixed[1].format = TexelFormat::R32Float;
    emit_all(&richest(), &mixed);
}

/// A bake without a table of D has materials without tiles of it.
#[test]
fn without_a_table_d_is_computed() {
    for (name, mut materials) in sets() {
        let records = materials
            .iter_mut()
            .flat_map(|m| m.layers.iter_mut().chain(m.constants.patina.as_mut().map(|patina| &mut patina.bare)));
        records.for_each(|layer| layer.tiles[TableKind::Distribution] = None);
        let tables: Vec<_> = tables().into_iter().filter(|t| t.kind != TableKind::Distribution).collect();
        emit_all(&materials, &tables);
        let text = emit(&MaterialSet::new(&materials, tables), Form::Baked, Target::Wgsl).unwrap();
        assert!(!text.contains("distribution_tile") && !text.contains("luthier_lookup_distribution"), "{name}");
    }
}

#[test]
fn every_mapping_passes() {
    let exponents = [0.125, 0.25, 0.5, 1.0, 1.7, 2.0, 3.0, 4.0, 8.0, 16.0];
    let mut mappings = vec![Mapping::Linear, Mapping::Logarithmic, Mapping::Periodic];
    mappings.extend([0.05, 0.5].map(|bend| Mapping::Rational { bend }));
    mappings.extend(exponents.map(|exponent| Mapping::Power { exponent }));
    for mapping in mappings {
        let mut tables = tables();
        for table in &mut tables {
            let axes = std::iter::once(&mut table.layout.x).chain(&mut table.layout.y);
            for axis in axes {
                axis.mapping = mapping;
                if mapping == Mapping::Logarithmic {
                    axis.min = axis.min.max(1e-3);
                }
            }
            table.layout.apron = 1;
        }
        emit_all(&richest(), &tables);
    }
}

#[test]
fn every_axis_and_layout_passes() {
    for (fresnel, distribution) in [("cos_theta", "theta_h"), ("theta", "cos_theta_h")] {
        for (columns, tiles) in [(1, 6), (2, 7), (6, 6)] {
            let mut tables = tables();
            tables[0].layout.x.quantity = fresnel.to_owned();
            tables[2].layout.x.quantity = fresnel.to_owned();
            tables[1].layout.x.quantity = distribution.to_owned();
            for table in &mut tables {
                (table.layout.columns, table.layout.tiles) = (columns, tiles);
            }
            emit_all(&richest(), &tables);
        }
    }
}

#[test]
fn what_a_set_lacks_is_not_in_its_text() {
    let text = |layers: &[luthier_manifest::LayerRecord], form| {
        let materials = [material("sample", layers)];
        emit(&MaterialSet::new(&materials, tables()), form, Target::Wgsl).unwrap()
    };
    let film = ["film", "airy", "phase", "luthier_thickness"];
    let depth = ["optical_depth", "exp(-layer"];
    let oren = ["sigma", "Oren"];
    let cases: [(&[luthier_manifest::LayerRecord], &[&[&str]]); 6] = [
        (&[diffuse(0.0)], &[&film, &depth, &oren, &["alpha", "fresnel", "Path", "luthier_sampler"]]),
        (&[dielectric()], &[&film, &depth, &oren, &["layer.eta", "albedo:", "open = true", "ggx", "diffuse("]]),
        (&[clear(), diffuse(0.0)], &[&film, &depth, &oren, &["ggx"]]),
        (&[dielectric(), diffuse(0.4)], &[&film, &["ggx", "LUTHIER_DIFFUSE"]]),
        (&[conductor()], &[&film, &depth, &oren, &["beckmann", "layer.eta", "LUTHIER_DIELECTRIC"]]),
        (&[filmed(), conductor()], &[&depth, &oren, &["LUTHIER_DIFFUSE"]]),
    ];
    for (layers, absent) in cases {
        for form in Form::ALL {
            let text = text(layers, form);
            let code: String = text.lines().filter(|line| !line.trim_start().starts_with("//")).collect();
            for word in absent.iter().flat_map(|words| words.iter()) {
                assert!(!code.contains(word), "`{word}` is in {form} of {layers:?}:\n{text}");
            }
        }
    }
    assert!(text(&[filmed()], Form::Full).contains("luthier_film("));
    assert!(text(&[filmed()], Form::Baked).contains("luthier_lookup_phase("));
}

#[test]
fn shipped_functions_have_no_loops_and_no_placeholders() {
    // The cells of glitter are looked for in a loop.
    for (name, materials) in sets().into_iter().filter(|(_, m)| m.iter().all(|m| m.constants.glitter.is_none())) {
        let plain = MaterialSet::new(&materials, tables());
        let whole = MaterialSet { functions: FunctionGroup::ALL.into_iter().collect(), ..plain.clone() };
        for (set, form) in [plain, whole].iter().flat_map(|set| forms(&materials).map(move |form| (set, form))) {
            for target in Target::TEXT {
                let text = text((name, set), form, target, Part::Snippet);
                for word in ["loop", "while", "for (", "$", "//?", "_group_", "_e1", "main(", "\n\n\n"] {
                    assert!(!text.contains(word), "`{word}` in {form} {target}:\n{text}");
                }
            }
        }
    }
}

/// Bindings keep their numbers in every language, in the snippet's header and in what a complete shader declares.
#[test]
fn complete_shaders_bind_by_our_numbers() {
    let materials = richest();
    let set = MaterialSet::new(&materials, tables());
    for (target, texture, sampler, buffer, entry) in [
        (Target::Hlsl, "register(t1)", "register(s5)", "register(t6)", "float4 main("),
        (Target::Msl, "[[texture(1)]]", "[[sampler(5)]]", "[[buffer(6)]]", "fragment main_Output main_("),
    ] {
        let text = complete(&set, Form::Baked, target).unwrap();
        let lines: Vec<&str> = text.lines().filter(|line| !line.starts_with("//")).collect();
        for (name, place) in [
            ("luthier_distribution", texture),
            ("luthier_sampler", sampler),
            ("luthier_materials", buffer),
            (entry, ""),
        ] {
            assert!(lines.iter().any(|l| l.contains(name) && l.contains(place)), "{target} {name} {place}:\n{text}");
        }
        assert!(!text.contains("_e5") && !text.to_lowercase().contains("naga"), "{text}");
    }
}

#[test]
fn functions_of_the_face_are_documented_in_every_language() {
    let materials = richest();
    let set = MaterialSet::new(&materials, tables());
    for target in Target::TEXT {
        let text = emit(&set, Form::Baked, target).unwrap();
        let lines: Vec<&str> = text.lines().collect();
        for name in [
            "eval",
            "bounded",
            "lookup_fresnel",
            "lookup_distribution",
            "lookup_fgd",
            "lookup_phase",
            "lookup_thickness",
        ] {
            let at =
                lines.iter().position(|l| l.contains(&format!(" luthier_{name}(")) && l.ends_with(['{', '('])).unwrap();
            assert!(lines[at - 1].starts_with("//"), "{target} {name}");
        }
    }
}

#[test]
fn full_binds_the_buffer_only_and_baked_what_it_reads() {
    let numbers = |layers: &[luthier_manifest::LayerRecord], tables: Vec<TableFace>, form| {
        let materials = [material("sample", layers)];
        bindings(&MaterialSet::new(&materials, tables), form).iter().map(|b| b.binding).collect::<Vec<_>>()
    };
    assert_eq!(numbers(&[filmed()], tables(), Form::Full), [6]);
    assert_eq!(numbers(&[filmed()], tables(), Form::Baked), [0, 1, 3, 4, 7, 5, 6]);
    assert_eq!(numbers(&[dielectric()], tables(), Form::Baked), [0, 1, 2, 5, 6]);
    assert_eq!(numbers(&[diffuse(0.0)], tables(), Form::Baked), [6]);
    let unfiltered = tables().into_iter().map(|t| TableFace { format: TexelFormat::Rgba32Float, ..t }).collect();
    assert_eq!(numbers(&[dielectric()], unfiltered, Form::Baked), [0, 1, 2, 6]);
}

#[test]
fn sets_that_cannot_be_emitted_say_why() {
    let attempt = |materials: &[luthier_manifest::MaterialEntry], tables: Vec<TableFace>, target| {
        emit(&MaterialSet::new(materials, tables), Form::Baked, target).unwrap_err()
    };
    let lone = |layer| [material("sample", &[layer])];
    assert!(matches!(attempt(&[], tables(), Target::Wgsl), ShaderError::NoMaterials));
    assert!(matches!(attempt(&[material("a", &[])], tables(), Target::Wgsl), ShaderError::NoLayers(_)));
    let twins = [material("a-b", &[conductor()]), material("A-B", &[conductor()])];
    assert!(matches!(attempt(&twins, tables(), Target::Wgsl), ShaderError::NameClash { .. }));
    let mut layer = conductor();
    layer.tiles[TableKind::Fresnel] = None;
    let error = attempt(&lone(layer), tables(), Target::Wgsl);
    assert!(matches!(error, ShaderError::NoTile { table: TableKind::Fresnel, layer: 0, .. }), "{error}");
    let error = attempt(&lone(conductor()), Vec::new(), Target::Wgsl);
    assert!(matches!(error, ShaderError::TileOutOfRange { tiles: 0, .. }), "{error}");
    let mut odd = tables();
    odd[0].layout.x.quantity = "wavelength".to_owned();
    assert!(matches!(attempt(&lone(conductor()), odd, Target::Wgsl), ShaderError::Layout { .. }));
    assert!(matches!(attempt(&lone(conductor()), tables(), Target::SpirV), ShaderError::NotText));
    // One layer more than the words that shaders count.
    let layers = vec![conductor(); BUFFER_WORDS_MAX / LAYER_WORDS];
    let error = attempt(&[material("deep", &layers)], tables(), Target::Wgsl);
    assert!(matches!(error, ShaderError::BufferTooLarge { words: 8_388_611, limit: 8_388_608 }), "{error}");
}

/// A material of `lobes` has no form `full`; the others keep theirs, with the numbers of a buffer that has all. Oracle: the shader of one alone.
#[test]
fn a_form_is_for_those_that_have_it() {
    let fitted = sets().into_iter().find(|(name, _)| *name == "lobes").unwrap().1.remove(0);
    let gold = material("gold", &[clear(), conductor()]);
    let materials = [material("clay", &[diffuse(0.3)]), fitted, gold];
    let set = MaterialSet::new(&materials, tables());
    assert_eq!(set.in_form(Form::Baked), set);
    assert!(matches!(emit(&set, Form::Full, Target::Wgsl), Err(ShaderError::NoForm { .. })));
    for target in Target::TEXT {
        let text = complete(&set.in_form(Form::Full), Form::Full, target).unwrap();
        assert!(text.contains("The buffer has others") && !text.to_lowercase().contains("lobes"), "{target}:\n{text}");
        assert!(target == Target::Wgsl || text.contains("LUTHIER_MATERIAL_GOLD"), "{target}:\n{text}");
    }
    let text = emit(&set.in_form(Form::Full), Form::Full, Target::Wgsl).unwrap();
    assert!(text.contains("const LUTHIER_MATERIAL_GOLD: u32 = 2u;"), "{text}");
    let machine = Machine::new(&text, &material_buffer(&materials), std::collections::BTreeMap::new());
    for number in [0, 2] {
        let alone = full(&materials[number..=number]);
        for (wi, wo) in directions(40) {
            assert_eq!(eval(&machine, number as u32, wi, wo), eval(&alone, 0, wi, wo));
        }
    }
    let only = MaterialSet::new(&materials[1..2], tables()).in_form(Form::Full);
    assert!(matches!(emit(&only, Form::Full, Target::Wgsl), Err(ShaderError::NoMaterials)));
    // A surface with cells of a material that is not there is not either.
    let cells = |numbers: &[u32]| CellsRecord { seed: 1, frequency: 4.0, materials: numbers.to_vec() };
    for (numbers, is_kept) in [(vec![0, 2], true), (vec![0, 1], false)] {
        let surface = SurfaceEntry {
            name: "ground".to_owned(),
            source: String::new(),
            source_hash: String::new(),
            cells: cells(&numbers),
            switches: Vec::new(),
            glitter: None,
        };
        let surfaces = [surface];
        let set = MaterialSet { surfaces: &surfaces, ..set.clone() }.in_form(Form::Full);
        assert_eq!(emit(&set, Form::Full, Target::Wgsl).unwrap().contains("fn luthier_pick("), is_kept, "{numbers:?}");
    }
}

/// A set that no uniform block of GLSL ES 3.00 holds; 33 materials of two layers take 1,089 words, and 63 more than one row of texels.
#[test]
fn any_number_of_materials_is_emitted() {
    let layers = [clear(), conductor()];
    for (count, width, height, coordinates) in
        [(33, 1089, 1, "ivec2(int(index), 0)"), (63, 2048, 2, "ivec2(int(index & 2047u), int(index >> 11u))")]
    {
        let materials: Vec<_> = (0..count).map(|i| material(&format!("m-{i}"), &layers)).collect();
        emit_all(&materials, &tables());
        let set = MaterialSet::new(&materials, tables());
        let text = emit(&set, Form::Baked, Target::GlslEs300).unwrap();
        for part in [
            format!("luthier_materials: sampler2D, RGBA32F, {width} x {height}, not filtered"),
            "uniform highp sampler2D luthier_materials;".to_owned(),
            format!("return texelFetch(luthier_materials, {coordinates}, 0);"),
        ] {
            assert!(text.contains(&part), "`{part}` is not in\n{text}");
        }
        assert!(!text.contains("luthier_materials["), "{text}");
    }
}

/// Constants in the place of the buffer pass in every language, bind none, and give the same values to the last bit.
#[test]
fn one_material_can_be_constants() {
    for layers in [vec![clear(), conductor()], vec![filmed(), dielectric(), diffuse(0.4)], vec![conductor()]] {
        use luthier_manifest::ShadingModel::{Elek, GranierHeidrich, Microfacet, Phong, WeidlichWilkie};
        for model in [Elek, WeidlichWilkie, GranierHeidrich, Phong, Microfacet] {
            let materials = [luthier_manifest::MaterialEntry { model, ..material("sample", &layers) }];
            let set = MaterialSet::new(&materials, tables());
            for form in Form::ALL {
                for target in Target::TEXT {
                    let text = emit_constant(&set, form, target).unwrap_or_else(|e| panic!("{form} {target}: {e}"));
                    let is_buffer =
                        |line: &&str| line.contains("luthier_materials") && !line.trim_start().starts_with("//");
                    let declared: Vec<&str> = text.lines().filter(is_buffer).collect();
                    for word in ["binding", "buffer", "register", "uniform", "&"] {
                        assert!(declared.iter().all(|line| !line.contains(word)), "{form} {target}: {declared:?}");
                    }
                }
            }
            let text = emit_constant(&set, Form::Full, Target::Wgsl).unwrap();
            let constant = Machine::new(&text, &[], std::collections::BTreeMap::new());
            let buffer = full(&materials);
            for (wi, wo) in directions(100) {
                assert_eq!(eval(&constant, 7, wi, wo), eval(&buffer, 0, wi, wo), "{}", model.name());
            }
        }
    }
    let two = [material("a", &[conductor()]), material("b", &[conductor()])];
    let set = MaterialSet::new(&two, tables());
    assert!(matches!(emit_constant(&set, Form::Baked, Target::Wgsl), Err(ShaderError::NotOne(2))));
}

/// The form `baked` without a table of D has the functions of `full` for it, and reads the others as before.
#[test]
fn without_its_table_d_is_a_closed_form() {
    let closed: Vec<TableFace> = tables().into_iter().filter(|t| t.kind != TableKind::Distribution).collect();
    for (_, materials) in sets() {
        emit_all(&materials, &closed);
    }
    let materials = [material("sample", &[clear(), conductor()])];
    let set = MaterialSet::new(&materials, closed);
    let text = emit(&set, Form::Baked, Target::Wgsl).unwrap();
    assert!(!text.contains("luthier_lookup_distribution") && text.contains("fn luthier_beckmann("), "{text}");
    assert!(text.contains("luthier_lookup_fresnel(layer"), "{text}");
    assert!(bindings(&set, Form::Baked).iter().all(|b| b.name != "luthier_distribution"));
}

/// Sets in which light is totally reflected read their rows at the cosine of the refracted direction; others have no word of it.
#[test]
fn only_total_reflection_pays_for_its_rows() {
    let inward = luthier_manifest::LayerRecord { eta: 1.0 / 1.5, critical_cot_sq: 1.25, ..clear() };
    let materials = [material("wine-glass", &[clear(), inward, filmed(), conductor()])];
    emit_all(&materials, &tables());
    let text = |layers: &[luthier_manifest::LayerRecord], form| {
        let materials = [material("sample", layers)];
        emit(&MaterialSet::new(&materials, tables()), form, Target::Wgsl).unwrap()
    };
    assert!(text(&materials[0].layers, Form::Baked).contains("layer.critical_cot_sq * sin_theta_i_sq"));
    assert!(!text(&materials[0].layers, Form::Full).contains("critical_cot_sq"));
    assert!(!text(&[clear(), filmed(), conductor()], Form::Baked).contains("critical_cot_sq"));
}

#[test]
fn kernels_can_be_appended() {
    let materials = [material("gold", &[conductor()])];
    let set = MaterialSet::new(&materials, tables());
    let kernel = "@group(1) @binding(0) var<storage, read_write> out: array<vec3<f32>>;\n\
        @compute @workgroup_size(64) fn kernel(@builtin(global_invocation_id) id: vec3<u32>) {\n\
        out[id.x] = luthier_eval(LUTHIER_MATERIAL_GOLD, vec3<f32>(0.0, 0.0, 1.0), vec3<f32>(0.0, 0.0, 1.0)); }";
    for form in Form::ALL {
        validate(&format!("{}\n{kernel}", emit(&set, form, Target::Wgsl).unwrap())).unwrap();
    }
}

#[test]
fn names_read_back() {
    for form in Form::ALL {
        assert_eq!(form.to_string().parse::<Form>().unwrap(), form);
    }
    for target in Target::ALL {
        assert_eq!(target.to_string().parse::<Target>().unwrap(), target);
    }
    for target in Target::ALL {
        assert!("cg".parse::<Target>().unwrap_err().to_string().contains(target.name()));
        assert_eq!(Target::TEXT.contains(&target), target != Target::SpirV);
    }
    assert!("fast".parse::<Form>().is_err());
    assert_eq!(LayerKind::Conductor, conductor().kind);
}
