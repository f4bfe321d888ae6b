"""Pairs of directions a second and core, in batches of a million: python bench.py

Prints a table in Markdown: the best of five runs of `Function.eval` for each material and model, by processor time of one thread. Directions are random in the
hemisphere.
"""

import os
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


def hemisphere(seed):
    random = np.random.default_rng(seed)
    z, phi = random.uniform(0.0, 1.0, COUNT), random.uniform(0.0, 2.0 * np.pi, COUNT)
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)


def seconds(function, wi, wo):
    best = float("inf")
    for _ in range(5):
        start = time.process_time()
        function.eval(wi, wo)
        best = min(best, time.process_time() - start)
    return best


wi, wo = hemisphere(1), hemisphere(2)
print("Millions of pairs a second and core:\n")
print("| model | material | pairs |\n|---|---|--:|")
for model, name, layers in CASES:
    function = luthier.load({"schema": 1, "name": "bench", "layer": layers}).function(model)
    function.eval(wi[:1], wo[:1])
    print(f"| `{model}` | {name} | {COUNT / seconds(function, wi, wo) / 1e6:.1f} |")
