"""Page of the kinds of jobs: their counts by callgrind and their times, against the limits of one core. `scripts/jobs.sh` calls it.

Reads the disassembly of the program from standard input, and from the folder of its argument what that script has put there.
"""

import collections
import glob
import json
import re
import sys

# What a job's work is counted in: the calls of these functions.
UNITS = {
    "fresnel": ("reflectances", "luthier_optics::fresnel::coated"),
    "film": ("reflectances", "luthier_optics::fresnel::coated"),
    "facet-grid": ("walks", "luthier_optics::microsurface::walk_after_first_facet"),
    "crossed": ("walks", "luthier_optics::microsurface::crossed_and_returned"),
    "fgd-truth": ("sums over walks", "luthier_optics::albedo::FacetStatistics::later_share"),
    "escape": ("quadratures", "luthier_layers::models::statistics::total_reflection::reflected_above"),
    "thickness": ("Perlin values", "Perlin"),
    "fit": ("paths", "JointPaths::path"),
    "distribution": ("powers", "libm::math::pow::pow"),
}
# Names of the types of jobs, where these are not the names of the kinds.
KINDS = {"FgdJob": "fgd", "FgdTruthJob": "fgd-truth", "FacetGridJob": "facet-grid", "CrossedJob": "crossed"}

LIMITS = """
## What holds them back

- No job is held back by memory. If all that a job touches came from there, one after the other, the rate above would do for all kinds but `thickness`,
  which reads the same small tables of Perlin's noise again and again.
- `facet-grid`, `crossed` and `fit` are walks of light. Each step needs the direction of the step before, and its `exp`, `log` and `sincos` are chains of
  products that wait for each other: fewer than two instructions a cycle. Several walks side by side in the lanes of one register would use what is idle. This
  needs versions of these functions over lanes that round alike on every processor, because bytes must not depend on the machine.
- `film` and `fresnel` are complex roots and quotients, for each wavelength and boundary. Wavelengths are independent of each other, so that lanes would
  serve here too.
- `fgd-truth` and `thickness` keep the core busy: only fewer instructions would help.
"""

SUM = re.compile(r"^v?(add|sub|mul)([sp])[sd]$")
SLOW = re.compile(r"^v?(div|sqrt)([sp])[sd]$")


def classes(lines):
    """Per address: sums and products, divisions, roots, bytes that the instruction reads or writes."""
    table = {}
    for line in lines:
        parts = line.split(None, 2)
        if len(parts) < 2 or not parts[0].endswith(":"):
            continue
        name, operands = parts[1], parts[2] if len(parts) > 2 else ""
        flops = divisions = roots = 0
        if found := SUM.match(name):
            flops = 2 if found[2] == "p" else 1
        elif found := SLOW.match(name):
            lanes = 2 if found[2] == "p" else 1
            divisions, roots = (lanes, 0) if found[1] == "div" else (0, lanes)
        touched = 0
        if "(" in operands and not name.startswith(("lea", "nop", "prefetch")):
            touched = 16 if name.endswith(("ps", "pd", "dqa", "dqu")) else 8
        try:
            table[int(parts[0][:-1], 16)] = (flops, divisions, roots, touched)
        except ValueError:
            continue
    return table


def counts(path, table):
    """Kind of the job of one file of callgrind, its counts, how often each function was called, and the instructions of each."""
    kind, sums, calls, own = None, collections.Counter(), collections.Counter(), collections.Counter()
    function, callee, skip, ours = None, None, False, False
    with open(path) as file:
        for line in file:
            if line.startswith("0x"):
                if skip:
                    skip = False
                    continue
                address, _, times = line.split()
                times = int(times)
                sums["instructions"] += times
                own[function] += times
                if ours and (found := table.get(int(address, 16))):
                    for name, each in zip(("flops", "divisions", "roots", "bytes"), found):
                        sums[name] += each * times
            elif line.startswith("ob="):
                ours = line.rstrip().endswith("/luthier")
            elif line.startswith("fn="):
                function = line[3:].strip()
            elif line.startswith("cfn="):
                callee = line[4:].strip()
            elif line.startswith("calls="):
                calls[callee] += int(line[6:].split()[0])
                skip = True
            elif found := re.match(r"desc: Trigger: --dump-after=<.*::(\w+) as ", line):
                kind = KINDS.get(found[1], found[1].removesuffix("Job").lower())
    return kind, sums, calls, own


def plain(function):
    """Name of a function without its modules and types."""
    found = re.match(r"<(.*) as .*>::(\w+)", function)
    name = f"{found[1]}::{found[2]}" if found else function
    return "::".join(re.sub(r"<.*>", "", name).split("::")[-2:])


def main():
    work = sys.argv[1]
    table = classes(sys.stdin)
    machine = json.load(open(f"{work}/machine.json"))
    jobs, sums, calls, own = collections.Counter(), {}, {}, {}
    for path in glob.glob(f"{work}/*.calls.*"):
        kind, these, called, inside = counts(path, table)
        if kind is None:
            continue
        jobs[kind] += 1
        sums.setdefault(kind, collections.Counter()).update(these)
        calls.setdefault(kind, collections.Counter()).update(called)
        own.setdefault(kind, collections.Counter()).update(inside)
    seconds = collections.Counter()
    for first in glob.glob(f"{work}/*.1.json"):
        runs = [json.load(open(first.replace(".1.json", f".{run}.json")))["seconds"] for run in (1, 2, 3)]
        for kind in runs[0]:
            seconds[kind] += min(run[kind] for run in runs)

    hertz = machine["hertz"]
    print("# Kinds of jobs, and the limits of one core\n")
    print(
        "`scripts/jobs.sh` made this page. It bakes six of the shipped materials on one core, whose jobs are of all kinds, takes the best of three"
        " times, and counts the instructions of each job with callgrind and the disassembly.\n"
    )
    print("## The core\n")
    print(
        f"`crates/luthier-bake/examples/machine.rs` measures it, with the instructions that a build has by default (SSE2): {hertz / 1e9:.2f} GHz, "
        f"{machine['flops'] / 1e9:.1f} G sums and products of f64 a second ({machine['flops'] / hertz:.1f} a cycle), "
        f"{machine['divisions'] / 1e9:.2f} G divisions ({hertz / machine['divisions']:.1f} cycles each), "
        f"{machine['roots'] / 1e9:.2f} G roots ({hertz / machine['roots']:.1f} cycles each), "
        f"{machine['bytes'] / 1e9:.0f} GB/s from memory.\n"
    )
    print("## The jobs\n")
    print(
        "- *Per cycle* are instructions.\n"
        "- *Sums* is the share of the time that sums and products need at the core's rate, *quotients* that of divisions and roots. These have units of their own,"
        " and with these instructions no job can be faster than the larger share.\n"
        "- *Times the limit* is the time over the larger share.\n"
        "- *Touched* are bytes that the instructions read and write, in GB a second, wherever those are: most are in the caches.\n"
    )
    print("| kind | jobs | seconds | unit | units | ns each | instructions each | per cycle | sums | quotients | times the limit | touched |")
    print("|---|--:|--:|---|--:|--:|--:|--:|--:|--:|--:|--:|")
    rest = []
    for kind in sorted(sums, key=lambda kind: -seconds[kind]):
        time, count = seconds[kind], sums[kind]
        if kind not in UNITS:
            rest.append(f"`{kind}` ({jobs[kind]} jobs, {1e3 * time:.1f} ms)")
            continue
        unit, function = UNITS[kind]
        units = sum(number for name, number in calls[kind].items() if function in name)
        if units == 0:
            sys.exit(f"error: no call of {function} in a job of kind {kind}")
        flops = count["flops"] / machine["flops"] / time
        slow = (count["divisions"] / machine["divisions"] + count["roots"] / machine["roots"]) / time
        print(
            f"| `{kind}` | {jobs[kind]} | {time:.3f} | {unit} | {units} | {1e9 * time / units:.0f} | {count['instructions'] / units:.0f} "
            f"| {count['instructions'] / time / hertz:.2f} | {100 * flops:.0f} % | {100 * slow:.0f} % | {1 / max(flops, slow):.1f} | {count['bytes'] / time / 1e9:.1f} |"
        )
    if rest:
        print(f"\nThe others take next to no time: {', '.join(sorted(rest))}.")
    print("\n## Where their instructions are\n")
    for kind in sorted(set(UNITS) & set(sums), key=lambda kind: -seconds[kind]):
        total = sums[kind]["instructions"]
        shares = [f"`{plain(name)}` {100 * number / total:.0f} %" for name, number in own[kind].most_common(4) if number > 0.03 * total]
        print(f"- `{kind}`: {', '.join(shares)}")
    print(LIMITS)


main()
