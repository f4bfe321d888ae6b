"""The shader of a bake, GLSL ES 3.00, in what GLSL, ESSL, Metal and Slang have in common after MaterialX has renamed types.

These languages differ in constructors of structures, in arrays as values, and in globals. So structures are made by functions, and functions that read tables, or numbers of
materials, take the image as their first argument, by MaterialX' words for it.
"""

import re

from tables import Unreadable

SIGNATURE, ARGUMENT = "$texSamplerSignature", "$texSamplerSampler2D"
# Names for which MaterialX has one of its own in each language.
MATH = re.compile(r"\b(inversesqrt|sin|cos|tan|asin|acos|atan|mod)\(")
ZERO = re.compile(r"0u|0\.0|false|vec[234]\(0\.0\)|\w+_zero\(\)")
# What is not the same in all languages, and is left over nowhere.
FOREIGN = re.compile(r"\bmat[234]\b|\w\[\d+\]\(|\b(?:texelFetch|textureSize|[iu]vec[234]|(?:float|uint|int)BitsTo\w+|usampler2D|in?out|out)\b")

HEAD = """// The functions of luthier for the materials of a bake, for MaterialX: GLSL that is also ESSL, Metal and Slang once MaterialX has renamed its types.
// Made by luthier_mtlx.py: bake again instead of editing. Functions that read tables have their image as the first argument.

#include "libraries/pbrlib/genglsl/lib/mx_closure_type.glsl"
#include "luthier_$fileTransformUv"

#ifdef GL_ES
precision highp int;
#endif

// Four half floats of their upper and lower bytes.
vec4 luthier_mx_halves(vec4 high, vec4 low)
{
    vec4 bits = 256.0 * floor(255.0 * high + 0.5) + floor(255.0 * low + 0.5);
    vec4 negative = floor(bits / 32768.0);
    bits -= 32768.0 * negative;
    vec4 exponent = floor(bits / 1024.0);
    vec4 normal = min(exponent, vec4(1.0));
    return (1.0 - 2.0 * negative) * (bits - 1024.0 * exponent + 1024.0 * normal) * exp2(exponent - normal - 24.0);
}

// What has another name in these languages.
#if defined(__METAL_VERSION__)
#define texelFetch(image, at, level) image.tex.read(uint2(at), level)
#define uintBitsToFloat(bits) as_type<float>(bits)
#elif defined(__SLANG__)
#define texelFetch(image, at, level) image.tex.Load(int3(at, level))
#define uintBitsToFloat(bits) asfloat(bits)
#endif
#if defined(__METAL_VERSION__) || defined(__SLANG__)
#define lessThan(a, b) ((a) < (b))
#define lessThanEqual(a, b) ((a) <= (b))
#define greaterThan(a, b) ((a) > (b))
#define greaterThanEqual(a, b) ((a) >= (b))
#endif

// A texel of the image.
vec4 luthier_mx_pixel($texSamplerSignature, int x, int y)
{
    return texelFetch($texSamplerSampler2D, ivec2(x, LUTHIER_MX_ROW(y, ROWS)), 0);
}

// A float of its four bytes, the upper one first.
float luthier_mx_float(vec4 bytes)
{
    vec4 whole = floor(255.0 * bytes + 0.5);
    return uintBitsToFloat((uint(whole.x) << 24u) | (uint(whole.y) << 16u) | (uint(whole.z) << 8u) | uint(whole.w));
}

// Image and sampler are two arguments where MaterialX generates GLSL for WGSL.
#define sampler2D(image, sampling) image, sampling

// A word of the numbers of the materials, `materials.bin`.
vec4 luthier_word($texSamplerSignature, uint index)
{
    int x = 4 * int(index % WORDSu);
    int y = FIRST + int(index / WORDSu);
    vec4 word;
    word.x = luthier_mx_float(luthier_mx_pixel($texSamplerSampler2D, x, y));
    word.y = luthier_mx_float(luthier_mx_pixel($texSamplerSampler2D, x + 1, y));
    word.z = luthier_mx_float(luthier_mx_pixel($texSamplerSampler2D, x + 2, y));
    word.w = luthier_mx_float(luthier_mx_pixel($texSamplerSampler2D, x + 3, y));
    return word;
}

// A texel of the tables, by its whole position.
vec4 luthier_mx_texel($texSamplerSignature, vec2 at)
{
    int x = 2 * int(at.x);
    int y = int(at.y);
    vec4 high = luthier_mx_pixel($texSamplerSampler2D, x, y);
    return luthier_mx_halves(high, luthier_mx_pixel($texSamplerSampler2D, x + 1, y));
}

// A table at a position in texels, whose centres are at i + 0.5: what a linear filter gives, with weights of 32 bits. A table begins at the row `first`.
vec4 luthier_mx_read($texSamplerSignature, vec2 position, vec2 size, float first)
{
    vec2 corner = floor(position - vec2(0.5));
    vec2 weight = position - vec2(0.5) - corner;
    vec2 near = clamp(corner, vec2(0.0), size - vec2(1.0));
    vec2 far = clamp(corner + vec2(1.0), vec2(0.0), size - vec2(1.0));
    vec4 left = luthier_mx_texel($texSamplerSampler2D, vec2(near.x, near.y + first));
    vec4 right = luthier_mx_texel($texSamplerSampler2D, vec2(far.x, near.y + first));
    vec4 top = mix(left, right, weight.x);
    // Rows that nothing lies between are read alone.
    if (weight.y < 0.0001 || far.y == near.y)
    {
        return top;
    }
    left = luthier_mx_texel($texSamplerSampler2D, vec2(near.x, far.y + first));
    right = luthier_mx_texel($texSamplerSampler2D, vec2(far.x, far.y + first));
    return mix(top, mix(left, right, weight.x), weight.y);
}
"""

FRAME = """// The frame of a surface: unit, the normal towards the eye.
struct LuthierMxFrame
{
    vec3 x;
    vec3 y;
    vec3 z;
};

LuthierMxFrame luthier_mx_frame(ClosureData closureData, vec3 tangent)
{
    LuthierMxFrame frame;
    frame.z = mx_forward_facing_normal(closureData.N, closureData.V);
    frame.x = normalize(tangent - dot(tangent, frame.z) * frame.z);
    frame.y = cross(frame.z, frame.x);
    return frame;
}

vec3 luthier_mx_into(LuthierMxFrame frame, vec3 w)
{
    return vec3(dot(w, frame.x), dot(w, frame.y), dot(w, frame.z));
}

// A normal of the world in the frame, on the side of the eye.
vec3 luthier_mx_normal(LuthierMxFrame frame, vec3 normal)
{
    vec3 n = luthier_mx_into(frame, normalize(normal));
    return (n.z < 0.0) ? -n : n;
}

// Unit normal of the texel of a normal map.
vec3 luthier_mx_unit(vec3 texel)
{
    return normalize(2.0 * texel - 1.0);
}

// What MaterialX asks of a BSDF: f cos of a light, or the light of the environment. Nothing is let through.
void luthier_mx_shade(ClosureData closureData, $texSamplerSignature, LuthierMxFrame frame, LuthierPlace place, uint material, inout BSDF bsdf)
{
    bsdf.throughput = vec3(0.0);
    bsdf.response = vec3(0.0);
    if (closureData.closureType != CLOSURE_TYPE_REFLECTION && closureData.closureType != CLOSURE_TYPE_INDIRECT)
    {
        return;
    }
    LuthierPrepared prepared = luthier_prepare_at($texSamplerSampler2D, place, material, luthier_mx_into(frame, closureData.V));
    if (closureData.closureType == CLOSURE_TYPE_REFLECTION)
    {
        bsdf.response = closureData.occlusion * luthier_light($texSamplerSampler2D, prepared, luthier_mx_into(frame, closureData.L));
    }
SURROUNDINGS}
"""

# The mean of draws, as MaterialX has it for its own lobes: each in a mip level as wide as the draw stands for.
INDIRECT = """    else
    {
        int count = $envRadianceSamples;
        for (int i = 0; i < count; i++)
        {
            vec2 even = mx_spherical_fibonacci(i, count);
            LuthierSample drawn = luthier_sample($texSamplerSampler2D, prepared, vec3(even, fract((float(i) + 0.5) * 0.7548776662)));
            if (drawn.pdf > 0.0)
            {
                vec3 wi = drawn.wi.x * frame.x + drawn.wi.y * frame.y + drawn.wi.z * frame.z;
                float lod = mx_latlong_compute_lod(wi, drawn.pdf, float($envRadianceMips - 1), count);
                bsdf.response += drawn.weight * mx_latlong_map_lookup(wi, $envMatrix, lod, $envRadiance);
            }
        }
        bsdf.response *= $envLightIntensity / max(float(count), 1.0);
    }
"""

# The first row of the tables is row 0 of an image that a program loads as it is; the other file is for programs that turn images.
TRANSFORMS = {
    "luthier_mx_transform_uv.glsl": "#define LUTHIER_MX_ROW(y, rows) (rows - 1 - (y))\n",
    "luthier_mx_transform_uv_vflip.glsl": "#define LUTHIER_MX_ROW(y, rows) (y)\n",
}


def rewrite(text, pattern, change):
    """`text` with each call whose name matches replaced by what `change` makes of the match and the arguments."""
    done, at = [], 0
    for_name = re.compile(pattern)
    while match := for_name.search(text, at):
        arguments, begin, depth, end = [], match.end(), 0, match.end()
        while depth or text[end] != ")":
            depth += (text[end] in "([") - (text[end] in ")]")
            if text[end] == "," and not depth:
                arguments.append(text[begin:end])
                begin = end + 1
            end += 1
        arguments.append(text[begin:end])
        arguments = [rewrite(argument.strip(), pattern, change) for argument in arguments if argument.strip()]
        done += [text[at : match.start()], change(match, arguments)]
        at = end + 1
    return "".join(done) + text[at:]


class Text:
    """The text of a shader as its parts: comment and code of each, by name."""

    def __init__(self, source, prefix):
        self.prefix, self.type = prefix, prefix[0].upper() + prefix[1:]
        self.structs, self.functions, self.constants = {}, {}, {}
        comment, lines = [], iter(source.splitlines())
        for line in lines:
            if line.startswith("//") or not line:
                comment = [*comment, line] if line else []
                continue
            code = [line]
            if line.endswith("{"):
                while code[-1] not in ("}", "};"):
                    code.append(next(lines))
            part = ("".join(f"{text}\n" for text in comment), "\n".join(code))
            comment = []
            if match := re.match(r"struct (\w+) \{", line):
                self.structs[match[1]] = part
            elif match := re.match(r"const \w+ (\w+) = (.+);", line):
                self.constants[match[1]] = match[2]
            elif match := re.match(r"\w+ (\w+)\(", line):
                self.functions[match[1]] = part
            elif not line.startswith("uniform "):
                raise Unreadable(f"the shader has a line that this program does not know, {line}: use luthier of its version, and bake anew")

    def members(self, name):
        """Type, name and, of arrays, length of the members of a structure."""
        return re.findall(r"^    (\w+) (\w+)(?:\[(\d+)\])?;", self.structs[name][1], re.M)

    def closure(self, roots):
        """Names of the functions that some need, themselves with them."""
        reached, left = set(), list(roots)
        while left:
            name = left.pop()
            if name not in reached:
                reached.add(name)
                left += [called for called in re.findall(r"\b(\w+)\(", self.functions[name][1]) if called in self.functions]
        return reached

    def material(self, number):
        """The constant of a material."""
        return next(name for name, value in self.constants.items() if "_MATERIAL_" in name and value == f"{number}u")

    def common(self, roots, tables, image):
        """The functions `roots` with all that they need, and those that read the image. `tables` has the size and the first row of each table there."""
        word = f"{self.prefix}_word"
        needed = self.closure(roots) - {word, f"{self.prefix}_bilinear"}
        textures = {word, *(f"{self.prefix}_{table}" for table in tables)}
        reading = {word} | {name for name in needed if any(re.search(rf"\b{texture}\b", self.functions[inner][1]) for inner in self.closure([name]) for texture in textures)}
        code = {name: self.portable(self.functions[name][1], tables, reading) for name in self.functions if name in needed}
        functions = "\n".join(f"{self.functions[name][0]}{text}\n" for name, text in code.items())
        makers = "\n".join(self.makers(functions))
        used, structs = set(re.findall(rf"\b{self.type}\w+", functions)), ""
        for name in reversed(self.structs):
            if name in used:
                comment, text = self.structs[name]
                used |= set(re.findall(rf"\b{self.type}\w+", text))
                structs = f"{comment}{text}\n\n{structs}"
        constants = "".join(f"#define {name} {value}\n" for name, value in self.constants.items())
        head = self.passed(HEAD, reading)
        for name, value in (("ROWS", image.rows), ("WORDS", image.width // 4), ("FIRST", image.first_word)):
            head = head.replace(name, str(value))
        frame = FRAME.replace("SURROUNDINGS", INDIRECT if f"{self.prefix}_sample" in roots else "")
        texts = [head, constants, structs.rstrip("\n") + "\n", makers, functions, self.passed(frame, reading)]
        text = self.renamed("\n".join(part for part in texts if part)) + "\n#undef sampler2D\n"
        return text, reading

    def renamed(self, text):
        """Names of this file, under the prefix of the bake."""
        return text if self.prefix == "luthier" else text.replace("luthier_mx_", f"{self.prefix}_mx_").replace("LuthierMx", f"{self.type}Mx").replace(
            "LUTHIER_MX_", f"{self.prefix.upper()}_MX_"
        )

    def passed(self, text, reading):
        """The text of this file with the names of the bake, and without the image where a function reads no table."""
        text = re.sub(r"\bluthier_(?=(?:word|prepare_at|light|sample)\b)", f"{self.prefix}_", re.sub(r"\bLuthier(?!Mx)", self.type, text))
        for name in ("prepare_at", "light", "sample"):
            if f"{self.prefix}_{name}" not in reading:
                text = text.replace(f"{self.prefix}_{name}({ARGUMENT}, ", f"{self.prefix}_{name}(")
        return text

    def portable(self, code, tables, reading):
        """A function in what all languages have."""
        head, body = code.split("\n", 1)
        read = lambda table, position: f"luthier_mx_read({ARGUMENT}, {position}, vec2({tables[table][0]}.0, {tables[table][1]}.0), {tables[table][2]}.0)"
        for table in tables:
            name, (width, height, _) = f"{self.prefix}_{table}", tables[table]
            body = rewrite(body, rf"\btextureLod\((?={name},)", lambda _, given: read(table, f"{given[1]} * vec2({width}.0, {height}.0)"))
            body = rewrite(body, rf"\b{self.prefix}_bilinear\((?={name},)", lambda _, given: read(table, given[1]))
        # A whole number n is 2^23 + n.
        body = body.replace("floatBitsToUint(word) & 8388607u", "uint(word - 8388608.0)")
        body = rewrite(body, rf"\b({self.type}\w+)(\[\d+\])?\(", self.made)
        for name in reading:
            head = head.replace(f" {name}(", f" {name}({SIGNATURE}, ").replace(", )", ")")
        names = "|".join(sorted(reading, key=len, reverse=True))
        if names:
            body = rewrite(body, rf"\b({names})\(", lambda match, given: f"{match[1]}({', '.join([ARGUMENT, *given])})")
        text = MATH.sub(r"mx_\1(", f"{head}\n{body}")
        if found := FOREIGN.search(text):
            raise Unreadable(f"the shader has {found[0]}, which MaterialX does not translate, in {head}: bake other materials anew without this one")
        return text

    def made(self, match, given):
        """The call that makes a structure."""
        if all(ZERO.fullmatch(value) for value in given):
            return f"{match[1]}_zero()"
        if match[2]:
            raise Unreadable(f"the shader has an array of {match[1]} that is not zero: bake other materials anew without this one")
        return f"{match[1]}_of({', '.join(given)})"

    def makers(self, functions):
        """Functions that make structures: all zeros, or of their members."""
        zeros, left = set(), re.findall(r"\b(\w+)_zero\(\)", functions)
        while left:
            name = left.pop()
            if name not in zeros:
                zeros.add(name)
                left += [kind for kind, _, _ in self.members(name) if kind in self.structs]
        of = set(re.findall(r"\b(\w+)_of\(", functions))
        for name in self.structs:
            if name in zeros:
                lines = []
                for kind, member, length in self.members(name):
                    zero = {"uint": "0u", "float": "0.0", "bool": "false"}.get(kind) or (f"{kind}_zero()" if kind in self.structs else f"{kind}(0.0)")
                    lines += [f"    made.{member}{f'[{i}]' if length else ''} = {zero};" for i in range(int(length or 1))]
                yield "\n".join([f"{name} {name}_zero()", "{", f"    {name} made;", *lines, "    return made;", "}", ""])
            if name in of:
                given = [(f"{kind} {member}_", f"    made.{member} = {member}_;") for kind, member, _ in self.members(name)]
                yield "\n".join(
                    [f"{name} {name}_of({', '.join(take for take, _ in given)})", "{", f"    {name} made;", *(line for _, line in given), "    return made;", "}", ""]
                )
