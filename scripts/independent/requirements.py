"""Rows of `papers.py`: laws that the documents ask of a model, integrals, and colours of spectra."""

import math

from closed_forms import no_base
from papers import *
from spreads import first_bounce


def reciprocity():
    """f(i, o) = f(o, i): the values by hand are those of exchanged directions."""
    plain = lambda cos: fresnel(METAL, cos)
    two = coat(COAT, "alpha = 0.2\n", DEPTH) + metal("alpha = 0.3\n")
    below = [(COAT, 0.2, DEPTH, ggx), (METAL, 0.3, None, ggx)]
    exchanged = lambda model: lambda i, o: model(o, i) / o[2] * i[2]
    for model, text, by_hand in [
        ("microfacet", metal("alpha = 0.4\n"), facets(ggx(0.4), smith(lambda_ggx, 0.4), plain)),
        ("weidlich-wilkie", two, layers(below, no_base)),
        ("elek", two, layers(below, no_base, clamp=True)),
    ]:
        values(COURSE, f"reciprocity, {model}", "section 2.1.1", text, model, exchanged(by_hand))


def over_the_sky(model, cos, rings=300, around=150):
    """The reflectance equation under light of radiance 1 from everywhere, by midpoints over the directions of the light."""
    o = (math.sqrt(1 - cos * cos), 0.0, cos)
    total = 0.0
    for k in range(rings):
        z = (k + 0.5) / rings
        sin = math.sqrt(1 - z * z)
        for j in range(around):
            phi = PI * (j + 0.5) / around
            total += model((sin * math.cos(phi), sin * math.sin(phi), z), o)
    return total * 2 * PI / (rings * around)


def integrals():
    one = facets(ggx(0.5), smith(lambda_ggx, 0.5), lambda cos: fresnel(METAL, cos))
    albedos(LECTURE, "reflectance equation", "slide on the reflectance equation", metal("alpha = 0.5\n"), "microfacet", lambda cos: over_the_sky(one, cos), 1e-3)

    # A surface that absorbs nothing returns at most what falls in: the rest of it meets a second facet.
    told = ask(metal("alpha = 0.5\n"), "--model", "microfacet", "--furnace", "--angles", "0,45,70")["furnace"]
    pairs = [(first_bounce(0.5, lambda c: 1, math.cos(math.radians(angle))), entry["radiance"]) for angle, entry in zip((0, 45, 70), told)]
    assert all(a <= 1 for a, _ in pairs), pairs
    row(COURSE, "energy of a surface without loss", "section 2.1.1", pairs, 2e-3)

    # Mean over all incident light: 4 to 10 percent of it for what is no metal, 80 to 90 percent for metals.
    pairs, angles = [], [math.degrees(math.acos(math.sqrt((k + 0.5) / 640))) for k in range(640)]
    for n, least, most in [(1.33, 0.04, 0.1), (1.5, 0.04, 0.1), (0.96 + 6.69j, 0.8, 0.92), (0.44 + 3.7j, 0.8, 0.9)]:
        mean = simpson(lambda c: 2 * c * fresnel(n, max(c, 1e-9)), 0, 1)
        assert least <= mean <= most, (n, mean)
        text = coat(n, "smooth = true\n") if not isinstance(n, complex) else f'[[layer]]\ntype = "conductor"\nior = {{ n = {n.real}, k = {n.imag} }}\nsmooth = true\n'
        told = ask(text, "--polarised", "--angles", ",".join(map(str, angles)))["polarised"]
        pairs.append((mean, sum(entry["refl_s"][0] + entry["refl_p"][0] for entry in told) / 1280))
    row(COURSE, "mean reflectance of metals and others", "section 4.1.1", pairs, 2e-3)


# CIE 1931 and D65 from 380 to 780 nm in steps of 20.
X = [0.001368, 0.01431, 0.13438, 0.34828, 0.2908, 0.09564, 0.0049, 0.06327, 0.2904, 0.5945, 0.9163, 1.0622, 0.85445, 0.4479, 0.1649, 0.04677, 0.011359, 0.002899, 0.00069, 0.000166, 0.000042]
Y = [0.000039, 0.000396, 0.004, 0.023, 0.06, 0.13902, 0.323, 0.71, 0.954, 0.995, 0.87, 0.631, 0.381, 0.175, 0.061, 0.017, 0.004102, 0.001047, 0.000249, 0.00006, 0.000015]
Z = [0.00645, 0.06785, 0.6456, 1.74706, 1.6692, 0.81295, 0.272, 0.07825, 0.0203, 0.0039, 0.00165, 0.0008, 0.00019, 0.00002, 0, 0, 0, 0, 0, 0, 0]
D65 = [49.9755, 82.7549, 93.4318, 104.865, 117.812, 115.923, 109.354, 104.79, 104.405, 100, 95.788, 90.0062, 87.6987, 83.6992, 80.2146, 78.2842, 71.6091, 61.604, 75.087, 46.4182, 63.3828]
TO_RGB = [[3.2404542, -1.5371385, -0.4985314], [-0.969266, 1.8760108, 0.041556], [0.0556434, -0.2040259, 1.0572252]]


def smooth_curve(table, nm):
    """Catmull and Rom's cubic between the nodes."""
    x = min(max((nm - 380) / 20, 0), 20 - 1e-9)
    k, t = int(x), x - int(x)
    a, b, c, d = (table[min(max(k + j, 0), 20)] for j in (-1, 0, 1, 2))
    return b + t * ((c - a) + t * (2 * a - 5 * b + 4 * c - d + t * (3 * (b - c) + d - a))) / 2


def colour_of(spectrum):
    """Linear Rec.709 of a reflectance under D65; 1 is white."""
    nodes = [382.5 + 5 * k for k in range(80)]
    sums = [sum(smooth_curve(curve, nm) * smooth_curve(D65, nm) * spectrum(nm) for nm in nodes) for curve in (X, Y, Z)]
    white = sum(smooth_curve(Y, nm) * smooth_curve(D65, nm) for nm in nodes)
    rgb = [sum(m * v / white for m, v in zip(line, sums)) for line in TO_RGB]
    return rgb


def spectra():
    """Section 8 of Granier and Heidrich: both beams of a film at every wavelength, projected on RGB."""
    white = colour_of(lambda nm: 1)
    pairs = []
    for ti, pi, to, po in PAIRS:
        i, o = direction(ti, pi), direction(to, po)
        beams = lambda nm: facets(ggx(0.4), smith(lambda_ggx, 0.4), lambda cos: two_beams(1.4, 300 * NM / nm, cos))(i, o)
        told = ask(film(1.4, 300) + metal("alpha = 0.4\n"), "--model", "microfacet-granier-film", "--wi", f"{ti},{pi}", "--wo", f"{to},{po}", colour=("--rgb",))
        pairs += [(a / w, b) for a, w, b in zip(colour_of(beams), white, told["values"][0]["value"], strict=True)]
    row(GRANIER, "spectrum of a film on RGB", "section 8", pairs, 2e-2)


def compare():
    reciprocity()
    integrals()
    spectra()
