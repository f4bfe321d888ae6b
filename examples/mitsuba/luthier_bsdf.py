"""A BSDF of Mitsuba 3 that shows a material of luthier. Import it once a variant is set: it registers the plugin `luthier`.

Mitsuba and luthier name directions the other way round: `si.wi` leads to the eye, which is luthier's `wo`, and Mitsuba's `wo` leads to the light, which is
luthier's `wi`. Both point away from the surface, in a frame whose z is the normal, and both values hold the cosine of the light's direction.
"""

import drjit as dr
import luthier
import mitsuba as mi
import numpy as np

if not (mi.variant() or "").endswith("_rgb"):
    raise ImportError(f"luthier_bsdf: the variant is {mi.variant()}; set one that ends in _rgb before the import, such as llvm_ad_rgb or scalar_rgb")

IS_JIT = not mi.variant().startswith("scalar")
if IS_JIT:
    # The values come from a library, which needs numbers: calls and loops are evaluated one after the other in place of being compiled together.
    for flag in (dr.JitFlag.SymbolicLoops, dr.JitFlag.SymbolicCalls, dr.JitFlag.SymbolicConditionals):
        dr.set_flag(flag, False)


def rows(directions):
    """Directions of Mitsuba as unit rows. Lanes that are off may hold anything: they look down, where luthier is dark."""
    found = np.array(directions, np.float64).T.reshape(-1, 3)
    length = np.linalg.norm(found, axis=1)
    is_off = ~(np.isfinite(length) & (length > 0.0))
    found[is_off], length[is_off] = [0.0, 0.0, -1.0], 1.0
    return found / length[:, None]


def numbers(values):
    """Numbers of luthier, one a lane, as a number of Mitsuba."""
    values = np.asarray(values).reshape(-1)
    return mi.Float(values.astype(np.float32)) if IS_JIT else float(values[0])


def spectrum(values):
    """Colours of luthier, one a lane, as a colour of Mitsuba."""
    return mi.Spectrum(*(numbers(channel) for channel in values.T))


class Luthier(mi.BSDF):
    """The plugin. Its properties:

    material: path of a material file.
    model: a reflectance model that `luthier models` lists; that of the material unless given.
    """

    def __init__(self, props):
        mi.BSDF.__init__(self, props)
        if "material" not in props:
            raise ValueError("luthier: the property `material` is missing: the path of a material file")
        self.material = luthier.load(str(mi.file_resolver().resolve(props["material"])))
        self.model = props.get("model", self.material.model)
        self.function = self.material.function(self.model)
        flags = mi.BSDFFlags.GlossyReflection | mi.BSDFFlags.FrontSide | mi.BSDFFlags.Anisotropic
        self.m_components = [flags]
        self.m_flags = flags

    def sample(self, ctx, si, sample1, sample2, active=True):
        bs = dr.zeros(mi.BSDFSample3f)
        if not ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0):
            return bs, mi.Spectrum(0.0)
        u = np.stack(np.broadcast_arrays(*(np.atleast_1d(np.array(x, np.float64)) for x in (sample1, sample2[0], sample2[1]))), axis=1)
        # The largest number below 1 of single precision: Mitsuba's numbers may be rounded up to 1.
        wi, weight, pdf = self.function.sample(rows(si.wi), np.clip(u, 0.0, 1.0 - 2.0**-24))
        bs.wo = mi.Vector3f(*(numbers(axis) for axis in wi.T))
        bs.pdf = dr.select(active, numbers(pdf), 0.0)
        bs.eta = 1.0
        bs.sampled_type = mi.UInt32(int(mi.BSDFFlags.GlossyReflection))
        bs.sampled_component = mi.UInt32(0)
        return bs, dr.select(bs.pdf > 0.0, spectrum(weight), 0.0)

    def eval(self, ctx, si, wo, active=True):
        if not ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0):
            return mi.Spectrum(0.0)
        return dr.select(active, spectrum(self.function.eval(rows(wo), rows(si.wi))), 0.0)

    def pdf(self, ctx, si, wo, active=True):
        if not ctx.is_enabled(mi.BSDFFlags.GlossyReflection, 0):
            return mi.Float(0.0)
        return dr.select(active, numbers(self.function.pdf(rows(wo), rows(si.wi))), 0.0)

    def eval_pdf(self, ctx, si, wo, active=True):
        return self.eval(ctx, si, wo, active), self.pdf(ctx, si, wo, active)

    def to_string(self):
        return f"Luthier[material = {self.material.name}, model = {self.model}]"


mi.register_bsdf("luthier", Luthier)
