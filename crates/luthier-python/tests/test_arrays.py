"""Shapes, types and memory of arrays; threads; errors."""

import os
import pickle
import subprocess
import sys
import tempfile
import threading
import time
import unittest

import numpy as np
from workshop import CHALK, LACQUER, METAL, command, hemisphere

import luthier


class Shapes(unittest.TestCase):
    def setUp(self):
        self.lacquer = luthier.load(LACQUER)
        self.up = np.array([0.0, 0.0, 1.0])

    def test_broadcasting(self):
        wi, wo = hemisphere(12, 1).reshape(3, 4, 3), hemisphere(4, 2)
        found = self.lacquer.eval(wi, wo, model="elek")
        self.assertEqual(found.shape, (3, 4, 3))
        for i in range(3):
            for j in range(4):
                np.testing.assert_array_equal(found[i, j], self.lacquer.eval(wi[i, j], wo[j], model="elek"))
        self.assertEqual(self.lacquer.eval(wi[:, :1], wo, model="elek").shape, (3, 4, 3))
        self.assertEqual(self.lacquer.eval(wi, wo, model="elek", wavelength_nm=500.0).shape, (3, 4))
        self.assertEqual(self.lacquer.eval(self.up, self.up, model="elek").shape, (3,))
        self.assertEqual(self.lacquer.eval(self.up, self.up, model="elek", wavelength_nm=500.0).shape, ())
        self.assertEqual(self.lacquer.albedo(wi, model="phong").shape, (3, 4, 3))
        self.assertEqual(self.lacquer.pdf(wi, wo, model="elek").shape, (3, 4))
        drawn = self.lacquer.sample(self.up, np.full((2, 5, 3), 0.5), "elek")
        self.assertEqual([part.shape for part in drawn], [(2, 5, 3), (2, 5, 3), (2, 5)])

    def test_one_pair_with_leading_axes(self):
        self.assertEqual(self.lacquer.eval(self.up.reshape(1, 1, 3), self.up, model="elek").shape, (1, 1, 3))

    def test_empty_arrays(self):
        self.assertEqual(self.lacquer.eval(np.zeros((0, 3)), self.up, model="elek").shape, (0, 3))
        self.assertEqual(self.lacquer.eval(np.zeros((4, 0, 3)), np.zeros((0, 3)), model="elek").shape, (4, 0, 3))
        self.assertEqual(self.lacquer.pdf(np.zeros((0, 3)), self.up, model="elek").shape, (0,))
        self.assertEqual(self.lacquer.albedo(np.zeros((0, 3)), model="elek").shape, (0, 3))
        self.assertEqual(self.lacquer.sample(np.zeros((0, 3)), self.up * 0.0, "elek")[0].shape, (0, 3))
        self.assertEqual(luthier.directions([]).shape, (0, 3))

    def test_wrong_shapes(self):
        for wi in [1.0, [0.0, 1.0], np.zeros((3, 2)), np.zeros((3, 4))]:
            with self.assertRaisesRegex(ValueError, r"expected \(\.\.\., 3\)"):
                self.lacquer.eval(wi, self.up, model="elek")
        with self.assertRaisesRegex(ValueError, "do not broadcast"):
            self.lacquer.eval(hemisphere(2), hemisphere(3), model="elek")

    def test_directions_are_unit(self):
        with self.assertRaisesRegex(ValueError, "direction 1 .* not of length 1"):
            self.lacquer.eval([[0.0, 0.0, 1.0], [0.0, 0.0, 2.0]], self.up, model="elek")
        with self.assertRaisesRegex(ValueError, "not of length 1"):
            self.lacquer.eval([0.0, 0.0, np.inf], self.up, model="elek")
        with self.assertRaisesRegex(ValueError, "from 0 up to 1"):
            self.lacquer.sample(self.up, [0.0, 0.5, 1.0], "elek")

    def test_nan_stays_in_its_row(self):
        wi = hemisphere(10000)
        expected = self.lacquer.eval(wi, self.up, model="elek")
        wi[4321] = [np.nan, 0.0, 1.0]
        found = self.lacquer.eval(wi, self.up, model="elek")
        self.assertTrue(np.isnan(found[4321]).all())
        np.testing.assert_array_equal(np.delete(found, 4321, axis=0), np.delete(expected, 4321, axis=0))
        self.assertTrue(np.isnan(self.lacquer.pdf(wi, self.up, model="elek")[4321]))
        self.assertTrue(np.isnan(self.lacquer.albedo([np.nan] * 3, model="elek")).all())

    def test_below_the_horizon_is_dark(self):
        self.assertTrue(np.all(self.lacquer.eval([[0.0, 0.6, -0.8], [1.0, 0.0, 0.0]], self.up, model="elek") == 0.0))
        self.assertEqual(self.lacquer.pdf([0.0, 0.6, -0.8], self.up, model="elek"), 0.0)

    def test_memory_layouts_and_types(self):
        wi, wo = hemisphere(60, 1), hemisphere(60, 2)
        expected = self.lacquer.eval(wi, wo, model="elek")
        np.testing.assert_array_equal(self.lacquer.eval(np.asfortranarray(wi), wo, model="elek"), expected)
        padded = np.zeros((60, 2, 6))
        padded[:, 1, ::2] = wi
        np.testing.assert_array_equal(self.lacquer.eval(padded[:, 1, ::2], wo, model="elek"), expected)
        np.testing.assert_array_equal(self.lacquer.eval(wi[::-1], wo[::-1], model="elek"), expected[::-1])
        np.testing.assert_array_equal(self.lacquer.eval(wi.tolist(), wo, model="elek"), expected)
        np.testing.assert_array_equal(self.lacquer.eval(wi.astype(">f8"), wo, model="elek"), expected)
        single = wi.astype(np.float32)
        found = self.lacquer.eval(single, wo, model="elek")
        self.assertEqual(found.dtype, np.float64)
        np.testing.assert_array_equal(found, self.lacquer.eval(single.astype(np.float64), wo, model="elek"))
        before = wi.copy()
        wi.flags.writeable = False
        self.lacquer.eval(wi, wo, model="elek")
        np.testing.assert_array_equal(wi, before)

    def test_directions(self):
        np.testing.assert_allclose(luthier.directions([0.0, 90.0], [0.0, 90.0]), [[0, 0, 1], [0, 1, 0]], atol=1e-15)
        self.assertEqual(luthier.directions(np.zeros((2, 1)), np.zeros(5)).shape, (2, 5, 3))


class Threads(unittest.TestCase):
    def test_values_do_not_depend_on_the_number_of_threads(self):
        script = (
            "import sys, numpy as np, luthier; sys.path.insert(0, sys.argv[1]); from workshop import LACQUER, hemisphere\n"
            "m = luthier.load(LACQUER); wi = hemisphere(20001); u = np.random.default_rng(1).uniform(size=(999, 3))\n"
            "out = [m.eval(wi, [0, 0, 1], 'elek'), *m.sample([0, 0.6, 0.8], u, 'elek'), m.albedo(wi[:9], 'elek')]\n"
            "import hashlib; print(hashlib.sha256(b''.join(a.tobytes() for a in out)).hexdigest())"
        )
        run = lambda threads: subprocess.run(
            [sys.executable, "-c", script, os.path.dirname(__file__)],
            env={**os.environ, "RAYON_NUM_THREADS": str(threads)}, check=True, capture_output=True, text=True,
        ).stdout
        self.assertEqual(run(1), run(5))

    def test_the_lock_is_released(self):
        """A thread of Python goes on while another one evaluates."""
        function, wi = luthier.load(METAL).function("elek"), hemisphere(1_000_000)
        function.eval(wi[:10], [0.0, 0.0, 1.0])
        ticks, done = 0, threading.Event()

        def work():
            for _ in range(3):
                function.eval(wi, [0.0, 0.0, 1.0])
            done.set()

        thread = threading.Thread(target=work)
        # A thread that keeps the lock is never asked for it within a call into native code.
        thread.start()
        while not done.is_set():
            time.sleep(0.001)
            ticks += 1
        thread.join()
        self.assertGreater(ticks, 5)

    def test_two_threads_have_their_values(self):
        lacquer, wi = luthier.load(LACQUER), hemisphere(100_000)
        expected = {model: lacquer.eval(wi, [0.0, 0.0, 1.0], model) for model in ("elek", "phong")}
        found = {}
        threads = [threading.Thread(target=lambda model=model: found.update({model: lacquer.eval(wi, [0.0, 0.0, 1.0], model)})) for model in expected]
        [thread.start() for thread in threads]
        [thread.join() for thread in threads]
        for model, values in expected.items():
            np.testing.assert_array_equal(found[model], values)


class Errors(unittest.TestCase):
    def test_a_file_with_a_mistake(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "gold.toml")
            with open(path, "w") as file:
                file.write('schema = 1\nname = "gold"\n[[layer]]\ntype = "conductor"\nior = "au"\nroughness = 20\n')
            with self.assertRaises(luthier.MaterialError) as caught:
                luthier.load(path)
            text = str(caught.exception)
            for part in [f"{path}:6", "roughness = 20", "20 per cent is `roughness = 0.2`"]:
                self.assertIn(part, text)
            # The command says the same.
            self.assertIn(text.splitlines()[0], command("check", path)[1])
            [mistake] = caught.exception.diagnostics
            self.assertEqual((mistake["line"], mistake["severity"], mistake["file"]), (6, "error", path))
            self.assertIsInstance(caught.exception, ValueError)

    def test_a_dict_with_a_mistake(self):
        with self.assertRaisesRegex(luthier.MaterialError, "<dict>:6") as caught:
            luthier.load({"schema": 1, "name": "x", "layer": [{"type": "diffuse", "albedo": 80}]})
        self.assertEqual(caught.exception.diagnostics[0]["line"], 6)

    def test_a_missing_file(self):
        with self.assertRaisesRegex(FileNotFoundError, "nowhere.toml"):
            luthier.load("nowhere.toml")

    def test_numbers_beyond_their_limits(self):
        chalk, up = luthier.load(CHALK), [0.0, 0.0, 1.0]
        refused = {
            "wavelength_nm: expected a wavelength from 360 to 830 nm": {"wavelength_nm": 359.0},
            "either color or wavelength_nm": {"wavelength_nm": 500.0, "color": "spectral"},
            "seed: expected a whole number from 0": {"seed": -1},
            "samples: expected a whole number from 1": {"samples": 2**70},
            "uv: expected 2 numbers": {"uv": 3},
        }
        for words, arguments in refused.items():
            with self.assertRaisesRegex(ValueError, words):
                chalk.eval(up, up, model="layered-mc", **arguments)

    def test_names(self):
        chalk, up = luthier.load(CHALK), [0.0, 0.0, 1.0]
        with self.assertRaisesRegex(ValueError, "no model `elec`; did you mean `elek`"):
            chalk.eval(up, up, model="elec")
        with self.assertRaisesRegex(ValueError, "no color `rgb`"):
            chalk.eval(up, up, model="elek", color="rgb")
        with self.assertRaisesRegex(ValueError, "takes no `samples`"):
            chalk.eval(up, up, model="elek", samples=3)
        with self.assertRaisesRegex(ValueError, "live"):
            chalk.eval(up, up, model="elek", live={"layer.0.albedo": [1.0, 1.0, 1.0]})
        with self.assertRaisesRegex(ValueError, "uv: expected 2 numbers"):
            chalk.eval(up, up, model="elek", uv=(1.0,))
        with self.assertRaises(TypeError):
            chalk.eval(up, up, model="elek", colour="spectral")
        with self.assertRaisesRegex(ValueError, "wavelength"):
            chalk.eval(up, up, model="elek", wavelength_nm=-1.0)

    def test_materials_are_pickled(self):
        lacquer, wi = luthier.load(LACQUER), hemisphere(20)
        again = pickle.loads(pickle.dumps(lacquer))
        self.assertEqual(repr(again), "<luthier.Material 'lacquer' of 2 layers>")
        np.testing.assert_array_equal(again.eval(wi, wi, "elek"), lacquer.eval(wi, wi, "elek"))

    def test_dicts_are_files(self):
        lacquer = luthier.load(LACQUER)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "lacquer.toml")
            with open(path, "w") as file:
                file.write(lacquer.text)
            again = luthier.load(path)
        self.assertEqual((again.name, again.layers, again.model), ("lacquer", 2, lacquer.model))
        wi, wo = hemisphere(20, 1), hemisphere(20, 2)
        np.testing.assert_array_equal(again.eval(wi, wo, "elek"), lacquer.eval(wi, wo, "elek"))
        numbers = {**CHALK, "layer": [{"type": "diffuse", "albedo": np.array([0.8, 0.5, 0.2])}]}
        np.testing.assert_array_equal(luthier.load(numbers).eval(wi, wo, "elek"), luthier.load(CHALK).eval(wi, wo, "elek"))
        with self.assertRaises(TypeError):
            luthier.load({"schema": 1, "name": "x", "layer": [{"type": object()}]})
        odd = luthier.load({"schema": 1, "name": "odd", "layer": [{"type": "diffuse", "albedo": 0.5}], "bake": {"model": "elek"}})
        self.assertEqual(odd.model, "elek")


if __name__ == "__main__":
    unittest.main()
