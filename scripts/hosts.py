"""The page of pictures that hosts draw, beside those of `luthier preview`: hosts.py SHEET LOG... prints it, and writes some of the pictures into SHEET, a PNG file.

A log is what the test of a host printed; its name is the host's. Lines that compare a picture are
`holds: PICTURE by RENDERER against preview: median M of 255, 95 % within P, 99 % within Q, largest L, N pixels`, the 95 % left out in some.
"""

import re
import sys
from pathlib import Path

ROOT = Path(__file__).parent.parent
sys.path += [str(ROOT / "examples/c"), str(ROOT / "examples/materialx")]
from difference import read
from tables import png

LINE = re.compile(
    r"(?P<holds>holds|FAILS): (?P<picture>.+?) by (?P<by>.+?) against preview: median (?P<median>[\d.]+) of 255(, 95 % within (?P<p95>[\d.]+))?"
    r", 99 % within (?P<p99>[\d.]+), largest (?P<most>[\d.]+), (?P<pixels>\d+) pixels"
)
NAMES = {"three": "three.js", "babylon": "Babylon.js", "playcanvas": "PlayCanvas", "bevy": "Bevy", "godot": "Godot", "materialx": "MaterialX", "c": "C", "web": "two bakes in one program"}

# Pictures of one material, worn brass with four maps, 256 x 256, by folders of target/; beside each NAME-HOW.png is NAME-preview.png.
SHOWN = [
    ("three.js, WebGL 2", "three/brass-webgl"),
    ("three.js, WebGPU", "three/brass-webgpu"),
    ("Babylon.js, WebGL 2", "babylon/brass-webgl"),
    ("Babylon.js, WebGPU", "babylon/brass-webgpu"),
    ("PlayCanvas, WebGL 2", "playcanvas/brass-webgl2"),
    ("PlayCanvas, WebGPU", "playcanvas/brass-webgpu"),
    ("Bevy", "bevy/brass"),
    ("Godot 4 Forward+", "godot/brass-forward"),
    ("Godot 4 Mobile", "godot/brass-mobile"),
    ("Godot 4 Compatibility", "godot/brass-compatibility"),
    ("Godot 3.6", "godot/brass-godot3"),
    ("MaterialX", "materialx/worn-brass"),
]
# A difference of 1/255 is so many grey levels in the sheet.
FACTOR = 16


def halved(path):
    """Texels of a picture of half the side."""
    side, rgb = read(path)
    at = lambda x, y, c: rgb[3 * (side * y + x) + c]
    half = range(side // 2)
    return [[[(at(2 * x, 2 * y, c) + at(2 * x + 1, 2 * y, c) + at(2 * x, 2 * y + 1, c) + at(2 * x + 1, 2 * y + 1, c) + 2) // 4 for c in range(3)] for x in half] for y in half]


def sheet(path):
    """Writes `preview` and the hosts that have run, and below each host its difference from `preview`; their names, none where none has run."""
    names, above, below = ["luthier preview"], [], []
    for name, place in SHOWN:
        found = ROOT / "target" / f"{place}.png"
        expected = found.with_name(re.sub(r"(brass)(-.*)?$", r"\1-preview.png", found.stem))
        if not (found.exists() and expected.exists()):
            continue
        ours, theirs = halved(expected), halved(found)
        if not above:
            above.append(ours)
            below.append([[[128] * 3 for _ in row] for row in ours])
        names.append(name)
        above.append(theirs)
        below.append([[[min(max(128 + FACTOR * (q - p), 0), 255) for p, q in zip(*pixels)] for pixels in zip(*rows)] for rows in zip(ours, theirs)])
    if not above:
        return []
    rows = [b"\0" + bytes(value for picture in line for pixel in picture[y] for value in (*pixel, 255)) for line in (above, below) for y in range(len(line[0]))]
    path.write_bytes(png(len(rows[0]) // 4, len(rows), b"".join(rows)))
    return names


place, *logs = map(Path, sys.argv[1:])
names = sheet(place)
print("""# Hosts

Made by `scripts/hosts.sh`, which runs the test of each host in `examples/`. A picture is a ball under a lamp, drawn by the host through its own module for luthier, beside that of `luthier preview` from the same bake.
Differences are those of the channel that is farthest, in steps of 1/255 of the encoded colours, over the pixels that are not black in both. *95 %* and *99 %* of the pixels are within the numbers there. All ran on software: SwiftShader in
Chromium, llvmpipe elsewhere. The path tracer Mitsuba 3 draws from material files, without a bake; [using.md](../using.md#mitsuba-3) has its errors. A median of 2 is allowed.
""")
if names:
    print(f"""![Balls of worn brass: by luthier preview and by {len(names) - 1} hosts; below, their differences about grey]({place.name})

*Worn brass, four maps, from the left: {"; ".join(names)}. Below: the differences from `preview` times {FACTOR}, about grey. Hosts read maps from mipmaps, of which `preview` reads level 0.*
""")
rows, worst = [], []
for log in logs:
    found = [match for match in map(LINE.match, log.read_text().splitlines()) if match]
    if not found:
        sys.exit(f"error: {log} compares no picture")
    name = NAMES[log.stem]
    for by in dict.fromkeys(match["by"] for match in found):
        own = [match for match in found if match["by"] == by]
        label = by if by.lower().startswith(name.lower()) else f"{name}, {by}"
        most = [max(float(match[key] or 0) for match in own) for key in ("median", "p99", "most")]
        worst.append(f"| {label} | {len(own)} | {sum(match['holds'] == 'holds' for match in own)} | " + " | ".join(f"{number:g}" for number in most) + " |")
        rows += [f"| {label} | {match['picture']} | {match['median']} | {match['p95'] or '–'} | {match['p99']} | {match['most']} | {match['pixels']} |" for match in own]
print("| host | pictures | within its limits | largest median | 99 %, at most | largest |\n|---|--:|--:|--:|--:|--:|")
print("\n".join(worst))
print("\n## Each picture\n\n| host | picture | median | 95 % | 99 % | largest | pixels |\n|---|---|--:|--:|--:|--:|--:|")
print("\n".join(rows))
