"""Bakes, tables, audits and imports: what the command makes of the same inputs."""

import json
import os
import pathlib
import tempfile
import unittest

import numpy as np
from workshop import CHALK, LACQUER, METAL, ROOT, command, share_store

import luthier


def files_of(folder):
    """Bytes of all files in a folder, by relative path."""
    folder = pathlib.Path(folder)
    return {path.relative_to(folder).as_posix(): path.read_bytes() for path in folder.rglob("*") if path.is_file()}


class Bakes(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        share_store()
        cls.baked = luthier.bake([luthier.load(LACQUER), luthier.load(METAL)], model="elek")

    def test_contents(self):
        baked = self.baked
        self.assertEqual([material["name"] for material in baked.manifest["materials"]], ["lacquer", "metal"])
        self.assertEqual(sorted(baked.tables), sorted(table["kind"] for table in baked.manifest["tables"]))
        for table in baked.manifest["tables"]:
            texels, unrounded = baked.tables[table["kind"]], baked.unrounded()[table["kind"]]
            self.assertEqual((texels.dtype, texels.ndim), (np.float32, 3))
            self.assertEqual(texels.shape, unrounded.shape)
            self.assertLess(np.abs(texels - unrounded).max(), 1e-2)
        self.assertIn("fn luthier_eval(", baked.shaders["baked.wgsl"])
        self.assertEqual(baked.files["shaders/baked.wgsl"].decode(), baked.shaders["baked.wgsl"])
        self.assertEqual(len(baked.files["materials.bin"]) % 16, 0)

    def test_files_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            sources = []
            for material in (LACQUER, METAL):
                path = os.path.join(folder, material["name"] + ".toml")
                with open(path, "w") as file:
                    file.write(luthier.load(material).text)
                sources.append(path)
            here, there = os.path.join(folder, "here"), os.path.join(folder, "there")
            luthier.bake([luthier.load(path) for path in sources], here, model="elek")
            _, error, code = command("bake", *sources, "--out", there, "--model", "elek")
            self.assertEqual(code, 0, error)
            found, expected = files_of(here), files_of(there)
            self.assertEqual(sorted(found), sorted(expected))
            for name, data in found.items():
                self.assertEqual(data, expected[name], name)

    def test_options(self):
        baked = luthier.bake([luthier.load(METAL)], model="elek", forms=["full"], targets=["hlsl", "spirv"], functions=["sample"])
        self.assertEqual(baked.tables, {})
        self.assertEqual(sorted(baked.shaders), ["full.hlsl", "full.spv"])
        self.assertIsInstance(baked.shaders["full.spv"], bytes)
        self.assertIn("luthier_sample", baked.shaders["full.hlsl"])
        with self.assertRaisesRegex(ValueError, "unknown target `cuda`"):
            luthier.bake([luthier.load(METAL)], targets=["cuda"])

    def test_refusals(self):
        with self.assertRaises(luthier.MaterialError):
            luthier.bake([luthier.load(CHALK), luthier.load(CHALK)], model="elek")
        with self.assertRaises(luthier.MaterialError):
            luthier.bake([])
        with self.assertRaisesRegex(TypeError, "materials: expected Material, found str"):
            luthier.bake(["chalk.toml"])

    def test_one_in_place_of_some(self):
        one = luthier.bake(luthier.load(CHALK), model="elek", targets="hlsl", forms="full")
        self.assertEqual(list(one.shaders), ["full.hlsl"])


class Tables(unittest.TestCase):
    def test_limits_are_those_of_the_command(self):
        refused = {
            "size: expected 2 whole numbers from 4 to 1024": lambda: luthier.table_dfg("unreal", size=(0, 4)),
            "size: expected 3 whole numbers from 2 to 1024": lambda: luthier.table_fresnel(size=(8, -4, 4)),
            "lie one below the other": lambda: luthier.table_fresnel(size=(8, 1024, 1024)),
            "size: a search finds its own": lambda: luthier.table_dfg(max_abs=0.1, size=(8, 8)),
            "max_abs: expected a positive number": lambda: luthier.table_dfg(max_abs=-1),
            "a preset has a distribution": lambda: luthier.table_dfg("unreal", distribution="beckmann"),
            "film: expected an index": lambda: luthier.table_film(float("nan"), 1.5),
            "base: expected an index": lambda: luthier.table_film(1.4, 1.5 - 2j),
            "above: expected a positive number": lambda: luthier.table_film(1.4, 1.5, above=-1),
            "min_cos: expected a number from 0 up to 1": lambda: luthier.table_cloth(min_cos=1.0),
        }
        for words, call in refused.items():
            with self.assertRaisesRegex(ValueError, words):
                call()

    def test_a_preset_is_held_to_what_it_says(self):
        table = luthier.table_dfg("filament", size=(32, 32))
        self.assertEqual(table.texels.shape[:2], (32, 32))
        verdict = luthier.audit(table.texels, preset="filament")
        self.assertTrue(verdict["held"], verdict["line"])
        flipped = luthier.audit(table.texels[::-1], preset="filament")
        self.assertFalse(flipped["held"])
        self.assertIn("flip", flipped["line"])

    def test_audits_are_those_of_the_command(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "dfg.ktx2")
            command("table", "dfg", "--max-abs", "0.01", "-o", path)
            text, error, code = command("audit", path, "--axes", "cos_theta,alpha", "--json")
            expected = json.loads(text)
            found = luthier.audit(path, axes="cos_theta,alpha")
            for key in ("format", "stated", "line", "held", "audit"):
                self.assertEqual(found[key], expected[key], key)
            self.assertEqual(found["held"], code == 0, error)

    def test_a_search_holds_its_error(self):
        table = luthier.table_dfg(max_abs=0.01)
        self.assertTrue(table.about["held"])
        self.assertLessEqual(table.about["error"]["max_abs_err"], 0.01)

    def test_fresnel_by_the_formula(self):
        table = luthier.table_fresnel(size=(32, 16, 4))
        self.assertEqual(table.texels.shape, (16 * 4, 32, 1))
        # The last column is the normal; slices of k lie one below the other. n is from 0.05 to 5, k from 0 to 10.
        n, k = np.meshgrid(np.linspace(0.05, 5.0, 16), np.linspace(0.0, 10.0, 4), indexing="xy")
        expected = ((n - 1.0) ** 2 + k**2) / ((n + 1.0) ** 2 + k**2)
        np.testing.assert_allclose(table.texels[:, -1, 0].reshape(4, 16), expected, atol=1e-6)

    def test_films_of_no_thickness_are_bare(self):
        table = luthier.table_film(1.33, 1.5, size=(8, 16))
        self.assertEqual(table.texels.shape, (16, 8, 3))
        np.testing.assert_allclose(table.texels[0, -1], 0.04, atol=1e-4)

    def test_cloth(self):
        self.assertEqual(luthier.table_cloth(size=(8, 8)).texels.shape, (8, 8, 1))

    def test_integers_are_fractions(self):
        texels = np.round(luthier.table_dfg("filament", size=(64, 64)).texels.astype(np.float64).clip(0.0, 1.0) * 65535).astype(np.uint16)
        self.assertTrue(luthier.audit(texels, preset="filament")["held"])
        with self.assertRaisesRegex(ValueError, "table has shape"):
            luthier.audit(np.zeros(4))
        with self.assertRaisesRegex(ValueError, "no preset `filaments`"):
            luthier.audit(texels, preset="filaments")


class Imports(unittest.TestCase):
    def test_files_are_those_of_the_command(self):
        text = {
            "asset": {"version": "2.0"},
            "materials": [
                {
                    "name": "Red Lacquer",
                    "pbrMetallicRoughness": {"baseColorFactor": [0.5, 0.1, 0.1, 1], "metallicFactor": 0},
                    "extensions": {"KHR_materials_clearcoat": {"clearcoatFactor": 1}},
                }
            ],
        }
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "lacquer.gltf")
            with open(path, "w") as file:
                json.dump(text, file)
            here, there = os.path.join(folder, "here"), os.path.join(folder, "there")
            imported = luthier.import_files([path], here)
            _, error, code = command("import", path, "-o", there)
            self.assertEqual(code, 0, error)
            found, expected = files_of(here), files_of(there)
            self.assertEqual(found["red-lacquer.toml"], expected["red-lacquer.toml"])
            self.assertEqual(json.loads(found["import.json"]), json.loads(expected["import.json"]))
            self.assertEqual(list(imported.texts), ["red-lacquer"])
            self.assertEqual(luthier.load(os.path.join(here, "red-lacquer.toml")).name, "red-lacquer")
            with self.assertRaises(FileExistsError):
                imported.write(here)
            imported.write(here, force=True)
            with self.assertRaises(OSError):
                luthier.import_files(os.path.join(folder, "nowhere.gltf"))
            with self.assertRaisesRegex(ValueError, "lacquer.toml"):
                luthier.import_files([os.path.join(here, "red-lacquer.toml")])


if __name__ == "__main__":
    unittest.main()
