#!/usr/bin/env python3
"""Errors and costs of the maskings, reflectances and internal reflections that a material file may choose, as a page in Markdown.

    python3 scripts/choices.py [PROGRAM] >docs/pages/choices.md
"""

import json
import math
import os
import subprocess
import sys
import tempfile

PROGRAM = sys.argv[1] if len(sys.argv) > 1 else "target/release/luthier"
FLOOR = 0.1 / math.pi
ANGLES = (0, 40, 75, 85)
FAMILIES = ("gcn5", "rdna2", "rdna3")


def layer(kind, ior, alpha, more=""):
    return f'[[layer]]\ntype = "{kind}"\nior = {ior}\nalpha = {alpha}\n{more}'


def metal(name, alpha=0.25):
    return layer("conductor", f'"{name}"', alpha)


COAT = layer("dielectric", 1.5, 0.09, "thickness_um = 10\nabsorption_per_um = [0.01, 0.02, 0.05]\n")


def run(folder, layers, bake, *arguments):
    path = os.path.join(folder, "m.toml")
    with open(path, "w") as file:
        file.write(f'schema = 1\nname = "m"\n{layers}\n[bake]\n{bake}\n')
    command = [PROGRAM, arguments[0], path, *arguments[1:], "--json"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode != 0:
        sys.exit(f"{done.stderr}{' '.join(command)}")
    return json.loads(done.stdout)


def pairs():
    """Directions all over the hemisphere, and within 5 degrees of the mirrored one, up to 88 degrees."""
    part = lambda i, step: (i * step) % 1.0
    for i in range(1, 2001):
        theta, phi = 88 * part(i, 0.754877666), 360 * part(i, 0.569840291)
        u, v = part(i, 0.819172513), part(i, 0.671043606)
        if i % 2:
            yield theta, phi, 88 * u, 360 * v
        else:
            yield theta, phi, min(88, max(0, theta + 10 * (u - 0.5))), (phi + 180 + 10 * (v - 0.5)) % 360


def values(folder, layers, model, bake):
    bake = f'model = "{model}"\n{bake}'
    told = run(folder, layers, bake, "eval", "--model", model, "--directions", os.path.join(folder, "pairs.csv"))
    return [entry["value"] for entry in told["values"]]


def error(found, expected):
    apart = lambda a, b: max(abs(x - y) for x, y in zip(a, b)) / max(max(b), FLOOR)
    return max(apart(a, b) for a, b in zip(found, expected))


def bar(value, whole):
    return "#" * max(1, round(20 * min(1.0, value / whole)))


def main():
    with tempfile.TemporaryDirectory() as folder:
        with open(os.path.join(folder, "pairs.csv"), "w") as file:
            file.write("\n".join(",".join(map(str, pair)) for pair in pairs()))
        print("# Maskings, reflectances and internal reflections of files\n")
        print(
            "`scripts/choices.py` made this page. [materials.md](../materials.md#parts-of-facet-models) says what the choices are. An error is the largest difference of"
            " f cos theta_i to the default, over 2,000 pairs of directions up to 88 degrees, half of them within 5 degrees of the mirrored one; it is relative to the brightest"
            " channel, or to 0.1/pi where that is larger. Both values are those of `luthier eval --directions`, in spectral colour; those of `exact` are at three wavelengths, so"
            " that their error is one of colour.\n"
        )
        print("## Reflectances\n\nErrors against `table`, in the model `elek`:\n")
        print("| material | `exact` | `approximate` | `lazanyi` |\n|---|--:|--:|--:|")
        stacks = [("copper", metal("cu")), ("gold", metal("au")), ("aluminium", metal("al")), ("glass", COAT), ("a coat over copper", COAT + metal("cu"))]
        for name, layers in stacks:
            expected = values(folder, layers, "elek", "")
            found = [error(values(folder, layers, "elek", f'reflectance = "{choice}"'), expected) for choice in ("exact", "approximate", "lazanyi")]
            print(f"| {name} | {' | '.join(f'{value:.3f}' for value in found)} |")
        print(
            "\nGlass reflects less than a tenth of the light up to 60 degrees, so that a reflectance that is off by 0.02 is off by a fifth. Cycles of inverse throughput of `luthier cost"
            " FILE --model elek --fresnel CHOICE` for the coat over copper, D in closed form; *reads* are look-ups in tables:\n"
        )
        print(f"| reflectance | form | {' | '.join(FAMILIES)} | reads | {FAMILIES[1]} as a bar |\n|---|---|{'--:|' * len(FAMILIES)}--:|---|")
        rows = []
        for choice in ("table", "exact", "approximate", "lazanyi"):
            arguments = [word for family in FAMILIES for word in ("--family", family)]
            told = run(folder, COAT + metal("cu"), 'model = "elek"', "cost", "--model", "elek", "--fresnel", choice, "--closed", *arguments)
            for form in ("baked", "full"):
                counts = {
                    row["family"]: row for row in told["rows"] if row["form"] == form and not row["constant"] and (row["closed"] or form == "full")
                }
                rows.append((choice, form, [counts[family]["inverse_throughput"] for family in FAMILIES], counts[FAMILIES[1]]))
        most = max(cycles[1] for _, _, cycles, _ in rows)
        for choice, form, cycles, counts in rows:
            print(f"| `{choice}` | {form} | {' | '.join(map(str, cycles))} | {counts['texture_reads']} | `{bar(cycles[1], most)}` |")
        print("\n## Maskings\n\nErrors against `smith`, of copper in the model `microfacet`, by alpha. They are largest at grazing angles:\n")
        choices = ("smith-separable", "schlick-smith", "v-cavity", "kelemen", "implicit")
        print(f"| alpha | {' | '.join(f'`{choice}`' for choice in choices)} |\n|--:|{'--:|' * len(choices)}")
        for alpha in (0.1, 0.25, 0.5):
            layers = metal("cu", alpha)
            expected = values(folder, layers, "microfacet", "")
            found = [error(values(folder, layers, "microfacet", f'masking = "{choice}"'), expected) for choice in choices]
            print(f"| {alpha} | {' | '.join(f'{value:.2f}' for value in found)} |")
        print(
            "\nShares of the light from everywhere that a mirror of alpha 0.5 returns to an eye at an angle, by `luthier eval FILE --model microfacet --furnace --angles"
            f" {','.join(map(str, ANGLES))}`. What is missing is light that facets would scatter again:\n"
        )
        print(f"| masking | {' | '.join(f'{angle} degrees' for angle in ANGLES)} | at {ANGLES[-1]} as a bar |\n|---|{'--:|' * len(ANGLES)}---|")
        for choice in ("smith", *choices):
            bake = f'model = "microfacet"\nmasking = "{choice}"'
            told = run(folder, metal("cu", 0.5), bake, "eval", "--model", "microfacet", "--furnace", "--angles", ",".join(map(str, ANGLES)))
            shares = [entry["radiance"] for entry in told["furnace"]]
            print(f"| `{choice}` | {' | '.join(f'{share:.3f}' for share in shares)} | `{bar(shares[-1], 1)}` |")
        inside(folder)


def inside(folder):
    """Light with and without the term of internal reflection."""
    print(
        "\n## Internal reflections\n\nErrors of `none` against `facets`, in the model `elek`, of a clear coat of alpha 0.1 over copper of alpha 0.25; and shares of the light from everywhere"
        " that the coat over a mirror of alpha 0.1 returns, by `luthier eval FILE --model elek --furnace --angles 0,45,75`. Both are too bright, because the model lacks 1 / n^2:\n"
    )
    print("| index of the coat | error | `facets` at 0, 45, 75 degrees | `none` | `none` at 0 as a bar |\n|--:|--:|---|---|---|")
    for index in (1.1, 1.3, 1.5, 2.0, 2.5):
        coat = layer("dielectric", index, 0.1)
        choices = [f'internal_reflection = "{choice}"' for choice in ("facets", "none")]
        expected, found = (values(folder, coat + metal("cu"), "elek", choice) for choice in choices)
        shares = []
        for choice in choices:
            told = run(folder, coat + metal("cu", 0.1), f'model = "elek"\n{choice}', "eval", "--model", "elek", "--furnace", "--angles", "0,45,75")
            shares.append([entry["radiance"] for entry in told["furnace"]])
        row = " | ".join(", ".join(f"{share:.3f}" for share in choice) for choice in shares)
        print(f"| {index} | {error(found, expected):.3f} | {row} | `{bar(shares[1][0], 4.5)}` |")


main()
