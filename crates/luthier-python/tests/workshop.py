"""What tests share: the package, the command, small materials, random directions."""

import json
import os
import pathlib
import subprocess
import tempfile

import numpy as np

import luthier

ROOT = pathlib.Path(__file__).resolve().parents[3]
MATERIALS = sorted((ROOT / "materials").glob("*.toml"))

METAL = {"schema": 1, "name": "metal", "layer": [{"type": "conductor", "f0": [0.9, 0.6, 0.3], "alpha": 0.4}]}
CHALK = {"schema": 1, "name": "chalk", "layer": [{"type": "diffuse", "albedo": [0.8, 0.5, 0.2]}]}
LACQUER = {
    "schema": 1,
    "name": "lacquer",
    "layer": [
        {"type": "dielectric", "ior": 1.5, "alpha": 0.2, "thickness_um": 10, "absorption_per_um": [0.0, 0.02, 0.05]},
        {"type": "diffuse", "albedo": [0.7, 0.3, 0.2]},
    ],
}


def command(*arguments):
    """What the command of this build prints, and its exit code."""
    environment = {**os.environ, "LUTHIER_CACHE": os.environ.get("LUTHIER_TEST_STORE", "")}
    program = os.environ.get("LUTHIER") or str(ROOT / "target/debug/luthier")
    done = subprocess.run([program, *map(str, arguments)], env=environment, capture_output=True, text=True, check=False)
    return done.stdout, done.stderr, done.returncode


def hemisphere(count, seed=1):
    """Uniform directions above the surface."""
    random = np.random.default_rng(seed)
    z, phi = random.uniform(0.02, 1.0, count), random.uniform(0.0, 2.0 * np.pi, count)
    r = np.sqrt(1.0 - z * z)
    return np.stack([r * np.cos(phi), r * np.sin(phi), z], axis=-1)


def pairs_file(angles):
    """A CSV file of pairs for `luthier eval --directions`: rows theta_i, phi_i, theta_o, phi_o, in degrees."""
    file = tempfile.NamedTemporaryFile("w", suffix=".csv", delete=False)
    with file:
        file.write("theta_i,phi_i,theta_o,phi_o\n")
        file.writelines(",".join(repr(float(x)) for x in row) + "\n" for row in angles)
    return file.name


def values_of(text):
    """Values of `luthier eval --json`, a row for each pair."""
    return np.array([row["value"] for row in json.loads(text)["values"]])


def share_store():
    """Keeps fits where the command of the tests keeps its own."""
    folder = os.environ.get("LUTHIER_TEST_STORE")
    if folder:
        luthier.cache(folder)
