"""The page of pictures that hosts draw, beside those of `luthier preview`: hosts.py LOG... prints it.

A log is what the test of a host printed; its name is the host's. Lines that compare a picture are
`holds: PICTURE by RENDERER against preview: median M of 255, 95 % within P, 99 % within Q, largest L, N pixels`, the 95 % left out in some.
"""

import re
import sys
from pathlib import Path

LINE = re.compile(
    r"(?P<holds>holds|FAILS): (?P<picture>.+?) by (?P<by>.+?) against preview: median (?P<median>[\d.]+) of 255(, 95 % within (?P<p95>[\d.]+))?"
    r", 99 % within (?P<p99>[\d.]+), largest (?P<most>[\d.]+), (?P<pixels>\d+) pixels"
)
NAMES = {"three": "three.js", "babylon": "Babylon.js", "playcanvas": "PlayCanvas", "bevy": "Bevy", "godot": "Godot", "materialx": "MaterialX", "c": "C", "web": "two bakes in one program"}

print("""# Hosts

Made by `scripts/hosts.sh`, which runs the test of each host in `examples/`. A picture is a ball under a lamp, drawn by the host through its own module for luthier, beside that of `luthier preview` from the same bake.
Differences are those of the channel that is farthest, in steps of 1/255 of the encoded colours, over the pixels that are not black in both. *95 %* and *99 %* of the pixels are within the numbers there. All ran on software: SwiftShader in
Chromium, llvmpipe elsewhere. The path tracer Mitsuba 3 draws from material files, without a bake; [using.md](../using.md#mitsuba-3) has its errors. A median of 2 is allowed.
""")
rows, worst = [], []
for log in map(Path, sys.argv[1:]):
    found = [match for match in map(LINE.match, log.read_text().splitlines()) if match]
    if not found:
        sys.exit(f"error: {log} compares no picture")
    name = NAMES[log.stem]
    for by in dict.fromkeys(match["by"] for match in found):
        own = [match for match in found if match["by"] == by]
        label = name if by.lower() == name.lower() else f"{name}, {by}"
        most = [max(float(match[key] or 0) for match in own) for key in ("median", "p99", "most")]
        worst.append(f"| {label} | {len(own)} | {sum(match['holds'] == 'holds' for match in own)} | " + " | ".join(f"{number:g}" for number in most) + " |")
        rows += [f"| {label} | {match['picture']} | {match['median']} | {match['p95'] or '–'} | {match['p99']} | {match['most']} | {match['pixels']} |" for match in own]
print("| host | pictures | within its limits | largest median | 99 %, at most | largest |\n|---|--:|--:|--:|--:|--:|")
print("\n".join(worst))
print("\n## Each picture\n\n| host | picture | median | 95 % | 99 % | largest | pixels |\n|---|---|--:|--:|--:|--:|--:|")
print("\n".join(rows))
