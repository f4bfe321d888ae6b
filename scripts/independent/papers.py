"""Elements of the five papers, worked out anew in Python from their formulas and compared with what `luthier eval` prints.

    python3 scripts/independent/papers.py [PROGRAM] >docs/pages/by-hand.md

PROGRAM is `target/release/luthier` unless given. It ends with 1 where an element differs by more than the row allows. Nothing but Python 3 is needed,
and nothing of luthier is read but its output. It takes two minutes. Files beside it have more rows, by what they need:

    closed_forms.py   one function of two directions
    places.py         textures, flakes, patina, cells
    spreads.py        statistics of light, with random walks for energies
    tables.py         texels of baked files
    requirements.py   laws, integrals, and colours of spectra
"""

import cmath
import importlib
import json
import math
import os
import struct
import subprocess
import sys
import tempfile
import zlib

PROGRAM = os.path.abspath(sys.argv[1] if len(sys.argv) > 1 else "target/release/luthier")
NM = 550.0
# theta_i, phi_i, theta_o, phi_o in degrees.
PAIRS = [(30, 0, 45, 140), (10, 20, 12, 200), (65, 0, 50, 190)]
PI = math.pi


# Vectors and directions.


def direction(theta, phi):
    theta, phi = math.radians(theta), math.radians(phi)
    return (math.sin(theta) * math.cos(phi), math.sin(theta) * math.sin(phi), math.cos(theta))


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def half(a, b):
    h = [x + y for x, y in zip(a, b)]
    length = math.sqrt(dot(h, h))
    return tuple(x / length for x in h)


def refracted(w, eta):
    """Direction below a plane, turned up again."""
    x, y = w[0] / eta, w[1] / eta
    return (x, y, math.sqrt(1 - x * x - y * y))


# Reflectances.


def amplitudes(n_a, n_b, cos_a, cos_b):
    s = (n_a * cos_a - n_b * cos_b) / (n_a * cos_a + n_b * cos_b)
    p = (n_b * cos_a - n_a * cos_b) / (n_b * cos_a + n_a * cos_b)
    return s, p


def cosine_in(n_a, n_b, cos_a):
    return cmath.sqrt(1 - (n_a / n_b) ** 2 * (1 - cos_a * cos_a))


def fresnel_sp(n, cos, above=1.0):
    return tuple(abs(r) ** 2 for r in amplitudes(above, n, cos, cosine_in(above, n, cos)))


def fresnel(n, cos, above=1.0):
    return sum(fresnel_sp(n, cos, above)) / 2


def airy_sp(n_film, thickness, n_base, cos):
    """Airy's sum of one film."""
    cos_f, cos_b = cosine_in(1, n_film, cos), cosine_in(1, n_base, cos)
    top, bottom = amplitudes(1, n_film, cos, cos_f), amplitudes(n_film, n_base, cos_f, cos_b)
    turn = cmath.exp(1j * 4 * PI * n_film * thickness * cos_f / NM)
    return tuple(abs((a + b * turn) / (1 + a * b * turn)) ** 2 for a, b in zip(top, bottom))


def schlick(f0, cos):
    return f0 + (1 - f0) * (1 - cos) ** 5


def f0_of(n):
    return abs((n - 1) / (n + 1)) ** 2


def lazanyi(n, cosines=256):
    """Schlick's form less a c (1 - c)^e: e in eighths from 1 to 16, a by least squares over midpoints of the cosine."""
    f0 = f0_of(n)
    points = [((i + 0.5) / cosines) for i in range(cosines)]
    excess = [schlick(f0, c) - fresnel(n, c) for c in points]
    best = None
    for e in (k / 8 for k in range(8, 129)):
        shape = [c * (1 - c) ** e for c in points]
        a = sum(s * x for s, x in zip(shape, excess)) / sum(s * s for s in shape)
        left = sum((x - a * s) ** 2 for s, x in zip(shape, excess))
        if best is None or left < best[0]:
            best = (left, a, e)
    _, a, e = best
    return lambda cos: min(max(schlick(f0, cos) - a * cos * (1 - cos) ** e, 0.0), max(f0, 1.0))


def f82(n, cos):
    """Schlick's form with the term that makes it exact at a cosine of 1/7."""
    f0, at = f0_of(n), 1 / 7
    weight = (schlick(f0, at) - min(fresnel(n, at), schlick(f0, at))) / (at * (1 - at) ** 6)
    return schlick(f0, cos) - weight * cos * (1 - cos) ** 6


def two_beams(n, thickness, cos):
    """Granier and Heidrich, eq. 5 at aligned boundaries."""
    inside = math.sqrt(1 - (1 - cos * cos) / (n * n))
    r = schlick(f0_of(n), cos)
    t = (1 - r) * (1 - schlick(f0_of(n), inside))
    return r + t + 2 * math.cos(4 * PI * n * thickness / NM * inside) * math.sqrt(r * t)


def belcour_barla(n_film, thickness, n_base, cos, orders=2):
    """Airy's sum as a series in the orders of interference, cut off."""
    cos_f = cosine_in(1, n_film, cos).real
    cos_b = cosine_in(n_film, n_base, cos_f)
    total = 0.0
    for r12, r23 in zip(amplitudes(1, n_film, cos, cos_f), amplitudes(n_film, n_base, cos_f, cos_b)):
        r12 = r12.real if isinstance(r12, complex) else r12
        through, far = 1 - r12 * r12, abs(r23) ** 2
        later = through * through * far / (1 - r12 * r12 * far)
        echo = -r12 * r23
        rho, turn = abs(echo), cmath.phase(echo)
        part = r12 * r12 + later
        for order in range(1, orders + 1):
            phase = 2 * PI * order * 2 * n_film * thickness * cos_f / NM + order * turn
            part += 2 * rho**order * (later - through) * math.cos(phase)
        total += part / 2
    return total


# Distributions of facet normals, as functions of the half vector.


def beckmann(alpha):
    return lambda h: math.exp(-(1 / h[2] ** 2 - 1) / alpha**2) / (PI * alpha**2 * h[2] ** 4)


def ggx(alpha):
    return lambda h: alpha**2 / (PI * ((alpha**2 - 1) * h[2] ** 2 + 1) ** 2)


def blinn(alpha):
    e = 2 / alpha**2 - 2
    return lambda h: (e + 2) / (2 * PI) * h[2] ** e


def simpson(f, a, b, steps=4000):
    width = (b - a) / steps
    return width / 3 * sum((1 if k in (0, steps) else 4 if k % 2 else 2) * f(a + k * width) for k in range(steps + 1))


def abc(alpha):
    return abc_of(2 / alpha**2, 2.0)


def abc_of(b, c):
    norm = 2 * PI * simpson(lambda cos: cos / (1 + b * (1 - cos)) ** c, 0, 1)
    return lambda h: 1 / (norm * (1 + b * (1 - h[2])) ** c)


def sgd(alpha):
    a = alpha**2
    # With p = 1 the norm is the exponential integral E1(a).
    e1 = simpson(lambda y: math.exp(-a * math.exp(y)), 0, math.log(60 / a), 20000)

    def density(h):
        x = a * a + 1 / h[2] ** 2 - 1
        return math.exp(-x / a) / (e1 * x) / (PI * h[2] ** 4)

    return density


def sgd_of(a, p):
    # The norm is the incomplete gamma function of 1 - p and a.
    gamma = simpson(lambda y: math.exp((1 - p) * y - math.exp(y)), math.log(a), math.log(60), 20000)

    def density(h):
        x = a * a + 1 / h[2] ** 2 - 1
        return a ** (p - 1) / gamma * math.exp(-x / a) / x**p / (PI * h[2] ** 4)

    return density


def stretched(alpha_x, alpha_y, radial):
    return lambda h: radial((h[0] / alpha_x) ** 2 + (h[1] / alpha_y) ** 2, h[2]) / (PI * alpha_x * alpha_y)


def ward(alpha_x, alpha_y):
    return stretched(alpha_x, alpha_y, lambda sq, cos: math.exp(-sq / cos**2) / cos**4)


def ggx_stretched(alpha_x, alpha_y):
    return stretched(alpha_x, alpha_y, lambda sq, cos: 1 / (sq + cos**2) ** 2)


# Masking: functions of both directions and the half vector.


def slope(w, alpha_x, alpha_y=None):
    alpha_y = alpha_x if alpha_y is None else alpha_y
    return math.hypot(alpha_x * w[0], alpha_y * w[1]) / w[2]


def lambda_ggx(a):
    return (math.sqrt(1 + a * a) - 1) / 2


def lambda_beckmann(a):
    nu = 1 / a
    return (math.erf(nu) - 1) / 2 + math.exp(-nu * nu) / (2 * nu * math.sqrt(PI))


def lambda_by_quadrature(density, w, steps=600):
    """1/G1 - 1, from the area of the facets that a direction sees."""
    seen = 0.0
    sin, cos = math.sqrt(1 - w[2] ** 2), w[2]
    for i in range(steps):
        theta = (i + 0.5) / steps * PI / 2
        inner = 0.0
        for j in range(steps):
            phi = (j + 0.5) / steps * PI
            inner += max(0.0, sin * math.sin(theta) * math.cos(phi) + cos * math.cos(theta))
        seen += density((0, 0, math.cos(theta))) * math.sin(theta) * inner
    return seen * 2 * (PI / 2 / steps) * (PI / steps) / cos - 1


def smith(function, alpha_x, alpha_y=None):
    return lambda i, o, h: 1 / (1 + function(slope(i, alpha_x, alpha_y)) + function(slope(o, alpha_x, alpha_y)))


def smith_separable(function, alpha):
    return lambda i, o, h: 1 / ((1 + function(slope(i, alpha))) * (1 + function(slope(o, alpha))))


def smith_of(density):
    return lambda i, o, h: 1 / (1 + lambda_by_quadrature(density, i) + lambda_by_quadrature(density, o))


def v_cavity(i, o, h):
    return min(1, 2 * h[2] * i[2] / dot(i, h), 2 * h[2] * o[2] / dot(o, h))


def kelemen(i, o, h):
    return min(1, i[2] * o[2] / dot(i, h) ** 2)


def implicit(i, o, h):
    return i[2] * o[2]


def schlick_smith(alpha):
    k = alpha * math.sqrt(2 / PI)
    return lambda i, o, h: i[2] / (i[2] * (1 - k) + k) * o[2] / (o[2] * (1 - k) + k)


# Models: f cos theta_i.


def facets(density, masking, reflectance):
    """Torrance and Sparrow: F D G / (4 cos_i cos_o), times cos_i."""

    def value(i, o):
        h = half(i, o)
        return reflectance(dot(i, h)) * density(h) * masking(i, o, h) / (4 * o[2])

    return value


def oren_nayar(rho, sigma):
    def value(i, o):
        sq = sigma * sigma
        thetas = sorted(math.acos(w[2]) for w in (i, o))
        beta, alpha = thetas
        cos_phi = (i[0] * o[0] + i[1] * o[1]) / (math.sin(beta) * math.sin(alpha))
        c1 = 1 - 0.5 * sq / (sq + 0.33)
        c2 = 0.45 * sq / (sq + 0.09) * (math.sin(alpha) - (0 if cos_phi >= 0 else (2 * beta / PI) ** 3))
        c3 = 0.125 * sq / (sq + 0.09) * (4 * alpha * beta / PI**2) ** 2
        first = c1 + cos_phi * c2 * math.tan(beta) + (1 - abs(cos_phi)) * c3 * math.tan((alpha + beta) / 2)
        later = 0.17 * sq / (sq + 0.13) * (1 - cos_phi * (2 * beta / PI) ** 2)
        return i[2] / PI * (rho * first + rho * rho * later)

    return value


def blinn_phong(alpha, i, o):
    e = 2 / alpha**2 - 2
    return (e + 2) / (8 * PI) * half(i, o)[2] ** e


def phong_lobe(alpha, i, o):
    e = (2 / alpha**2 - 2) / 4
    return (e + 2) / (2 * PI) * max(0.0, dot((-i[0], -i[1], i[2]), o)) ** e


def layers(surfaces, base, transmit="half", clamp=False, inside=True, in_air=False, own_cosine=False, cavities=None, lower=None, beside=None):
    """The recursion of Weidlich and Wilkie, eq. 3.1 to 3.3, in Elek's form: surfaces are (eta, alpha, optical depth, distribution, index below over vacuum)."""

    def value(i, o):
        total, through, wi, wo, above, least = 0.0, 1.0, i, o, 1.0, 0.0
        for index, alpha, depth, distribution in surfaces:
            least = max(least, alpha) if clamp else alpha
            h = half(wi, wo)
            cos_d = dot(wi, h)
            f, g = fresnel(index, cos_d, 1.0 if in_air else above), (cavities or v_cavity)(wi, wo, h)
            seen = wi[2] / i[2] if own_cosine else 1
            facets = distribution(least)(h) * g / (4 * wi[2] * wo[2])
            if lower and above > 1:
                facets, g = lower(least, wi, wo), 1
            total += seen * through * f * facets
            if depth is None:
                return total * i[2]
            eta = index / above
            ti, to = refracted(wi, eta), refracted(wo, eta)
            if transmit == "half":
                t = 1 - f
                through *= t * ((1 - g) + t * g if inside else 1)
            else:
                through *= (1 - fresnel(index, wi[2], above)) * (1 - fresnel(index, wo[2], above))
            through *= math.exp(-depth * (1 / ti[2] + 1 / to[2]))
            wi, wo, above = ti, to, index
        if beside:
            # Line 22 of Algorithm 1: a metal of this F0, and (1 - F2) of the diffuse part, in one layer.
            f0, alpha, distribution = beside
            least = max(least, alpha) if clamp else alpha
            h = half(wi, wo)
            f = schlick(f0, dot(wi, h))
            total += through * f * distribution(least)(h) * v_cavity(wi, wo, h) / (4 * wi[2] * wo[2])
            through *= 1 - f
        return (total + through * base(wi, wo) / wi[2]) * i[2]

    return value


def lambert(rho):
    return lambda i, o: rho * i[2] / PI


def phong_of_metal(n, alpha):
    e = (2 / alpha**2 - 2) / 4
    return lambda i, o: f0_of(n) * (e + 1) / (2 * PI) * max(0.0, dot((-i[0], -i[1], i[2]), o)) ** e


def granier(n, thickness, alpha, rho, lean=(0.0, 0.0), exponents=None, weights=(1.0, 1.0), printed=False):
    """Eq. 3 to 18 of Granier and Heidrich, each lobe times (e + 1) / (2 pi), that of the film over solid angles in it; no thickness, no interference. Lobes have height one if printed."""
    e0, e1 = exponents or (2 / alpha**2 - 2,) * 2
    f = f0_of(n)
    inner = direction(*lean)

    def value(i, o):
        fi = schlick(f, i[2])
        r = fi * max(0.0, dot((-i[0], -i[1], i[2]), o)) ** e0
        ti, to = refracted(i, n), refracted(o, n)
        along = dot(ti, inner)
        mirrored = tuple(2 * along * m - x for m, x in zip(inner, ti))
        t = (1 - fi) * (1 - schlick(f, to[2])) * max(0.0, dot(mirrored, to)) ** e1
        if not printed:
            r *= (e0 + 1) / (2 * PI)
            t *= (e1 + 1) / (2 * PI) * i[2] / (n * n * ti[2])
        rd = (21 * (n * n + 1) - 38 * n) / (21 * (n + 1) ** 2)
        phase = lambda cosines: 0 if thickness is None else 2 * math.cos(2 * PI * n * thickness / NM * cosines)
        diffuse = max(0.0, 1 + phase(2) * math.sqrt(rd * (1 - rd)))
        specular = max(0.0, r + t + phase(ti[2] + to[2]) * math.sqrt(r * t))
        return weights[0] * specular + weights[1] * rho * diffuse / PI * i[2]

    return value


def coated_lambert(n, rho):
    """Albedo of a smooth coat on a white base: what it mirrors, and the series of inner bounces."""
    outside = simpson(lambda u: 4 * u**3 * fresnel(n, u * u), 0, 1)
    inside = 1 - (1 - outside) / (n * n)
    return lambda cos: fresnel(n, cos) + (1 - fresnel(n, cos)) * (1 - inside) * rho / (1 - rho * inside)


def coated_metal(n, depth):
    """Albedo of a smooth tinted coat on a smooth metal: s and p apart would differ, luthier adds unpolarised powers."""

    def albedo(cos):
        inside = math.sqrt(1 - (1 - cos * cos) / (n * n))
        f, r, a = fresnel(n, cos), fresnel(METAL, inside, n), math.exp(-2 * depth / inside)
        return f + (1 - f) ** 2 * r * a / (1 - f * r * a)

    return albedo


# Materials.

METAL = 0.2 + 3.4j
COAT, INNER, DEPTH = 1.5, 1.8, 0.3


def metal(surface):
    return f'[[layer]]\ntype = "conductor"\nior = {{ n = {METAL.real}, k = {METAL.imag} }}\n{surface}'


def coat(index, surface, depth=0.0):
    return f'[[layer]]\ntype = "dielectric"\nior = {index}\n{surface}\nthickness_um = 1\nabsorption_per_um = {depth}\n'


def matte(rho, sigma=0):
    return f'[[layer]]\ntype = "diffuse"\nalbedo = {rho}\nsigma = {sigma}\n'


def film(index, thickness):
    return f'[[layer]]\ntype = "thin-film"\nior = {index}\nthickness_nm = {thickness}\n'


# What is compared.


def ask(text, *arguments, beside=None, colour=("--wavelength", str(NM))):
    """What `eval` prints of layers, or of a surface file with its materials beside it; pictures may stand beside either."""
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "m.toml")
        files = {"m.toml": text if text.startswith("surface") else f'schema = 1\nname = "m"\n{text}', **(beside or {})}
        for name, content in files.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(content if isinstance(content, bytes) else content.encode())
        command = [PROGRAM, "eval", path, "--json", *colour, *arguments]
        run = subprocess.run(command, capture_output=True, text=True, cwd=folder)
        if run.returncode != 0:
            sys.exit(f"{run.stdout}{run.stderr}\n{text}{' '.join(command)}")
        return json.loads(run.stdout)


def png(texel):
    """A picture of one texel, RGB of eight bits."""
    chunk = lambda name, data: struct.pack(">I", len(data)) + name + data + struct.pack(">I", zlib.crc32(name + data))
    head, row_of = struct.pack(">IIBBBBB", 1, 1, 8, 2, 0, 0, 0), bytes([0, *texel])
    return b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(row_of)) + chunk(b"IEND", b"")


ROWS = []


def row(paper, element, where, pairs, allowed):
    """A row of the page: pairs of values by hand and by the program."""
    worst = max(abs(a - b) / max(abs(a), abs(b), 1e-300) for a, b in pairs)
    ROWS.append((paper, element, where, pairs[0][0], worst, allowed))


def values(paper, element, where, text, model, by_hand, allowed=1e-9, extra=(), picture=None):
    got = []
    for ti, pi, to, po in PAIRS:
        [value] = ask(text, "--model", model, "--wi", f"{ti},{pi}", "--wo", f"{to},{po}", *extra, beside={"map.png": picture} if picture else None)["values"][0]["value"]
        got.append((by_hand(direction(ti, pi), direction(to, po)), value))
    row(paper, element, where, got, allowed)


def albedos(paper, element, where, text, model, by_hand, allowed, extra=()):
    angles = (0, 45, 70)
    told = ask(text, "--model", model, "--albedo", "--angles", ",".join(map(str, angles)), *extra)["albedo"]
    got = [(by_hand(math.cos(math.radians(angle))), entry["albedo"]) for angle, entry in zip(angles, told)]
    row(paper, element, where, got, allowed)


def polarised(paper, element, where, text, by_hand):
    angles = (0, 45, 60, 80)
    told = ask(text, "--polarised", "--angles", ",".join(map(str, angles)))["polarised"]
    for k, name in enumerate(("refl_s", "refl_p")):
        got = [(by_hand(math.cos(math.radians(angle)))[k], entry[name][0]) for angle, entry in zip(angles, told)]
        row(paper, f"{element}, {name[-1]}", where, got, 1e-9)


ELEK, GRANIER, YAMAGUCHI, LECTURE, COURSE = "Elek", "Granier and Heidrich", "Yamaguchi", "lecture", "course"


# Surfaces of several materials: PCG numbers of lattice cells, Voronoi cells, Perlin noise.


def mix(x):
    """PCG's output function after one step (Jarzynski and Olano 2020)."""
    state = (x * 747796405 + 2891336453) % 2**32
    word = ((state >> ((state >> 28) + 4)) ^ state) * 277803737 % 2**32
    return (word >> 22) ^ word


def lattice(seed, x, y):
    return mix((mix((mix(seed) + x) % 2**32) + y) % 2**32)


def number(word, index):
    return (mix((word + index * 0x9E3779B9) % 2**32) >> 8) / 2**24


def voronoi(seed, x, y):
    """The word of the nearest random point, one in each square of the lattice."""
    squares = [(i, j) for j in range(math.floor(y) - 3, math.floor(y) + 4) for i in range(math.floor(x) - 3, math.floor(x) + 4)]
    words = [(i, j, lattice(seed, i, j)) for i, j in squares]
    return min(words, key=lambda s: math.hypot(s[0] + number(s[2], 0) - x, s[1] + number(s[2], 1) - y))[2]


def perlin(seed, x, y, octaves):
    """Perlin's noise: gradients of length sqrt(2) at multiples of 45 degrees, blended by the curve of 2002."""
    total = 0.0
    for octave in range(octaves):
        u, v = x * 2**octave, y * 2**octave
        i, j = math.floor(u), math.floor(v)
        for di, dj in ((0, 0), (1, 0), (0, 1), (1, 1)):
            turn = int(number(lattice(seed + octave, i + di, j + dj), 0) * 8)
            s = 1 if turn & 4 else -1
            # An even number is a diagonal, an odd one an axis.
            gradient = ((1 if turn & 2 else -1), s) if turn % 2 == 0 else ((0, s * math.sqrt(2)) if turn & 2 else (s * math.sqrt(2), 0))
            weight = 1.0
            for d in (abs(u - i - di), abs(v - j - dj)):
                weight *= 1 - (6 * d**5 - 15 * d**4 + 10 * d**3)
            total += weight * (gradient[0] * (u - i - di) + gradient[1] * (v - j - dj)) / 2**octave
    return total / sum(0.5**octave for octave in range(octaves))


def switched():
    """Bases of four albedos at forty places: two in the veins of noise, one in larger cells, and one elsewhere."""
    albedos = {"ground": 0.2, "vein": 0.5, "pale": 0.9, "tile": 0.35}
    surface = (
        'surface = 1\nname = "s"\n[cells]\nmaterials = ["ground.toml"]\n'
        "[[switch]]\nnoise = { seed = 8, frequency = 5, octaves = 3, between = [-0.12, 0.08] }\n"
        'cells = { seed = 3, frequency = 30, materials = ["vein.toml", "pale.toml", "vein.toml"] }\n'
        "[[switch]]\ntiles = { seed = 4, frequency = 6, share = 0.5 }\ncells = { materials = [\"tile.toml\"] }\n"
    )
    beside = {f"{name}.toml": f'schema = 1\nname = "{name}"\n{matte(rho)}' for name, rho in albedos.items()}
    pairs, names = [], set()
    for k in range(1, 41):
        u, v = (k * 0.7548776662) % 1, (k * 0.5698402910) % 1
        if -0.12 <= perlin(8, 5 * u, 5 * v, 3) <= 0.08:
            name = ("vein", "pale", "vein")[int(number(voronoi(3, 30 * u, 30 * v), 2) * 3)]
        else:
            name = "tile" if number(voronoi(4, 6 * u, 6 * v), 2) < 0.5 else "ground"
        [value] = ask(surface, "--model", "lambert", "--uv", f"{u},{v}", "--wi", "30,0", "--wo", "45,140", beside=beside)["values"][0]["value"]
        pairs.append((albedos[name] / PI * math.cos(math.radians(30)), value))
        names.add(name)
    assert len(names) == 4, names
    row(COURSE, "noise that switches between maps", "section 5.2.1, lepidolite", pairs, 1e-9)


def compare():
    a = 0.4
    rough = f"alpha = {a}\n"
    base, plain = metal(rough), lambda cos: fresnel(METAL, cos)
    smooth = "smooth = true\n"
    glass = f'[[layer]]\ntype = "dielectric"\nior = {COAT}\n{smooth}'
    soap = (1.4, 300.0)

    # Reflectances.
    polarised(ELEK, "Fresnel, glass", "section 2.1", glass, lambda cos: fresnel_sp(COAT, cos))
    polarised(ELEK, "Fresnel, metal", "section 2.1", metal(smooth), lambda cos: fresnel_sp(METAL, cos))
    polarised(GRANIER, "film on glass, all beams", "Airy 1833, the truth behind eq. 5", film(*soap) + glass, lambda cos: airy_sp(*soap, COAT, cos))
    polarised(GRANIER, "film on metal, all beams", "Airy 1833, the truth behind eq. 5", film(*soap) + metal(smooth), lambda cos: airy_sp(*soap, METAL, cos))
    ggx_smith = (ggx(a), smith(lambda_ggx, a))
    for paper, element, where, model, reflectance in [
        (LECTURE, "Schlick's Fresnel", "slide on Schlick", "schlick", lambda cos: schlick(f0_of(METAL), cos)),
        (ELEK, "approximated Fresnel, FresnelTermNP", "algorithm 1", "complex-f0", lambda cos: schlick(f0_of(METAL), cos)),
        (LECTURE, "F82", "Kutz et al. 2021", "f82", lambda cos: f82(METAL, cos)),
    ]:
        values(paper, element, where, base, f"microfacet-{model}", facets(*ggx_smith, reflectance))
    for reflectance, by_hand in [("approximate", lambda cos: schlick(f0_of(METAL), cos)), ("exact", plain), ("lazanyi", lazanyi(METAL))]:
        chosen = f'{base}distribution = "ggx"\n[bake]\nmodel = "microfacet"\nreflectance = "{reflectance}"\n'
        values(ELEK, f"reflectance of a file, {reflectance}", "appendix B", chosen, "microfacet", facets(*ggx_smith, by_hand))
    # At 550 nm the green channel counts.
    for element, text, f0 in [
        ("F0 of a metal", f'[[layer]]\ntype = "conductor"\nf0 = [0.955, 0.638, 0.538]\n{rough}', 0.638),
        ("F0 half metallic", f'[[layer]]\ntype = "metallic-roughness"\nbase_color = [0.955, 0.638, 0.538]\nmetallic = 0.5\n{rough}', 0.04 + 0.5 * (0.638 - 0.04)),
    ]:
        values(LECTURE, element, "slide on Schlick, exercise", text, "microfacet", facets(*ggx_smith, lambda cos, f0=f0: schlick(f0, cos)))
    coated = film(*soap) + metal(rough)
    values(GRANIER, "two beams of a film", "eq. 5", coated, "microfacet-granier-film", facets(*ggx_smith, lambda cos: two_beams(*soap, cos)))
    values(GRANIER, "orders of a film, two", "Belcour and Barla 2017", coated, "microfacet-belcour-barla", facets(*ggx_smith, lambda cos: belcour_barla(*soap, METAL, cos)))
    values(GRANIER, "film by matrices", "Abeles 1950", coated, "microfacet-transfer-matrix", facets(*ggx_smith, lambda cos: sum(airy_sp(*soap, METAL, cos)) / 2))

    # Distributions.
    for paper, element, where, model, density, allowed in [
        (LECTURE, "distribution, GGX", "slides on D", "ggx", ggx(a), 1e-9),
        (ELEK, "distribution, Beckmann", "appendix B", "beckmann", beckmann(a), 1e-9),
        (COURSE, "distribution, Blinn", "shader blinnD", "blinn-phong", blinn(a), 1e-4),
        (LECTURE, "distribution, ABC", "slides on D", "abc", abc(a), 1e-4),
        (LECTURE, "distribution, shifted gamma", "Bagher et al. 2012", "sgd", sgd(a), 1e-4),
    ]:
        closed = {"ggx": smith(lambda_ggx, a), "beckmann": smith(lambda_beckmann, a)}
        values(paper, element, where, base, f"microfacet-{model}", facets(density, closed.get(model) or smith_of(density), plain), allowed)
    ax, ay = 0.2, 0.6
    turned = f"alpha_x = {ax}\nalpha_y = {ay}\n"
    values(YAMAGUCHI, "anisotropic GGX", "section 2.1", metal(turned), "microfacet-ggx", facets(ggx_stretched(ax, ay), smith(lambda_ggx, ax, ay), plain))
    values(LECTURE, "anisotropic Beckmann", "Ward 1992", metal(turned), "microfacet-beckmann", facets(ward(ax, ay), smith(lambda_beckmann, ax, ay), plain))

    # Masking.
    for paper, element, where, model, masking in [
        (LECTURE, "masking, implicit", "slides on G", "implicit", implicit),
        (ELEK, "masking, V-cavities", "section 2.1", "v-cavity", v_cavity),
        (LECTURE, "masking, Kelemen", "Kelemen and Szirmay-Kalos 2001", "kelemen", kelemen),
        (LECTURE, "masking, Schlick and Smith", "slides on G", "schlick-smith", schlick_smith(a)),
        (LECTURE, "masking, Smith separable", "slides on G", "smith-separable", smith_separable(lambda_ggx, a)),
    ]:
        values(paper, element, where, base, f"microfacet-{model}", facets(ggx(a), masking, plain))
        # The part as a file chooses it, for a shader.
        chosen = f'{base}distribution = "ggx"\n[bake]\nmodel = "microfacet"\nmasking = "{model}"\n'
        values(paper, f"{element}, of a file", where, chosen, "microfacet", facets(ggx(a), masking, plain))

    # Distributions as a file chooses them, for a shader; the course's surface is the first.
    blinn_file = metal('alpha = 0.4\ndistribution = "blinn"\n')
    values(COURSE, "distribution of a file, Blinn", "shaders blinnD and geom", blinn_file, "weidlich-wilkie", facets(blinn(a), v_cavity, plain))
    cavities = '[bake]\nmodel = "microfacet"\nmasking = "v-cavity"\n'
    for element, where, surface, density in [
        ("distribution of a file, ABC", "Low et al. 2012", "abc = { b = 50, c = 1.2 }\n", abc_of(50, 1.2)),
        ("distribution of a file, shifted gamma", "Bagher et al. 2012", "sgd = { alpha = 0.09, p = 0.8 }\n", sgd_of(0.09, 0.8)),
    ]:
        values(LECTURE, element, where, metal(surface) + cavities, "microfacet", facets(density, v_cavity, plain))

    # Bases.
    values(LECTURE, "Lambert", "slides on diffuse light", matte(0.6), "lambert", lambert(0.6))
    values(COURSE, "Oren and Nayar", "section 2.1.2", matte(0.6, 0.5), "oren-nayar", oren_nayar(0.6, 0.5))
    glossy = coat(COAT, rough) + matte(0.6) + '[bake]\nmodel = "microfacet"\ndiffuse_term = "added"\n'
    one, other = facets(*ggx_smith, lambda cos: fresnel(COAT, cos)), lambert(0.6)
    values(LECTURE, "Lambert beside facets on one surface", "slides on diffuse light; implementation overview", glossy, "microfacet", lambda i, o: one(i, o) + other(i, o))
    for name, f in [("copper", 0.638), ("glass", 0.0425)]:
        preset = f'[[layer]]\ntype = "conductor"\nf0 = "{name}"\n{rough}[bake]\nmodel = "microfacet"\n'
        values(LECTURE, f"F0 of {name} by name", "tables of F0", preset, "microfacet", facets(*ggx_smith, lambda cos, f=f: schlick(f, cos)))
    values(ELEK, "Phong", "table 1", base, "phong", phong_of_metal(METAL, a))

    f0, c = 0.04 + 0.5 * (0.638 - 0.04), 0.5 * 0.638
    smooth_engine = f'[[layer]]\ntype = "metallic-roughness"\nbase_color = [0.955, 0.638, 0.538]\nmetallic = 0.5\n{smooth}'
    albedos(LECTURE, "half metallic, smooth: specular and diffuse light", "exercise", smooth_engine, "closed-form", lambda cos: schlick(f0, cos) + (1 - schlick(f0, cos)) * c, 1e-6)

    switched()

    # Layers.
    two = coat(COAT, "alpha = 0.2\ndistribution = \"beckmann\"\n", DEPTH) + metal("alpha = 0.3\n")
    below_two = [(COAT, 0.2, DEPTH, beckmann), (METAL, 0.3, None, ggx)]
    three = coat(COAT, "alpha = 0.4\n", 0.1) + coat(INNER, "alpha = 0.2\n", DEPTH) + metal("alpha = 0.3\n")
    below_three = [(COAT, 0.4, 0.1, ggx), (INNER, 0.2, DEPTH, ggx), (METAL, 0.3, None, ggx)]
    on_matte = coat(COAT, "alpha = 0.2\n", DEPTH) + matte(0.6, 0.5)
    below_matte = [(COAT, 0.2, DEPTH, ggx)]
    none = lambda i, o: 0.0
    for paper, model, clamp, where in [(ELEK, "elek", True, "algorithm 1"), (COURSE, "weidlich-wilkie", False, "eq. 3.1 to 3.3")]:
        values(paper, f"{model}: tinted coat on metal", where, two, model, layers(below_two, none, clamp=clamp))
        values(paper, f"{model}: two coats on metal", where, three, model, layers(below_three, none, clamp=clamp))
        values(paper, f"{model}: tinted coat on a diffuse base", where, on_matte, model, layers(below_matte, oren_nayar(0.6, 0.5), clamp=clamp))
        whole = f'{two}[bake]\nmodel = "{model}"\ninternal_reflection = "none"\n'
        values(paper, f"{model}: no internal reflection", "eq. 4, t = 1" if clamp else "eq. 3.3, t = 1", whole, model, layers(below_two, none, clamp=clamp, inside=False))
    values(COURSE, "transmission at the directions' angles", "eq. 3.2", three, "weidlich-wilkie-directions", layers(below_three, none, "directions"))
    chosen = f'{three}[bake]\nmodel = "weidlich-wilkie"\ninternal_reflection = "directions"\n'
    values(COURSE, "transmission at the directions' angles, of a file", "eq. 3.1, another reading", chosen, "weidlich-wilkie", layers(below_three, none, "directions"))
    chosen = f'{two}[bake]\nmodel = "elek"\nlower_reflectance = "in-air"\n'
    values(ELEK, "elek: F2 as in air", "algorithm 1, line 21", chosen, "elek", layers(below_two, none, clamp=True, in_air=True))
    chosen = f'{two}[bake]\nmodel = "elek"\nlower_cosine = "inside"\n'
    values(ELEK, "elek: NdotL' of the lower layer", "algorithm 1, line 21; appendix B", chosen, "elek", layers(below_two, none, clamp=True, own_cosine=True))

    of_both = coat(COAT, "alpha = 0.2\ndistribution = \"beckmann\"\n", DEPTH) + '[[layer]]\ntype = "dielectric"\nf0 = 0.6\nalpha = 0.3\n' + matte(0.6, 0.5)
    for paper, model, clamp in [(ELEK, "elek", True), (COURSE, "weidlich-wilkie", False)]:
        part = f'[bake]\nmodel = "{model}"\n'
        values(paper, f"{model}: G left out after Kelemen", "section 3.1", f'{three}{part}masking = "kelemen"\n', model, layers(below_three, none, clamp=clamp, cavities=kelemen))
        values(paper, f"{model}: Phong's lobe below a coat", "section 3.1" if clamp else "section 3.4.1", f'{three}{part}lower_facets = "phong"\n', model, layers(below_three, none, clamp=clamp, lower=phong_lobe))
        values(paper, f"{model}: Blinn and Phong's lobe below a coat", "section 3.1" if clamp else "section 3.4.1", f'{three}{part}lower_facets = "blinn-phong"\n', model, layers(below_three, none, clamp=clamp, lower=blinn_phong))
        beside = layers([(COAT, 0.2, DEPTH, beckmann)], oren_nayar(0.6, 0.5), clamp=clamp, beside=(0.6, 0.3, ggx))
        values(paper, f"{model}: metal and diffuse in one lower layer", "algorithm 1, lines 21 and 22" if clamp else "eq. 3.1", f'{of_both}{part}diffuse_part = "beside"\n', model, beside)
    values(COURSE, "weidlich-wilkie: base as rough as its coat", "slides, type f", f'{three}[bake]\nmodel = "weidlich-wilkie"\nlower_alpha = "at-least-above"\n', "weidlich-wilkie", layers(below_three, none, clamp=True))

    # Granier and Heidrich.
    thin = film(*soap) + metal(rough)
    values(GRANIER, "film on metal", "eq. 3 to 12", thin, "granier-heidrich", granier(*soap, a, 0))
    values(GRANIER, "inner boundary leans", "eq. 10", thin, "granier-heidrich", granier(*soap, a, 0, (8, 30)), extra=("--inner-normal", "8,30"))
    slab = coat(COAT, rough) + matte(0.6)
    values(GRANIER, "thick layer on a diffuse base", "eq. 13 to 18", slab, "granier-heidrich", granier(COAT, None, a, 0.6))
    own = film(*soap) + coat(1.8, "exponents = [90, 170]\n") + matte(0.6)
    own += '[bake]\nmodel = "granier-heidrich"\n[bake.granier-heidrich]\nspecular_weight = 0.9\ndiffuse_weight = 0.5\ninner_tilt_deg = 14\ninner_azimuth_deg = 30\n'
    values(GRANIER, "granier-heidrich: exponents, weights and lean", "eq. 6 and 10; section 7", own, "granier-heidrich", granier(*soap, a, 0.6, (14, 30), (90, 170), (0.9, 0.5)))
    high = film(*soap) + coat(1.8, "exponents = [9, 17]\n") + matte(0.6) + '[bake]\nmodel = "granier-heidrich"\n[bake.granier-heidrich]\nlobe_height = "one"\n'
    values(GRANIER, "granier-heidrich: lobes of height one", "eq. 5, 6 and 10", high, "granier-heidrich", granier(*soap, a, 0.6, exponents=(9, 17), printed=True))

    painted = slab + 'maps = { albedo = "map.png" }\n'
    values(GRANIER, "granier-heidrich: diffuse part as a texture", "section 6", painted, "granier-heidrich", granier(COAT, None, a, 0.6 * 51 / 255), 1e-6, ("--uv", "0.3,0.4"), png((51, 51, 51)))

    texel = (153, 140, 252)
    x, y, z = (2 * c / 255 - 1 for c in texel)
    lean = (math.degrees(math.atan2(math.hypot(x, y), z)), math.degrees(math.atan2(y, x)))
    leaning = coat(COAT, rough + 'maps = { lean = "map.png" }') + matte(0.6)
    values(GRANIER, "granier-heidrich: lean as a texture", "sections 3.2 and 7.3", leaning, "granier-heidrich", granier(COAT, None, a, 0.6, lean), 1e-6, ("--uv", "0.3,0.4"), png(texel))

    level = coat(1.49, "alpha = 0.2") + metal("alpha = 0.3\n")
    for model in ("belcour", "yamaguchi"):
        chosen = f'{level}[bake]\nmodel = "{model}"\nreflectance = "exact"\n'
        values(YAMAGUCHI, f"{model}: FGD by Unity's approximation", "section 3, after StackLit", chosen, model, added(1.49, 0.2, METAL, 0.3))

    # Albedos of smooth stacks.
    clear, mirror = coat(COAT, smooth) + matte(0.5), coat(COAT, smooth, DEPTH) + metal(smooth)
    # Almost smooth: the highlight of a Gaussian has no tail into the directions that are compared.
    gleaming = coat(COAT, 'alpha = 0.001\ndistribution = "beckmann"\n') + matte(0.5)
    values(COURSE, "corrected, smooth coat on Lambert", "eq. 3.1, with 1/n^2", gleaming, "weidlich-wilkie-corrected", corrected(COAT, 0.5), 1e-6)
    for paper, model, allowed in [(YAMAGUCHI, "belcour", 1e-6), (YAMAGUCHI, "yamaguchi", 1e-6), (COURSE, "layered-mc", 0.01)]:
        albedos(paper, f"{model}: smooth coat on Lambert", "adding", clear, model, coated_lambert(COAT, 0.5), allowed, draws(model))
    for paper, model, allowed in [(YAMAGUCHI, "belcour", 1e-6), (YAMAGUCHI, "yamaguchi", 1e-6), (COURSE, "layered-mc", 0.01)]:
        albedos(paper, f"{model}: smooth tinted coat on metal", "adding", mirror, model, coated_metal(COAT, DEPTH), allowed, draws(model))


def draws(model):
    """Enough samples for four standard errors within a hundredth."""
    return ("--samples", "200000") if model == "layered-mc" else ()


def added(n_top, alpha, n_base, alpha_base):
    """Two interfaces by adding (Belcour 2018; eq. 1 to 3 of Yamaguchi et al.), whose energies are Fresnel's at the mean direction, as in StackLit of Unity."""
    variance = lambda a: a**1.1 / (1 - a**1.1)
    slope = lambda s: min((s / (1 + s)) ** (1 / 1.1), 1)
    lobe = lambda a: facets(ggx(a), smith(lambda_ggx, a), lambda cos: 1)

    def value(i, o):
        cos = o[2]
        inside = math.sqrt(1 - (1 - cos * cos) / (n_top * n_top))
        first, second = fresnel(n_top, cos), fresnel(n_base, inside, n_top)
        wider = n_top * inside / cos
        enters, leaves = (variance(0.5 * abs(1 - x) * alpha) for x in (1 / wider, wider))
        echo = first * second
        between = (variance(alpha_base) + variance(alpha)) * echo / (1 - echo)
        spread = leaves + (enters + variance(alpha_base) + between) * wider
        return first * lobe(alpha)(i, o) + (1 - first) ** 2 * second / (1 - echo) * lobe(slope(spread))(i, o)

    return value


def corrected(n, rho):
    """Value of a smooth coat on a Lambert base away from the mirror direction: exact."""
    outside = simpson(lambda u: 4 * u**3 * fresnel(n, u * u), 0, 1)
    inside = 1 - (1 - outside) / (n * n)
    return lambda i, o: i[2] * (1 - fresnel(n, i[2])) * (1 - fresnel(n, o[2])) * rho / (PI * n * n * (1 - rho * inside))


def main():
    compare()
    # The rows of the other files take the functions of this one, as `papers`.
    sys.modules["papers"] = sys.modules["__main__"]
    for name in ("closed_forms", "places", "spreads", "tables", "requirements"):
        importlib.import_module(name).compare()
    failed = [r for r in ROWS if not r[4] <= r[5]]
    print("# Elements of the papers by hand\n")
    print(
        "`scripts/independent/papers.py` and the files beside it made this page. They work each element out from its formula, in Python and without luthier, and compare it with what"
        " `luthier eval` prints, or with the texels that `luthier bake` and `luthier table` write. The wavelength is 550 nm, or that of each channel. A value is for three pairs of directions, three or four angles,"
        " or some places of a surface: the first by hand stands here, and the largest relative difference of all. Differences of texels are relative to the largest of their table."
        " *Where* is the place of the formula, in the paper or, where the paper only names it, in its own source. *Allowed* is the precision of the calculation by hand: closed forms, numbers of single precision in textures,"
        " the steps of a texel format, quadrature, or the noise of random walks and of a simulation.\n"
    )
    print(f"{len(ROWS)} elements, {len(failed)} of them further off than allowed.\n")
    print("| paper | element | where | by hand | difference | allowed |\n|---|---|---|--:|--:|--:|")
    for paper, element, where, first, worst, allowed in ROWS:
        print(f"| {paper} | {element} | {where} | {first:.6g} | {worst:.1e} | {allowed:.0e} |")
    sys.exit(1 if failed else 0)


if __name__ == "__main__":
    main()
