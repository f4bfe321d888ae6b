#!/usr/bin/env python3
"""Counts the inner walls of the code, as JSON: python3 scripts/walls.py [FOLDER [LUTHIER]].

FOLDER is a checkout; that of the script by default. Counts of two checkouts compare two states of the code. LUTHIER is a built
command, whose bakes `strace` looks at.

models     files that name single reflectance models, and lines that do so, outside the crate with the facts and the project's own pages
marks      share of the lines of WGSL that are conditions (//?)
circles    knots of modules that use each other, by crate, from `crate::` paths; and the modules in them
probes     places where luthier-gpu looks for a word in the text of a shader
closures   named closures (`let name = |..|`) per 1,000 lines of code
lines      code lines of crates/*/src, WGSL included; tests, comments and blank lines excluded
reads      how often a bake opens a material file; with LUTHIER alone
"""

import json
import pathlib
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(sys.argv[1] if len(sys.argv) > 1 else pathlib.Path(__file__).parent.parent)
MODEL = re.compile(
    r'ShadingModel::(?:Elek|WeidlichWilkie|GranierHeidrich|Belcour|Yamaguchi|Phong|Microfacet|Lobes)\b'
    r'|"(?:elek|weidlich-wilkie|granier-heidrich|belcour|yamaguchi|phong|microfacet|lobes)"'
)
FACTS = ("luthier-model", "luthier-lab")


def is_test(path):
    is_named = path.name in ("tests.rs", "fixtures.rs") or path.stem.endswith("_tests") or path.stem.startswith("tests_")
    return is_named or "tests" in path.parts[path.parts.index("src"):]


def code(path):
    """Lines of code of a file: without tests, comments and blank lines."""
    text = path.read_text()
    if path.suffix == ".rs":
        if is_test(path):
            return []
        # Files of tests that a module declares are no test code of its own.
        text = re.split(r"#\[cfg\(test\)\]\nmod \w+ \{", text, maxsplit=1)[0]
    lines = (line.strip() for line in text.splitlines())
    return [line for line in lines if line and (line.startswith("//?") or not line.startswith("//"))]


def sources(crate, *endings):
    return sorted(p for p in (crate / "src").rglob("*") if p.suffix in endings)


def module(crate, path):
    """The room of a file: the first part of its path under src."""
    first = path.relative_to(crate / "src").parts[0]
    return first.removesuffix(".rs")


def paths(crate):
    """Which room uses which, from `crate::` paths; aliases at the root count as the room that they stand for."""
    files = [p for p in sources(crate, ".rs") if not is_test(p)]
    rooms = {module(crate, p) for p in files} - {"lib", "main"}
    root = crate / "src" / "lib.rs"
    root = root if root.exists() else crate / "src" / "main.rs"
    alias = {}
    if root.exists():
        uses = re.findall(r"use (?:self::|crate::)?(\w+)(?:::\w+)*::(?:\{([^}]*)\}|(\w+));", root.read_text())
        for room, many, one in uses:
            for name in re.findall(r"\w+", many or one):
                if room in rooms:
                    alias[name] = room
    edges = {room: set() for room in rooms}
    for path in files:
        room = module(crate, path)
        if room not in rooms:
            continue
        text = "\n".join(code(path))
        names = re.findall(r"\bcrate::(\w+)", text)
        for group in re.findall(r"\bcrate::\{((?:[^{}]|\{[^{}]*\})*)\}", text):
            names += re.findall(r"(?:^|,)\s*(\w+)", re.sub(r"\{[^{}]*\}", "", group))
        for name in names:
            target = name if name in rooms else alias.get(name)
            if target and target != room:
                edges[room].add(target)
    return edges


def knots(edges):
    """Strongly connected rooms, each knot sorted."""
    index, low, stack, found, count = {}, {}, [], [], [0]

    def visit(v):
        index[v] = low[v] = count[0]
        count[0] += 1
        stack.append(v)
        for w in sorted(edges[v]):
            if w not in index:
                visit(w)
                low[v] = min(low[v], low[w])
            elif w in stack:
                low[v] = min(low[v], index[w])
        if low[v] == index[v]:
            knot = []
            while True:
                w = stack.pop()
                knot.append(w)
                if w == v:
                    break
            if len(knot) > 1:
                found.append(sorted(knot))

    for v in sorted(edges):
        if v not in index:
            visit(v)
    return sorted(found)


def reads(luthier):
    """How often a bake opens its material file."""
    text = 'schema = 1\nname = "chalk"\n[[layer]]\ntype = "diffuse"\nalbedo = 0.8\n'
    with tempfile.TemporaryDirectory() as folder:
        material, log = pathlib.Path(folder, "chalk.toml"), pathlib.Path(folder, "log")
        material.write_text(text)
        bake = [luthier, "bake", material, "--out", pathlib.Path(folder, "out"), "--no-cache", "--quiet"]
        subprocess.run(["strace", "-f", "-e", "trace=open,openat", "-o", log, *bake], check=True)
        return sum('chalk.toml"' in line for line in log.read_text().splitlines())


def main():
    crates = sorted(p for p in (ROOT / "crates").iterdir() if (p / "src").is_dir())
    files = models = closures = lines = rust = wgsl = marks = probes = 0
    circles = {}
    for crate in crates:
        for path in sources(crate, ".rs", ".wgsl"):
            here = code(path)
            lines += len(here)
            if path.suffix == ".wgsl":
                wgsl += len(here)
                marks += sum(line.startswith("//?") for line in here)
                continue
            rust += len(here)
            closures += sum(bool(re.match(r"let (?:mut )?\w+(?:: [^=]*)? = (?:move )?\|", line)) for line in here)
            if crate.name not in FACTS:
                named = sum(bool(MODEL.search(line)) for line in here)
                models += named
                files += named > 0
            if crate.name == "luthier-gpu":
                probes += sum(bool(re.search(r'self\.has\(\"|wgsl\.contains\(', line)) for line in here)
        found = knots(paths(crate))
        if found:
            circles[crate.name] = found
    print(json.dumps({
        **({"reads": reads(sys.argv[2])} if len(sys.argv) > 2 else {}),
        "models": {"files": files, "lines": models},
        "marks": {"share": round(marks / max(wgsl, 1), 3), "marks": marks, "wgsl": wgsl},
        "circles": {"modules": sum(len(k) for all in circles.values() for k in all), "knots": circles},
        "probes": probes,
        "closures": {"count": closures, "per_1000": round(1000 * closures / max(rust, 1), 1)},
        "lines": lines,
    }, indent=2))


main()
