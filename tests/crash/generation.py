"""A reader of bakes that shares no code with luthier. It follows docs/manifest.md: a file in `.luthier-ready/` comes before its place.

    generation.py name FOLDER NAME=REFERENCE...   the name of the reference bake whose generation the folder holds, for two readers:
                                                  one that follows the rule, and one that does not know `.luthier-ready/`
    generation.py has FOLDER MANIFEST             fails where the folder lacks a file that this manifest names, or has it with other bytes
    generation.py tidy FOLDER                     fails where the folder holds a file that neither its manifest nor that of the generation before names
    generation.py watch FOLDER UNTIL NAME=REFERENCE...   reads until the file UNTIL exists, under the shared lock; prints how often it read
                                                  each, and fails where a read was mixed; `--no-lock` reads without
"""

import fcntl
import hashlib
import json
import os
import sys
import time

READY = ".luthier-ready"
BEFORE = ".luthier-before.json"


class Mixed(Exception):
    """A manifest whose files are not those that it names."""


def bytes_of(folder, path, knows_ready):
    ready = os.path.join(folder, READY, path)
    place = os.path.join(folder, path)
    try:
        with open(ready if knows_ready and os.path.lexists(ready) else place, "rb") as file:
            return file.read()
    except (FileNotFoundError, NotADirectoryError):
        return None


def entries(value):
    """All objects of a manifest that name a file with its hash."""
    if isinstance(value, dict):
        if isinstance(value.get("path"), str) and isinstance(value.get("sha256"), str):
            yield value
        for inner in value.values():
            yield from entries(inner)
    elif isinstance(value, list):
        for inner in value:
            yield from entries(inner)


def read(folder, knows_ready=True):
    """SHA-256 of the manifest, all of whose files were read and are whole; None where there is no bake."""
    manifest = bytes_of(folder, "manifest.json", knows_ready)
    if manifest is None:
        return None
    named = list(entries(json.loads(manifest)))
    if not named:
        raise Mixed("the manifest names no file")
    for entry in named:
        found = bytes_of(folder, entry["path"], knows_ready)
        if found is None:
            raise Mixed(f"{entry['path']} is missing")
        if hashlib.sha256(found).hexdigest() != entry["sha256"]:
            raise Mixed(f"{entry['path']} is of another generation")
    return hashlib.sha256(manifest).hexdigest()


def lacks(folder, manifest):
    """The files of a manifest that was read earlier which the folder does not have at their places."""
    with open(manifest, "rb") as file:
        named = list(entries(json.loads(file.read())))
    found = {entry["path"]: bytes_of(folder, entry["path"], False) for entry in named}
    is_whole = lambda e: found[e["path"]] is not None and hashlib.sha256(found[e["path"]]).hexdigest() == e["sha256"]
    return [entry["path"] for entry in named if not is_whole(entry)]


def unnamed(folder):
    """The files of a folder that no manifest there names."""
    manifests = ["manifest.json", BEFORE]
    named = set(manifests)
    for manifest in manifests:
        named.update(entry["path"] for entry in entries(json.loads(bytes_of(folder, manifest, False) or b"{}")))
    held = (os.path.relpath(os.path.join(at, file), folder) for at, _, files in os.walk(folder) for file in files)
    return sorted(set(held) - named)


def name(folder, known, knows_ready):
    try:
        found = read(folder, knows_ready)
    except Mixed:
        return "mixed"
    return "none" if found is None else known.get(found, "unknown")


def references(words):
    pairs = (word.split("=", 1) for word in words)
    return {read(folder): name for name, folder in pairs}


def watch(folder, until, known, locks):
    seen = dict.fromkeys([*known.values(), "none", "unknown", "mixed"], 0)
    last = False
    while True:
        # The last read is one after the end.
        last = os.path.exists(until)
        lock = os.open(folder, os.O_RDONLY)
        if locks:
            fcntl.flock(lock, fcntl.LOCK_SH)
        seen[name(folder, known, True)] += 1
        os.close(lock)
        if last:
            break
        time.sleep(0.001)
    print(" ".join(f"{name} {count}" for name, count in seen.items() if count or name == "mixed"))
    return 1 if locks and seen["mixed"] + seen["unknown"] else 0


def main(words):
    locks = "--no-lock" not in words
    words = [word for word in words if word != "--no-lock"]
    if words[0] == "name":
        known = references(words[2:])
        print(name(words[1], known, True), name(words[1], known, False))
        return 0
    if words[0] in ("has", "tidy"):
        wrong = lacks(words[1], words[2]) if words[0] == "has" else unnamed(words[1])
        print(*wrong, sep="\n", end="\n" if wrong else "", file=sys.stderr)
        return 1 if wrong else 0
    return watch(words[1], words[2], references(words[3:]), locks)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
