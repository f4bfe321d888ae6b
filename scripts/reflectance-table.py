#!/usr/bin/env python3
"""Errors of tables of reflectance over three axes, and of a row for each material, as a page in Markdown.

    python3 scripts/reflectance-table.py [PROGRAM] >docs/pages/reflectance-table.md
"""

import json
import math
import os
import re
import struct
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "target/release/luthier"
WAVELENGTHS = (680, 550, 440)
COSINES = [(i + 0.5) / 500 for i in range(500)]
LAYOUTS = (
    ("cos_theta,ior_n,ior_k", (128, 32, 32)),
    ("cos_theta^2,ior_n,ior_k", (128, 32, 32)),
    ("cos_theta,ior_n@log,ior_k^2", (128, 32, 32)),
    ("cos_theta^2,ior_n@log,ior_k^2", (32, 64, 64)),
    ("cos_theta^2,ior_n@log,ior_k^2", (64, 90, 90)),
)


def told(*arguments):
    done = subprocess.run([PROGRAM, *arguments, "--json"], capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{done.stderr}{' '.join(arguments)}")
    return json.loads(done.stdout)


def fresnel(cos, n, k):
    """Fresnel's equations in real numbers: a and b are those of the complex cosine in the material."""
    sin2 = 1 - cos * cos
    q = n * n - k * k - sin2
    root = math.sqrt(q * q + 4 * n * n * k * k)
    a2, a = (root + q) / 2, math.sqrt(max(0.0, (root + q) / 2))
    b2 = a2 - q
    s = (a2 + b2 - 2 * a * cos + cos * cos) / (a2 + b2 + 2 * a * cos + cos * cos)
    across = sin2 * sin2 / (cos * cos)
    p = s * (a2 + b2 - 2 * a * sin2 / cos + across) / (a2 + b2 + 2 * a * sin2 / cos + across)
    return (s + p) / 2


def at(values, position):
    """Neighbours on an axis of so many nodes, and the weight of the second."""
    low = min(int(position), values - 2)
    return low, position - low


class Table:
    def __init__(self, path, axes, size):
        with open(path, "rb") as file:
            data = file.read()
        self.texels, self.size = struct.unpack(f"<{len(data) // 2}e", data), size
        self.axes = [re.fullmatch(r"(\w+?)(?:\^(\d)|(@log))?", axis).groups() for axis in axes.split(",")]

    def read(self, cos, n, k):
        places = []
        for (name, power, log), size in zip(self.axes, self.size):
            low, high, value = {"cos_theta": (0, 1, cos), "ior_n": (0.05, 5, n), "ior_k": (0, 10, k)}[name]
            if log:
                part = math.log(value / low) / math.log(high / low)
            else:
                part = ((value - low) / (high - low)) ** (1 / int(power or 1))
            places.append(at(size, min(1.0, max(0.0, part)) * (size - 1)))
        total = 0.0
        for corner in range(8):
            weight, index = 1.0, 0
            for axis in (2, 1, 0):
                low, far = places[axis]
                up = corner >> axis & 1
                weight *= far if up else 1 - far
                index = index * self.size[axis] + low + up
            total += weight * self.texels[index]
        return total


def half(value):
    return struct.unpack("<e", struct.pack("<e", value))[0]


def row_error(n, k, size):
    row = [half(fresnel(max(1e-9, i / (size - 1)), n, k)) for i in range(size)]
    worst = 0.0
    for cos in COSINES:
        low, far = at(size, cos * (size - 1))
        worst = max(worst, abs(row[low] * (1 - far) + row[low + 1] * far - fresnel(cos, n, k)))
    return worst


def indices():
    """n and k of every built-in material that covers the wavelengths, none beyond the axes."""
    found = []
    for entry in told("ior"):
        samples = told("ior", entry["id"])["samples"]
        for wavelength in WAVELENGTHS:
            for a, b in zip(samples, samples[1:]):
                if a["wavelength_nm"] <= wavelength <= b["wavelength_nm"]:
                    t = (wavelength - a["wavelength_nm"]) / (b["wavelength_nm"] - a["wavelength_nm"])
                    n, k = (a[key] + (b[key] - a[key]) * t if a.get(key) is not None else 0.0 for key in ("n", "k"))
                    if 0.05 <= n <= 5 and k <= 10:
                        found.append((entry["id"], entry["class"], n, k))
                    break
    return found


def main():
    surfaces = indices()
    dielectrics = [s for s in surfaces if s[3] < 0.01]
    metals = [s for s in surfaces if s[3] >= 0.01]
    print("# One table of reflectance for all materials\n")
    print(
        "`scripts/reflectance-table.py` made this page. Weidlich and Wilkie 2009 (section 3.4.1) weigh two tables of Fresnel's reflectance: one over the angle, n and k for all materials, read"
        " once for each channel, or a row over the angle for each material, read once. luthier bakes the rows into its atlas; `luthier table fresnel` bakes the other. The columns"
        f" have largest errors of reads that are linear along each axis, over 500 cosines, of {len(dielectrics)} indices of dielectrics and {len(metals)} of metals: the sets of `luthier ior` at 680, 550 and 440 nm"
        " that lie on the axes (n 0.05 to 5, k 0 to 10). This script reads the texels by itself. *Any n, k* is what the command says: all n and k of the axes.\n"
    )
    print("| table | texels | bytes | dielectrics | metals | at | any n, k | root mean square |\n|---|---|--:|--:|--:|---|--:|--:|")
    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "f.bin")
        for axes, size in LAYOUTS:
            sides = "x".join(map(str, size))
            error = told("table", "fresnel", "--axes", axes, "--size", sides, "-o", path)["error"]
            table = Table(path, axes, size)
            worst = lambda kind: max((abs(table.read(cos, n, k) - fresnel(cos, n, k)), name) for name, _, n, k in kind for cos in COSINES)
            (glass, _), (metal, name) = worst(dielectrics), worst(metals)
            print(
                f"| `{axes}` | {sides} | {os.path.getsize(path)} | {glass:.4f} | {metal:.4f} | {name} | {error['max_abs_err']:.2f} | {error['rms_err']:.4f} |"
            )
    for size in (128, 1024):
        glass, metal = (max((row_error(n, k, size), name) for name, _, n, k in kind) for kind in (dielectrics, metals))
        print(f"| a row for each of {len({s[0] for s in surfaces})} materials, linear | {size} | {2 * 3 * size} each | {glass[0]:.4f} | {metal[0]:.4f} | {metal[1]} | - | - |")
    print(
        "\nThe first line is the layout that the authors propose. For real materials it is good: it errs by less than 0.005. A row of 128 texels needs a 340th of the bytes and errs"
        " no more. The table cannot hold all n and k: where n falls below 1 and k is small, the reflectance jumps to 1 at the critical angle, and no linear read follows a jump. The look-up"
        " that the command writes keeps the slices in a texture of two dimensions, and so reads twice for each channel: six reads where a row needs one."
    )


main()
