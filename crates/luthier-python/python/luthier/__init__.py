"""Layered materials in Python: reflectance models, bakes, tables, audits and imports on NumPy arrays.

Directions are unit vectors of shape ``(..., 3)`` in the local frame: +z is the normal, and both the light's ``wi`` and the eye's ``wo`` point away from
the surface. Values are in double precision and those of the command ``luthier``. Functions that compute release the interpreter's lock and use all
cores; the variable RAYON_NUM_THREADS bounds them. Results do not depend on the number of threads.

    >>> import luthier
    >>> gold = luthier.load({"schema": 1, "name": "gold", "layer": [{"type": "conductor", "ior": "au", "alpha": 0.2}]})
    >>> wi, wo = luthier.directions([0.0, 30.0, 60.0]), luthier.directions(40.0, 180.0)
    >>> gold.eval(wi, wo, model="elek").shape
    (3, 3)
"""

from __future__ import annotations

import atexit
import json
import os
from collections.abc import Iterable, Mapping, Sequence
from typing import Any, Union

import numpy as np

from . import _checks, _luthier
from ._luthier import MaterialError, __version__
from ._toml import text_of

__all__ = [
    "Bake", "Function", "Imported", "Material", "MaterialError", "Table", "audit", "bake", "cache", "directions", "import_files", "load", "models",
    "table_cloth", "table_dfg", "table_energy", "table_film", "table_fresnel", "table_ltc", "table_sheen", "__version__",
]

Array = np.ndarray
"""An array of NumPy. Arguments may be all that ``numpy.asarray`` takes."""

PathLike = Union[str, "os.PathLike[str]"]
"""A path of a file or a folder."""


def load(source: PathLike | Mapping[str, Any], name: str = "<dict>") -> Material:
    """Reads a material.

    Args:
        source: the path of a material file, or a dict with the keys of one (docs/materials.md): ``{"schema": 1, "name": …, "layer": [{…}, …]}``, the
            topmost layer first. Numbers, lists and texts are as in TOML; arrays of NumPy count as lists.
        name: name of a dict in messages and manifests. Files that a dict names are relative to the folder of this name, so that of the process unless
            it has one.

    Raises:
        MaterialError: the material cannot be used. The text is that of ``luthier check``, with line, mistake and hint; the attribute
            ``diagnostics`` has a dict for each mistake (``file``, ``severity``, ``line``, ``column``, ``message``, ``hint``).
        OSError: the file cannot be read.
    """
    if isinstance(source, Mapping):
        return Material(_luthier.parse(text_of(source), name))
    return Material(_luthier.load(_checks.there(os.fspath(source))))


def directions(theta_deg: Any, phi_deg: Any = 0.0) -> Array:
    """Unit directions of angles.

    Args:
        theta_deg: angles from the normal, in degrees, of any shape.
        phi_deg: angles around the normal, in degrees; broadcast against ``theta_deg``.

    Returns:
        float64 of shape ``(..., 3)``, bit by bit the directions of the command.
    """
    theta, phi = np.broadcast_arrays(np.asarray(theta_deg, np.float64), np.asarray(phi_deg, np.float64))
    return _luthier.directions(np.ravel(theta), np.ravel(phi)).reshape(*theta.shape, 3)


def cache(folder: PathLike | None) -> None:
    """Keeps results of simulations and fits in a folder, which may be that of the command (``LUTHIER_CACHE``). Without a folder, and before the first call,
    they are kept in memory until the process ends.

    Raises:
        OSError: the folder can be neither made nor listed.
    """
    _luthier.cache(None if folder is None else os.fspath(folder))


# Counts what was written, and removes the oldest results where the folder is full.
atexit.register(_luthier.cache, None)


def models() -> list[dict[str, Any]]:
    """All reflectance models, as ``luthier models`` lists them.

    Returns:
        a dict for each: ``name``, ``kind`` (``surface``, ``layered``, ``place``, ``density``, ``reference``), ``source``, ``domain``, ``leaves_out``,
        ``reciprocal``, ``conserves_energy`` and ``inputs``.
    """
    return _luthier.models()


def _rows(array: Any, name: str) -> Array:
    array = np.asarray(array, np.float64)
    if array.ndim == 0 or array.shape[-1] != 3:
        raise ValueError(f"{name} has shape {array.shape}, expected (..., 3)")
    return array


def _broadcast(first: Any, second: Any, names: tuple[str, str]) -> tuple[Array, Array, tuple[int, ...]]:
    """Two arrays of rows of three, flat, and the shape of their pairs. A single row stays one."""
    arrays = _rows(first, names[0]), _rows(second, names[1])
    try:
        shape = np.broadcast_shapes(*(array.shape[:-1] for array in arrays))
    except ValueError:
        raise ValueError(f"{names[0]} of shape {arrays[0].shape} and {names[1]} of shape {arrays[1].shape} do not broadcast") from None
    flat = (array if array.size == 3 else np.broadcast_to(array, (*shape, 3)) for array in arrays)
    first, second = (np.ascontiguousarray(array).reshape(-1, 3) for array in flat)
    return first, second, shape


class Function:
    """A model of a material at one place, as a function of two directions. :meth:`Material.function` makes it.

    Where a result has a channel axis, it is the last: 3 channels of linear Rec.709 (D65), or none at a wavelength.
    """

    def __init__(self, raw: _luthier.Function) -> None:
        self._raw = raw

    def _shaped(self, flat: Array, shape: tuple[int, ...]) -> Array:
        return flat.reshape(*shape, 3) if self._raw.columns == 3 else flat.reshape(shape)

    def eval(self, wi: Any, wo: Any) -> Array:
        """The BRDF times the cosine of the incident direction, ``f cos_theta_i``, per steradian: as ``luthier eval``.

        Args:
            wi: directions to the light, shape ``(..., 3)``.
            wo: directions to the eye, shape ``(..., 3)``; both broadcast.

        Returns:
            float64 of shape ``(..., 3)``, or ``(...)`` at a wavelength. 0 where a direction is at or below the horizon, NaN where one has a NaN.

        Raises:
            ValueError: shapes that do not broadcast, or a direction that is not of length 1 (to 5e-5).
        """
        wi, wo, shape = _broadcast(wi, wo, ("wi", "wo"))
        return self._shaped(self._raw.eval(wi, wo), shape)

    def eval_with_error(self, wi: Any, wo: Any) -> tuple[Array, Array]:
        """:meth:`eval`, and the standard errors of models that are estimates: 0 for the others, inf where too few samples make most of the value."""
        wi, wo, shape = _broadcast(wi, wo, ("wi", "wo"))
        values, errors = self._raw.estimate(wi, wo)
        return self._shaped(values, shape), self._shaped(errors, shape)

    def albedo(self, wo: Any) -> Array:
        """Directional albedo: the integral of ``f cos_theta_i`` over all directions of light, as ``luthier eval --albedo``.

        Args:
            wo: directions to the eye, shape ``(..., 3)``.

        Returns:
            float64 of shape ``(..., 3)``, or ``(...)`` at a wavelength. By quadrature to 1e-4, unless a lobe is narrower than its finest points; models
            that are estimates include light that smooth interfaces mirror.
        """
        return self.albedo_with_error(wo)[0]

    def albedo_with_error(self, wo: Any) -> tuple[Array, Array]:
        """:meth:`albedo`, and how far each may be off: the change at the last doubling of the points of a quadrature, or a standard error."""
        wo = _rows(wo, "wo")
        values, errors = self._raw.albedo(np.ascontiguousarray(wo).reshape(-1, 3))
        return self._shaped(values, wo.shape[:-1]), self._shaped(errors, wo.shape[:-1])

    def sample(self, wo: Any, u: Any) -> tuple[Array, Array, Array]:
        """Directions of light, drawn in proportion to what the layers roughly reflect to the eye (Weidlich and Wilkie 2009, eq. 3.6), a tenth by a
        cosine. All models of a material have the same draws. The mean of ``weight`` over ``u`` is the albedo.

        Args:
            wo: directions to the eye, shape ``(..., 3)``.
            u: numbers from 0 up to 1, shape ``(..., 3)``: which part is drawn, then two for its direction; broadcast against ``wo``.

        Returns:
            ``wi``, shape ``(..., 3)``; ``weight``, ``f cos_theta_i`` over the density, shape ``(..., 3)``, or ``(...)`` at a wavelength; ``pdf``, the
            density per steradian, shape ``(...)``. All are 0 where a draw is below the horizon.
        """
        wo, u, shape = _broadcast(wo, u, ("wo", "u"))
        wi, weight, pdf = self._raw.sample(wo, u)
        return wi.reshape(*shape, 3), self._shaped(weight, shape), pdf.reshape(shape)

    def pdf(self, wi: Any, wo: Any) -> Array:
        """The density with which :meth:`sample` draws ``wi``, per steradian.

        Args:
            wi: directions to the light, shape ``(..., 3)``.
            wo: directions to the eye, shape ``(..., 3)``; both broadcast.

        Returns:
            float64 of shape ``(...)``; 0 where a direction is at or below the horizon.
        """
        wi, wo, shape = _broadcast(wi, wo, ("wi", "wo"))
        return self._raw.pdf(wi, wo).reshape(shape)


class Material:
    """A valid material. :func:`load` makes it.

    ``eval``, ``albedo``, ``sample`` and ``pdf`` are those of :class:`Function`; their keyword arguments are those of :meth:`function`. A material keeps its
    latest functions, so that repeated calls prepare nothing anew.
    """

    def __init__(self, raw: _luthier.Material) -> None:
        self._raw = raw
        self._functions: dict[str, Function] = {}

    def __reduce__(self) -> tuple[Any, ...]:
        # Copies and processes get the text; files that it names are read again.
        return _restored, (self.text, self.source)

    def __repr__(self) -> str:
        return f"<luthier.Material {self.name!r} of {self.layers} layers>"

    @property
    def name(self) -> str:
        """The name in the file."""
        return self._raw.name

    @property
    def source(self) -> str:
        """The file, as it was named."""
        return self._raw.source

    @property
    def text(self) -> str:
        """The text of the material file."""
        return self._raw.text

    @property
    def model(self) -> str:
        """Name of the model that a bake takes: that of the file, or the default for its layers."""
        return self._raw.model

    @property
    def layers(self) -> int:
        """Number of layers, a diffuse base included."""
        return self._raw.layers

    @property
    def warnings(self) -> list[dict[str, Any]]:
        """Warnings about the file, each as a dict (see :func:`load`)."""
        return self._raw.warnings

    def function(
        self,
        model: str | None = None,
        *,
        color: str = "material",
        wavelength_nm: float | None = None,
        effects: bool = True,
        uv: Sequence[float] | None = None,
        distance: float | None = None,
        normal: Sequence[float] | None = None,
        alpha_factor: float | None = None,
        slab_factor: float | None = None,
        film_factor: float | None = None,
        slope_variance: float | None = None,
        live: Mapping[str, float | Sequence[float]] | None = None,
        samples: int | None = None,
        seed: int | None = None,
    ) -> Function:
        """A model of the material at one place. The model ``lobes`` simulates and fits here, which takes seconds; others take little.

        Args:
            model: one of :func:`models`; that of the material unless given.
            color: ``spectral`` (D65 and the eye of 1931), ``three-wavelengths`` (those of the file), or ``material``, the mode of the file.
            wavelength_nm: one wavelength in place of a colour, 360 to 830.
            effects: whether flakes, patina, glitter and maps of the file count, as far as the model shows them.
            uv: texture coordinate of the place; (0, 0) unless given.
            distance: distance of the eye in scene units, for flakes that fade.
            normal: normal of the place, in the local frame.
            alpha_factor: factor on the slope parameters of all layers.
            slab_factor: factor on the thickness of the slab below the first interface.
            film_factor: factor on the thickness of the films on the first interface.
            slope_variance: variance, along either axis, of the slopes of the normals that a pixel sees.
            live: values of numbers that the file has under ``live``, such as ``{"layer.1.base_color": [0.8, 0.3, 0.1]}``; layers count from 0.
            samples: random samples per value, for models that are estimates; 4096 unless given.
            seed: which random numbers, for these.

        Raises:
            ValueError: an unknown name, an argument that the model does not take, or a material outside the domain of the model.
        """
        if wavelength_nm is not None and not 360.0 <= wavelength_nm <= 830.0:
            raise ValueError(f"wavelength_nm: expected a wavelength from 360 to 830 nm, found {wavelength_nm!r}")
        if wavelength_nm is not None and color != "material":
            raise ValueError("state either color or wavelength_nm")
        samples, seed = _checks.whole(samples, 1, "samples"), _checks.whole(seed, 0, "seed")
        numbers = [(*_live_key(key), np.ravel(np.asarray(value, np.float64)).tolist()) for key, value in (live or {}).items()]
        at = {
            "effects": effects, "uv": _tuple(uv, 2, "uv"), "distance": distance, "normal": _tuple(normal, 3, "normal"), "alpha_factor": alpha_factor,
            "slab_factor": slab_factor, "film_factor": film_factor, "slope_variance": slope_variance, "live": numbers, "samples": samples, "seed": seed,
        }
        key = repr((model, color, wavelength_nm, at))
        function = self._functions.get(key)
        if function is None:
            function = Function(_luthier.prepare(self._raw, model or self.model, color, wavelength_nm, at))
            while len(self._functions) >= _KEPT:
                self._functions.pop(next(iter(self._functions)), None)
            self._functions[key] = function
        return function

    def eval(self, wi: Any, wo: Any, model: str | None = None, **at: Any) -> Array:
        """:meth:`Function.eval` of :meth:`function`: ``f cos_theta_i`` per steradian for ``wi`` and ``wo`` of shape ``(..., 3)``, shape ``(..., 3)``."""
        return self.function(model, **at).eval(wi, wo)

    def albedo(self, wo: Any, model: str | None = None, **at: Any) -> Array:
        """:meth:`Function.albedo` of :meth:`function`: directional albedo for ``wo`` of shape ``(..., 3)``, shape ``(..., 3)``."""
        return self.function(model, **at).albedo(wo)

    def sample(self, wo: Any, u: Any, model: str | None = None, **at: Any) -> tuple[Array, Array, Array]:
        """:meth:`Function.sample` of :meth:`function`: ``wi``, ``weight`` and ``pdf`` for ``wo`` and ``u`` of shape ``(..., 3)``."""
        return self.function(model, **at).sample(wo, u)

    def pdf(self, wi: Any, wo: Any, model: str | None = None, **at: Any) -> Array:
        """:meth:`Function.pdf` of :meth:`function`: density per steradian for ``wi`` and ``wo`` of shape ``(..., 3)``, shape ``(...)``."""
        return self.function(model, **at).pdf(wi, wo)


def _restored(text: str, source: str) -> Material:
    return Material(_luthier.parse(text, source))


_KEPT = 16
"""Functions that a material keeps."""


def _tuple(values: Sequence[float] | None, count: int, name: str) -> tuple[float, ...] | None:
    if values is None:
        return None
    found = tuple(float(value) for value in np.atleast_1d(values))
    if len(found) != count or not np.isfinite(found).all():
        raise ValueError(f"{name}: expected {count} numbers, found {found}")
    return found


def _live_key(key: str) -> tuple[int, str]:
    parts = key.split(".")
    if len(parts) != 3 or parts[0] != "layer" or not parts[1].isdigit():
        raise ValueError(f"live: expected a key such as layer.1.base_color, found {key}")
    return int(parts[1]), parts[2]


class Bake:
    """Tables, shaders and a manifest of some materials, in memory. :func:`bake` makes it.

    Attributes:
        manifest: the manifest as a dict (docs/manifest.md).
        tables: texels of each table as a shader reads them, by kind: float32 of shape ``(height, width, channels)``.
        shaders: text of each shader by file name, such as ``baked.wgsl``; SPIR-V as bytes.
        files: bytes of all files but the manifest, by path in the folder.
        warnings: warnings, as the command prints them.
    """

    manifest: dict[str, Any]
    tables: dict[str, Array]
    shaders: dict[str, str | bytes]
    files: dict[str, bytes]
    warnings: list[str]

    def __init__(self, raw: _luthier.Baked) -> None:
        self._raw = raw
        self.manifest = json.loads(raw.manifest)
        self.tables = raw.tables(False)
        self.files = raw.files()
        self.warnings = raw.warnings
        shaders = {path.removeprefix("shaders/"): data for path, data in self.files.items() if path.startswith("shaders/")}
        self.shaders = {name: data if name.endswith(".spv") else data.decode() for name, data in shaders.items()}

    def unrounded(self) -> dict[str, Array]:
        """Texels of the tables before they were rounded to their formats: float32 of shape ``(height, width, channels)``."""
        return self._raw.tables(True)

    def write(self, folder: PathLike) -> None:
        """Publishes the bake in a folder, as ``luthier bake --out`` does: the folder changes at once or not at all."""
        self._raw.write(os.fspath(folder))


def bake(
    materials: Material | Iterable[Material],
    out: PathLike | None = None,
    *,
    model: str | None = None,
    no_fit: bool = False,
    forms: str | Sequence[str] = (),
    targets: str | Sequence[str] = ("wgsl", "glsl450", "glsl-es300"),
    functions: str | Sequence[str] = (),
    tables: str | Sequence[str] = (),
) -> Bake:
    """Bakes materials: the tables that their models need, and shaders that read these.

    Args:
        materials: a material, or some whose names differ.
        out: a folder where the bake is published; none unless given.
        model: the model of all materials in place of those of the files.
        no_fit: True where nothing may be simulated: materials that name no model take one in closed form.
        forms: forms of the shaders, ``baked`` and ``full``; all that the models have unless given.
        targets: languages of the shaders, as for ``luthier bake --target``.
        functions: groups of functions beside ``eval``, as for ``luthier bake --functions``.
        tables: kinds of tables to bake beside those that shaders read.

    Raises:
        MaterialError: materials that cannot be baked, or not together.
        OSError: the folder cannot be written.
    """
    raw = [material._raw for material in _checks.listed(materials, Material, "materials")]
    words = {"forms": forms, "targets": targets, "functions": functions, "tables": tables}
    asked = {"model": model, "no_fit": no_fit, **{name: _checks.listed(some, str, name) for name, some in words.items()}}
    made = Bake(_luthier.bake(raw, asked))
    if out is not None:
        made.write(out)
    return made


def audit(
    table: PathLike | Any,
    *,
    preset: str | None = None,
    model: str | None = None,
    axes: str | None = None,
    nodes: str | None = None,
    values: Sequence[str] | None = None,
    channels: Sequence[int] | None = None,
    ior: str | float | complex | None = None,
    min_cos: float = 0.01,
    min_alpha: float = 0.0025,
    max_error: float = 0.05,
) -> dict[str, Any]:
    """Judges a table of another program, as ``luthier audit`` does: is it as stated, or which mistakes explain it better.

    Args:
        table: a file (DDS, KTX2, EXR, PNG, Radiance HDR), or texels of shape ``(height, width, channels)`` or ``(height, width)``, the first row on top.
            uint8 and uint16 count as fractions of 255 and 65535; float16, float32 and float64 as they are.
        preset: model, axes, nodes and values of an engine; other arguments override it (docs/audit.md lists the names).
        model: the function that the table should hold, such as ``ggx-correlated``, ``ggx-ndf`` or ``fresnel``.
        axes: axes of the table, the one across first: ``cos_theta,roughness``; ``-`` before one that falls.
        nodes: ``centres`` of texels, or ``ends``.
        values: content of each channel: ``scale``, ``bias``, ``albedo``, ``red``, ``green``, ``blue``, ``scaled-d``, ``d``.
        channels: channels to read, from 0, in the order of ``values``.
        ior: index of the medium below: a data set of ``luthier ior``, n, or n + kj.
        min_cos: errors at lower cosines do not count.
        min_alpha: errors at lower slope parameters do not count.
        max_error: largest error that is forgiven.

    Returns:
        a dict: ``held`` (whether it is as stated within ``max_error``), ``line`` (the verdict in words), ``stated``, ``format``, ``notes``, ``max_error``
        and ``audit`` (all that was found).
    """
    if isinstance(ior, complex):
        ior = f"{ior.real!r},{ior.imag!r}"
    names = {
        "preset": preset, "model": model, "axes": axes, "nodes": nodes, "values": None if values is None else list(values),
        "channels": None if channels is None else list(channels), "ior": None if ior is None else str(ior), "min_cos": min_cos, "min_alpha": min_alpha,
    }
    if isinstance(table, (str, os.PathLike)):
        return json.loads(_luthier.audit(os.fspath(table), names, max_error))
    return json.loads(_luthier.audit(_texels(table), names, max_error))


def _texels(table: Any) -> tuple[Array, str]:
    """Texels in single precision, and the type of their samples."""
    table = np.asarray(table)
    if table.ndim == 2:
        table = table[..., np.newaxis]
    if table.ndim != 3 or not 1 <= table.shape[2] <= 4 or 0 in table.shape:
        raise ValueError(f"table has shape {table.shape}, expected (height, width, channels) with 1 to 4 channels")
    samples = {"uint8": ("unorm8", 255.0), "uint16": ("unorm16", 65535.0), "float16": ("half", 1.0)}
    kind, largest = samples.get(table.dtype.name, ("float", 1.0))
    return np.ascontiguousarray(table.astype(np.float64) / largest, np.float32), kind


class Table:
    """A table that engines read beside a material.

    Attributes:
        texels: float32 of shape ``(height, width, channels)``, the first row on top; slices of a third axis lie one below the other.
        about: axes, values, size and error as a dict. ``about["error"]`` is that of reads as a sampler makes them, against quadrature.
    """

    texels: Array
    about: dict[str, Any]

    def __init__(self, raw: tuple[Array, str]) -> None:
        self.texels = raw[0]
        self.about = json.loads(raw[1])


def table_dfg(
    preset: str | None = None,
    *,
    max_abs: float | None = None,
    distribution: str | None = None,
    masking: str | None = None,
    size: tuple[int, int] | None = None,
    min_cos: float = 0.01,
    min_alpha: float = 0.01,
) -> Table:
    """The split sum of image-based lighting, also called DFG: that of an engine, or the smallest in half floats that holds an error.

    Args:
        preset: an engine, as for ``luthier table dfg --preset``.
        max_abs: largest error of a search, where no preset is given. ``about["held"]`` says whether it is held.
        distribution: ``ggx`` (unless given) or ``beckmann``, for a search.
        masking: the masking term, for a search; ``correlated`` unless given.
        size: texels across and down, 4 to 1024 each, in place of those of the preset.
        min_cos: errors at lower cosines do not count.
        min_alpha: errors at lower slope parameters do not count.
    """
    if (preset is None) == (max_abs is None):
        raise ValueError("state either a preset or max_abs")
    if preset is not None and not (distribution is None and masking is None):
        raise ValueError("a preset has a distribution and a masking term of its own: leave them out, or state max_abs")
    if preset is None and size is not None:
        raise ValueError("size: a search finds its own, leave it out, or state a preset")
    limit = np.inf if max_abs is None else _checks.positive(max_abs, "max_abs")
    size = None if size is None else _checks.sides(size, 2, 4)
    return Table(_luthier.table_dfg(preset, limit, distribution or "ggx", masking or "correlated", size, _lowest(min_cos, min_alpha)))


def _lowest(min_cos: float, min_alpha: float) -> tuple[float, float]:
    return _checks.share(min_cos, "min_cos"), _checks.share(min_alpha, "min_alpha")


def table_cloth(
    visibility: str = "neubelt",
    *,
    axes: str = "cos_theta,roughness",
    nodes: str = "ends",
    size: tuple[int, int] = (32, 32),
    min_cos: float = 0.01,
    min_alpha: float = 0.01,
) -> Table:
    """The directional albedo of Charlie's cloth, in floats. ``visibility`` is ``neubelt`` or ``estevez-kulla``; ``size`` is texels across and down."""
    return Table(_luthier.table_cloth(visibility, axes, nodes, _checks.sides(size, 2, 4), _lowest(min_cos, min_alpha)))


def table_energy(preset: str, *, min_cos: float = 0.01, min_alpha: float = 0.01) -> dict[str, Table]:
    """The tables of energy compensation of a renderer, by name, as ``luthier table energy --preset``."""
    return {name: Table(raw) for name, raw in _luthier.table_energy(preset, _lowest(min_cos, min_alpha))}


def table_film(
    film: complex,
    base: complex,
    *,
    above: float = 1.0,
    axes: str = "cos_theta,thickness_nm=0..1000",
    nodes: str = "ends",
    size: tuple[int, int] = (32, 128),
    three_wavelengths: bool = False,
    min_cos: float = 0.01,
) -> Table:
    """The colour (linear Rec.709) that a plane reflects under a thin film, over angle and thickness. Indices are n + kj; ``size`` is texels across and down."""
    pairs = _checks.index(film, "film"), _checks.index(base, "base")
    above, size, min_cos = _checks.positive(above, "above"), _checks.sides(size, 2, 4), _checks.share(min_cos, "min_cos")
    return Table(_luthier.table_film(*pairs, above, axes, nodes, size, three_wavelengths, min_cos))


def table_fresnel(
    *, axes: str = "cos_theta,ior_n,ior_k", nodes: str = "ends", size: tuple[int, int, int] = (128, 32, 32), min_cos: float = 0.01
) -> Table:
    """The reflectance of a smooth plane of any index in air, over angle, n and k."""
    return Table(_luthier.table_fresnel(axes, nodes, _checks.sides(size, 3, 2), _checks.share(min_cos, "min_cos")))


def table_ltc(distribution: str = "ggx", *, masking: str = "correlated") -> tuple[Table, Table]:
    """Linearly transformed cosines of a rough metal for area lights: the matrices, and the norms. ``masking`` is ``correlated`` or ``separable``."""
    matrices, norms = _luthier.table_ltc(distribution, masking)
    return Table(matrices), Table(norms)


def table_sheen() -> Table:
    """Linearly transformed cosines of a layer of fibres: ``a``, ``b`` and albedo over cosine and slope parameter."""
    return Table(_luthier.table_sheen())


class Imported:
    """Materials of other formats as material files. :func:`import_files` makes it.

    Attributes:
        files: bytes of material files and pictures, by path relative to one folder.
        report: what became of each property, as the file ``import.json`` of the command.
    """

    files: dict[str, bytes]
    report: dict[str, Any]

    def __init__(self, files: dict[str, bytes], report: dict[str, Any]) -> None:
        self.files, self.report = files, report

    @property
    def texts(self) -> dict[str, str]:
        """Texts of the material files by name of the material."""
        return {path.removesuffix(".toml"): data.decode() for path, data in self.files.items() if path.endswith(".toml")}

    def write(self, folder: PathLike, force: bool = False) -> list[str]:
        """Writes all files and ``import.json`` into a folder, and returns the paths of the material files. Nothing is written where one of the files is
        there already, unless ``force``."""
        report = (json.dumps(self.report, indent=2, ensure_ascii=False) + "\n").encode()
        places = {os.path.join(folder, path): data for path, data in (*self.files.items(), ("import.json", report))}
        there = [path for path in places if os.path.lexists(path)]
        if there and not force:
            raise FileExistsError(f"{there[0]} is there already; nothing was written")
        for path, data in places.items():
            os.makedirs(os.path.dirname(path) or ".", exist_ok=True)
            with open(path, "wb") as file:
                file.write(data)
        return [path for path in places if path.endswith(".toml")]


def import_files(paths: PathLike | Iterable[PathLike], out: PathLike | None = None, *, root: PathLike | None = None, force: bool = False) -> Imported:
    """Material files from glTF, MaterialX and physicallybased.info, as ``luthier import`` makes them.

    Args:
        paths: a file, or some.
        out: a folder to write into, see :meth:`Imported.write`.
        root: the folder that has all that the files name; that of each file unless given.
        force: whether files that are there are replaced.

    Raises:
        ValueError: a file that is none of these formats.
        OSError: a file that cannot be read or written.
    """
    paths = [_checks.there(os.fspath(path)) for path in _checks.listed(paths, (str, os.PathLike), "paths")]
    files, report = _luthier.import_files(paths, None if root is None else os.fspath(root))
    imported = Imported({path: bytes(data) for path, data in files.items()}, json.loads(report))
    if out is not None:
        imported.write(out, force)
    return imported
