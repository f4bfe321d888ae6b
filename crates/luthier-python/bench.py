"""Pairs of directions a second and core, in batches of a million: python bench.py >docs/pages/python-speed.md

Directions are random in the hemisphere. The module is that of the Python that runs this.
"""

import os
import platform
import time

os.environ["RAYON_NUM_THREADS"] = "1"

import numpy as np

import luthier

COUNT = 1_000_000
F0 = [0.9, 0.6, 0.3]
METAL = {"type": "conductor", "f0": F0, "alpha": 0.3}
BASE = {"type": "diffuse", "albedo": [0.7, 0.3, 0.2]}
CLEAR = {"type": "dielectric", "f0": 0.04, "alpha": 0.2}
TINTED = {"type": "dielectric", "f0": 0.04, "alpha": 0.2, "thickness_um": 20, "absorption_per_um": [0.01, 0.02, 0.03]}
GLASS = {"type": "dielectric", "ior": 1.5, "alpha": 0.2}
CASES = [
    ("phong", "metal of a given F0", [METAL]),
    ("phong", "tinted coat of a given F0 over a diffuse base", [TINTED, BASE]),
    ("elek", "metal of a given F0", [METAL]),
    ("elek", "clear coat of a given F0 over a diffuse base", [CLEAR, BASE]),
    ("elek", "clear coat over metal, both of a given F0", [CLEAR, METAL]),
    ("elek", "tinted coat of a given F0 over a diffuse base", [TINTED, BASE]),
    ("elek", "glass by Fresnel's equations over a diffuse base", [GLASS, BASE]),
    ("microfacet", "metal of a given F0", [METAL]),
]
# Models that are random estimates, with one walk for each pair.
ONE = {model: {"samples": 1} for model in ("random-walk", "layered-mc", "layered-mc-one-facet")}


def hemisphere(seed):
    random = np.random.default_rng(seed)
    z, phi = random.uniform(0.0, 1.0, COUNT), random.uniform(0.0, 2.0 * np.pi, COUNT)
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)


def seconds(function, wi, wo, runs=5):
    best = float("inf")
    for _ in range(runs):
        start = time.process_time()
        function.eval(wi, wo)
        best = min(best, time.process_time() - start)
    return best


def millions(function):
    """Pairs in a microsecond, of as many as take half a second: ten at least, a million at most."""
    function.eval(wi[:1], wo[:1])
    count = 10
    while count < COUNT and (once := seconds(function, wi[:count], wo[:count], 1)) < 0.5:
        count = min(COUNT, 2 * count if once > 0.2 else 10 * count)
    return count / seconds(function, wi[:count], wo[:count]) / 1e6


def function(model, layers):
    return luthier.load({"schema": 1, "name": "bench", "layer": layers}).function(model, **ONE.get(model, {}))


def processor():
    """The name of the processor, as Linux has it."""
    try:
        with open("/proc/cpuinfo") as info:
            found = dict(line.split(":", 1) for line in info if ":" in line)
        return " ".join(f"{key.strip()} {value.strip()}," for key, value in found.items() if key.strip() in ("model name", "cpu MHz"))
    except OSError:
        return f"{platform.machine()},"


HEAD = """# Speed of the Python module

Made by `crates/luthier-python/bench.py` with the module of a release build, luthier {version}, on one core: {processor} NumPy {numpy}. Numbers are
millions of pairs of directions a second of processor time that `Function.eval` takes: arrays of up to a million random pairs, the best of five runs.

## Phong, Elek's model and one surface

| model | material | pairs |
|---|---|--:|"""

ALL = """
## All models

The material is a tinted coat over a diffuse base. A model of one surface takes the coat alone, Lambert's and Oren and Nayar's the base. Random walks have
one walk for each pair. Slow models get fewer pairs.

| model | pairs |
|---|--:|"""

wi, wo = hemisphere(1), hemisphere(2)
print(HEAD.format(version=luthier.__version__, processor=processor(), numpy=np.__version__))
for model, name, layers in CASES:
    print(f"| `{model}` | {name} | {millions(function(model, layers)):.1f} |")
print(ALL)
for model in luthier.models():
    name = model["name"]
    print(f"| `{name}` | {millions(function(name, [TINTED, BASE])):.2g} |", flush=True)
