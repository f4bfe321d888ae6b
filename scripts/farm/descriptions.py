"""Runs the commands that the descriptions for Kubernetes and OpenCue contain, as these engines would; descriptions.sh calls it."""

import os
import pathlib
import shutil
import subprocess
import sys
import xml.etree.ElementTree as xml

import yaml

LUTHIER = os.environ["LUTHIER"]
EXAMPLES = pathlib.Path("examples/farm")
NAMES = ["car-paint", "soap-film", "papers/sugar"]


def run(command, folder, **environment):
    """Runs a command in a folder, with nothing of this environment but PATH."""
    shown = subprocess.run(command, cwd=folder, env={"PATH": f"{folder}/bin:{os.environ['PATH']}", **environment}, capture_output=True, text=True)
    if shown.returncode != 0:
        sys.exit(f"error: {command} failed: {shown.stderr}{shown.stdout}")


def compare(name, plain, merged):
    """Ends the program unless both folders hold the same bytes."""
    if subprocess.run(["diff", "-rq", plain, merged]).returncode != 0:
        sys.exit(f"error: {name}: other bytes than those of a plain bake")
    print(f"{name}: the commands give the bytes of a plain bake")


def kubernetes(work, plain):
    """Runs the container of each index of the first job, then that of the second. The store is a folder here, not S3."""
    jobs = [yaml.safe_load((EXAMPLES / "kubernetes" / name).read_text()) for name in ("bake.yaml", "merge.yaml")]
    out = work / "kubernetes"
    for job in jobs:
        container = job["spec"]["template"]["spec"]["containers"][0]
        values = {entry["name"]: entry["value"] for entry in container["env"]}
        completions = job["spec"].get("completions", 1)
        if completions != int(values.get("SHARDS", completions)):
            sys.exit("error: bake.yaml: SHARDS differs from completions")
        del values["LUTHIER_STORE"]
        values.update(MATERIALS=str(work / "materials"), OUT=str(out), LUTHIER_CACHE=str(work / "kubernetes-store"))
        for index in range(completions):
            run(container["command"] + container["args"], work, **{**values, "JOB_COMPLETION_INDEX": str(index)})
    compare("kubernetes", plain, out)


def opencue(work, plain):
    """Runs the frames of each layer, layers in the order that their dependency asks for."""
    out = work / "opencue"
    arguments = [str(work / "materials"), str(out), "--store", str(work / "opencue-store"), "--print", "--", "--no-fit"]
    text = subprocess.run([sys.executable, EXAMPLES / "opencue/bake.py", *arguments], check=True, capture_output=True, text=True).stdout
    specification = xml.fromstring(text[text.index("<spec>") :])
    depend = specification.find("depends/depend")
    order = [depend.findtext("onlayer"), depend.findtext("deplayer")]
    if order != ["shares", "merge"] or depend.get("type") != "LAYER_ON_LAYER":
        sys.exit("error: bake.py: the merge does not wait for all shares")
    layers = {layer.get("name"): layer for layer in specification.iter("layer")}
    for name in order:
        first, _, last = layers[name].findtext("range").partition("-")
        for frame in range(int(first), int(last or first) + 1):
            command = layers[name].findtext("cmd").replace("#IFRAME#", str(frame))
            run(["/bin/sh", "-c", command], work, HOME=str(work))
    compare("opencue", plain, out)


def main():
    work = pathlib.Path(sys.argv[1])
    (work / "materials").mkdir()
    for name in NAMES:
        shutil.copy(f"materials/{name}.toml", work / "materials")
    (work / "bin").mkdir()
    (work / "bin/luthier").symlink_to(LUTHIER)
    for name, options in ("with fits", []), ("without fits", ["--no-fit"]):
        command = [LUTHIER, "bake", str(work / "materials"), *options, "--out", name, "--quiet"]
        run(command, work, LUTHIER_CACHE="")
    kubernetes(work, work / "with fits")
    opencue(work, work / "without fits")


main()
