#!/usr/bin/env python3
"""Tests of the library for MaterialX, in MaterialX 1.39.5: test_library.py OUT, in an X display (xvfb-run). Pictures are left in OUT.

- Balls under one directional light, by MaterialX' renderer, against `luthier preview`; three have maps of colours and slopes, one has normal maps.
- A ball in even light from all around.
- A program that turns images sees the same as one that does not.
- Shaders of all targets: glslang compiles GLSL, ESSL, Vulkan and the GLSL for WGSL, slangc compiles Slang; Metal is read for what it does not have.
- Wrong bakes are refused.

The environment variable LUTHIER names the program that bakes; by default cargo builds it. SLANGC names the compiler of Slang. Needs glslangValidator, a Vulkan
driver for `luthier preview`, and an OpenGL driver for MaterialX.
"""

import math
import os
import pathlib
import re
import shutil
import subprocess
import sys
import zlib

import host
import tables

sys.path.append(str(pathlib.Path(__file__).resolve().parent.parent / "c"))
from difference import read  # noqa: E402

HERE = pathlib.Path(__file__).resolve().parent
ROOT = HERE.parent.parent
CARGO = ["cargo", "run", "--locked", "--quiet", "-p", "luthier-cli", "--bin", "luthier", "--"]
LUTHIER = [os.environ["LUTHIER"]] if os.environ.get("LUTHIER") else CARGO
BAKED = ["--target", "wgsl,glsl-es300", "--form", "baked", "--no-zstd", "--quiet", "--functions"]
SIZE = 256
LAMP = (1.75, 1.7, 1.62)
# The lamp of `preview` has a size.
SLOPE_VARIANCE = 0.05**2 / 8
PREVIEW = ["--shape", "sphere", "--size", str(SIZE), "--samples", "1", "--tone", "none", "--light-color", ",".join(map(str, LAMP)), "--background"]
failures = []


def check(holds, words):
    print(f"{'holds' if holds else 'FAILS'}: {words}", flush=True)
    if not holds:
        failures.append(words)


def luthier(*arguments):
    subprocess.run([*LUTHIER, *map(str, arguments)], cwd=ROOT, check=True)


def library(bake, out):
    """Makes the library of a bake; what the program said where it refused."""
    made = subprocess.run([sys.executable, HERE / "luthier_mtlx.py", bake, "-o", out], capture_output=True, text=True)
    return made.stderr if made.returncode else ""


def encoded(value):
    """A channel of 8 bits, by the curve of sRGB."""
    value = min(max(value, 0.0), 1.0)
    return int(255 * (12.92 * value if value <= 0.0031308 else 1.055 * value ** (1 / 2.4) - 0.055) + 0.5)


def write(path, pixels):
    """A picture of linear radiance as PNG; its RGB bytes."""
    rgb = [bytes(channel for pixel in row for channel in map(encoded, pixel or (0, 0, 0))) for row in pixels]
    rows = b"".join(b"\0" + b"".join(row[i : i + 3] + b"\xff" for i in range(0, len(row), 3)) for row in rgb)
    path.write_bytes(tables.png(len(pixels), len(pixels), rows))
    return b"".join(rgb)


def difference(left, right, shown=lambda p, q: any(p) or any(q)):
    """Median, 95 %, 99 % and the largest of the differences of pixels, each by its channel that is farthest, and their number."""
    pairs = ((left[i : i + 3], right[i : i + 3]) for i in range(0, len(left), 3))
    apart = sorted(max(abs(x - y) for x, y in zip(p, q)) for p, q in pairs if shown(p, q))
    return [*(apart[min(int(share * len(apart)), len(apart) - 1)] for share in (0.5, 0.95, 0.99)), apart[-1], len(apart)]


def compare(words, expected, found, shown=None):
    median, p95, p99, most, pixels = difference(expected, found, *([shown] if shown else []))
    # A texture that is misread makes 5 or more in the 95 %.
    check(median <= 2 and p95 <= 3, f"{words}: median {median} of 255, 95 % within {p95}, 99 % within {p99}, largest {most}, {pixels} pixels")


def even(path, byte):
    """A map of two texels of one radiance: 0, or one half where the byte is 128."""
    path.write_bytes(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y 1 +X 2\n" + bytes([byte] * 8))
    return path


def waves(out):
    """A material file with a normal map of the surface, and one of a layer."""
    slope = lambda at, most: round(127.5 + 127.5 * most * math.sin(2 * math.pi * (at + 0.5) / 64))
    rows = b"".join(b"\0" + b"".join(bytes([slope(x, 0.3), slope(y, 0.2), 240, 255]) for x in range(64)) for y in range(64))
    (out / "waves.png").write_bytes(tables.png(64, 64, rows))
    path = out / "waves.toml"
    path.write_text(
        'schema = 1\nname = "waves"\n[[layer]]\ntype = "dielectric"\nior = 1.5\nroughness = 0.4\nmaps = { normal = "waves.png" }\n'
        '[[layer]]\ntype = "conductor"\nior = "au"\nalpha = 0.25\nmaps = { bumps = "waves.png" }\n'
    )
    return path


def balls(out, bakes):
    renderer = host.Renderer(SIZE, out)
    dark = ["--light", "0.5,0.7,0.6", "--environment", even(out / "black.hdr", 0), "--environment-samples", "1"]
    cases = [("polished-gold", "plain"), ("red-lacquer", "plain"), ("granier-film", "film"), ("worn-brass", "board"), ("celadon-tile", "board"), ("varnished-oak", "board"), ("waves", "waves")]
    for material, bake in cases:
        name = material.replace("-", "_")
        scene = host.Host(bakes[bake])
        scene.add_light((0.5, 0.7, 0.6), LAMP)
        scene.document.getNode(f"{name}_bsdf").setInputValue("slope_variance", SLOPE_VARIANCE)
        found = write(out / f"{material}.png", renderer.draw(scene, name))
        luthier("preview", material, "--out", out / bake, "-o", out / f"{material}-preview.png", *PREVIEW, *dark)
        compare(f"{material} by MaterialX against preview", read(out / f"{material}-preview.png")[1], found)

    # Images that a program turns upside down: the library's is turned by hand, and the generator is told.
    turned = out / "turned-library"
    shutil.copytree(bakes["plain"], turned, dirs_exist_ok=True)
    image = turned / "luthier_tables.png"
    image.write_bytes(upside_down(image.read_bytes()))
    scene = host.Host(turned)
    scene.add_light((0.5, 0.7, 0.6), LAMP)
    scene.document.getNode("polished_gold_bsdf").setInputValue("slope_variance", SLOPE_VARIANCE)
    pixels = write(out / "turned-gold.png", renderer.draw(scene, "polished_gold", turned=False))
    compare("polished-gold with images that are turned by MaterialX against preview", read(out / "polished-gold-preview.png")[1], pixels)

    # Behind the ball there is the environment in one, and nothing in the other.
    grey = even(out / "grey.hdr", 128)
    pixels = write(out / "even-lacquer.png", renderer.draw(host.Host(bakes["sampled"]), "red_lacquer", environment=(grey, 64)))
    luthier("preview", "red-lacquer", "--out", out / "sampled", "-o", out / "even-lacquer-preview.png", *PREVIEW, "--environment", grey)
    compare("red-lacquer in even light by MaterialX against preview", read(out / "even-lacquer-preview.png")[1], pixels, lambda p, q: any(q))


def upside_down(png):
    """The PNG of a library, which has one chunk of data and no filters, with its last row first."""
    width, height = int.from_bytes(png[16:20], "big"), int.from_bytes(png[20:24], "big")
    at = png.index(b"IDAT")
    rows = zlib.decompress(png[at + 4 : at + 4 + int.from_bytes(png[at - 4 : at], "big")])
    stride = 4 * width + 1
    return tables.png(width, height, b"".join(rows[i : i + stride] for i in reversed(range(0, len(rows), stride))))


def targets(out, bakes):
    compilers = {
        "GLSL": ["glslangValidator", "-S", "frag"], "ESSL": ["glslangValidator", "-S", "frag"], "Vulkan": ["glslangValidator", "-V", "-o", out / "a.spv", "-S", "frag"],
        "WGSL": ["glslangValidator", "-V", "-o", out / "a.spv", "-S", "frag"],
    }
    if os.environ.get("SLANGC"):
        compilers["Slang"] = [os.environ["SLANGC"], "-target", "metal", "-stage", "fragment", "-entry", "fragmentMain", "-o", out / "a.metal"]
    materials = [("plain", "red_lacquer"), ("film", "granier_film"), ("board", "worn_brass"), ("waves", "waves"), ("sampled", "red_lacquer"), ("plain", "mixed")]
    failed = {target: [] for target in host.GENERATORS}
    for bake, material in materials:
        scene = host.Host(bakes[bake])
        scene.add_light((0.5, 0.7, 0.6), LAMP)
        if material == "mixed":
            mix(scene)
        for target in host.GENERATORS:
            path = out / f"{bake}-{material}-{target.lower()}.{'slang' if target == 'Slang' else 'frag'}"
            path.write_text(scene.text(material, target))
            if target in compilers:
                ran = subprocess.run([*compilers[target], path], capture_output=True, text=True)
                failed[target] += [f"{material}: {ran.stdout}{ran.stderr}"] if ran.returncode else []
            else:
                failed[target] += foreign(path.read_text(), material)
    for target in host.GENERATORS:
        by = pathlib.Path(compilers[target][0]).name if target in compilers else "a search for names of other languages"
        check(not failed[target], f"{len(materials)} shaders of {target} by {by}" + "".join(f"\n{text}" for text in failed[target]))


def mix(scene):
    """A material of two nodes of luthier and one of MaterialX."""
    document = scene.document
    metal = document.addNode("conductor_bsdf", "standard_bsdf", "BSDF")
    inner, outer = document.addNode("mix", "inner_mix", "BSDF"), document.addNode("mix", "outer_mix", "BSDF")
    for node, front, back in ((inner, "polished_gold_bsdf", "red_lacquer_bsdf"), (outer, "inner_mix", metal.getName())):
        node.addInput("fg", "BSDF").setNodeName(front)
        node.addInput("bg", "BSDF").setNodeName(back)
        node.setInputValue("mix", 0.5)
    surface = document.addNode("surface", "mixed_surface", "surfaceshader")
    surface.addInput("bsdf", "BSDF").setNodeName(outer.getName())
    document.addMaterialNode("mixed", surface)


def foreign(text, material):
    """Words of GLSL in a text of Metal or Slang, outside of macros that are for GLSL."""
    code = re.sub(r"//.*", "", text)
    return [f"{material} has {word}" for word in sorted(set(re.findall(r"\b(?:[iub]?vec[234]|mat[234]|sampler2D|inversesqrt|floatBitsToUint|inout|gl_\w+(?<!gl_FragCoord))\b|\$\w+", code)))]


def refusals(out):
    bake = out / "refused"
    bad = lambda: library(bake, out / "refused-library").strip()

    def refused(why, word, *arguments, change=None):
        shutil.rmtree(bake, ignore_errors=True)
        luthier("bake", "materials/polished-gold.toml", "--no-fit", "--form", "baked", "--quiet", "--out", bake, *arguments)
        if change:
            change()
        said = bad()
        one = said.startswith("error: ") and len(said.splitlines()) == 1 and str(bake) in said
        check(one and word in said, f"{why} is refused: {said.replace(str(bake), 'BAKE')}")

    whole = ["--target", "glsl-es300", "--functions", "surface", "--no-zstd"]
    manifest = bake / "manifest.json"
    edit = lambda old, new: lambda: manifest.write_text(manifest.read_text().replace(old, new, 1))
    refused("a bake without the functions", "--functions surface", "--target", "glsl-es300", "--no-zstd")
    refused("a bake for another target", "--target glsl-es300", "--target", "wgsl", "--functions", "surface", "--no-zstd")
    refused("a compressed table", "--no-zstd", "--target", "glsl-es300", "--functions", "surface")
    refused("another schema", "schema 5", *whole, change=edit('"schema": 4', '"schema": 5'))
    refused("a manifest that is no JSON", "is no manifest", *whole, change=lambda: manifest.write_text(manifest.read_text()[1:]))
    refused("a table of another bake", "is not the file of this bake", *whole, change=lambda: (bake / "tables/fresnel.ktx2").write_bytes(b"no"))
    refused("a table that is missing", "No such file", *whole, change=lambda: (bake / "tables/fresnel.ktx2").unlink())


def main():
    if len(sys.argv) != 2:
        sys.exit(f"usage: {sys.argv[0]} OUT")
    out = pathlib.Path(sys.argv[1]).resolve()
    out.mkdir(parents=True, exist_ok=True)
    baked = {
        "plain": ["materials/polished-gold.toml", "materials/red-lacquer.toml", *BAKED, "surface"],
        "sampled": ["materials/red-lacquer.toml", *BAKED, "surface,sample"],
        "board": ["materials/textured", "--no-fit", *BAKED, "surface"],
        "waves": [waves(out), "--no-fit", *BAKED, "surface"],
        "film": ["materials/papers/granier-film.toml", *BAKED, "surface"],
    }
    bakes = {}
    for name, arguments in baked.items():
        luthier("bake", *arguments, "--out", out / name)
        bakes[name] = out / f"{name}-library"
        said = library(out / name, bakes[name])
        valid, words = host.Host(bakes[name]).document.validate() if not said else (False, said)
        check(valid, f"the library of {name} is valid: {words or 'by MaterialX'}")
    balls(out, bakes)
    targets(out, bakes)
    refusals(out)
    if failures:
        sys.exit(f"{len(failures)} failed:\n" + "\n".join(failures))


if __name__ == "__main__":
    main()
