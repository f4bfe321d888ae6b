"""Oracles in NumPy: closed forms of one interface, the white furnace, quadrature and random draws."""

import unittest

import numpy as np
from workshop import CHALK, LACQUER, METAL, hemisphere

import luthier


def refraction(n, cos_i):
    return np.sqrt(1.0 - (1.0 - cos_i**2) / n**2)


def fresnel(n, cos_i):
    """Unpolarised reflectance of a dielectric of index n in vacuum."""
    cos_t = refraction(n, cos_i)
    s = (cos_i - n * cos_t) / (cos_i + n * cos_t)
    p = (n * cos_i - cos_t) / (n * cos_i + cos_t)
    return 0.5 * (s * s + p * p)


def torrance_sparrow(alpha, reflectance, wi, wo):
    """F D G / (4 cos_theta_o) with GGX and V-cavities (Elek 2010, eq. 3), typed from the paper: f cos_theta_i."""
    h = wi + wo
    h = h / np.linalg.norm(h, axis=-1, keepdims=True)
    cos_h, cos_d = h[..., 2], np.sum(wi * h, axis=-1)
    density = alpha**2 / (np.pi * (cos_h**2 * (alpha**2 - 1.0) + 1.0) ** 2)
    masking = np.minimum(1.0, 2.0 * cos_h * np.minimum(wi[..., 2], wo[..., 2]) / cos_d)
    return reflectance(cos_d) * density * masking / (4.0 * wo[..., 2])


class ClosedForms(unittest.TestCase):
    def test_lambert(self):
        wi, wo = hemisphere(200, 1), hemisphere(200, 2)
        found = luthier.load(CHALK).eval(wi, wo, model="elek")
        expected = wi[:, 2:] * np.array([0.8, 0.5, 0.2]) / np.pi
        np.testing.assert_allclose(found, expected, rtol=1e-12)

    def test_metal_of_a_given_f0(self):
        wi, wo = hemisphere(200, 3), hemisphere(200, 4)
        found = luthier.load(METAL).eval(wi, wo, model="elek")
        for channel, f0 in enumerate([0.9, 0.6, 0.3]):
            expected = torrance_sparrow(0.4, lambda cos: f0 + (1.0 - f0) * (1.0 - cos) ** 5, wi, wo)
            np.testing.assert_allclose(found[:, channel], expected, rtol=1e-9)

    def test_glass_over_black(self):
        glass = {"schema": 1, "name": "glass", "layer": [{"type": "dielectric", "ior": 1.5, "alpha": 0.3}, {"type": "diffuse", "albedo": 0.0}]}
        wi, wo = hemisphere(200, 5), hemisphere(200, 6)
        found = luthier.load(glass).eval(wi, wo, model="elek", wavelength_nm=550.0)
        np.testing.assert_allclose(found, torrance_sparrow(0.3, lambda cos: fresnel(1.5, cos), wi, wo), rtol=1e-9)

    def test_absorbing_coat_over_a_diffuse_base(self):
        """One slab: T(i) T(o) exp(-tau (1/cos_i' + 1/cos_o')) albedo / pi cos_i, with T at the half vector (Elek 2010, eq. 2), plus the coat."""
        wi, wo = hemisphere(200, 7), hemisphere(200, 8)
        found = luthier.load(LACQUER).eval(wi, wo, model="elek", wavelength_nm=445.0)
        n, tau, albedo = 1.5, 0.5, 0.2
        h = wi + wo
        h = h / np.linalg.norm(h, axis=-1, keepdims=True)
        cos_d = np.sum(wi * h, axis=-1)
        through = 1.0 - fresnel(n, cos_d)
        masking = np.minimum(1.0, 2.0 * h[:, 2] * np.minimum(wi[:, 2], wo[:, 2]) / cos_d)
        path = 1.0 / refraction(n, wi[:, 2]) + 1.0 / refraction(n, wo[:, 2])
        left = (1.0 - masking) + through * masking
        base = wi[:, 2] * through * np.exp(-tau * path) * left * albedo / np.pi
        coat = torrance_sparrow(0.2, lambda cos: fresnel(n, cos), wi, wo)
        np.testing.assert_allclose(found, coat + base, rtol=1e-9)

    def test_reciprocity(self):
        wi, wo = hemisphere(100, 9), hemisphere(100, 10)
        lacquer = luthier.load(LACQUER)
        there, back = lacquer.eval(wi, wo, model="elek") / wi[:, 2:], lacquer.eval(wo, wi, model="elek") / wo[:, 2:]
        np.testing.assert_allclose(there, back, rtol=1e-12)

    def test_smooth_interface_by_the_closed_form(self):
        """The albedo of the simulation of smooth glass over black is Fresnel's reflectance."""
        glass = {"schema": 1, "name": "glass", "layer": [{"type": "dielectric", "ior": 1.5, "smooth": True}, {"type": "diffuse", "albedo": 0.0}]}
        theta = np.array([0.0, 45.0, 70.0])
        function = luthier.load(glass).function("layered-mc", wavelength_nm=550.0, samples=20000)
        values, errors = function.albedo_with_error(luthier.directions(theta))
        expected = fresnel(1.5, np.cos(np.radians(theta)))
        self.assertTrue(np.all(np.abs(values - expected) <= 5.0 * errors + 1e-12), f"{values} {errors} {expected}")


class Draws(unittest.TestCase):
    def stratified(self, side, seed=11):
        grid = np.stack(np.meshgrid(*[np.arange(side)] * 3, indexing="ij"), axis=-1).reshape(-1, 3)
        return (grid + np.random.default_rng(seed).uniform(size=grid.shape)) / side

    def test_means_of_weights_are_albedos(self):
        wo = luthier.directions(50.0, 20.0)
        for material, model in [(LACQUER, "elek"), (METAL, "elek"), (CHALK, "elek"), (LACQUER, "belcour"), (LACQUER, "phong"), (METAL, "microfacet")]:
            material = luthier.load(material)
            _, weight, pdf = material.sample(wo, self.stratified(48), model)
            self.assertTrue(np.all(pdf >= 0.0) and np.all(weight >= 0.0))
            np.testing.assert_allclose(weight.mean(axis=0), material.albedo(wo, model), rtol=1e-2, err_msg=f"{material.name} {model}")

    def test_weights_are_values_over_densities(self):
        lacquer, wo = luthier.load(LACQUER), luthier.directions(50.0, 20.0)
        wi, weight, pdf = lacquer.sample(wo, self.stratified(8), "elek")
        up = pdf > 0.0
        self.assertGreater(up.mean(), 0.9)
        np.testing.assert_allclose(np.linalg.norm(wi[up], axis=-1), 1.0, rtol=1e-12)
        np.testing.assert_allclose(lacquer.pdf(wi[up], wo), pdf[up], rtol=1e-6)
        np.testing.assert_allclose(lacquer.eval(wi[up], wo, "elek") / pdf[up, np.newaxis], weight[up], rtol=1e-6)
        self.assertTrue(np.all(weight[~up] == 0.0) and np.all(wi[~up] == 0.0))

    def test_densities_integrate_to_one(self):
        lacquer, wo = luthier.load(LACQUER), luthier.directions(50.0, 20.0)
        nodes, weights = np.polynomial.legendre.leggauss(400)
        cos, phi = 0.5 * (nodes + 1.0), np.arange(800) * 2.0 * np.pi / 800
        sin = np.sqrt(1.0 - cos * cos)[:, np.newaxis]
        wi = np.stack([sin * np.cos(phi), sin * np.sin(phi), np.broadcast_to(cos[:, np.newaxis], (400, 800))], axis=-1)
        integral = np.sum(0.5 * weights * lacquer.pdf(wi, wo).mean(axis=1)) * 2.0 * np.pi
        self.assertAlmostEqual(integral, 1.0, places=4)

    def test_albedos_are_means_of_values(self):
        """A uniform mean over the hemisphere, by Gauss and Legendre in the cosine and equal steps around."""
        lacquer, wo = luthier.load(LACQUER), luthier.directions([0.0, 30.0, 60.0])
        nodes, weights = np.polynomial.legendre.leggauss(200)
        cos, phi = 0.5 * (nodes + 1.0), np.arange(400) * 2.0 * np.pi / 400
        sin = np.sqrt(1.0 - cos * cos)[:, np.newaxis]
        wi = np.stack([sin * np.cos(phi), sin * np.sin(phi), np.broadcast_to(cos[:, np.newaxis], (200, 400))], axis=-1)
        values = lacquer.eval(wi[:, :, np.newaxis, :], wo, model="elek").mean(axis=1)
        expected = 2.0 * np.pi * np.tensordot(0.5 * weights, values, 1)
        np.testing.assert_allclose(lacquer.albedo(wo, model="elek"), expected, rtol=2e-4)


class Furnace(unittest.TestCase):
    def test_no_reference_gains_energy(self):
        """A white base under clear glass returns all light in the simulation."""
        white = {"schema": 1, "name": "white", "layer": [{"type": "dielectric", "ior": 1.5, "alpha": 0.3}, {"type": "diffuse", "albedo": 1.0}]}
        function = luthier.load(white).function("layered-mc", wavelength_nm=550.0, samples=20000)
        values, errors = function.albedo_with_error(luthier.directions([0.0, 40.0, 70.0]))
        self.assertTrue(np.all(np.abs(values - 1.0) <= 5.0 * errors + 2e-3), f"{values} {errors}")


if __name__ == "__main__":
    unittest.main()
