"""Dicts as the text of a material file."""

from __future__ import annotations

import json
from typing import Any, Mapping


def text_of(material: Mapping[str, Any]) -> str:
    """The TOML text of a dict: numbers and texts first, then tables, then lists of tables, each key on a line of its own."""
    return "".join(_lines(material, ()))


def _is_tables(value: Any) -> bool:
    return isinstance(value, (list, tuple)) and bool(value) and all(isinstance(item, Mapping) for item in value)


def _lines(table: Mapping[str, Any], path: tuple[str, ...]):
    for key, value in table.items():
        if not isinstance(value, Mapping) and not _is_tables(value):
            yield f"{_key(key)} = {_value(value)}\n"
    for key, value in table.items():
        name = ".".join(_key(part) for part in (*path, key))
        if isinstance(value, Mapping):
            yield f"\n[{name}]\n"
            yield from _lines(value, (*path, key))
        elif _is_tables(value):
            for item in value:
                yield f"\n[[{name}]]\n"
                yield from _lines(item, (*path, key))


def _key(key: str) -> str:
    is_bare = key and all(letter.isascii() and (letter.isalnum() or letter in "_-") for letter in key)
    return key if is_bare else json.dumps(key)


def _value(value: Any) -> str:
    # Numbers of NumPy are those of Python, and arrays lists.
    value = value.tolist() if hasattr(value, "tolist") else value
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False)
    if isinstance(value, Mapping):
        return "{ " + ", ".join(f"{_key(key)} = {_value(item)}" for key, item in value.items()) + " }"
    if isinstance(value, (list, tuple)):
        return "[" + ", ".join(_value(item) for item in value) + "]"
    raise TypeError(f"a material has no {type(value).__name__}: {value!r}")
