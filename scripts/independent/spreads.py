"""Rows of `papers.py`: energies, means and spreads of Belcour 2018 as Yamaguchi et al. restate them, and their covariance matrices.

Energies of rough surfaces are quadrature for the first bounce and random walks for the later ones (Heitz et al. 2016). Spreads are triples xx, xy, yy.
"""

import math
import random

from closed_forms import CHANNELS
from papers import *
from places import even

ALL = 1.0  # the reflectance of a white metal


# Spreads.


def h(alpha):
    """Eq. 1 and 2: variance of light from a surface of slope parameter alpha."""
    power = alpha**1.1
    return power / (1 - power)


def h_inverse(variance):
    return (variance / (1 + variance)) ** (1 / 1.1)


def plus(*spreads):
    return tuple(map(sum, zip(*spreads)))


def times(factor, spread):
    return tuple(factor * x for x in spread)


def covariance(surface, scale):
    """M diag(h(s alpha_x), h(s alpha_y)) M^T, with the tangent and the binormal as the columns of M."""
    x, y = h(scale * surface["alpha"][0]), h(scale * surface["alpha"][1])
    c, s = math.cos(surface["turn"]), math.sin(surface["turn"])
    return (c * c * x + s * s * y, c * s * (x - y), s * s * x + c * c * y)


def scalar(surface, scale):
    """The isotropic spread, of the geometric mean of both slope parameters."""
    variance = h(scale * math.sqrt(surface["alpha"][0] * surface["alpha"][1]))
    return (variance, 0.0, variance)


def jacobians(n, cos_i, cos_t):
    """Eq. 4 and 5, found anew: how far the mirrored and the refracted direction move on the base plane with the half vector, which moves from the
    normal across the plane of incidence. The first is 2 cos_t for light that comes from below."""
    step = 1e-6
    m = (0.0, step, math.sqrt(1 - step * step))
    w = (math.sqrt(1 - cos_i * cos_i), 0.0, cos_i)
    along = dot(w, m)
    inside = math.sqrt(1 - (1 - along * along) / (n * n))
    refracted_y = -w[1] / n + (along / n - inside) * m[1]
    t = (math.sqrt(1 - cos_t * cos_t), 0.0, cos_t)
    mirrored_y = 2 * dot(t, m) * m[1] - t[1]
    eq_4, eq_5 = 2 * cos_t, (cos_i - n * cos_t) / n
    assert abs(mirrored_y / step - eq_4) < 1e-6 and abs(refracted_y / step - eq_5) < 1e-6
    return mirrored_y / step, refracted_y / step


def scaling(n, cos_i, cos_t):
    """s of light that a rough interface bends: the Jacobian of eq. 5 over that of eq. 4, because h is of mirrored light."""
    reflection, refraction = jacobians(n, cos_i, cos_t)
    return abs(refraction / reflection)


# Energies.


def mirrored(w, m):
    along = 2 * dot(w, m)
    return tuple(along * b - a for a, b in zip(w, m))


def slopes(alpha, rings, around):
    """Facets of GGX, each as likely as the next by the area of the level plane that they cover; two halves are alike."""
    for k in range(rings):
        u = (k + 0.5) / rings
        tan_sq = alpha * alpha * u / (1 - u)
        cos = 1 / math.sqrt(1 + tan_sq)
        sin = math.sqrt(tan_sq) * cos
        for j in range(around):
            phi = PI * (j + 0.5) / around
            yield sin * math.cos(phi), sin * math.sin(phi), cos


def first_bounce(alpha, reflectance, cos):
    w = (math.sqrt(1 - cos * cos), 0.0, cos)
    seen, rings, around = lambda_ggx(alpha * w[0] / cos), 300, 90
    total = 0.0
    for m in slopes(alpha, rings, around):
        along = dot(w, m)
        if along <= 0:
            continue
        out = mirrored(w, m)
        if out[2] > 0:
            total += reflectance(along) * along / m[2] / (1 + seen + lambda_ggx(alpha * math.sqrt(1 - out[2] ** 2) / out[2]))
    return total / (rings * around * cos)


def facet(w, alpha, rng):
    """A visible normal, by the spherical caps of Dupuy and Benyoub 2023."""
    stretched_w = (alpha * w[0], alpha * w[1], w[2])
    length = math.sqrt(dot(stretched_w, stretched_w))
    s = tuple(x / length for x in stretched_w)
    phi, z = 2 * PI * rng.random(), (1 - rng.random()) * (1 + s[2]) - s[2]
    sin = math.sqrt(max(0.0, 1 - z * z))
    m = (alpha * (sin * math.cos(phi) + s[0]), alpha * (sin * math.sin(phi) + s[1]), z + s[2])
    length = math.sqrt(dot(m, m))
    return tuple(x / length for x in m)


def height(w, start, alpha, rng):
    """Height, as the share of facets below it, at which a ray meets a facet; None where it leaves upward."""
    if w[2] > 0.9999:
        return None
    if w[2] < -0.9999:
        return rng.random() * start
    a = alpha * math.sqrt(1 - w[2] ** 2) / abs(w[2])
    free = (math.copysign(math.sqrt(1 + a * a), w[2]) - 1) / 2
    u = 1 - rng.random()
    if free > 0 and u <= start**free:
        return None
    return min(start * u ** (-1 / free), 1.0)


def later_bounces(alpha, reflectance, cos, n=None, walks=36000):
    """Share of light that leaves upward after two facets or more. `n` is the index of a medium that lets light in, and out again."""
    rng = random.Random(1)
    total = 0.0
    for _ in range(walks):
        w, at, outside, weight, met = (-math.sqrt(1 - cos * cos), 0.0, -cos), 1.0, True, 1.0, 0
        while met < 64:
            # Seen from below, directions and heights are turned over.
            sign = 1 if outside else -1
            found = height(tuple(sign * x for x in w), at if outside else 1 - at, alpha, rng)
            if found is None:
                total += weight if outside and met > 1 else 0.0
                break
            at = found if outside else 1 - found
            met += 1
            back = tuple(-x for x in w)
            m = tuple(sign * x for x in facet(tuple(sign * x for x in back), alpha, rng))
            along = dot(back, m)
            if n is None:
                weight *= reflectance(along)
                w = mirrored(back, m)
                continue
            eta = n if outside else 1 / n
            sin_sq = (1 - along * along) / (eta * eta)
            reflected = 1.0 if sin_sq >= 1 else fresnel(eta, along)
            if rng.random() < reflected:
                w = mirrored(back, m)
            else:
                inside = math.sqrt(1 - sin_sq)
                w = tuple(-b / eta + (along / eta - inside) * c for b, c in zip(back, m))
                outside = not outside
    return total / walks


KNOWN = {}


def fgd(surface, above, cos):
    """FGD-infinity of each channel."""
    alpha = math.sqrt(surface["alpha"][0] * surface["alpha"][1])
    if surface["index"] == ALL:
        return ALL
    n = surface["index"] / above
    reflectance = lambda c: fresnel(n, c)
    if alpha <= 1e-3:
        return reflectance(cos)
    key = (alpha, n, cos)
    if key not in KNOWN:
        transparent = None if isinstance(n, complex) else n
        KNOWN[key] = first_bounce(alpha, reflectance, cos) + later_bounces(alpha, reflectance, cos, transparent)
    return KNOWN[key]


def escaping(cos, alpha, eta):
    """Share of a lobe in a medium, light that GGX mirrors upward, within the critical angle of the interface above."""
    key = ("escaping", cos, alpha, eta)
    if eta >= 1 or key in KNOWN:
        return KNOWN.get(key, 1.0)
    critical = math.sqrt(1 - eta * eta)
    w = (math.sqrt(1 - cos * cos), 0.0, cos)
    inside, whole = 0.0, 0.0
    for m in slopes(alpha, 500, 120):
        along = dot(w, m)
        if along > 0:
            up = mirrored(w, m)[2]
            whole += along / m[2] if up > 0 else 0
            inside += along / m[2] if up > critical else 0
    KNOWN[key] = inside / whole
    return KNOWN[key]


# Adding.


def lobes(surfaces, cos, spread, channels=1, tir=True):
    """Energy of each channel and spread of each lobe, by the adding of Belcour 2018, section 4 and 5: interface 12 below what has been added, 0i."""
    mean = lambda values: sum(values) / channels
    t0i, ti0, ri0, slab = [1.0] * channels, [1.0] * channels, [0.0] * channels, [1.0] * channels
    s_t0i, s_ti0, s_ri0 = (0.0,) * 3, (0.0,) * 3, (0.0,) * 3
    j_0i, j_i0, above, over, found = 1.0, 1.0, 1.0, None, []
    for surface in surfaces:
        r12, s_r12 = fgd(surface, above, cos), spread(surface, 1)
        if over is not None and tir:
            wide = plus(s_t0i, s_r12)
            share = escaping(cos, h_inverse((wide[0] + wide[2]) / 2), over / above)
            ri0 = [r + (1 - share) * t * a for r, t, a in zip(ri0, ti0, slab)]
            ti0 = [share * t for t in ti0]
        bounces = mean([r * r12 / (1 - r * r12) for r in ri0])
        between = times(bounces, plus(s_r12, s_ri0))
        energy = [down * r12 * up / (1 - r * r12) for down, up, r in zip(t0i, ti0, ri0)]
        found.append((energy, plus(s_ti0, times(j_0i, plus(s_t0i, s_r12, between)))))
        if surface["depth"] is None:
            return found
        n = surface["index"] / above
        cos_t = math.sqrt(1 - (1 - cos * cos) / (n * n))
        j = n * cos_t / cos
        s_t12, s_t21 = spread(surface, scaling(n, cos, cos_t)), spread(surface, scaling(1 / n, cos_t, cos))
        t12 = 1 - r12
        back = [t12 * r * t12 / (1 - r * r12) for r in ri0]
        share = mean(back) / mean([r12 + b for b in back])
        deep = plus(s_t12, times(j, plus(s_t21, s_ri0, between)))
        s_ri0, s_t0i, s_ti0 = (
            plus(times(1 - share, s_r12), times(share, deep)),
            plus(times(j, plus(s_t0i, between)), s_t12),
            plus(s_ti0, times(j_i0, plus(s_t21, between))),
        )
        slab = [math.exp(-depth / cos_t) for depth in surface["depth"]]
        t0i = [t * t12 / (1 - r * r12) * a for t, r, a in zip(t0i, ri0, slab)]
        ti0 = [t * t12 / (1 - r * r12) * a for t, r, a in zip(ti0, ri0, slab)]
        ri0 = [(r12 + b) * a * a for b, a in zip(back, slab)]
        j_0i, j_i0, over, above, cos = j_0i * j, j_i0 / j, above, surface["index"], cos_t


def added(surfaces, spread, channels=1, tir=True):
    """f cos of the sum of eq. 3: each lobe a GGX surface in the principal axes of its spread, seen from the eye."""

    def value(i, o):
        total = [0.0] * channels
        for energy, (xx, xy, yy) in lobes(surfaces, o[2], spread, channels, tir):
            middle, radius = (xx + yy) / 2, math.hypot((xx - yy) / 2, xy)
            turn = math.atan2(xy, (xx - yy) / 2) / 2
            axes = [max(h_inverse(v), 1e-4) for v in (middle + radius, max(middle - radius, 1e-300))]
            c, s = math.cos(turn), math.sin(turn)
            ti, to = [(c * w[0] + s * w[1], -s * w[0] + c * w[1], w[2]) for w in (i, o)]
            lobe = facets(ggx_stretched(*axes), smith(lambda_ggx, *axes), lambda cos: 1)(ti, to)
            total = [t + e * lobe for t, e in zip(total, energy)]
        return total

    return value


# Layers, as files and as they count above.


def layer(index, alpha, depth=None, turn_deg=0, sigma=None):
    """The text of a layer and its surface; without a depth it is a metal."""
    pair = alpha if isinstance(alpha, tuple) else (alpha, alpha)
    surface = f"alpha_x = {pair[0]}\nalpha_y = {pair[1]}\n" if isinstance(alpha, tuple) else f"alpha = {alpha}\n"
    surface = "smooth = true\n" if alpha == 0 else surface
    surface += f"rotation_deg = {turn_deg}\n" if turn_deg else ""
    counted = {"index": index, "alpha": pair, "turn": math.radians(turn_deg), "depth": depth}
    if depth is not None:
        counted["depth"] = sigma or [depth]
        absorption = f"absorption_per_um = {sigma or depth}\nthickness_um = 1\n"
        return f'[[layer]]\ntype = "dielectric"\nior = {index}\n{surface}{absorption}', counted
    ior = "f0 = 1.0" if index == ALL else f"ior = {{ n = {index.real}, k = {index.imag} }}"
    return f'[[layer]]\ntype = "conductor"\n{ior}\n{surface}', counted


# Apart from the mirror direction of a smooth coat, whose highlight is narrower than any other.
AWAY = [(30, 0, 45, 140), (20, 10, 40, 170), (65, 0, 50, 190)]


def stack(element, where, model, parts, allowed, pairs=AWAY):
    texts, surfaces = zip(*parts)
    by_hand = added(surfaces, scalar if model == "belcour" else covariance)
    got = []
    for ti, pi, to, po in pairs:
        told = ask("".join(texts), "--model", model, "--wi", f"{ti},{pi}", "--wo", f"{to},{po}")["values"][0]["value"]
        got.append((by_hand(direction(ti, pi), direction(to, po))[0], told[0]))
    row(YAMAGUCHI, element, where, got, allowed)


def compare():
    stack("belcour: rough metal in a smooth coat", "eq. 1, h", "belcour", [layer(COAT, 0, 0.1), layer(ALL, 0.3)], 2e-3)
    stack("belcour: rough coat on rough metal", "eq. 1 to 3", "belcour", [layer(COAT, 0.1, 0.1), layer(METAL, 0.3)], 1e-2)
    stack("belcour: metal behind a rough coat", "eq. 2, s and h(s alpha)", "belcour", [layer(COAT, 0.4, 0), layer(ALL, 0.1)], 1e-2)
    stack("belcour: all bounces of a metal", "section 3, FGD", "belcour", [layer(METAL, 0.6)], 5e-3, PAIRS)
    stack("yamaguchi: three rough layers", "section 2.1, last paragraph", "yamaguchi", [layer(1.4, 0.1, 0.1), layer(1.9, 0.2, 0.2), layer(METAL, 0.2)], 1e-2)
    stack("yamaguchi: brushed metal in a coat", "section 2.1, eq. 4", "yamaguchi", [layer(COAT, 0, 0.1), layer(ALL, (0.45, 0.12))], 2e-3)
    stack("yamaguchi: metal in a brushed coat", "section 2.1, eq. 5", "yamaguchi", [layer(COAT, (0.25, 0.06), 0), layer(ALL, 0.2)], 1e-2)
    turned = [layer(COAT, (0.25, 0.06), 0, 90), layer(ALL, (0.45, 0.12), None, 30)]
    stack("yamaguchi: tangents of each layer", "section 2", "yamaguchi", turned, 1e-2)

    totally_reflected()
    fields()
    channels()


def totally_reflected():
    """An absorbing coat keeps what it reflects totally for another way through it: without, half as bright again."""
    parts = [layer(1.8, 0, 0.3), layer(ALL, 0.5)]
    surfaces = [surface for _, surface in parts]
    i, o = direction(30, 0), direction(45, 140)
    [kept], [free] = [added(surfaces, scalar, tir=tir)(i, o) for tir in (True, False)]
    assert free / kept > 1.2, (kept, free)
    stack("belcour: total reflection in a tinted coat", "section 1; Belcour 2018, section 5", "belcour", parts, 2e-3)


def fields():
    """Tangents of both layers from pictures: 2 RG - 1 is the direction of twice the angle."""
    angle = lambda r, g: math.degrees(math.atan2(2 * g / 255 - 1, 2 * r / 255 - 1) / 2)
    parts = [layer(COAT, (0.25, 0.06), 0, angle(64, 230)), layer(ALL, (0.4, 0.1), None, angle(128, 64))]
    surfaces = [surface for _, surface in parts]
    text = layer(COAT, (0.25, 0.06), 0)[0] + 'maps = { tangent = "a.png" }\n' + layer(ALL, (0.4, 0.1))[0] + 'maps = { tangent = "b.png" }\n'
    beside = {"a.png": even(64, 230, 128), "b.png": even(128, 64, 200)}
    got = []
    for ti, pi, to, po in AWAY:
        told = ask(text, "--model", "yamaguchi", "--wi", f"{ti},{pi}", "--wo", f"{to},{po}", "--uv", "0.1,0.1", beside=beside)
        got.append((added(surfaces, covariance)(direction(ti, pi), direction(to, po))[0], told["values"][0]["value"][0]))
    row(YAMAGUCHI, "yamaguchi: tangents from pictures", "figures 1 and 2", got, 1e-2)


def channels():
    """Three channels of a tinted coat, each with energies of its own and all with the mean of their spreads."""
    # In colour, no surface is smoother than this.
    parts = [layer(2.2, 0.001, 0, 0, [0.0, 0.3, 1.5]), layer(ALL, (0.1, 0.3))]
    surfaces = [surface for _, surface in parts]
    # A channel by itself, with its own spread, is another value.
    blue = [layer(2.2, 0.001, 1.5)[1], surfaces[1]]
    i, o = direction(30, 0), direction(45, 140)
    [alone], [_, _, shared] = added(blue, covariance)(i, o), added(surfaces, covariance, 3)(i, o)
    assert alone / shared > 1.2, (alone, shared)
    got = []
    for ti, pi, to, po in AWAY:
        told = ask(parts[0][0] + parts[1][0], "--model", "yamaguchi", "--wi", f"{ti},{pi}", "--wo", f"{to},{po}", colour=CHANNELS)
        got += zip(added(surfaces, covariance, 3)(direction(ti, pi), direction(to, po)), told["values"][0]["value"], strict=True)
    row(YAMAGUCHI, "yamaguchi: mean of the channels", "section 3", got, 2e-3)
