//! A text without mistakes, and the same text with each mistake planted.

use super::*;

const HLSL: &str = "\
struct Layer {
    uint kind;
    float3 albedo;
    float rows[4];
};

static const uint COUNT = 4u;
typedef float4 ret_words[2];

Texture2D<float4> table : register(t0);
SamplerState sampler_ : register(s1);
ByteAddressBuffer materials : register(t2, space1);

float3 read(Layer layer, float2 at) {
    float4 texel = table.SampleLevel(sampler_, at, 0.0);
    float word = asfloat(materials.Load(4+layer.kind*16));
    float4 words = asfloat(materials.Load4((layer.kind + 1u)*16));
    bool3 larger = texel.xyz > (0.0).xxx;
    float3 chosen = float3(larger.x ? texel.x : 1.0, larger.y ? words.y : 1e-3, (dot(at, at) > layer.rows[1]) ? word : 0.0);
    if (all(larger) && (layer.kind == 1u || any(texel.xyz == (0.0).xxx))) {
        return lerp(chosen, layer.albedo, saturate(word));
    }
    uint i = 0u;
    bool first = true;
    while(true) {
        if (!first) {
            i = asuint(asint(i) + asint(int(1)));
        }
        first = false;
        if (i < COUNT) {
        } else {
            break;
        }
        chosen = chosen + (i).xxx;
    }
    for (uint k = 0u; k < COUNT; k++) {
        chosen.x += rsqrt(max(chosen.y, 1.0));
    }
    return ((Layer)0).albedo + chosen;
}
";

const MSL: &str = "\
#include <metal_stdlib>
using metal::uint;

struct Materials {
    metal::float4 inner[33];
};

// A comment with what would be a mistake: half3 x = select(a > b ? c : d);
metal::float3 read(uint index, metal::float2 at, metal::texture2d<float> table, metal::sampler filter_, device Materials const& materials) {
    metal::float4 texel = table.sample(filter_, at, metal::level(0.0));
    const auto own = at;
    metal::float3 words = materials.inner[index].xyz;
    metal::float3 chosen = metal::select(words, texel.xyz, texel.xyz > metal::float3(0.0));
    return (as_type<uint>(words.x) & 7u) == 1u && own.x > 0.0 ? metal::mix(chosen, words, 0.5) : -(chosen);
}

struct main_Output {
    metal::float4 color [[color(0)]];
};
fragment main_Output main_(metal::float2 uv [[user(loc0), center_perspective]]) {
    return main_Output { metal::float4(uv, 0.0, 1.0) };
}
";

fn messages(text: &str, target: Target) -> Vec<String> {
    findings(text, target).into_iter().map(|finding| format!("{}: {}", finding.line, finding.what)).collect()
}

#[test]
fn texts_without_mistakes_pass() {
    assert_eq!(messages(HLSL, Target::Hlsl), [""; 0]);
    assert_eq!(messages(MSL, Target::Msl), [""; 0]);
}

#[test]
fn each_mistake_is_found() {
    let of_three = "a condition of 3 numbers";
    let cases = [
        // Vectors as conditions.
        ("larger.x ? texel.x : 1.0", "(larger ? texel.xyz : (1.0).xxx).x", of_three),
        ("larger.x ? texel.x : 1.0", "(texel.xyz > (0.0).xxx ? texel.xyz : (1.0).xxx).x", of_three),
        ("larger.x ? texel.x : 1.0", "dot(at, at) > 1.0 ? (layer.albedo >= 0.5 ? chosen : chosen).x : 1.0", of_three),
        (
            "if (i < COUNT) {\n        } else",
            "if (larger) {\n        }\n        if (i < COUNT) {\n        } else",
            of_three,
        ),
        ("all(larger) &&", "all(larger && larger) &&", of_three),
        ("any(texel.xyz ==", "any(larger || texel.xyz ==", of_three),
        ("larger.x ? texel.x", "unheard_of ? texel.x", "a condition whose type is not known"),
        // Words of the language as names.
        ("float word =", "float pass = 0.0;\n    float word =", "`pass` is a word of"),
        ("float word =", "float Technique = 0.0;\n    float word =", "`Technique` is a word of"),
        ("float2 at)", "float2 at, float sample)", "`sample` is a word of"),
        ("    uint kind;", "    uint kind;\n    float linear;", "`linear` is a word of"),
        ("struct Layer {", "struct matrix {\n    float x;\n};\nstruct Layer {", "`matrix` is a word of"),
        ("float3 read(", "float texture(float x) {\n    return x;\n}\nfloat3 read(", "`texture` is a word of"),
        // What shader model 5.1 does not have.
        ("rsqrt(max", "select(larger.x, 1.0, 0.0) * rsqrt(max", "`select` is no function of shader model 5.1"),
        ("rsqrt(max", "WaveActiveSum(1.0) * rsqrt(max", "`WaveActiveSum` is no function of"),
        ("rsqrt(max", "inversesqrt(max", "`inversesqrt` is no function of"),
        ("table.SampleLevel(", "table.SampleCmpLevel(", "`.SampleCmpLevel` is no function of"),
        ("float word =", "float16_t small = 0.0;\n    float word =", "`float16_t` is no type of"),
        ("    uint kind;", "    uint kind;\n    int64_t wide;\n", "`int64_t` is no type of"),
        // Loops.
        ("            break;\n", "", "a loop without a bound"),
        ("asint(i) + asint(int(1))", "asint(i) + asint(i)", "a loop without a bound"),
        ("if (i < COUNT) {", "if (first) {", "a loop without a bound"),
        ("k < COUNT;", "true;", "a loop without a bound"),
        ("k++", "k = k * COUNT", "a loop without a bound"),
    ];
    for (right, wrong, message) in cases {
        let text = HLSL.replacen(right, wrong, 1);
        assert_ne!(text, HLSL, "{right}");
        let found = messages(&text, Target::Hlsl);
        assert!(!found.is_empty() && found.iter().all(|found| found.contains(message)), "{wrong}: {found:?}");
    }
    let cases = [
        ("metal::mix(chosen, words, 0.5)", "(chosen > words ? chosen : words)", of_three),
        ("index,", "kernel,", "`kernel` is a word of"),
        ("metal::float3 words =", "metal::float3 fragment =", "`fragment` is a word of"),
        ("metal::mix(", "metal::lerp(", "`lerp` is no function of MSL 2.0"),
        ("table.sample(", "table.SampleLevel(", "`.SampleLevel` is no function of"),
        ("metal::float3 words =", "metal::bfloat y = 0.0;\n    metal::float3 words =", "`bfloat` is no type of"),
        ("    return (as_type", "    while(true) {\n    }\n    return (as_type", "a loop without a bound"),
    ];
    for (right, wrong, message) in cases {
        let text = MSL.replacen(right, wrong, 1);
        assert_ne!(text, MSL, "{right}");
        let found = messages(&text, Target::Msl);
        assert!(found.iter().any(|found| found.contains(message)), "{wrong}: {found:?}");
    }
}

/// The message names the line as it stands, and a module of a user's gets it, too.
#[test]
fn a_vector_as_condition_is_refused() {
    let wgsl = "fn choose(a: vec3<f32>, b: vec3<f32>) -> vec3<f32> {\n    return select(a, b, a > b);\n}\n";
    let error = crate::library(wgsl, Target::Hlsl).unwrap_err().to_string();
    assert!(error.contains("a condition of 3 numbers") && error.contains("(a > b) ? b : a"), "{error}");
    // MSL has a function for it.
    assert!(crate::library(wgsl, Target::Msl).unwrap().contains("metal::select(a, b, a > b)"));
    let scalar = wgsl.replace("a > b)", "a.x > b.x)");
    assert!(crate::library(&scalar, Target::Hlsl).is_ok());
}

/// MSL has a structure around each type of array, and functions name it as it is declared: once, names of values in a function were shortened, and
/// that of such a type with them, which the lint found.
#[test]
fn arrays_keep_the_names_of_their_types() {
    let wgsl = "fn pick(i: u32) -> u32 {\n    var few = array<u32, 2>(1u, 2u);\n    var many = array<u32, 3>(3u, 4u, 5u);\n    \
        return few[i % 2u] + many[i % 3u];\n}\n";
    let text = crate::library(wgsl, Target::Msl).unwrap();
    assert_eq!(text.matches("struct LuthierArray").count(), 2, "{text}");
    for (right, wrong) in [("    LuthierArray", "    Array"), (" = LuthierArray", " = Array")] {
        let other = text.replacen(right, wrong, 1);
        assert!(messages(&other, Target::Msl).iter().any(|found| found.contains("is no type of")), "{other}");
    }
}
