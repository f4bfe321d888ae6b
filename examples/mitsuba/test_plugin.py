"""Tests of the plugin: python -m unittest test_plugin

They need Mitsuba 3 with the variant llvm_ad_rgb, and for the ball the command `luthier` (the variable LUTHIER), whose pictures and Mitsuba's are left in the folder
PICTURES. All random numbers are seeded.
"""

import os
import pathlib
import subprocess
import sys
import tempfile
import time
import unittest

import mitsuba as mi
import numpy as np

mi.set_variant("llvm_ad_rgb")
import drjit as dr
import luthier
import luthier_bsdf
from mitsuba.python.chi2 import BSDFAdapter, ChiSquareTest, SphericalDomain
from sky import sky

HERE = pathlib.Path(__file__).resolve().parent
HEAD = 'schema = 1\nname = "{}"\n'
# The simulation has three wavelengths, whose gold is another than that of whole spectra.
METAL = '[[layer]]\ntype = "conductor"\nior = "au"\nalpha = 0.2\n[bake]\ncolor = "three-wavelengths"\n'
PLASTIC = '[[layer]]\ntype = "dielectric"\nior = 1.5\nalpha = 0.15\n[[layer]]\ntype = "diffuse"\nalbedo = [0.7, 0.2, 0.1]\n'
VARNISH = (
    '[[layer]]\ntype = "dielectric"\nior = 1.5\nalpha = 0.1\nthickness_um = 20\nabsorption_per_um = [0.002, 0.01, 0.03]\n'
    '[[layer]]\ntype = "conductor"\nior = "al"\nalpha = 0.3\n'
)
# Largest medians of differences of the balls, in 1/255.
MOST_PIXELS, MOST_BLOCKS = 2.5, 1.2
STACKS = {"metal": METAL, "plastic": PLASTIC, "varnish": VARNISH}


def setUpModule():
    global folder
    folder = tempfile.TemporaryDirectory()
    unittest.addModuleCleanup(folder.cleanup)
    for name, layers in STACKS.items():
        pathlib.Path(path_of(name)).write_text(HEAD.format(name) + layers)
    # Lobes are fitted once for all tests, and for the command.
    os.environ["LUTHIER_CACHE"] = os.path.join(folder.name, "store")
    luthier.cache(os.environ["LUTHIER_CACHE"])
    unittest.addModuleCleanup(luthier.cache, None)


def path_of(name):
    return os.path.join(folder.name, f"{name}.toml")


def bsdf_of(name, **more):
    return {"type": "luthier", "material": path_of(name), **more}


def direction(theta_deg, phi_deg=0.0):
    return luthier.directions(theta_deg, phi_deg).tolist()


class Values(unittest.TestCase):
    def test_directions_are_swapped_and_the_cosine_is_in(self):
        """On a material that is not reciprocal, values tell which direction is which."""
        bsdf, material = mi.load_dict(bsdf_of("varnish", model="elek")), luthier.load(path_of("varnish"))
        si = dr.zeros(mi.SurfaceInteraction3f)
        eye, light = direction(20), direction(65, 150)
        si.wi = eye
        found = np.array(bsdf.eval(mi.BSDFContext(), si, mi.Vector3f(light))).ravel()
        np.testing.assert_allclose(found, material.eval(light, eye, "elek"), rtol=1e-4)
        self.assertFalse(np.allclose(found, material.eval(eye, light, "elek"), rtol=1e-2))

    def test_weights_are_values_over_densities(self):
        bsdf, count = mi.load_dict(bsdf_of("plastic")), 1000
        si = dr.zeros(mi.SurfaceInteraction3f, count)
        si.wi = direction(50)
        u = np.random.default_rng(1).random((3, count)).astype(np.float32)
        drawn, weight = bsdf.sample(mi.BSDFContext(), si, mi.Float(u[0]), mi.Point2f(u[1], u[2]))
        value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, drawn.wo)
        is_drawn = np.array(drawn.pdf) > 0.0
        self.assertGreater(is_drawn.mean(), 0.9)
        # Directions went through single precision, which a lobe of alpha 0.15 notices.
        np.testing.assert_allclose(np.array(drawn.pdf)[is_drawn], np.array(pdf)[is_drawn], rtol=1e-3)
        np.testing.assert_allclose(np.array(weight * pdf)[:, is_drawn], np.array(value)[:, is_drawn], rtol=2e-3)

    def test_lanes_that_are_off_and_the_back_are_dark(self):
        bsdf = mi.load_dict(bsdf_of("metal", model="elek"))
        si = dr.zeros(mi.SurfaceInteraction3f, 3)
        si.wi = mi.Vector3f([0.0, 0.0, 0.0], [0.0, 0.0, 0.0], [1.0, -1.0, 0.0])
        active = mi.Bool([True, True, False])
        value, pdf = bsdf.eval_pdf(mi.BSDFContext(), si, mi.Vector3f(0.0, 0.0, 1.0), active)
        self.assertEqual((np.array(value)[0] > 0.0).tolist(), [True, False, False])
        self.assertEqual((np.array(pdf) > 0.0).tolist(), [True, False, False])

    def test_scalar_variants_have_these_values(self):
        eye, light = direction(40, 30), direction(25, 200)
        script = (
            "import sys, json, mitsuba as mi; mi.set_variant('scalar_rgb')\nimport luthier_bsdf, drjit as dr\n"
            "path, eye, light = sys.argv[1], *map(json.loads, sys.argv[2:])\n"
            "bsdf = mi.load_dict({'type': 'luthier', 'material': path, 'model': 'elek'})\n"
            "si = dr.zeros(mi.SurfaceInteraction3f); si.wi = eye; ctx = mi.BSDFContext()\n"
            "drawn, weight = bsdf.sample(ctx, si, 0.3, [0.6, 0.2])\n"
            "print(*bsdf.eval(ctx, si, light), bsdf.pdf(ctx, si, light), *drawn.wo, drawn.pdf, *weight)\n"
        )
        done = subprocess.run([sys.executable, "-c", script, path_of("varnish"), str(eye), str(light)], cwd=HERE, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        function = luthier.load(path_of("varnish")).function("elek")
        wi, weight, pdf = function.sample(eye, [0.3, 0.6, 0.2])
        expected = np.concatenate([function.eval(light, eye), [function.pdf(light, eye)], wi, [pdf], weight])
        np.testing.assert_allclose([float(x) for x in done.stdout.split()], expected, rtol=1e-3, atol=1e-6)

    def test_mistakes(self):
        broken = path_of("broken")
        pathlib.Path(broken).write_text(HEAD.format("broken") + METAL.replace("0.2", "20"))
        mistakes = [
            ({"type": "luthier"}, "`material` is missing"),
            ({"type": "luthier", "material": "nowhere.toml"}, "nowhere.toml"),
            ({"type": "luthier", "material": broken}, "broken.toml:6"),
            (bsdf_of("metal", model="elec"), "did you mean `elek`"),
        ]
        for description, words in mistakes:
            with self.assertRaisesRegex(Exception, words):
                mi.load_dict(description)
        script = "import mitsuba as mi; mi.set_variant('scalar_spectral'); import luthier_bsdf"
        done = subprocess.run([sys.executable, "-c", script], cwd=HERE, capture_output=True, text=True, check=False)
        self.assertNotEqual(done.returncode, 0)
        self.assertIn("set one that ends in _rgb", done.stderr)


class ChiSquare(unittest.TestCase):
    VIEWS = [(0, 0), (30, 40), (80, 200)]

    def test_draws_have_their_density(self):
        cases = [(name, view) for name in STACKS for view in self.VIEWS]
        for name, view in cases:
            with self.subTest(material=name, view=view):
                sample, pdf = BSDFAdapter("luthier", bsdf_of(name), wi=direction(*view))
                test = ChiSquareTest(SphericalDomain(), sample, pdf, sample_dim=3, sample_count=500_000, res=101, ires=8, seed=7)
                passed = test.run(test_count=len(cases), quiet=True)
                print(f"chi-square: {name} at {view[0]} degrees: p = {np.ravel(test.p_value)[0]:.3f}")
                self.assertTrue(passed, test.messages)

    def test_a_wrong_density_is_found(self):
        sample, pdf = BSDFAdapter("luthier", bsdf_of("metal"), wi=direction(30))
        _, other = BSDFAdapter("luthier", bsdf_of("metal"), wi=direction(33))
        test = ChiSquareTest(SphericalDomain(), sample, other, sample_dim=3, sample_count=500_000, res=101, ires=8, seed=7)
        self.assertFalse(test.run(quiet=True))


class Furnace(unittest.TestCase):
    """A disk under a white sky, seen from far away: what a path tracer finds is the directional albedo."""

    def test_albedo(self):
        worst = 0.0
        for name in STACKS:
            function = mi.load_dict(bsdf_of(name))
            for theta in (0.0, 45.0, 80.0):
                eye = direction(theta)
                scene = mi.load_dict({
                    "type": "scene",
                    "integrator": {"type": "path", "max_depth": 3},
                    "sky": {"type": "constant", "radiance": {"type": "rgb", "value": 1.0}},
                    "disk": {"type": "disk", "bsdf": function},
                    "sensor": {
                        "type": "perspective", "fov": 0.1,
                        "to_world": mi.ScalarTransform4f().look_at([20.0 * x for x in eye], [0, 0, 0], [0, 1, 0]),
                        "film": {"type": "hdrfilm", "width": 32, "height": 32, "rfilter": {"type": "box"}},
                    },
                })
                found = np.array(mi.render(scene, spp=512, seed=3)).mean(axis=(0, 1))
                expected = luthier.load(path_of(name)).albedo(eye)
                worst = max(worst, np.abs(found - expected).max())
                print(f"furnace: {name} at {theta:.0f} degrees: Mitsuba {np.round(found, 4)}, luthier {np.round(expected, 4)}")
                np.testing.assert_allclose(found, expected, atol=0.003)
        print(f"furnace: at most {worst:.4f} apart")


class Ball(unittest.TestCase):
    """The unit ball of `luthier preview --shape sphere`, under one sky."""

    # Mitsuba renders in passes: a million paths that are on their way take half a gigabyte.
    SIZE, SPP, PASSES, SIMULATED = 128, 128, 8, 2048

    @classmethod
    def setUpClass(cls):
        cls.pictures = os.environ.get("PICTURES") or folder.name
        os.makedirs(cls.pictures, exist_ok=True)
        cls.sky = os.path.join(folder.name, "sky.exr")
        mi.Bitmap(sky()).write(cls.sky)

    def preview(self, name, kind, *options):
        """The picture of the command, linear."""
        file = os.path.join(self.pictures, f"{name}-{kind}.exr")
        command = [os.environ["LUTHIER"], "preview", path_of(name), "-o", file, "--shape", "sphere", "--size", str(self.SIZE), "--environment", self.sky, *options]
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        self.assertEqual(done.returncode, 0, done.stderr)
        return np.array(mi.Bitmap(file).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, False))

    def scene(self, name):
        turned = mi.ScalarTransform4f().rotate([0, 1, 0], 180)
        eye = mi.ScalarTransform4f().look_at([0, 0, 7], [0, 0, 0], [0, 1, 0])
        return mi.load_dict({
            "type": "scene",
            "integrator": {"type": "path", "max_depth": 2, "hide_emitters": True},
            "sky": {"type": "envmap", "filename": self.sky, "to_world": turned},
            "ball": {"type": "sphere", "bsdf": bsdf_of(name)},
            "sensor": {
                # The picture shows 1.22 to each side of the centre, 7 away.
                "type": "perspective", "fov": 2.0 * np.degrees(np.arctan(1.22 / 7.0)), "to_world": eye,
                "film": {"type": "hdrfilm", "width": self.SIZE, "height": self.SIZE, "rfilter": {"type": "box"}, "pixel_format": "rgb"},
            },
        })

    def test_pictures(self):
        at = (np.arange(self.SIZE) + 0.5) / self.SIZE * 2.0 - 1.0
        # The rim, where a pixel has some of the background, is left out.
        is_ball = np.hypot(*np.meshgrid(at, at)) * 1.22 < 0.97 * 7.0 / np.sqrt(48.0)
        for name in STACKS:
            with self.subTest(name):
                scene, start = self.scene(name), time.process_time()
                picture = np.mean([np.array(mi.render(scene, spp=self.SPP, seed=k)) for k in range(self.PASSES)], axis=0).astype(np.float32)
                seconds = time.process_time() - start
                print(f"ball: {name}: Mitsuba took {seconds:.0f} s of processor time, {self.SIZE**2 * self.SPP * self.PASSES / seconds / 1e6:.2f} million paths a second")
                mi.Bitmap(picture).write(os.path.join(self.pictures, f"{name}-mitsuba.exr"))
                # By samples of the simulated layers, and by those of the model's shader.
                for kind, options in (("simulated", ["--simulated", str(self.SIMULATED)]), ("shader", ["--environment-samples", "256"])):
                    other = self.preview(name, kind, *options)
                    pixels = difference(picture, other)[is_ball]
                    # Pixels have the noise of both pictures, blocks a quarter of it.
                    blocks = difference(blocks_of(picture), blocks_of(other))[blocks_of(is_ball[..., None] * 1.0)[..., 0] == 1.0]
                    said = [f"median {np.median(off):.1f}, 95 % within {np.percentile(off, 95):.1f}" for off in (pixels, blocks)]
                    print(f"ball: {name} beside {kind}, in 1/255: {said[0]}; in blocks of 4 x 4 pixels {said[1]}")
                    sheet = np.concatenate([picture, other, 0.5 + 4.0 * (picture - other)], axis=1).astype(np.float32)
                    mi.util.write_bitmap(os.path.join(self.pictures, f"{name}-{kind}.png"), sheet, write_async=False)
                    self.assertLessEqual(np.median(pixels), MOST_PIXELS)
                    self.assertLessEqual(np.median(blocks), MOST_BLOCKS)


def difference(a, b):
    """The channel that is farthest of two pictures as a display shows them, in 1/255."""
    shown = [np.array(mi.Bitmap(picture.astype(np.float32)).convert(mi.Bitmap.PixelFormat.RGB, mi.Struct.Type.Float32, True)).clip(0.0, 1.0) for picture in (a, b)]
    return 255.0 * np.abs(shown[0] - shown[1]).max(axis=-1)


def blocks_of(picture, side=4):
    """Means of squares of pixels."""
    height, width, channels = picture.shape
    return picture.reshape(height // side, side, width // side, side, channels).mean(axis=(1, 3))


if __name__ == "__main__":
    unittest.main()
