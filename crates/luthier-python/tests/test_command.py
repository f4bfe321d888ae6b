"""Values are those of the command."""

import json
import os
import pathlib
import tempfile
import unittest

import numpy as np
from workshop import LACQUER, MATERIALS, ROOT, command, pairs_file, share_store, values_of

import luthier

# Degrees: theta_i, phi_i, theta_o, phi_o. Around the mirror direction, grazing, and along the normal.
ANGLES = [(20.0, 0.0, 20.0, 180.0), (35.0, 10.0, 40.0, 200.0), (70.0, 90.0, 10.0, 0.0), (0.0, 0.0, 60.0, 30.0), (85.0, 45.0, 80.0, 225.0)]

# Models whose energies or lobes take seconds for each material are compared on these.
FEW = ("house-paint", "car-paint", "copper-patina")


def near(found, expected):
    """Equal to 1e-12 of the value; what is below 1e-300 is 0."""
    return np.allclose(found, expected, rtol=1e-12, atol=1e-300)


class Command(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        share_store()
        cls.pairs = pairs_file(ANGLES)
        angles = np.array(ANGLES).T
        cls.wi, cls.wo = luthier.directions(angles[0], angles[1]), luthier.directions(angles[2], angles[3])

    @classmethod
    def tearDownClass(cls):
        os.unlink(cls.pairs)

    def compare(self, path, model, arguments=(), **at):
        """The values of a model, or that both refuse it."""
        text, error, code = command("eval", path, "--model", model, "--directions", self.pairs, "--json", *arguments)
        with self.subTest(material=path.stem, model=model, arguments=arguments):
            if code != 0:
                with self.assertRaises(ValueError, msg=error):
                    luthier.load(path).eval(self.wi, self.wo, model, **at)
                return False
            expected = values_of(text)
            found = luthier.load(path).eval(self.wi, self.wo, model, **at)
            self.assertTrue(near(found.reshape(expected.shape), expected), f"{found} for {expected}")
        return True

    def test_all_models_of_all_materials(self):
        compared = set()
        for model in luthier.models():
            name, takes_samples = model["name"], "samples" in model["inputs"]
            at = {"samples": 16, "seed": 3} if takes_samples else {}
            arguments = ["--samples", "16", "--seed", "3"] if takes_samples else []
            is_slow = takes_samples or name.split("-")[0] in ("belcour", "yamaguchi", "lobes")
            for path in MATERIALS:
                if (not is_slow or path.stem in FEW) and self.compare(path, name, arguments, **at):
                    compared.add(name)
        # `fluorescence` without a matrix is Elek's model, so all models give values.
        self.assertEqual(compared, {model["name"] for model in luthier.models()})

    def test_wavelengths_and_colours(self):
        for path in MATERIALS:
            self.compare(path, "elek", ["--wavelength", "480"], wavelength_nm=480.0)
            self.compare(path, "weidlich-wilkie", ["--rgb"], color="spectral")
            self.compare(path, "microfacet", ["--three-wavelengths"], color="three-wavelengths")

    def test_places(self):
        flakes, patina = ROOT / "materials/car-paint.toml", ROOT / "materials/copper-patina.toml"
        self.compare(flakes, "elek", ["--uv", "0.31,0.72", "--distance", "2"], uv=(0.31, 0.72), distance=2.0)
        self.compare(flakes, "elek", ["--no-effects"], effects=False)
        self.compare(patina, "elek", ["--uv", "0.2,0.4"], uv=(0.2, 0.4))
        factors = ["--alpha-factor", "1.5", "--slab-factor", "0.5", "--slope-variance", "0.01", "--normal", "10,30"]
        normal = luthier.directions(10.0, 30.0)
        self.compare(patina, "weidlich-wilkie", factors, alpha_factor=1.5, slab_factor=0.5, slope_variance=0.01, normal=normal)

    def test_maps_of_layers(self):
        for name in ("worn-brass", "varnished-oak"):
            path = ROOT / f"materials/textured/board/{name}.toml"
            self.assertTrue(self.compare(path, "elek", ["--uv", "0.6,0.1"], uv=(0.6, 0.1)))
            self.assertTrue(self.compare(path, "belcour", ["--uv", "0.6,0.1"], uv=(0.6, 0.1)))
            self.compare(path, "phong", ["--alpha-factor", "2"], alpha_factor=2.0)

    def test_live_numbers(self):
        live = {**LACQUER, "layer": [LACQUER["layer"][0], {**LACQUER["layer"][1], "live": {"albedo": True}}]}
        with tempfile.TemporaryDirectory() as folder:
            path = pathlib.Path(folder) / "live.toml"
            path.write_text(luthier.load(live).text)
            at = {"live": {"layer.1.albedo": [0.1, 0.2, 0.9]}}
            self.assertTrue(self.compare(path, "elek", ["--live", "layer.1.albedo=0.1,0.2,0.9"], **at))

    def test_albedos(self):
        thetas = [0.0, 40.0, 75.0]
        for path in MATERIALS:
            text, error, code = command("eval", path, "--model", "elek", "--albedo", "--rgb", "--json", "--angles", "0,40,75")
            if code != 0:
                continue
            expected = np.array([row["albedo"] for row in json.loads(text)["albedo"]])
            found = luthier.load(path).albedo(luthier.directions(thetas), "elek", color="spectral")
            self.assertTrue(near(found, expected), f"{path.stem}: {found} for {expected}")

    def test_estimates_have_errors(self):
        path = ROOT / "materials/house-paint.toml"
        text, _, _ = command("eval", path, "--model", "layered-mc", "--directions", self.pairs, "--json", "--samples", "64", "--wavelength", "550")
        function = luthier.load(path).function("layered-mc", wavelength_nm=550.0, samples=64)
        values, errors = function.eval_with_error(self.wi, self.wo)
        rows = json.loads(text)["values"]
        self.assertTrue(near(values, [row["value"][0] for row in rows]))
        expected = [np.inf if row["std_err"][0] is None else row["std_err"][0] for row in rows]
        self.assertTrue(near(errors, expected), f"{errors} for {expected}")

    def test_models_are_listed_as_by_the_command(self):
        self.assertEqual(luthier.models(), json.loads(command("models", "--json")[0]))


if __name__ == "__main__":
    unittest.main()
