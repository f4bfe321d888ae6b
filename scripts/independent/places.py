"""Rows of `papers.py`: values at a place of a surface, with its maps, flakes, patina and particles."""

import math
import struct
import zlib

from closed_forms import colours, each, no_base
from papers import *


def picture(width, height, texel, channels=3):
    """A PNG of eight bits, from a function of column and row."""
    rows = b"".join(b"\0" + bytes(v for x in range(width) for v in texel(x, y)) for y in range(height))
    chunk = lambda kind, data: struct.pack(">I", len(data)) + kind + data + struct.pack(">I", zlib.crc32(kind + data))
    head = struct.pack(">IIBBBBB", width, height, 8, {1: 0, 3: 2}[channels], 0, 0, 0)
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(rows)) + chunk(b"IEND", b"")


def even(*texel):
    return picture(4, 4, lambda x, y: texel)


def unit(v):
    length = math.sqrt(dot(v, v))
    return tuple(x / length for x in v)


def cross(a, b):
    return (a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0])


def seen_along(normal):
    """Directions in a frame around a normal. Isotropic surfaces do not tell one tangent from another."""
    tangent = unit(cross((0.3, 0.9, 0.2), normal))
    axes = (tangent, cross(normal, tangent), normal)
    return lambda w: tuple(dot(axis, w) for axis in axes)


def leaning(normal, model):
    local = seen_along(normal)
    return lambda i, o: model(local(i), local(o))


def surface(f, density, masking):
    """F D G / (4 cos cos), without the cosine of the light."""

    def value(i, o):
        h = half(i, o)
        return f(dot(i, h)) * density(h) * masking(i, o, h) / (4 * i[2] * o[2])

    return value


plain = lambda cos: fresnel(METAL, cos)
TURNED = ("--normal", "8,30")
# Texels are numbers of single precision.
SINGLE = 1e-6
TEXELS = [v / 255 for v in (128, 64, 200)]
PLACE = ("--uv", "0.1,0.1")


def maps():
    # Line 2 of algorithm 1: all cosines are those against the map's normal.
    stack = coat(COAT, "alpha = 0.2\n") + metal("alpha = 0.3\n")
    flat = layers([(COAT, 0.2, 0, ggx), (METAL, 0.3, None, ggx)], no_base, clamp=True)
    values(ELEK, "normal map", "algorithm 1, line 2", stack, "elek", leaning(direction(8, 30), flat), extra=TURNED)
    one = facets(ggx(0.3), smith(lambda_ggx, 0.3), plain)
    values(LECTURE, "normal texture", "slide on textures", metal("alpha = 0.3\n"), "microfacet", leaning(direction(8, 30), one), extra=TURNED)

    # The texture scales the slopes of all layers.
    half_as_rough = layers([(COAT, 0.1, 0, ggx), (METAL, 0.15, None, ggx)], no_base, clamp=True)
    values(ELEK, "roughness map", "section 3, last paragraph", stack, "elek", half_as_rough, extra=("--alpha-factor", "0.5"))
    one = facets(ggx(0.15), smith(lambda_ggx, 0.15), plain)
    values(LECTURE, "roughness texture", "slide on textures", metal("alpha = 0.3\n"), "microfacet", one, extra=("--alpha-factor", "0.5"))

    thin = layers([(COAT, 0.2, 0.25 * DEPTH, ggx), (METAL, 0.3, None, ggx)], no_base, clamp=True)
    text = coat(COAT, "alpha = 0.2\n", DEPTH) + metal("alpha = 0.3\n")
    values(ELEK, "thickness map", "section 3, last paragraph", text, "elek", thin, extra=("--slab-factor", "0.25"))

    # Line 22: the diffuse map, times the albedo of the file.
    beside = {"colors.png": even(128, 64, 200)}
    text = coat(COAT, "alpha = 0.1\n") + '[[layer]]\ntype = "diffuse"\nalbedo = 0.9\nmaps = { albedo = "colors.png" }\n'
    bases = [layers([(COAT, 0.1, 0, ggx)], lambert(0.9 * t), clamp=True) for t in TEXELS]
    colours(ELEK, "diffuse map", "algorithm 1, line 22", text, "elek", each(bases), SINGLE, extra=PLACE, beside=beside)
    coloured = each([lambert(rho) for rho in (0.8, 0.3, 0.1)])
    colours(LECTURE, "albedo texture", "slide on textures", matte(0.5), "microfacet", coloured, extra=("--base-color", "0.8,0.3,0.1"))

    # F0 of a half metallic texel: between 0.04 and the base colour, as in the exercise.
    text = '[[layer]]\ntype = "metallic-roughness"\nbase_color = [0.9, 0.6, 0.4]\nmetallic = 1\nalpha = 0.3\n'
    text += 'maps = { base_color = "colors.png", metallic = { image = "colors.png", channel = "r" } }\n'
    amount = TEXELS[0]
    f0 = [0.04 + amount * (c * t - 0.04) for c, t in zip((0.9, 0.6, 0.4), TEXELS)]
    mixed = [facets(ggx(0.3), smith(lambda_ggx, 0.3), lambda cos, f=f: schlick(f, cos)) for f in f0]
    colours(LECTURE, "metallic texture", "slide on textures; exercise", text, "microfacet", each(mixed), SINGLE, extra=PLACE, beside=beside)


def below_a_coat(m1, m2, normal, depth=0.0):
    """Two layers with a flake as the lower one: directions are refracted at the surface's normal, and their cosines are those against the flake, as in
    Elek's code, which changes N between lines 13 and 14."""
    local = seen_along(normal)

    def value(i, o):
        h = half(i, o)
        f, g = fresnel(COAT, dot(i, h)), v_cavity(i, o, h)
        ti, to = local(refracted(i, COAT)), local(refracted(o, COAT))
        through = (1 - f) * ((1 - g) + (1 - f) * g) * math.exp(-depth * (1 / ti[2] + 1 / to[2]))
        lower = surface(lambda cos: fresnel(METAL, cos, COAT), ggx(m2), v_cavity)(ti, to)
        return f * ggx(m1)(h) * g / (4 * o[2]) + through * lower * i[2]

    return value


def bumpy_coat(m1, m2, normal):
    """Two layers, the upper with a bump, at which light is refracted. The lower one is level. Each has the light by the cosine that it has there."""
    local = seen_along(normal)
    back = lambda w: tuple(dot(axis, w) for axis in [local(axis) for axis in ((1, 0, 0), (0, 1, 0), (0, 0, 1))])

    def value(i, o):
        i, o = local(i), local(o)
        h = half(i, o)
        f, g = fresnel(COAT, dot(i, h)), v_cavity(i, o, h)
        through = (1 - f) * ((1 - g) + (1 - f) * g)
        ti, to = refracted(i, COAT), refracted(o, COAT)
        lower = surface(lambda cos: fresnel(METAL, cos, COAT), ggx(m2), v_cavity)(back(ti), back(to))
        return f * ggx(m1)(h) * g / (4 * o[2]) + through * lower * i[2] * back(ti)[2] / ti[2]

    return value


def flakes():
    texel = [2 * v / 255 - 1 for v in (153, 140, 252)]

    # N += max(distance, 1) (0, 0, 1) + (2 texel - 1): here the distance counts from where flakes begin to fade.
    def normal(distance, scale, flake=texel):
        return unit(tuple(z * (1 + max(distance, 1)) + scale * m for z, m in zip((0, 0, 1), flake)))

    stack = coat(COAT, "alpha = 0.05\n", DEPTH) + metal("alpha = 0.2\n")
    for name, where, distance, scale in [
        ("flakes below a coat", "section 4.1", 0.5, 1),
        ("flakes at a distance", "section 4.1; figure 7", 8, 1),
        ("weight of the flakes", "section 4.1", 0.5, 0.25),
    ]:
        text = f'{stack}[effects.flakes]\nnormal_map = "bumps.png"\ntiling = 4\nscale = {scale}\nfade_start = 2\n'
        model = below_a_coat(0.05, 0.2, normal(distance / 2, scale), DEPTH)
        extra = (*PLACE, "--distance", str(distance))
        colours(ELEK, name, where, text, "elek", each([model] * 3), SINGLE, extra=extra, beside={"bumps.png": even(153, 140, 252)})

    # Read without filtering: each of sixteen texels leans by itself, right up to its sides.
    leans = lambda x, y: (100 + 18 * x, 150 - 12 * y, 252)
    text = f'{stack}[effects.flakes]\nnormal_map = "bumps.png"\ntiling = 2\nscale = 1\nfade_start = 2\n'
    pairs = []
    for u, v in [(0.01, 0.02), (0.12, 0.3), (0.13, 0.3), (0.245, 0.49), (0.255, 0.49), (0.37, 0.12), (0.38, 0.13), (0.6, 0.88)]:
        m = [2 * t / 255 - 1 for t in leans(int(8 * u) % 4, int(8 * v) % 4)]
        by_hand = below_a_coat(0.05, 0.2, normal(0.25, 1, m), DEPTH)(direction(30, 0), direction(45, 140))
        extra = ("--uv", f"{u},{v}", "--distance", "0.5", "--wi", "30,0", "--wo", "45,140")
        told = ask(text, "--model", "elek", *extra, beside={"bumps.png": picture(4, 4, leans)})["values"][0]["value"]
        pairs.append((by_hand, told[0]))
    row(ELEK, "flakes read without filtering", "section 4.1", pairs, SINGLE)

    # Heights of a picture four texels wide: white is 0.4 of its width above black. The baked map has steps of 1 / 255.
    heights = lambda x, y: (40 * x + 20 * y) / 255
    x, y = 1, 1
    along, across = [(heights(*a) - heights(*b)) / 2 * 0.4 * 4 for a, b in (((x + 1, y), (x - 1, y)), ((x, y - 1), (x, y + 1)))]
    m = [round((v + 1) / 2 * 255) / 255 * 2 - 1 for v in unit((-along, -across, 1))]
    text = coat(COAT, "alpha = 0.1\n") + metal("alpha = 0.1\n")
    text += '[effects.flakes]\nheight_map = { image = "heights.png", height = 0.4 }\ntiling = 4\nfade_start = 1000\n'
    model = below_a_coat(0.1, 0.1, normal(0, 1, m))
    beside = {"heights.png": picture(4, 4, lambda x, y: (40 * x + 20 * y,), 1)}
    colours(ELEK, "flakes from heights", "section 4.1; figure 6", text, "elek", each([model] * 3), SINGLE, extra=PLACE, beside=beside)

    # The course: bumps of the metal below a varnish, and of the varnish above a level metal.
    text = coat(COAT, "alpha = 0.1\n") + metal("alpha = 0.1\n")
    bumps = {"bumps.png": even(153, 140, 252)}
    below = f'{text}[effects.flakes]\nnormal_map = "bumps.png"\ntiling = 4\nscale = 1\nfade_start = 1000\n'
    model = below_a_coat(0.1, 0.1, normal(0, 1))
    colours(COURSE, "bumps below a varnish", "figure 3.9d", below, "weidlich-wilkie", each([model] * 3), SINGLE, extra=PLACE, beside=bumps)
    above = text.replace("[[layer]]", 'maps = { bumps = "bumps.png" }\n[[layer]]').removeprefix('maps = { bumps = "bumps.png" }\n')
    model = bumpy_coat(0.1, 0.1, unit(texel))
    colours(COURSE, "bumps of a varnish", "figure 3.9d, the reverse", above, "weidlich-wilkie", each([model] * 3), SINGLE, extra=PLACE, beside=bumps)


def patina():
    """Section 4.2: the model with and without the first layer, blended by how much has grown. That is 0 at an extent of -transition and 1 at one of
    1 + transition whatever the map, and linear between."""
    n, map_value, diffuse = 2.0, 0.375, (0.25, 0.55, 0.42)
    cover = f'[[layer]]\ntype = "dielectric"\nior = {n}\nalpha = 0.35\nthickness_um = 1\nabsorption_per_um = [0.9, 0.25, 0.5]\n'
    for name, keys, extent, transition, m2, base_alpha, tarnish, scattered in [
        ("growth of patina", "diffuse_albedo = 0", 0.45, 0.65, 0.35, None, (1, 1, 1), (0, 0, 0)),
        ("growth of patina, further", "diffuse_albedo = 0", 0.85, 0.65, 0.35, None, (1, 1, 1), (0, 0, 0)),
        ("soft edge of patina", "diffuse_albedo = 0", 0.45, 0.9, 0.35, None, (1, 1, 1), (0, 0, 0)),
        ("diffuse part of patina", f"diffuse_albedo = {list(diffuse)}", 0.45, 0.65, 0.35, None, (1, 1, 1), diffuse),
        ("diffuse part that absorption leaves", "diffuse_remainder = 0.7", 0.45, 0.65, 0.35, None, (1, 1, 1), [0.7 * math.exp(-s) for s in (0.9, 0.25, 0.5)]),
        ("metal roughened by patina", "diffuse_albedo = 0\nbase_alpha = 0.8", 0.45, 0.65, 0.2, 0.8, (1, 1, 1), (0, 0, 0)),
        ("tarnish", "diffuse_albedo = 0\ntarnish = [0.8, 0.45, 0.25]", 0.45, 0.65, 0.35, None, (0.8, 0.45, 0.25), (0, 0, 0)),
    ]:
        grown = min(max(0.5 + (extent - map_value) / (2 * transition), 0), 1)
        m2_here = m2 if base_alpha is None else m2 + grown * (base_alpha - m2)
        channels = []
        for sigma, dark, rho in zip((0.9, 0.25, 0.5), tarnish, scattered):
            dark = 1 + grown * (dark - 1)
            bare = facets(ggx(m2_here), v_cavity, lambda cos, dark=dark: dark * plain(cos))

            def covered(i, o, sigma=sigma, dark=dark, rho=rho):
                upper = layers([(n, 0.35, sigma, ggx)], no_base)(i, o)
                both = layers([(n, 0.35, sigma, ggx), (METAL, m2_here, None, ggx)], no_base, clamp=True)(i, o)
                passed = 1 - fresnel(n, dot(i, half(i, o)))
                return upper + dark * (both - upper) + passed * rho * i[2] / PI

            channels.append(lambda i, o, bare=bare, covered=covered: (1 - grown) * bare(i, o) + grown * covered(i, o))
        text = cover + metal(f"alpha = {m2}\n") + "[effects.patina]\n"
        text += f"extent = {extent}\ntransition = {transition}\nmap = {{ noise = {{ seed = 4, frequency = 3, octaves = 5 }} }}\n{keys}\n"
        colours(ELEK, name, "section 4.2", text, "elek", each(channels), extra=("--map", str(map_value)))


def particles():
    """Section 5.2.1: Voronoi cells that choose a stack, and particles that lean by a random angle, uniform in solid angle."""
    matte_files = {f"{k}.toml": f'schema = 1\nname = "{k}"\n{matte(rho)}' for k, rho in (("a", 0.2), ("b", 0.7))}
    glitter = f'schema = 1\nname = "c"\n{metal("alpha = 0.2")}\n'
    cell = lambda seed, frequency, u, v: voronoi(seed, frequency * u, frequency * v)
    steps = [((k * 0.7548776662) % 1, (k * 0.5698402910) % 1) for k in range(1, 25)]
    i, o = direction(30, 0), direction(45, 140)
    angles = ("--wi", "30,0", "--wo", "45,140")
    one = facets(ggx(0.2), v_cavity, plain)

    def tilted(word, most):
        cos = 1 - number(word, 4) * (1 - math.cos(math.radians(most)))
        sin, phi = math.sqrt(1 - cos * cos), 2 * PI * number(word, 5)
        return leaning((sin * math.cos(phi), sin * math.sin(phi), cos), one)(i, o)

    def at_places(name, where, text, beside, by_hand):
        pairs, kinds = [], set()
        for u, v in steps:
            kind, expected = by_hand(u, v)
            told = ask(text, "--model", "weidlich-wilkie", "--uv", f"{u},{v}", *angles, beside=beside)
            pairs.append((expected, told["values"][0]["value"][0]))
            kinds.add(kind)
        assert len(kinds) > 1, name
        row(COURSE, name, where, pairs, 1e-9)

    def chosen(u, v):
        rho = (0.2, 0.7)[int(2 * number(cell(0, 20, u, v), 2))]
        return rho, rho * i[2] / PI

    text = 'surface = 1\nname = "s"\n[cells]\nfrequency = 20\nmaterials = ["a.toml", "b.toml"]\n'
    at_places("cells of several stacks", "section 5.2.1", text, matte_files, chosen)

    def sparkling(u, v):
        word = cell(1, 20, u, v)
        return (True, tilted(word, 17)) if number(word, 3) < 0.4 else (False, 0.2 * i[2] / PI)

    text = 'surface = 1\nname = "s"\n[cells]\nmaterials = ["a.toml"]\n[glitter]\nseed = 1\nfrequency = 20\nfilled = 0.4\ntilt_deg = 17\nmaterials = ["c.toml"]\n'
    at_places("glitter cells with a stack", "section 5.2.1", text, {**matte_files, "c.toml": glitter}, sparkling)

    text = metal("alpha = 0.2\n") + "[effects.glitter]\nseed = 3\nfrequency = 20\nfilled = 1\ntilt_deg = 20\n"
    leans = lambda u, v: (u, tilted(cell(3, 20, u, v), 20))
    at_places("tilted cells", "section 5.2.1, glitter map", text, {}, leans)


def compare():
    maps()
    flakes()
    patina()
    particles()
