"""Rows of `papers.py`: elements with a closed form, one wavelength or one of each channel."""

import math

from papers import *

CHANNELS = ("--three-wavelengths",)


def colours(paper, element, where, text, model, by_hand, allowed=1e-9, extra=(), beside=None):
    """A row of three channels: `by_hand` gives the value of each."""
    got = []
    for ti, pi, to, po in PAIRS:
        angles = ("--wi", f"{ti},{pi}", "--wo", f"{to},{po}")
        told = ask(text, "--model", model, *angles, *extra, beside=beside, colour=CHANNELS)["values"][0]["value"]
        got += zip(by_hand(direction(ti, pi), direction(to, po)), told, strict=True)
    row(paper, element, where, got, allowed)


def each(functions):
    """Three functions of both directions as one of three channels."""
    return lambda i, o: [f(i, o) for f in functions]


def no_base(i, o):
    return 0.0


def elek():
    plain = lambda cos: fresnel(METAL, cos)
    cavities = lambda m: facets(beckmann(m), v_cavity, plain)
    for name, m in [("elek: one surface", 0.4), ("elek: a surface of slope 0.15", 0.15)]:
        values(ELEK, name, "eq. 1", metal(f'alpha = {m}\ndistribution = "beckmann"\n'), "elek", cavities(m))

    # Copper of appendix A, at its own wavelengths.
    copper = [0.213 + 4.05j, 1.04 + 2.59j, 1.17 + 2.36j]
    nm = [690, 550, 450]
    listed = f"n = {[x.real for x in copper]}, k = {[x.imag for x in copper]}, wavelengths_nm = {nm}"
    text = f'[[layer]]\ntype = "conductor"\nior = {{ {listed} }}\nalpha = 0.35\ndistribution = "beckmann"\n[bake]\nwavelengths_nm = {nm}\n'
    lobes = [facets(beckmann(0.35), v_cavity, lambda cos, n=n: fresnel(n, cos)) for n in copper]
    colours(ELEK, "elek: an index for each channel", "appendix A", text, "elek", each(lobes))

    # Absorption of the channels along 2 um and half of one.
    sigma = (0.9, 0.25, 0.5)
    surfaces = lambda d: [[(COAT, 0.1, s * d, ggx), (METAL, 0.3, None, ggx)] for s in sigma]
    for name, d, place in [("elek: absorption", 2, "eq. 3, sigma"), ("elek: thickness", 0.5, "eq. 3, d")]:
        text = f'[[layer]]\ntype = "dielectric"\nior = {COAT}\nalpha = 0.1\nthickness_um = {d}\nabsorption_per_um = {list(sigma)}\n' + metal("alpha = 0.3\n")
        colours(ELEK, name, place, text, "elek", each([layers(s, no_base, clamp=True) for s in surfaces(d)]))

    # Figure 2: the lower layer is as rough as the upper one.
    text = coat(COAT, "alpha = 0.4\n") + metal("alpha = 0.05\n")
    clamped = layers([(COAT, 0.4, 0, ggx), (METAL, 0.05, None, ggx)], no_base, clamp=True)
    values(ELEK, "elek: max(m2, m1)", "algorithm 1, line 21; figure 2", text, "elek", clamped)

    # Line 28 with the exact F in place of its approximation, which has rows of its own.
    text = coat(COAT, "alpha = 0.3\n") + matte(0.2)
    told = ask(text, "--model", "elek", "--environment", "--angles", "0,45,70")["environment"]
    pairs = [(fresnel(COAT, math.cos(math.radians(entry["theta_o_deg"]))), entry["environment"]) for entry in told]
    row(ELEK, "elek: share of the surroundings", "algorithm 1, line 28, F exact", pairs, 1e-9)


def granier_heidrich():
    a, thin = 0.2, (1.4, 300.0)

    # Thicknesses of a whole period of the phase and more.
    pairs = []
    for d in range(100, 500, 25):
        by_hand = granier(1.4, d, a, 0)(direction(30, 0), direction(35, 170))
        angles = ("--wi", "30,0", "--wo", "35,170")
        [value] = ask(film(1.4, d) + metal(f"alpha = {a}\n"), "--model", "granier-heidrich", *angles)["values"][0]["value"]
        pairs.append((by_hand, value))
    row(GRANIER, "phase over sixteen thicknesses", "eq. 1 to 3", pairs, 1e-9)

    at = lambda nm, n, d, *rest: granier(n, d * NM / nm, *rest)
    text = film(*thin) + metal(f"alpha = {a}\n") + "[bake]\nwavelengths_nm = [610, 550, 465]\n"
    beams = [at(nm, *thin, a, 0) for nm in (610, 550, 465)]
    colours(GRANIER, "a wavelength for each channel", "section 3.3", text, "granier-heidrich", each(beams))

    n, nm = [1.4, 1.45, 1.6], [645, 525, 445]
    text = f'[[layer]]\ntype = "thin-film"\nior = {{ n = {n}, wavelengths_nm = {nm} }}\nthickness_nm = 300\n' + metal(f"alpha = {a}\n")
    beams = [at(l, k, 300, a, 0) for l, k in zip(nm, n)]
    colours(GRANIER, "an index for each channel", "section 3.1", text, "granier-heidrich", each(beams))

    # No interference in a thick layer: R + T of a black base.
    text = coat(1.8, f"alpha = {a}\n") + matte(0)
    values(GRANIER, "reflected and transmitted lobe of a thick layer", "eq. 6 to 11", text, "granier-heidrich", granier(1.8, None, a, 0))

    # The reflected lobe is so narrow that the pairs of directions show the transmitted one alone, and of that nothing but eq. 10.
    def transmitted(i, o):
        n, e = 1.4, 20
        ti, to = refracted(i, n), refracted(o, n)
        along = -ti[0] * to[0] - ti[1] * to[1] + ti[2] * to[2]
        t = (1 - schlick(f0_of(n), i[2])) * (1 - schlick(f0_of(n), to[2])) * along**e
        return t * (e + 1) / (2 * PI) * i[2] / (n * n * ti[2])

    text = coat(1.4, "exponents = [1000000, 20]\n") + matte(0) + '[bake]\nmodel = "granier-heidrich"\n'
    values(GRANIER, "transmitted lobe alone", "eq. 9 to 11", text, "granier-heidrich", transmitted)

    # Both lobes so narrow that the diffuse part is all.
    def diffuse(i, o):
        n, d = 1.5, 400
        rd = (21 * (n * n + 1) - 38 * n) / (21 * (n + 1) ** 2)
        return 0.6 * (1 + 2 * math.cos(4 * PI * n * d / NM) * math.sqrt(rd * (1 - rd))) / PI * i[2]

    text = film(1.5, 400) + coat(1.8, "exponents = [1000000, 1000000]\n") + matte(0.6) + '[bake]\nmodel = "granier-heidrich"\n'
    values(GRANIER, "diffuse part alone", "eq. 13 to 18", text, "granier-heidrich", diffuse)

    # A place of a film that varies: the factor is on the middle of its range.
    text = '[[layer]]\ntype = "thin-film"\nior = 1.4\n[layer.thickness_nm]\nmin = 250\nmax = 350\nextent_um = 3\nmap = { noise = { seed = 7, frequency = 4, octaves = 4 } }\n'
    values(GRANIER, "thickness of a place", "sections 3.2 and 7.1", text + metal(f"alpha = {a}\n"), "granier-heidrich", granier(1.4, 300 * 0.85, a, 0), extra=("--film-factor", "0.85"))

    own = '[bake]\nmodel = "granier-heidrich"\n[bake.granier-heidrich]\n'
    for name, where, line, changed in [
        ("weights of the parts", "section 7", "specular_weight = 1\ndiffuse_weight = 0.5\n", {"weights": (1, 0.5)}),
        ("constant lean of 14 degrees", "section 3.3; figure 4", "inner_tilt_deg = 14\n", {"lean": (14, 0)}),
    ]:
        text = film(1.4, 70) + coat(2.0, "exponents = [90, 170]\n") + matte(0.9) + own + line
        by_hand = granier(1.4, 70, 0.4, 0.9, changed.get("lean", (0, 0)), (90, 170), changed.get("weights", (1, 1)))
        values(GRANIER, name, where, text, "granier-heidrich", by_hand)


def lecture():
    plain = lambda cos: fresnel(METAL, cos)
    values(LECTURE, "microfacet BRDF", "slide on the specular term", metal("alpha = 0.25\n"), "microfacet", facets(ggx(0.25), smith(lambda_ggx, 0.25), plain))
    values(LECTURE, "Oren and Nayar of a file", "slides on diffuse roughness", matte(0.6, 0.4), "microfacet", oren_nayar(0.6, 0.4))

    # Phong's lighting as the first slides have it: k_d (n.l) + k_s (r.v)^e. The lobe carries k_s.
    ks, kd = f0_of(COAT), 0.4 * (1 - f0_of(COAT))
    e = (2 / 0.2**2 - 2) / 4
    mirrored = lambda i, o: max(0.0, dot((-i[0], -i[1], i[2]), o))
    text = coat(COAT, "alpha = 0.2\n") + matte(0.4)
    values(LECTURE, "Phong's lighting", "first slides", text, "phong", lambda i, o: kd * i[2] / PI + ks * (e + 1) / (2 * PI) * mirrored(i, o) ** e)

    # A narrow highlight away from the directions: what is left passes the slab twice, at the angles of Snell's law.
    def slab(i, o):
        inside = [math.sqrt(1 - (math.sin(math.acos(w[2])) / COAT) ** 2) for w in (i, o)]
        h = half(i, o)
        f, g = fresnel(COAT, dot(i, h)), v_cavity(i, o, h)
        return (1 - f) * ((1 - g) + (1 - f) * g) * math.exp(-0.8 * sum(1 / c for c in inside)) * 0.6 * i[2] / PI

    text = coat(COAT, 'alpha = 0.001\ndistribution = "beckmann"\n', 0.8) + matte(0.6)
    values(LECTURE, "Snell's law", "slide on Snell", text, "weidlich-wilkie", slab)


def course():
    surfaces = [(COAT, 0.2, DEPTH, ggx), (METAL, 0.3, None, ggx)]

    # Mean slopes in degrees: m is the tangent.
    m = math.tan(math.radians(12))
    red = (0.4, 0.05, 0.04)
    text = '[[layer]]\ntype = "dielectric"\nior = 1.6\nslope_deg = 12\ndistribution = "beckmann"\n[[layer]]\ntype = "diffuse"\nalbedo = [0.4, 0.05, 0.04]\n'
    bases = [layers([(1.6, m, 0, beckmann)], lambert(rho)) for rho in red]
    colours(COURSE, "mean slope in degrees", "section 5.1", text, "weidlich-wilkie", each(bases))

    # Class d: a tinted varnish over foil. Wider than the sheet's slopes, so that the foil is seen from all pairs.
    sigma = (0.02, 0.15, 0.9)
    slopes = [math.tan(math.radians(deg)) for deg in (5, 10)]
    text = f'[[layer]]\ntype = "dielectric"\nior = {COAT}\nslope_deg = 5\nthickness_um = 1\nabsorption_per_um = {list(sigma)}\n' + metal("slope_deg = 10\n")
    foil = [layers([(COAT, slopes[0], s, ggx), (METAL, slopes[1], None, ggx)], no_base) for s in sigma]
    colours(COURSE, "tinted varnish on foil", "section 5.1.3; class d", text, "weidlich-wilkie", each(foil))

    # The texture of figure 3.9c: the thickness times a factor.
    text = coat(COAT, "alpha = 0.1\n", DEPTH) + matte(0.9)
    thinner = layers([(COAT, 0.1, 0.3 * DEPTH, ggx)], lambert(0.9))
    values(COURSE, "varnish of three tenths of its thickness", "figure 3.9c", text, "weidlich-wilkie", thinner, extra=("--slab-factor", "0.3"))

    densities(surfaces)
    fluorescent()


def visible(alpha, w):
    """Density of the mirrored direction at facets drawn by what w sees of them: G1 D / (4 cos)."""

    def density(i):
        h = half(i, w)
        g1 = 1 / (1 + lambda_ggx(slope(w, *alpha)))
        return g1 * ggx_stretched(*alpha)(h) / (4 * abs(w[2]))

    return density


def densities(surfaces):
    """Densities of drawn directions: Heitz 2018 for one interface, and those of both methods of the course for two layers."""
    alpha = (0.25, 0.06)
    text = '[[layer]]\ntype = "dielectric"\nior = 1.5\nalpha_x = 0.25\nalpha_y = 0.06\n' + metal("alpha = 0.2\n")
    values(YAMAGUCHI, "density of visible normals", "section 3; Heitz 2018", text, "density-visible-normals", lambda i, o: visible(alpha, o)(i))

    # A varnish on a diffuse base. Directions below the horizon are turned up: s is how much the part below is squeezed to fit.
    n, m, rho = COAT, 0.3, 0.8
    text = coat(n, f"alpha = {m}\n") + matte(rho)

    def proposed(i, o):
        top = visible((m, m), o)
        squeeze = min(1.0, 1 / o[2])
        folded = (i[0], i[1], -i[2] / squeeze)
        flat = math.sqrt(1 - folded[2] ** 2) / math.hypot(i[0], i[1])
        folded = (i[0] * flat, i[1] * flat, folded[2])
        below = top(folded) if -folded[2] <= o[2] else 0.0
        return top(i) + below / squeeze, i[2] / PI

    def local(i, o):
        f = fresnel(n, o[2])
        w = [f, (1 - f) ** 2 * rho]
        return sum(a * p for a, p in zip(w, proposed(i, o))) / sum(w)

    values(COURSE, "densities of the global method", "section 3.2.2", text, "density-layers-global", lambda i, o: sum(proposed(i, o)))
    values(COURSE, "density of the local method", "section 3.2.4, eq. 3.6", text, "density-layers-local", local)
    own = lambda i, o: sum(a * p for a, p in zip((0.2, 0.8), proposed(i, o)))
    values(COURSE, "density of the local method, weights of one's own", "section 3.2.4, eq. 3.6", text, "density-layers-local", own, extra=("--weights", "0.2,0.8"))


def fluorescent():
    """Light of one wavelength that comes out at another below a varnish: all its ways between base and varnish, as a series of matrices."""
    dye = [[0.4, 0, 0], [0.2, 0.5, 0], [0.3, 0.1, 0.6]]
    nm = (520, 560, 600)
    matrix = "\n".join(["out/in,520,560,600"] + [",".join(map(str, (k, *shares))) for k, shares in zip(nm, dye)]) + "\n"
    outside = simpson(lambda u: 4 * u**3 * fresnel(COAT, u * u), 0, 1)
    inside = 1 - (1 - outside) / COAT**2
    product = lambda a, b: [[sum(a[r][k] * b[k][c] for k in range(3)) for c in range(3)] for r in range(3)]
    echo = [[inside * x for x in shares] for shares in dye]
    term, total = dye, [[0.0] * 3 for _ in range(3)]
    for _ in range(200):
        total = [[a + b for a, b in zip(*rows)] for rows in zip(total, term)]
        term = product(echo, term)
    text = coat(COAT, 'alpha = 0.001\ndistribution = "beckmann"\n') + matte(0.6)
    pairs = []
    for light, seen in ((0, 1), (0, 2), (1, 2), (2, 2)):
        for ti, pi, to, po in PAIRS:
            through = (1 - fresnel(COAT, math.cos(math.radians(ti)))) * (1 - fresnel(COAT, math.cos(math.radians(to))))
            angles = ("--wi", f"{ti},{pi}", "--wo", f"{to},{po}", "--matrix", "dye.csv", "--excitation", str(nm[light]))
            told = ask(text, "--model", "fluorescence", *angles, beside={"dye.csv": matrix}, colour=("--wavelength", str(nm[seen])))
            pairs.append((math.cos(math.radians(ti)) * through * total[seen][light] / (PI * COAT**2), told["values"][0]["value"][0]))
    row(COURSE, "re-radiation under a varnish", "section 5.2.2", pairs, 1e-6)


def compare():
    elek()
    granier_heidrich()
    lecture()
    course()
