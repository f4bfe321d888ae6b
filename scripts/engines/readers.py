"""Reads the files of `luthier table` with programs of others, and compares values with a quadrature of its own.

    python3 scripts/engines/readers.py LUTHIER

Needs the packages OpenImageIO and numpy, and a C compiler. OpenImageIO reads PNG and EXR, the compiler reads C arrays, numpy reads raw texels; three.js,
Babylon.js and Bevy read theirs in furnace.sh and engines-bevy. Prints a row for each file; exits with 1 where a value is off.
"""

import ctypes
import math
import os
import subprocess
import sys
import tempfile

import numpy as np
import OpenImageIO as oiio

luthier = os.path.abspath(sys.argv[1])
os.chdir(tempfile.mkdtemp())


def run(*words):
    subprocess.run(words, check=True, stdout=subprocess.DEVNULL)


def facets(alpha, cos, masking, n=1500):
    """Weights of GGX facets as seen from a direction (Heitz 2018), and the cosines at them: a grid over the visible normals."""
    u = (np.arange(n) + 0.5) / n
    u1, u2 = np.meshgrid(u, u)
    v = np.array([math.sqrt(1 - cos * cos), 0.0, cos])
    vh = np.array([alpha * v[0], 0.0, v[2]])
    vh /= np.linalg.norm(vh)
    t1 = np.array([0.0, 1.0, 0.0])
    t2 = np.cross(vh, t1)
    r, phi = np.sqrt(u1), 2 * np.pi * u2
    a, b = r * np.cos(phi), r * np.sin(phi)
    s = 0.5 * (1 + vh[2])
    b = (1 - s) * np.sqrt(1 - a * a) + s * b
    c = np.sqrt(np.maximum(0, 1 - a * a - b * b))
    h = a[..., None] * t1 + b[..., None] * t2 + c[..., None] * vh
    h[..., :2] *= alpha
    h[..., 2] = np.maximum(h[..., 2], 1e-12)
    h /= np.linalg.norm(h, axis=-1, keepdims=True)
    cos_d = h @ v
    cos_o = 2 * cos_d * h[..., 2] - cos
    lam = lambda c: 0.5 * (np.sqrt(1 + alpha * alpha * (1 / (c * c) - 1)) - 1)
    low = np.maximum(cos_o, 1e-9)
    k = 0.5 * alpha
    g1 = lambda c: c / (c * (1 - k) + k)
    g2 = {
        "correlated": (1 + lam(cos)) / (1 + lam(cos) + lam(low)),
        "separable": 1 / (1 + lam(low)),
        "schlick-half": g1(cos) * g1(low) * (1 + lam(cos)),
        "joint-approx": 2 * cos * low / (low * (cos * (1 - alpha) + alpha) + cos * (low * (1 - alpha) + alpha)) * (1 + lam(cos)),
    }[masking]
    return np.where(cos_o > 0, g2, 0.0), cos_d


def split_sum(alpha, cos, masking="correlated"):
    weight, cos_d = facets(alpha, cos, masking)
    bias = float(np.mean(weight * (1 - cos_d) ** 5))
    albedo = float(np.mean(weight))
    return {"scale": albedo - bias, "bias": bias, "albedo": albedo, "loss": 1 - albedo, "one": 1.0}


failed = False
print("| file | read by | texels | values compared | largest difference |\n|---|---|---|--:|--:|")


def judge(name, reader, image, channels, place, limit, masking="correlated"):
    """Values in the middle of a table, away from its borders, against the quadrature."""
    global failed
    height, width = image.shape[:2]
    worst, count = 0.0, 0
    for y in (height // 3, 2 * height // 3):
        for x in (width // 3, 2 * width // 3):
            cos, alpha = place((x, y), (width, height))
            expected = split_sum(alpha, cos, masking)
            for c, value in enumerate(channels):
                if value in expected:
                    worst = max(worst, abs(float(image[y, x, c]) - expected[value]))
                    count += 1
    failed |= not worst <= limit
    print(f"| {name} | {reader} | {width} x {height} x {image.shape[2]} | {count} | {worst:.1e} |")


centre = lambda i, n: (i + 0.5) / n
across = lambda t, n: (centre(t[0], n[0]), centre(t[1], n[1]) ** 2)
falling = lambda t, n: (centre(t[0], n[0]), (1 - centre(t[1], n[1])) ** 2)
ends = lambda t, n: ((t[0] / (n[0] - 1)) ** 2, (1 - t[1] / (n[1] - 1)) ** 2)
# What texels are moved by, so that reads between them err less, and rounding.
MOVED, BYTES = 1e-3, 5e-3


def pixels(file):
    return oiio.ImageBuf(file).get_pixels(oiio.FLOAT)


def table(preset, file, *more):
    run(luthier, "table", "dfg", "--preset", preset, "-o", file, *more)


reader = "OpenImageIO " + oiio.VERSION_STRING
table("gltf", "lut.png", "--size", "256x256")
judge("gltf, PNG", reader, pixels("lut.png"), ["scale", "bias"], across, BYTES)
table("babylon", "brdf.png")
found = oiio.ImageInput.open("brdf.png")
raw = found.read_image("uint8").astype(float) / 255
judge("babylon, PNG of RGBD", reader, raw[..., :3] ** 2.2 / raw[..., 3:], ["bias", "albedo"], across, BYTES)
table("hdrp", "fgd.exr")
judge("hdrp, EXR", reader, pixels("fgd.exr"), ["bias", "albedo", "disney", "one"], ends, 2 * MOVED)
for preset, file, shape, dtype, channels, place, masking in [
    ("filament", "dfg.bin", (128, 128, 3), "<f2", ["bias", "albedo", "cloth"], across, "correlated"),
    ("godot", "godot.bin", (128, 128, 4), "<f2", ["bias", "albedo", "cloth", "one"], falling, "schlick-half"),
    ("unreal", "gf.bin", (32, 128, 2), "<u2", ["scale", "bias"], across, "joint-approx"),
]:
    table(preset, file)
    values = np.fromfile(file, dtype).reshape(shape).astype(float) / (65535 if dtype == "<u2" else 1)
    judge(f"{preset}, raw", f"numpy {np.__version__}", values, channels, place, MOVED, masking)

# Cycles: the compiler reads the arrays; E of a metal against the quadrature.
run(luthier, "table", "energy", "--preset", "cycles", "-o", "cycles")
files = sorted(os.listdir("cycles"))
with open("cycles.c", "w") as out:
    for name in files:
        out.write(f'#include "cycles/{name}"\n')
        array = name.split(".")[0]
        out.write(f"const float *get_{array}(void) {{ return table_{array}; }}\n")
        out.write(f"int size_{array}(void) {{ return sizeof table_{array} / sizeof *table_{array}; }}\n")
run("cc", "-Wall", "-Werror", "-shared", "-fPIC", "-o", "cycles.so", "cycles.c")
library = ctypes.CDLL("./cycles.so")
sizes = [getattr(library, "size_" + name.split(".")[0])() for name in files]
get = library.get_ggx_E
get.restype = ctypes.POINTER(ctypes.c_float * 1024)
metal = np.array(get().contents).reshape(32, 32, 1)
judge(f"cycles, {len(files)} C arrays of {', '.join(map(str, sizes))} floats; ggx_E", "cc", metal, ["albedo"],
      lambda t, n: (t[1] / (n[1] - 1), (t[0] / (n[0] - 1)) ** 2), 2e-5)

# OpenPBR: the compiler includes the words; what a metal loses, whose masking is separable and whose least cosine is .001.
run(luthier, "table", "energy", "--preset", "openpbr", "-o", "openpbr")
files = sorted(os.listdir("openpbr"))
with open("openpbr.c", "w") as out:
    for name in files:
        array = name.removesuffix(".h")
        out.write(f'static const unsigned short table_{array}[] = {{\n#include "openpbr/{name}"\n}};\n')
        out.write(f"const unsigned short *get_{array}(void) {{ return table_{array}; }}\n")
        out.write(f"int size_{array}(void) {{ return sizeof table_{array} / 2; }}\n")
run("cc", "-Wall", "-Werror", "-shared", "-fPIC", "-o", "openpbr.so", "openpbr.c")
library = ctypes.CDLL("./openpbr.so")
sizes = [getattr(library, "size_" + name.removesuffix(".h"))() for name in files]
get = library.get_openpbr_ideal_metal_energy_complement_data
get.restype = ctypes.POINTER(ctypes.c_ushort * 1024)
metal = np.array(get().contents).reshape(32, 32, 1) / 65535
along = lambda t, n: (t[0] / (n[0] - 1), (t[1] / (n[1] - 1)) ** 2)
judge(f"openpbr, {len(files)} C arrays of {', '.join(map(str, sizes))} words; ideal_metal", "cc", metal, ["loss"], along, 3e-5, "separable")

# OSPRay: raw floats.
run(luthier, "table", "energy", "--preset", "ospray", "-o", "ospray")
metal = np.fromfile("ospray/albedo_dir.bin", "<f4").reshape(32, 32, 1)
judge(f"ospray, {len(os.listdir('ospray'))} files; albedo_dir", f"numpy {np.__version__}", metal, ["albedo"], along, 2e-5)
sys.exit(failed)
