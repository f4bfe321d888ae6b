#!/usr/bin/env python3
"""Checks the EXR truth of a bake against evaluations that share no code with luthier.

Needs PyPI `OpenEXR` and `numpy`. The EXR files are read by the reference library of the format; what they should hold is
evaluated here from the literature: Fresnel's equations, the closed forms of Beckmann and GGX, and a brute-force random
walk on the Smith micro-surface (Heitz et al. 2016).

    pip install OpenEXR numpy
    python3 scripts/independent/read_exr.py out/manifest.json
    python3 scripts/independent/read_exr.py out/manifest.json --index brass-foil/0=brass_70_30.csv --index coated/1=cu.csv/1.5

Without --index, spectral interfaces are evaluated only if their index is the same at all wavelengths of the manifest. --index TILE=BELOW or
TILE=BELOW/ABOVE names the media below and above an interface: a number, `n,k`, or a CSV of wavelength_nm, n, k.
Exits with 1 when a Fresnel or distribution table differs by more than its tolerance, or an FGD value by more than five
standard errors and 1e-3.
"""

import argparse
import csv
import json
import math
import pathlib
import sys

import numpy as np
import OpenEXR

# The files hold 32-bit floats: half a unit in the last place is 6e-8 of the value. The evaluations here and there are both
# in f64 and differ by rounding, which the exponential of a large argument magnifies.
TOLERANCE = 1e-6
# What the FGD tables promise at their nodes and between them, and how sure to be of a breach.
FGD_TOLERANCE = 1e-3
FGD_SIGMAS = 5.0

DEFAULT_DATA = pathlib.Path(__file__).resolve().parents[2] / "crates" / "luthier-optics" / "data"


# --- Files -----------------------------------------------------------------------------------------------------------


class Table:
    """A table of the manifest with its truth as an array [row, column, channel]."""

    def __init__(self, entry, folder):
        self.entry = entry
        self.layout = entry["layout"]
        path = folder / entry["truth"]["path"]
        part = OpenEXR.File(str(path), separate_channels=True)
        planes = part.channels()
        colour = [name for name in "RGBY" if name in planes]
        names = colour + sorted(set(planes) - set(colour))
        self.values = np.stack([planes[name].pixels for name in names], axis=-1)
        self.metadata = json.loads(part.header().get("luthier", "{}"))

    def nodes(self, which):
        """The axis values at the nodes of axis "x" or "y"."""
        axis = self.layout[which]
        kind = axis["mapping"]["kind"]
        count = axis["size"] if kind == "periodic" else axis["size"] - 1
        u = np.arange(axis["size"]) / count
        low, high = axis["min"], axis["max"]
        if kind == "logarithmic":
            return low * (high / low) ** u
        if kind == "power":
            u = u ** axis["mapping"]["exponent"]
        return low + (high - low) * u

    def tile(self, number):
        """The nodes of one tile, without apron."""
        apron, x, y = self.layout["apron"], self.layout["x"], self.layout["y"]
        width = x["size"] + 2 * apron
        height = 1 if y is None else y["size"] + 2 * apron
        left = number % self.layout["columns"] * width + apron
        top = number // self.layout["columns"] * height + (0 if y is None else apron)
        return self.values[top : top + (1 if y is None else y["size"]), left : left + x["size"]]


def read_columns(path):
    """Numeric rows of a CSV with `#` comments and perhaps a line of names."""
    rows = []
    with open(path, newline="", encoding="utf-8") as file:
        for row in csv.reader(line for line in file if not line.startswith("#")):
            try:
                rows.append([float(cell) for cell in row])
            except ValueError:
                continue
    return np.array([row for row in rows if len(row) == len(rows[-1])])


# --- Indices and colour ----------------------------------------------------------------------------------------------


def index_at(spec, wavelengths, data):
    """A complex index n + ik at wavelengths in nm, from `1.5`, `0.2,3.4` or a CSV; linear, constant outside."""
    try:
        numbers = [float(part) for part in spec.split(",")]
        return np.full(len(wavelengths), complex(*numbers))
    except ValueError:
        pass
    path = pathlib.Path(spec)
    columns = read_columns(path if path.exists() else data / spec)
    n = np.interp(wavelengths, columns[:, 0], columns[:, 1])
    k = np.interp(wavelengths, columns[:, 0], columns[:, 2]) if columns.shape[1] > 2 else 0.0
    return n + 1j * k


class Colour:
    """Wavelengths in nm and the weights [wavelength, channel] that turn a spectrum into linear Rec.709."""

    def __init__(self, mode, wavelengths_nm, data):
        if mode == "three-wavelengths":
            self.wavelengths, self.weights = np.array(wavelengths_nm), np.eye(3)
            return
        table = read_columns(data / "cie_1931_d65.csv")
        self.wavelengths = table[:, 0]
        xyz = table[:, 1:4] * table[:, 4:5]
        xyz /= xyz[:, 1].sum()
        # Rec.709 primaries, scaled so that the illuminant itself is (1, 1, 1).
        primaries = np.array([[x, y, 1.0 - x - y] for x, y in ((0.64, 0.33), (0.30, 0.60), (0.15, 0.06))]).T
        scaled = primaries * np.linalg.solve(primaries, xyz.sum(axis=0))
        self.weights = xyz @ np.linalg.inv(scaled).T


def fresnel(cos_theta, index):
    """Unpolarised power reflectance at an interface of relative complex index; the inputs broadcast."""
    cos_theta = np.asarray(cos_theta, dtype=float)
    index = np.asarray(index, dtype=complex)
    cos_t = np.sqrt(1.0 - (1.0 - cos_theta**2) / index**2)
    # The wave that decays away from the interface.
    inner = index * cos_t
    inner = np.where(inner.imag < 0.0, -inner, inner)
    cos_t = inner / index
    # An index-matched interface at grazing incidence is 0/0, and reflects nothing.
    with np.errstate(invalid="ignore"):
        r_s = np.nan_to_num((cos_theta - inner) / (cos_theta + inner))
        r_p = np.nan_to_num((index * cos_theta - cos_t) / (index * cos_theta + cos_t))
    return 0.5 * (np.abs(r_s) ** 2 + np.abs(r_p) ** 2)


# --- Distributions ---------------------------------------------------------------------------------------------------


def scaled_distribution(name, theta, alpha):
    """pi alpha^2 D(theta), from the tangent form."""
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        tangent_sq = np.tan(theta) ** 2
        cos4 = np.cos(theta) ** 4
        if name == "beckmann":
            value = np.exp(-tangent_sq / alpha**2) / cos4
        else:
            value = 1.0 / (cos4 * (1.0 + tangent_sq / alpha**2) ** 2)
    return np.where(np.cos(theta) < 1e-12, 0.0 if name == "beckmann" else alpha**4, value)


# --- The Smith random walk -------------------------------------------------------------------------------------------


def smith_lambda(name, alpha, cos_theta):
    """Signed Lambda, for directions on the whole sphere."""
    tangent = np.sqrt(np.maximum(1.0 - cos_theta**2, 1e-30)) / np.where(cos_theta == 0.0, 1e-30, cos_theta)
    if name == "ggx":
        return 0.5 * (np.sign(cos_theta) * np.sqrt(1.0 + (alpha * tangent) ** 2) - 1.0)
    nu = 1.0 / (alpha * tangent)
    erf = np.vectorize(math.erf)(nu)
    return 0.5 * (erf - 1.0) + np.exp(-(nu**2)) / (2.0 * math.sqrt(math.pi) * nu)


def visible_normals(name, alpha, towards, random):
    """Normals that a ray sees which came from the directions `towards` [n, 3]."""
    if name == "ggx":
        # Stretched to a hemisphere, whose reflections are uniform on a spherical cap (Dupuy and Benyoub 2023).
        stretched = towards * [alpha, alpha, 1.0]
        stretched /= np.linalg.norm(stretched, axis=1, keepdims=True)
        phi = 2.0 * math.pi * random.random(len(towards))
        z = (1.0 - random.random(len(towards))) * (1.0 + stretched[:, 2]) - stretched[:, 2]
        radius = np.sqrt(np.maximum(1.0 - z * z, 0.0))
        normals = np.stack([radius * np.cos(phi), radius * np.sin(phi), z], axis=1) + stretched
        normals *= [alpha, alpha, 1.0]
    else:
        # Gaussian slopes, accepted by the cosine they show. Slopes beyond 6 standard deviations are left out.
        reach = 6.0 * alpha / math.sqrt(2.0)
        sine = np.hypot(towards[:, 0], towards[:, 1])
        slopes = np.zeros((len(towards), 2))
        waiting = np.arange(len(towards))
        for _ in range(5_000):
            trial = random.normal(0.0, alpha / math.sqrt(2.0), (len(waiting), 2))
            w = towards[waiting]
            shown = w[:, 2] - trial[:, 0] * w[:, 0] - trial[:, 1] * w[:, 1]
            taken = random.random(len(waiting)) * (w[:, 2] + reach * sine[waiting]) < shown
            slopes[waiting[taken]] = trial[taken]
            waiting = waiting[~taken]
            if len(waiting) == 0:
                break
        else:
            # Directions that see next to nothing: the slope at the edge of what they see.
            w = towards[waiting]
            slopes[waiting] = w[:, :2] * ((w[:, 2] - 1e-9) / sine[waiting] ** 2)[:, None]
        normals = np.stack([-slopes[:, 0], -slopes[:, 1], np.ones(len(towards))], axis=1)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def walk(name, alpha, cos_theta, index, is_dielectric, paths, random):
    """Reflected share of a beam per wavelength and its part that never crossed, by brute force.

    `index` is the relative index per wavelength; a dielectric has one. Uniform heights; the share does not depend on
    the distribution of heights. A ray is kept in the frame of its side: z points out of the medium that it is in, and
    `level` is the share of the surface below it in that frame. Returns [2, wavelength] means and standard errors.
    """
    sine = math.sqrt(max(1.0 - cos_theta**2, 0.0))
    direction = np.tile([-sine, 0.0, -cos_theta], (paths, 1))
    level = np.full(paths, 1.0)
    inside = np.zeros(paths, dtype=bool)
    crossed = np.zeros(paths, dtype=bool)
    weight = np.ones((paths, 1 if is_dielectric else len(index)))
    reflected = np.zeros((2, *weight.shape))
    alive = np.arange(paths)
    for _ in range(10_000):
        w = direction[alive]
        exponent = smith_lambda(name, alpha, w[:, 2])
        u = random.random(len(alive))
        with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
            escapes = (w[:, 2] > 0.0) & (1.0 - u < level[alive] ** exponent)
            level[alive] = np.clip(level[alive] * (1.0 - u) ** (-1.0 / exponent), 0.0, 1.0)
        out = alive[escapes & ~inside[alive]]
        reflected[0, out] = weight[out]
        reflected[1, out] = weight[out] * ~crossed[out, None]
        alive = alive[~escapes]
        if len(alive) == 0:
            break

        back = -direction[alive]
        normal = visible_normals(name, alpha, back, random)
        cosine = np.clip(np.sum(back * normal, axis=1), 0.0, 1.0)
        mirrored = 2.0 * cosine[:, None] * normal - back
        if is_dielectric:
            eta = np.where(inside[alive], 1.0 / index[0].real, index[0].real)
            refracts = random.random(len(alive)) >= fresnel(cosine, eta)
            cos_t = np.sqrt(np.maximum(1.0 - (1.0 - cosine**2) / eta**2, 0.0))
            bent = normal * (cosine / eta - cos_t)[:, None] - back / eta[:, None]
            # On the other side everything is upside down.
            direction[alive] = np.where(refracts[:, None], -bent, mirrored)
            level[alive] = np.where(refracts, 1.0 - level[alive], level[alive])
            inside[alive] ^= refracts
            crossed[alive] |= refracts
        else:
            weight[alive] *= fresnel(cosine[:, None], index[None, :])
            direction[alive] = mirrored
    else:
        sys.exit("the walk does not come to an end")
    return reflected.mean(axis=1), reflected.std(axis=1) / math.sqrt(paths)


# --- The checks ------------------------------------------------------------------------------------------------------


def interfaces(manifest, key):
    """(tile number, material, layer record) of the first user of each tile."""
    seen = {}
    for material in manifest["materials"]:
        for layer in material["layers"]:
            if layer[key] is not None:
                seen.setdefault(layer[key], (material, layer))
    return [(tile, *seen[tile]) for tile in sorted(seen)]


def relative_index(name, layer, colour, options):
    """The relative index at the wavelengths of `colour`, or None where the manifest does not tell."""
    spec = options.index.get(name)
    if spec is not None:
        below, _, above = spec.partition("/")
        above = index_at(above, colour.wavelengths, options.data) if above else 1.0
        return index_at(below, colour.wavelengths, options.data) / above
    # Schlick's formula takes the place of an index.
    if layer["film_thickness_max_nm"] > 0.0 or "f0" in layer:
        return None
    if len(colour.wavelengths) == 3:
        return np.array(layer["ior_n"]) + 1j * np.array(layer["ior_k"])
    if len(set(layer["ior_n"])) > 1 or len(set(layer["ior_k"])) > 1:
        return None
    return np.full(len(colour.wavelengths), complex(layer["ior_n"][0], layer["ior_k"][0]))


def cosines(table):
    """Cosines at the nodes of an x axis over the cosine or the angle."""
    nodes = table.nodes("x")
    return np.cos(nodes) if table.layout["x"]["quantity"].startswith("theta") else nodes


def report(kind, name, difference, passed):
    print(f"{kind:13} {name:32} {difference:10.2e}  {'ok' if passed else 'DIFFERS'}")
    return passed


def check_fresnel(table, manifest, options):
    good, left_out = True, []
    for tile, material, layer in interfaces(manifest, "fresnel_tile"):
        name = table.entry["tiles"][tile]["name"]
        colour = Colour(material["color"], material["wavelengths_nm"], options.data)
        index = relative_index(name, layer, colour, options)
        if index is None:
            left_out.append(name)
            continue
        expected = fresnel(cosines(table)[:, None], index[None, :]) @ colour.weights
        worst = np.abs(table.tile(tile)[0, :, :3] - expected).max()
        good &= report("fresnel", name, worst, worst <= TOLERANCE)
    if left_out:
        print(f"{'fresnel':13} not evaluated, for want of --index: {', '.join(left_out)}")
    return good


def check_distribution(table):
    good = True
    nodes = table.nodes("x")
    theta = nodes if table.layout["x"]["quantity"] == "theta_h" else np.arccos(nodes)
    alpha = table.nodes("y")
    rows = alpha > 0.0
    for number, tile in enumerate(table.entry["tiles"]):
        name = "ggx" if "ggx" in tile["name"].lower() else "beckmann"
        expected = scaled_distribution(name, theta[None, :], alpha[rows, None])
        worst = np.abs(table.tile(number)[rows, :, 0] - expected).max()
        good &= report("distribution", tile["name"], worst, worst <= TOLERANCE)
    return good


def check_fgd(table, manifest, options):
    good = True
    random = np.random.default_rng(options.seed)
    mu, alpha = cosines(table), table.nodes("y")
    for tile, material, layer in interfaces(manifest, "fgd_tile"):
        name = table.entry["tiles"][tile]["name"]
        colour = Colour(material["color"], material["wavelengths_nm"], options.data)
        index = relative_index(name, layer, colour, options)
        is_dielectric = layer["kind"] == "dielectric"
        if index is None or (is_dielectric and (len(set(index)) > 1 or index[0].imag != 0.0)):
            print(f"{'fgd':13} {name:32} not evaluated")
            continue
        for _ in range(options.fgd_points):
            i = int(random.integers(1, len(mu)))
            j = int(random.integers(1, len(alpha)))
            mean, error = walk(
                layer["distribution"], alpha[j], mu[i], index, is_dielectric, options.paths, random
            )
            weights = np.ones((1, 3)) if is_dielectric else colour.weights
            difference = np.abs(table.tile(tile)[j, i, :3] - mean[0] @ weights).max()
            # Wavelengths share their paths, so their errors add up rather than cancel.
            bound = FGD_TOLERANCE + FGD_SIGMAS * (error[0] @ np.abs(weights)).max()
            if is_dielectric:
                single = abs(table.tile(tile)[j, i, 3] - mean[1, 0])
                difference = max(difference, single)
            good &= report("fgd", f"{name} mu={mu[i]:.4f} alpha={alpha[j]:.4f}", difference, difference <= bound)
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("manifest", type=pathlib.Path)
    parser.add_argument("--data", type=pathlib.Path, default=DEFAULT_DATA, help="folder of cie_1931_d65.csv and indices")
    parser.add_argument("--index", action="append", default=[], metavar="TILE=BELOW[/ABOVE]")
    parser.add_argument("--fgd-points", type=int, default=4, help="random nodes per FGD tile (0: none)")
    parser.add_argument("--paths", type=int, default=200_000, help="random walks per node")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    options.index = dict(item.split("=", 1) for item in options.index)

    manifest = json.loads(options.manifest.read_text(encoding="utf-8"))
    print("table         tile                             max difference")
    good = True
    for entry in manifest["tables"]:
        table = Table(entry, options.manifest.parent)
        if entry["kind"] == "fresnel":
            good &= check_fresnel(table, manifest, options)
        elif entry["kind"] == "distribution":
            good &= check_distribution(table)
        elif entry["kind"] == "fgd":
            good &= check_fgd(table, manifest, options)
        else:
            print(f"{entry['kind']:13} read, {table.values.shape}, not evaluated")
    sys.exit(0 if good else 1)


if __name__ == "__main__":
    main()
