//! Counts of small texts, by hand.

use luthier_manifest::{MATERIAL_WORDS, MaterialConstants};

use super::*;

/// A module whose evaluation has these statements, with a texture, a sampler and two buffers.
fn module_of(body: &str) -> String {
    format!(
        "@group(0) @binding(0) var rows: texture_2d<f32>;\n@group(0) @binding(5) var smooth_rows: sampler;\n\
         @group(0) @binding(6) var<storage, read> luthier_materials: array<vec4<f32>>;\n\
         @group(0) @binding(7) var<storage, read> packed: array<vec4<u32>>;\n\
         struct Layer {{ ior: vec3<f32>, alpha: f32, }}\n\
         fn layer(i: u32) -> Layer {{\n    var made: Layer;\n    made.ior = luthier_materials[3u * i].xyz;\n    \
         made.alpha = luthier_materials[3u * i + 1u].w;\n    return made;\n}}\n\
         fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n"
    )
}

fn of(body: &str) -> StaticCounts {
    count(&module_of(body), &[], 1).unwrap()
}

const NONE: StaticCounts = StaticCounts {
    filtered_reads: 0,
    wide_reads: 0,
    texel_fetches: 0,
    record_reads: 0,
    buffer_reads: 0,
    special: 0,
    plain: 0,
    branches: 0,
};

#[test]
fn arithmetic_counts_by_component() {
    for (body, special, plain) in [
        ("return wi;", 0, 0),
        ("return wi * wo;", 0, 3),
        // A product and a sum in one instruction each.
        ("return wi * wo + wi;", 0, 3),
        ("return vec3<f32>(dot(wi, wo));", 0, 3),
        // The dot product, its inverse root, three products.
        ("return normalize(wi);", 1, 6),
        // One reciprocal for all components; then one for each.
        ("return wi / wo.x;", 1, 3),
        ("return wi / wo;", 3, 3),
        ("return vec3<f32>(sqrt(wi.x), exp2(wi.y), log2(wi.z));", 3, 0),
        ("return vec3<f32>(exp(wi.x), sin(wi.y), pow(wi.z, wo.z));", 4, 3),
        // A difference, and a product with a sum.
        ("return mix(wi, wo, 0.3);", 0, 6),
        ("return cross(wi, wo);", 0, 6),
        ("return clamp(wi, vec3<f32>(0.0), vec3<f32>(2.0));", 0, 6),
        ("return -abs(saturate(wi));", 0, 0),
        ("return mat3x3<f32>(wi, wo, wi) * wo;", 0, 9),
    ] {
        assert_eq!(of(body), StaticCounts { special, plain, ..NONE }, "{body}");
    }
}

#[test]
fn constants_are_folded_equal_terms_shared_and_the_rest_left_out() {
    for (body, plain) in [
        ("return wi * (2.0 * 3.0 - 5.0);", 0),
        ("let a = wi.x * wo.y; let b = wo.y * wi.x; return vec3<f32>(a, b, a);", 1),
        ("let unused = wi.x * wo.y * 7.0; return wo;", 0),
        ("if 1.0 > 2.0 { return wi * wo; } return wi;", 0),
        // Two products are needed twice: a sum has an instruction of its own.
        ("let a = wi.x * wo.x; return vec3<f32>(a, a + 1.0, a + 2.0);", 3),
    ] {
        assert_eq!(of(body), StaticCounts { plain, ..NONE }, "{body}");
    }
}

#[test]
fn reads_are_told_apart() {
    assert_eq!(
        of("let at = wi.xy;\nlet a = textureSampleLevel(rows, smooth_rows, at, 0.0);\n\
            let b = textureLoad(rows, vec2<i32>(0, 1), 0);\nlet c = bitcast<vec4<f32>>(packed[7]);\nreturn (a * b * c).xyz;"),
        StaticCounts { filtered_reads: 1, texel_fetches: 1, buffer_reads: 1, plain: 6, ..NONE }
    );
    let wide =
        count(&module_of("return textureSampleLevel(rows, smooth_rows, wi.xy, 0.0).xyz;"), &["rows".to_owned()], 1);
    assert_eq!(wide.unwrap(), StaticCounts { wide_reads: 1, ..NONE });
    // A word is read once, and what nobody needs of a record is not read. The number of the word is one product, the offset is free.
    assert_eq!(
        of("return vec3<f32>(layer(material).alpha + luthier_materials[3u * material + 1u].x);"),
        StaticCounts { record_reads: 1, plain: 2, ..NONE }
    );
    assert_eq!(of("return layer(1u).ior;"), StaticCounts { record_reads: 1, ..NONE });
}

#[test]
fn of_two_sides_the_dearer_counts() {
    // The condition, the branch, the root; and the choice of the result for three components.
    assert_eq!(
        of("if wi.z < 0.0 { return vec3<f32>(wi.x + 1.0); }\nreturn vec3<f32>(sqrt(wo.x));"),
        StaticCounts { special: 1, plain: 2, branches: 1, ..NONE }
    );
    // What stands before the branch counts beside either side.
    assert_eq!(
        of(
            "let a = wi.x + wo.y;\nvar b = a;\nif wi.z < 0.0 { b = a * a; } else { b = exp2(a) + a; }\nreturn vec3<f32>(b);"
        ),
        StaticCounts { special: 1, plain: 4, branches: 1, ..NONE }
    );
    // Without work on either side there is no branch, but a selection.
    assert_eq!(
        of("var b = wi.x;\nif wi.z < 0.0 { b = wo.x; }\nreturn vec3<f32>(b);"),
        StaticCounts { plain: 2, ..NONE }
    );
    let cases = "var b = 0.0;\nswitch material {\ncase 0u: { b = sqrt(sqrt(wi.x)); }\ncase 1u, 2u: { b = wi.x + 1.0; }\ndefault: {}\n}\nreturn vec3<f32>(b);";
    // Two roots outweigh the other two cases; the first comparison, and the choice of the result.
    assert_eq!(of(cases), StaticCounts { special: 2, plain: 2, branches: 1, ..NONE });
}

#[test]
fn loops_have_the_turns_of_their_bound() {
    let of_bound = |bound: &str| {
        of(&format!(
            "var sum = 0.0;\nfor (var i = 0u; i < {bound}; i++) {{ sum += exp2(wi.x + f32(i)); }}\nreturn vec3<f32>(sum);"
        ))
    };
    // The first turn adds nothing to x and to the sum.
    assert_eq!(of_bound("4u"), StaticCounts { special: 4, plain: 6, ..NONE });
    assert_eq!(of_bound("material").special, 1);
}

#[test]
fn lights_share_what_a_view_decides() {
    let view = "struct LuthierPrepared { root: f32, }\n\
        fn luthier_prepare(material: u32, wo: vec3<f32>) -> LuthierPrepared {\n    return LuthierPrepared(sqrt(wo.x));\n}\n\
        fn luthier_light(prepared: LuthierPrepared, wi: vec3<f32>) -> vec3<f32> {\n    return exp2(wi) * prepared.root;\n}\n\
        fn luthier_eval(material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {\n    \
        return luthier_light(luthier_prepare(material, wo), wi);\n}\n";
    for lights in [1, 4] {
        let expected = StaticCounts { special: 1 + 3 * lights, plain: 3 * lights, ..NONE };
        assert_eq!(count(view, &[], lights).unwrap(), expected);
    }
    assert!(matches!(count("fn f() {}\n", &[], 1), Err(ShaderError::Uncounted(_))));
    assert!(matches!(count("fn f(", &[], 1), Err(ShaderError::Invalid(_))));
}

/// The numbers of a material decide the side that counts; with both sides, neighbours of other materials do.
#[test]
fn sides_are_those_that_are_asked_for() {
    let text = module_of(
        "let numbers = luthier_materials[material];\nvar b = wi.x;\nif numbers.x > 0.5 && wi.y > 0.0 { b = sqrt(sqrt(b)); }\n\
         switch u32(numbers.y) {\ncase 1u: { b = b * wo.x; }\ncase 2u: { b = exp2(b * b); }\ndefault: {}\n}\nreturn vec3<f32>(b);",
    );
    let words = [[0.0, 1.0, 0.0, 0.0], [1.0, 2.0, 0.0, 0.0]];
    let of = |sides| count_sides(&text, &[], 1, sides);
    let [plain, rich] = [0, 1].map(|material| of(Sides::Of(Record { words: &words, material })).unwrap());
    // The condition that the record decides alone, and its branch; the conversion and a comparison of the switch, and the product.
    assert_eq!(plain, StaticCounts { record_reads: 1, plain: 4, branches: 2, ..NONE });
    // `&&` is a branch of its own. The direction is compared, too, which decides for no side: the dearer one counts, and the choice of its result. The switch
    // converts and compares twice.
    assert_eq!(rich, StaticCounts { record_reads: 1, special: 3, plain: 7, branches: 4, ..NONE });
    let [dearer, both] = [Sides::Dearer, Sides::Both].map(|sides| of(sides).unwrap());
    assert_eq!((dearer.special, both.special), (3, 3));
    // The product of the first case counts beside the second.
    assert_eq!(both.plain, dearer.plain + 1);
    assert!(matches!(of(Sides::Of(Record { words: &words[..1], material: 1 })), Err(ShaderError::Uncounted(_))));
}

/// A text that takes a place is counted with what textures decide unknown: only normals are those of the surface, and those of flakes where a material has none.
#[test]
fn places_are_not_known() {
    let of_sides = |body: &str, sides: Sides<'_>| {
        let at = format!(
            "struct LuthierPlace {{ normal: vec3<f32>, factor: f32, layers: array<f32, 2>, flake_normal: vec3<f32>, }}\n\
             fn luthier_eval_at(place: LuthierPlace, material: u32, wi: vec3<f32>, wo: vec3<f32>) -> vec3<f32> {{\n{body}\n}}\n\
             fn luthier_place() -> LuthierPlace {{\n\
                 return LuthierPlace(vec3<f32>(0.0, 0.0, 1.0), 1.0, array<f32, 2>(1.0, 1.0), vec3<f32>(0.0, 0.0, 1.0));\n}}\n"
        );
        let eval = module_of("return luthier_eval_at(luthier_place(), material, wi, wo);");
        count_sides(&(at + &eval), &[], 1, sides).unwrap()
    };
    let of = |body: &str| of_sides(body, Sides::Dearer);
    let tilted = "if place.flake_normal.x != 0.0 { return wi * sqrt(place.flake_normal.x); }\nreturn wi;";
    assert_eq!(of(tilted).special, 1);
    let mut words = [[0.0; 4]; MATERIAL_WORDS];
    assert_eq!(of_sides(tilted, Sides::Of(Record { words: &words, material: 0 })).special, 0);
    words[MaterialConstants::FLAKES_WORD] = [0.0, 0.0, 1.0, 0.0];
    assert_eq!(of_sides(tilted, Sides::Of(Record { words: &words, material: 0 })).special, 1);
    assert_eq!(of("return wi * place.factor;"), StaticCounts { plain: 3, ..NONE });
    assert_eq!(of("return wi * (place.layers[0] * place.layers[1]);"), StaticCounts { plain: 4, ..NONE });
    assert_eq!(of("return vec3<f32>(place.normal.z / 2.0);"), NONE);
}
