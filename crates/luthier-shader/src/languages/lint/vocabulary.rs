//! Words that the languages know or reserve. Sources for HLSL: the pages "Intrinsic functions", "Keywords" and "Reserved words" of Microsoft's
//! reference, for shader model 5.1. Sources for MSL: Apple's Metal Shading Language Specification, version 2.0, sections 4 and 5, and the
//! keywords of C++14, on which it is based.

use crate::Target;

/// Types by name that are neither numbers, vectors nor matrices.
const HLSL_TYPES: [&str; 9] = [
    "void",
    "SamplerState",
    "Texture2D",
    "Texture2DArray",
    "Texture3D",
    "TextureCube",
    "ByteAddressBuffer",
    "RWByteAddressBuffer",
    "ConstantBuffer",
];
const MSL_TYPES: [&str; 10] = [
    "void",
    "char",
    "sampler",
    "texture1d",
    "texture2d",
    "texture2d_array",
    "texture3d",
    "texturecube",
    "packed_float3",
    "array",
];

/// Functions of both languages that give the shape of their widest argument.
const WIDEST: [&str; 35] = [
    "abs",
    "acos",
    "asin",
    "atan",
    "atan2",
    "ceil",
    "clamp",
    "cos",
    "cosh",
    "exp",
    "exp2",
    "floor",
    "fma",
    "fmod",
    "fmin",
    "fmax",
    "ldexp",
    "log",
    "log10",
    "log2",
    "max",
    "min",
    "normalize",
    "pow",
    "reflect",
    "round",
    "rsqrt",
    "saturate",
    "sign",
    "sin",
    "sinh",
    "smoothstep",
    "sqrt",
    "step",
    "tan",
];
const HLSL_WIDEST: [&str; 18] = [
    "asfloat",
    "asint",
    "asuint",
    "countbits",
    "ddx",
    "ddy",
    "f16tof32",
    "degrees",
    "faceforward",
    "firstbithigh",
    "firstbitlow",
    "frac",
    "fwidth",
    "lerp",
    "mad",
    "radians",
    "rcp",
    "refract",
];
const MSL_WIDEST: [&str; 12] =
    ["dfdx", "dfdy", "fract", "fwidth", "mix", "popcount", "rint", "select", "trunc", "tanh", "clz", "copysign"];
/// Functions that give one number, whatever their arguments are.
const SCALAR: [&str; 6] = ["all", "any", "determinant", "distance", "dot", "length"];
/// Methods of textures and buffers, and how many numbers each gives.
const HLSL_METHODS: [(&str, u8); 12] = [
    ("Load", 0),
    ("Load2", 2),
    ("Load3", 3),
    ("Load4", 4),
    ("Sample", 4),
    ("SampleLevel", 4),
    ("SampleGrad", 4),
    ("SampleBias", 4),
    ("Gather", 4),
    ("GetDimensions", 1),
    ("Store", 1),
    ("Store4", 1),
];
const MSL_METHODS: [(&str, u8); 8] = [
    ("read", 4),
    ("sample", 4),
    ("gather", 4),
    ("get_width", 1),
    ("get_height", 1),
    ("get_depth", 1),
    ("get_num_mip_levels", 1),
    ("write", 1),
];
/// Arguments of `sample` in MSL.
const MSL_ARGUMENTS: [&str; 4] = ["level", "bias", "gradient2d", "gradientcube"];

/// Reserved words.
const HLSL_RESERVED: &str = "asm asm_fragment auto BlendState bool break Buffer case catch cbuffer centroid char class column_major compile \
    compile_fragment const const_cast continue ComputeShader ConsumeStructuredBuffer default delete DepthStencilState DepthStencilView discard do \
    double DomainShader dword dynamic_cast else enum explicit export extern false float for friend fxgroup GeometryShader goto groupshared half Hullshader \
    if in inline inout InputPatch int interface line lineadj linear LineStream long matrix mutable namespace new nointerpolation noperspective NULL \
    operator out OutputPatch packoffset pass pixelfragment PixelShader point PointStream precise private protected public RasterizerState \
    register reinterpret_cast RenderTargetView return row_major RWBuffer RWByteAddressBuffer RWStructuredBuffer RWTexture1D RWTexture2D RWTexture3D \
    sample sampler SamplerState SamplerComparisonState shared short signed sizeof snorm stateblock stateblock_state static static_cast string struct \
    StructuredBuffer switch tbuffer technique technique10 technique11 template texture Texture1D Texture2D Texture2DArray Texture2DMS Texture3D TextureCube \
    this throw triangle triangleadj TriangleStream true try typedef typename uint uniform union unorm unsigned using vector vertexfragment VertexShader \
    virtual void volatile while min10float min12int min16float min16int min16uint";
/// Words that HLSL reserves in any case of their letters.
const HLSL_RESERVED_ANYHOW: [&str; 6] = ["asm", "decl", "pass", "technique", "texture2d", "texturecube"];
const MSL_RESERVED: &str = "alignas alignof and and_eq asm auto bitand bitor bool break case catch char char16_t char32_t class compl const const_cast \
    constexpr continue decltype default delete do double dynamic_cast else enum explicit export extern false float for friend goto half if inline int \
    long mutable namespace new noexcept not not_eq nullptr operator or or_eq private protected public register reinterpret_cast return short signed \
    sizeof static static_assert static_cast struct switch template this thread_local throw true try typedef typeid typename uint union unsigned \
    using virtual void volatile wchar_t while xor xor_eq kernel vertex fragment device constant thread threadgroup threadgroup_imageblock metal \
    uchar ushort ulong size_t ptrdiff_t sampler texture1d texture2d texture2d_array texture3d texturecube depth2d access main";

/// The vocabulary of a language.
#[derive(Debug, Clone, Copy)]
pub(super) struct Vocabulary {
    is_hlsl: bool,
}

impl Vocabulary {
    pub(super) fn of(target: Target) -> Self {
        Self { is_hlsl: target == Target::Hlsl }
    }

    /// The language, by the version that texts are for.
    pub(super) fn name(self) -> &'static str {
        if self.is_hlsl { "shader model 5.1" } else { "MSL 2.0" }
    }

    /// Whether a name is that of a type other than numbers, vectors, matrices and structures.
    pub(super) fn has_type(self, name: &str) -> bool {
        if self.is_hlsl { HLSL_TYPES.contains(&name) } else { MSL_TYPES.contains(&name) }
    }

    /// Whether a function gives the shape of its widest argument.
    pub(super) fn gives_widest(self, name: &str) -> bool {
        WIDEST.contains(&name) || if self.is_hlsl { HLSL_WIDEST.contains(&name) } else { MSL_WIDEST.contains(&name) }
    }

    /// Whether a function gives one number.
    pub(super) fn gives_scalar(self, name: &str) -> bool {
        SCALAR.contains(&name)
    }

    /// Whether the language has a function.
    pub(super) fn has_function(self, name: &str) -> bool {
        let others: &[&str] =
            if self.is_hlsl { &["clip", "cross", "mul", "transpose", "modf"] } else { &MSL_ARGUMENTS };
        self.gives_widest(name)
            || self.gives_scalar(name)
            || others.contains(&name)
            || ["cross", "transpose"].contains(&name)
    }

    /// How many numbers a method gives; 0 for one that gives one number of a buffer and four of a texture.
    pub(super) fn method(self, name: &str) -> Option<u8> {
        let methods: &[(&str, u8)] = if self.is_hlsl { &HLSL_METHODS } else { &MSL_METHODS };
        methods.iter().find(|(method, _)| *method == name).map(|(_, numbers)| *numbers)
    }

    /// Whether the language reserves a word.
    pub(super) fn keeps(self, name: &str) -> bool {
        let words = if self.is_hlsl { HLSL_RESERVED } else { MSL_RESERVED };
        let is_kept_anyhow = self.is_hlsl && HLSL_RESERVED_ANYHOW.iter().any(|word| word.eq_ignore_ascii_case(name));
        is_kept_anyhow || words.split_whitespace().any(|word| word == name)
    }
}
