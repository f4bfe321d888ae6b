"""Rows of `papers.py`: texels of baked tables, read from their files, against the functions that the papers put in them."""

import json
import math
import os
import struct
import subprocess
import tempfile

from papers import *
from places import picture

# VkFormat: channels, code of `struct`, and the number that stands for 1.
FORMATS = {37: (4, "B", 255), 76: (1, "e", 1), 97: (4, "e", 1)}


def run(*arguments, beside):
    """Runs the program in a folder of these files, and gives all files that are there then."""
    with tempfile.TemporaryDirectory() as folder:
        for name, content in beside.items():
            with open(os.path.join(folder, name), "wb") as file:
                file.write(content if isinstance(content, bytes) else content.encode())
        done = subprocess.run([PROGRAM, *arguments], capture_output=True, text=True, cwd=folder)
        if done.returncode != 0:
            sys.exit(f"{done.stderr}{' '.join(arguments)}")
        found = {}
        for place, _, names in os.walk(folder):
            for name in names:
                path = os.path.join(place, name)
                with open(path, "rb") as file:
                    found[os.path.relpath(path, folder)] = file.read()
        return found


def texels(data):
    """Width, height, bytes and texels, as tuples of channels, of a KTX2 file without compression."""
    form, _, width, height = struct.unpack("<4I", data[12:28])
    offset, length = struct.unpack("<2Q", data[80:96])
    channels, code, one = FORMATS[form]
    numbers = [x / one for x in struct.unpack(f"<{width * height * channels}{code}", data[offset : offset + length])]
    return width, height, length, [tuple(numbers[k : k + channels]) for k in range(0, len(numbers), channels)]


def baked(text, kind, beside=None):
    files = {"m.toml": f'schema = 1\nname = "m"\n{text}', **(beside or {})}
    made = run("bake", "m.toml", "--form", "baked", "--target", "wgsl", "--no-zstd", "--no-cache", "--out", "out", beside=files)
    [table] = [t for t in json.loads(made["out/manifest.json"])["tables"] if t["kind"] == kind]
    return texels(made[os.path.join("out", table["texture"]["path"])])


def compared(paper, element, where, pairs, allowed):
    """A row whose differences are relative to its largest value."""
    largest = max(abs(a) for a, _ in pairs)
    ROWS.append((paper, element, where, pairs[0][0], max(abs(a - b) for a, b in pairs) / largest, allowed))


# Half of a step of 1/255, and half a unit in the last place of a half float from 1 to 2.
BYTE, HALF = 0.5 / 255 * 1.05, 2**-11


def reflectance_rows():
    for paper, element, where, size, form, length, allowed in [
        (ELEK, "table of F, 128 texels of bytes", "section 3.1", 128, "rgba8unorm", 128 * 4, BYTE),
        (COURSE, "table of F, 1,024 texels of half floats", "section 3.4.1", 1024, "rgba16float", 1024 * 8, HALF),
    ]:
        settings = f'[bake]\nmodel = "elek"\ncolor = "three-wavelengths"\nfresnel = {{ size = {size}, mapping = "cosine", format = "{form}" }}\n'
        width, height, found, row_of = baked(metal("alpha = 0.3\n") + settings, "fresnel")
        assert (width, height, found) == (size, 1, length)
        compared(paper, element, where, [(fresnel(METAL, max(i / (size - 1), 1e-9)), t[1]) for i, t in enumerate(row_of)], allowed)


def distribution_table():
    """The size and the format of section 3.1, 0.5 MB: theta is a quarter turn times u^8, and the slopes are logarithmic from 0.001 to 1."""
    settings = '[bake]\nmodel = "elek"\ndistribution = { size = [512, 512], mapping = "power", exponent = 8, format = "r16float" }\n'
    width, height, found, table = baked(metal('alpha = 0.3\ndistribution = "beckmann"\n') + settings, "distribution")
    assert (width, height, found) == (512, 512, 512 * 1024)
    pairs = []
    for row_at in range(0, 512, 7):
        alpha = 0.001 * 1000 ** (row_at / 511)
        for column in range(0, 504, 3):
            theta = PI / 2 * (column / 511) ** 8
            expected = PI * alpha * alpha * beckmann(alpha)((math.sin(theta), 0, math.cos(theta)))
            pairs.append((expected, table[row_at * 512 + column][0]))
    # Texels are moved by a part of what a linear read errs between them.
    compared(ELEK, "table of D over u^8, 512 x 512 half floats", "section 3.1; figure 4", pairs, 2 * HALF)


def film_tables():
    # A wave along both directions, 64 texels wide.
    heights = lambda x, y: round(127 + 90 * math.sin(2 * PI * (x % 64) / 64) + 30 * math.cos(4 * PI * (y % 64) / 64))
    text = '[[layer]]\ntype = "thin-film"\nior = 1.4\nthickness_nm = { min = 250, max = 350, extent_um = 3, map = "heights.png" }\n' + metal("alpha = 0.2\n")
    text += '[bake]\nmodel = "granier-heidrich"\ncolor = "three-wavelengths"\nphase = { size = 256, format = "rgba16float" }\n'
    text += 'thickness = { size = 64, format = "rgba16float" }\n'
    beside = {"heights.png": picture(64, 64, lambda x, y: (heights(x, y),), 1)}
    _, _, _, row_of = baked(text, "phase", beside)
    pairs = [(2 * math.cos(2 * PI * 2 * 350 * 1.4 / nm * i / 255), t[c]) for i, t in enumerate(row_of) for c, nm in enumerate((645, 525, 445))]
    compared(GRANIER, "table of the phase", "section 6, eq. 19", pairs, HALF)

    # Node i lies at i / 64 of the width: between the texels i - 1 and i of the picture. One texel around repeats the other side.
    width, _, _, table = baked(text, "thickness", beside)
    assert width == 66
    by_channel = [[] for _ in range(4)]
    for j in range(64):
        for i in range(64):
            at = [[250 + 100 * heights(x, y) / 255 for x in (i - 1, i)] for y in (j - 1, j)]
            d = sum(map(sum, at)) / 4
            x = ((at[0][1] - at[0][0]) + (at[1][1] - at[1][0])) / 2 / (3000 / 64)
            y = ((at[1][0] - at[0][0]) + (at[1][1] - at[0][1])) / 2 / (3000 / 64)
            expected = (d / (2 * 350), x, y, math.sqrt(1 + x * x + y * y))
            for pairs, a, b in zip(by_channel, expected, table[(j + 1) * width + i + 1]):
                pairs.append((a, b))
    # Thickness, both slopes, and normalisation, each relative to its own largest value.
    scaled = []
    for pairs in by_channel:
        largest = max(abs(a) for a, _ in pairs)
        scaled += [(a / largest, b / largest) for a, b in pairs]
    compared(GRANIER, "table of the film", "section 6", scaled, 2 * HALF)


def all_materials():
    """The course's table over the angle, n and k, at the nodes of every third of its axes."""
    made = run("table", "fresnel", "--no-zstd", "--no-cache", "-o", "f.ktx2", beside={})
    width, height, length, table = texels(made["f.ktx2"])
    assert width * height == 128 * 32 * 32
    pairs = []
    for slice_at in range(0, 32, 3):
        for row_at in range(0, 32, 3):
            n = complex(0.05 + 4.95 * row_at / 31, 10 * slice_at / 31)
            for column in range(1, 128, 3):
                expected = fresnel(n, column / 127) if abs(n - 1) > 1e-9 else 0.0
                pairs.append((expected, table[(slice_at * 32 + row_at) * width + column][0]))
    compared(COURSE, "table over the angle, n and k", "section 3.4.1", pairs, HALF)


def compare():
    reflectance_rows()
    distribution_table()
    film_tables()
    all_materials()
