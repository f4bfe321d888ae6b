#!/usr/bin/env python3
"""Checks the reference model `layered-mc` against a random walk that shares no code with luthier.

Light walks through the stack ray by ray: at each interface over a height-uncorrelated Smith micro-surface of GGX facets (Heitz
et al. 2016), reflecting and refracting until it leaves on one side; in each slab it is absorbed. Nothing is clever: facets
are drawn from the distribution of normals and accepted by the area that they show, paths end when they leave or are dark.

Needs PyPI `numpy` and Python 3.11.

    cargo build --release -p luthier-cli --no-default-features
    python3 scripts/independent/layered.py scripts/independent/stacks/*.toml
    python3 scripts/independent/layered.py --paths 1000000 mine.toml

Materials are dielectrics over one conductor, GGX and isotropic, of constant index. Both programs give directional albedos with standard errors.
Exits with 1 when one differs by more than four standard errors of the difference, or the mean over all angles does.
"""

import argparse
import json
import math
import pathlib
import subprocess
import sys
import tomllib

import numpy as np

# How sure to be of a breach: one in 16 000 per angle by chance.
SIGMAS = 4.0

# Paths that carry less than this are cut: less than the digits printed.
DARK = 1e-7

DEFAULT_LUTHIER = pathlib.Path(__file__).resolve().parents[2] / "target" / "release" / "luthier"


# --- Materials -------------------------------------------------------------------------------------------------------


class Layer:
    """One interface: slope parameter, the complex index below, and the optical depth of the slab below."""

    def __init__(self, table):
        if table.get("distribution", "ggx") != "ggx":
            sys.exit("only GGX surfaces are evaluated")
        self.alpha = table["alpha"] if "alpha" in table else table["roughness"] ** 2
        ior = table["ior"]
        self.opaque = table["type"] == "conductor"
        self.index = complex(ior["n"], ior["k"]) if isinstance(ior, dict) else complex(ior)
        depths = [absorption * table.get("thickness_um", 0.0) for absorption in table.get("absorption_per_um", [0.0])]
        if len(set(depths)) > 1:
            sys.exit("only grey slabs are evaluated")
        self.optical_depth = depths[0]
        self.normals = Normals(self.alpha)


def read_material(path):
    """Layers from the top down."""
    with open(path, "rb") as file:
        material = tomllib.load(file)
    layers = [Layer(table) for table in material["layer"]]
    if not layers[-1].opaque or any(layer.opaque for layer in layers[:-1]):
        sys.exit(f"{path}: not dielectrics over one conductor")
    return material["name"], layers


# --- Interfaces ------------------------------------------------------------------------------------------------------


def reflectance(cosine, index):
    """Unpolarised Fresnel reflectance; `index` is the complex index behind the facet over that before it."""
    sine_sq = 1.0 - cosine**2
    # The root with a positive imaginary part decays; of a real one total reflection needs the imaginary root.
    inner = np.sqrt(index**2 - sine_sq + 0j)
    s = (cosine - inner) / (cosine + inner)
    p = (index**2 * cosine - inner) / (index**2 * cosine + inner)
    return 0.5 * (np.abs(s) ** 2 + np.abs(p) ** 2)


class Normals:
    """Facet normals drawn by the area that they show to a direction."""

    NODES = 40_000

    def __init__(self, alpha):
        # D per unit cosine is alpha^2 / (1 - k c^2)^2 with k = 1 - alpha^2, whose integral is a closed form; its inverse is read
        # from a list, in the sine of the angle, graded so that narrow lobes are resolved.
        self.alpha = alpha
        tangent = alpha * np.tan(np.linspace(0.0, 0.5 * math.pi, self.NODES))
        self.cosine = 1.0 / np.sqrt(1.0 + tangent**2)
        self.cosine[-1] = 0.0
        k = 1.0 - alpha**2
        c = self.cosine
        if k < 1e-9:
            area = c
        else:
            root = math.sqrt(k)
            area = 0.5 * c / (1.0 - k * c * c) + 0.5 * np.arctanh(root * c) / root
        self.area = area[::-1] / area[0]
        self.ascending = c[::-1]

    def seen(self, towards, random):
        """Normals that rays see which came from the directions `towards` [n, 3]."""
        normals = np.zeros_like(towards)
        waiting = np.arange(len(towards))
        while len(waiting) > 0:
            cosine = np.interp(random.random(len(waiting)), self.area, self.ascending)
            sine = np.sqrt(1.0 - cosine**2)
            phi = 2.0 * math.pi * random.random(len(waiting))
            trial = np.stack([sine * np.cos(phi), sine * np.sin(phi), cosine], axis=1)
            shown = np.sum(trial * towards[waiting], axis=1)
            taken = random.random(len(waiting)) < shown
            normals[waiting[taken]] = trial[taken]
            waiting = waiting[~taken]
        return normals


def smith_lambda(alpha, z):
    """Signed Lambda on the whole sphere: negative for rays that go down."""
    with np.errstate(divide="ignore"):
        tangent_sq = (1.0 - z * z) / (z * z)
    return 0.5 * (np.copysign(np.sqrt(1.0 + alpha**2 * tangent_sq), z) - 1.0)


def walk(layer, above, direction, weight, from_below, random):
    """Rays over one interface until they leave; returns (leaves below, direction), and scales `weight` in place.

    Directions are in the frame of the ray's own side, z out of the interface into that side. Heights are uniform, and
    `level` is the share of the surface that lies deeper than the ray; from the other side it is 1 - level.
    """
    below = np.full(len(direction), from_below)
    level = np.ones(len(direction))
    direction = direction.copy()
    alive = np.arange(len(direction))
    while len(alive) > 0:
        w = direction[alive]
        exponent = smith_lambda(layer.alpha, w[:, 2])
        # The ray misses all facets up to the level l with probability (level / l)^Lambda.
        with np.errstate(divide="ignore", over="ignore"):
            reached = level[alive] * random.random(len(alive)) ** (-1.0 / exponent)
        stays = ~((w[:, 2] > 0.0) & (reached >= 1.0))
        alive, w = alive[stays], w[stays]
        level[alive] = np.clip(reached[stays], 0.0, 1.0)
        if len(alive) == 0:
            break
        back = -w
        normal = layer.normals.seen(back, random)
        cosine = np.clip(np.sum(back * normal, axis=1), 0.0, 1.0)
        mirrored = 2.0 * cosine[:, None] * normal - back
        if layer.opaque:
            weight[alive] *= reflectance(cosine, layer.index / above)
            direction[alive] = mirrored
        else:
            eta = np.where(below[alive], above / layer.index.real, layer.index.real / above)
            crosses = random.random(len(alive)) >= reflectance(cosine, eta)
            cos_t = np.sqrt(np.maximum(1.0 - (1.0 - cosine**2) / eta**2, 0.0))
            refracted = normal * (cosine / eta - cos_t)[:, None] - back / eta[:, None]
            refracted[:, 2] *= -1.0
            direction[alive] = np.where(crosses[:, None], refracted, mirrored)
            level[alive] = np.where(crosses, 1.0 - level[alive], level[alive])
            below[alive] ^= crosses
        direction[alive] /= np.linalg.norm(direction[alive], axis=1, keepdims=True)
        alive = alive[weight[alive] > DARK]
    weight[weight <= DARK] = 0.0
    return below, direction


def albedo(layers, theta_deg, paths, random):
    """Directional albedo and its standard error."""
    theta = math.radians(theta_deg)
    # Where each ray is: above interface `place`, going down, or below interface `place - 1`, going up.
    direction = np.tile([-math.sin(theta), 0.0, -math.cos(theta)], (paths, 1))
    place = np.zeros(paths, dtype=int)
    upward = np.zeros(paths, dtype=bool)
    weight = np.ones(paths)
    alive = np.ones(paths, dtype=bool)
    out = np.zeros(paths)
    while alive.any():
        for number, layer in enumerate(layers):
            above = layers[number - 1].index.real if number > 0 else 1.0
            for from_below in (False, True):
                arrives = alive & (upward == from_below) & (place == (number + 1 if from_below else number))
                rays = np.flatnonzero(arrives)
                if len(rays) == 0:
                    continue
                # Own frames: a ray that arrives goes against its z axis, one that leaves goes along it.
                carried = weight[rays]
                below, leaving = walk(layer, above, direction[rays], carried, from_below, random)
                cosine = np.maximum(leaving[:, 2], 1e-12)
                slab = np.where(below, layer.optical_depth, layers[number - 1].optical_depth if number > 0 else 0.0)
                carried *= np.exp(-slab / cosine)
                # On the far side of the slab z points back into it.
                leaving[:, 2] *= -1.0
                direction[rays] = leaving
                upward[rays] = ~below
                place[rays] = np.where(below, number + 1, number)
                weight[rays] = carried
                done = rays[~below] if number == 0 else rays[:0]
                out[done] = weight[done]
                alive[done] = False
                alive[rays[carried <= DARK]] = False
    return out.mean(), out.std() / math.sqrt(paths)


# --- The check -------------------------------------------------------------------------------------------------------


def reference(options, path):
    """(angle, albedo, standard error) of luthier."""
    command = [options.luthier, "eval", path, "--model", "layered-mc", "--albedo", "--json"]
    printed = subprocess.run(command, check=True, stdout=subprocess.PIPE, stderr=subprocess.DEVNULL).stdout
    return [(row["theta_o_deg"], row["albedo"], row["error"]) for row in json.loads(printed)["albedo"]]


def check(options, path, random):
    name, layers = read_material(path)
    print(f"\n{name}\n theta  here                 luthier              difference / sigma")
    rows = []
    for theta, expected, error in reference(options, path):
        mean, own = albedo(layers, theta, options.paths, random)
        sigma = math.hypot(error, own)
        rows.append((mean - expected, sigma))
        print(f"{theta:6.1f}  {mean:.5f} +- {own:.5f}   {expected:.5f} +- {error:.5f}   {(mean - expected) / sigma:+.2f}")
    difference = sum(row[0] for row in rows) / len(rows)
    sigma = math.sqrt(sum(row[1] ** 2 for row in rows)) / len(rows)
    worst = max(abs(d) / s for d, s in rows)
    good = worst <= SIGMAS and abs(difference) <= SIGMAS * sigma
    print(f"  mean difference {difference:+.5f} +- {sigma:.5f}, worst {worst:.2f} sigma: {'ok' if good else 'DIFFERS'}")
    return good


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("materials", type=pathlib.Path, nargs="+", metavar="FILE")
    parser.add_argument("--luthier", type=pathlib.Path, default=DEFAULT_LUTHIER, help="the program to check")
    parser.add_argument("--paths", type=int, default=100_000, help="paths per angle")
    parser.add_argument("--seed", type=int, default=1)
    options = parser.parse_args()
    random = np.random.default_rng(options.seed)
    results = [check(options, path, random) for path in options.materials]
    sys.exit(0 if all(results) else 1)


if __name__ == "__main__":
    main()
