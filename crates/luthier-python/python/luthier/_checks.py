"""Values that the functions take, with the limits of the command's options. A value beyond them is a ``ValueError`` that begins with its name."""

from __future__ import annotations

import errno
import math
import os
from collections.abc import Iterable, Sequence
from typing import Any

ROWS_MAX = 8192
"""Most rows of all slices of a table together: what every device takes as a side of a texture."""


def listed(value: Any, kind: type | tuple[type, ...], name: str) -> list[Any]:
    """One value, or some, as a list; each is of a type."""
    values = [value] if isinstance(value, kind) else list(value) if isinstance(value, Iterable) else [value]
    for one in values:
        if not isinstance(one, kind):
            wanted = kind[0] if isinstance(kind, tuple) else kind
            raise TypeError(f"{name}: expected {wanted.__name__}, found {type(one).__name__}")
    return values


def sides(size: Sequence[int], count: int, least: int, name: str = "size") -> tuple[int, ...]:
    """Texels along the axes of a table: ``least`` to 1024 each."""
    found = tuple(size) if isinstance(size, Iterable) else (size,)
    if len(found) != count or not all(_is_whole(side) and least <= side <= 1024 for side in found):
        raise ValueError(f"{name}: expected {count} whole numbers from {least} to 1024, found {size!r}")
    if count == 3 and found[1] * found[2] > ROWS_MAX:
        raise ValueError(f"{name}: {found[1]} x {found[2]} rows lie one below the other, and a texture has {ROWS_MAX} at most")
    return tuple(int(side) for side in found)


def index(value: complex, name: str) -> tuple[float, float]:
    """An index of refraction, n + kj."""
    n, k = complex(value).real, complex(value).imag
    if not (0.0 < n <= 100.0 and 0.0 <= k <= 100.0):
        raise ValueError(f"{name}: expected an index of refraction n + kj, n above 0 and k from 0, found {value!r}")
    return n, k


def positive(value: float, name: str) -> float:
    """A number above 0."""
    if not (math.isfinite(value) and value > 0.0):
        raise ValueError(f"{name}: expected a positive number, found {value!r}")
    return float(value)


def share(value: float, name: str) -> float:
    """A number from 0 up to 1."""
    if not 0.0 <= value < 1.0:
        raise ValueError(f"{name}: expected a number from 0 up to 1, found {value!r}")
    return float(value)


def whole(value: Any, least: int, name: str) -> int | None:
    """A whole number of at most 64 bits, or none."""
    if value is not None and not (_is_whole(value) and least <= value < 2**64):
        raise ValueError(f"{name}: expected a whole number from {least} up, found {value!r}")
    return value if value is None else int(value)


def there(path: str) -> str:
    """A path of something that exists."""
    if not os.path.exists(path):
        raise FileNotFoundError(errno.ENOENT, os.strerror(errno.ENOENT), path)
    return path


def _is_whole(value: Any) -> bool:
    try:
        return not isinstance(value, bool) and value == int(value)
    except (TypeError, ValueError, OverflowError):
        return False
