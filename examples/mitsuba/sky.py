"""The sky of the balls that renderers of others draw beside `luthier preview`."""

import numpy as np


def sky():
    """An equirectangular map of soft lamps, in luthier's orientation: the middle looks along -z, +x is right of it, the top is +y."""
    height = 128
    u, v = (np.arange(2 * height) + 0.5) / (2 * height), (np.arange(height) + 0.5) / height
    phi, theta = np.meshgrid((u - 0.5) * 2 * np.pi, v * np.pi)
    d = np.stack([np.sin(theta) * np.sin(phi), np.cos(theta), -np.sin(theta) * np.cos(phi)], axis=-1)
    lamps = [([0.5, 0.6, 0.6], 12, [3.0, 2.6, 2.2]), ([-0.8, 0.1, 0.6], 20, [0.4, 0.8, 1.6]), ([0.2, -0.9, 0.3], 6, [0.5, 0.3, 0.2])]
    radiance = 0.15 + 0.1 * d[..., 1:2] * np.ones(3)
    for towards, sharpness, color in lamps:
        towards = np.array(towards) / np.linalg.norm(towards)
        radiance = radiance + np.exp(sharpness * (d @ towards - 1.0))[..., None] * np.array(color)
    return radiance.astype(np.float32)
