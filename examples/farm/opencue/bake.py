#!/usr/bin/env python3
"""Submits a bake to OpenCue: a layer with a frame for each share, and a layer that merges them.

Needs OpenCue's libraries (pip install opencue-pyoutline), and CUEBOT_HOSTS, which names the server. Hosts of the farm need luthier,
the material files and the store at the same paths.

    bake.py MATERIALS OUT --store /shared/luthier --shards 16 [-- OPTIONS OF BAKE]

--print writes the specification of the job instead of submitting it.
"""

import argparse
import sys

import outline
import outline.cuerun
from outline.modules.shell import Shell


def job(args):
    """The outline: OpenCue puts the number of the frame in the place of #IFRAME#."""
    bake = [args.luthier, "bake", args.materials, *args.options, "--cache", args.store, "--threads", str(args.threads)]
    merge = [args.luthier, "merge", args.materials, *args.options, "--cache", args.store, "--out", args.out]
    graph = outline.Outline("luthier", frame_range=f"1-{args.shards}")
    shares = Shell("shares", command=[*bake, "--shard", f"#IFRAME#/{args.shards}"], range=f"1-{args.shards}", threads=args.threads)
    package = Shell("merge", command=merge, range="1-1", threads=1)
    package.depend_all(shares)
    graph.add_layer(shares)
    graph.add_layer(package)
    return graph


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("materials")
    parser.add_argument("out")
    parser.add_argument("--luthier", default="luthier", help="path of the program on the hosts")
    parser.add_argument("--store", required=True, help="folder that all hosts see")
    parser.add_argument("--shards", type=int, default=4)
    parser.add_argument("--threads", type=int, default=1, help="threads, and cores reserved, of each share")
    parser.add_argument("--print", action="store_true", help="print the specification, and submit nothing")
    words = sys.argv[1:]
    end = words.index("--") if "--" in words else len(words)
    args = parser.parse_args(words[:end])
    args.options = words[end + 1 :]

    graph = job(args)
    if args.print:
        # What launch() below sends.
        graph.setup()
        print(outline.cuerun.OutlineLauncher(graph).serialize(use_pycuerun=False))
    else:
        outline.cuerun.launch(graph, use_pycuerun=False)


if __name__ == "__main__":
    main()
