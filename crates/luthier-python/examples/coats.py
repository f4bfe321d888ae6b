"""Directional albedo of 50 clear coats over copper, from smooth to rough, as a plot: coats.py [OUT.png]"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as plt
import numpy as np

import luthier

alphas = np.linspace(0.02, 1.0, 50)
theta = np.arange(0, 90, 5)
table = np.empty((len(alphas), len(theta), 3))
for row, alpha in enumerate(alphas):
    coat = {"type": "dielectric", "ior": 1.5, "alpha": alpha, "thickness_um": 30, "absorption_per_um": [0.002, 0.004, 0.01]}
    copper = {"type": "conductor", "ior": "cu", "alpha": 0.15}
    material = luthier.load({"schema": 1, "name": "coat", "layer": [coat, copper]})
    table[row] = material.albedo(luthier.directions(theta), model="elek")

figure, (left, right) = plt.subplots(1, 2, figsize=(11, 4.5), layout="constrained")
left.imshow(np.clip(table, 0, 1) ** (1 / 2.2), aspect="auto", origin="lower", extent=(0, 90, alphas[0], alphas[-1]))
left.set(xlabel="angle of the eye (degrees)", ylabel="alpha of the coat", title="albedo, as a colour")
image = right.imshow(table.mean(axis=2), aspect="auto", origin="lower", extent=(0, 90, alphas[0], alphas[-1]))
right.set(xlabel="angle of the eye (degrees)", ylabel="alpha of the coat", title="albedo, mean of the channels")
figure.colorbar(image)
figure.savefig(sys.argv[1] if len(sys.argv) > 1 else "coats.png", dpi=120)
