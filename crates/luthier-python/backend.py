"""The build of the wheel: that of maturin, after a look at what it needs, so that `pip install` names what is missing before it compiles for minutes."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

HERE = pathlib.Path(__file__).resolve().parent


def oldest_rust():
    """The version that Cargo.toml of the workspace states, or None where this is no part of it."""
    manifest = HERE.parent.parent / "Cargo.toml"
    found = re.search(r'^rust-version = "(\d+)\.(\d+)', manifest.read_text(encoding="utf-8"), re.MULTILINE) if manifest.exists() else None
    return found and (int(found[1]), int(found[2]))


def missing():
    """What the build cannot do without, in words, or None."""
    has_own_linker = any(name.endswith("_LINKER") for name in os.environ)
    if sys.platform.startswith("linux") and not has_own_linker and shutil.which("cc") is None:
        return "a linker is missing: there is no `cc`. On Debian and Ubuntu: apt-get install gcc libc6-dev"
    cargo, oldest = shutil.which("cargo"), oldest_rust()
    if cargo is None or oldest is None:
        # maturin fetches a toolchain where there is none.
        return None
    said = subprocess.run([cargo, "--version"], cwd=HERE, capture_output=True, text=True, check=False).stdout
    found = re.match(r"cargo (\d+)\.(\d+)", said)
    if found is None or (int(found[1]), int(found[2])) >= oldest:
        return None
    wanted = ".".join(map(str, oldest))
    return (
        f"{cargo} is of Rust {found[1]}.{found[2]}, and luthier needs {wanted} or later. Update it (`rustup update`), or take it off the PATH: "
        "the build fetches a toolchain where there is none"
    )


def checked(hook):
    """A hook of maturin that looks for what is missing first."""

    def run(*arguments, **named):
        reason = missing()
        if reason is not None:
            raise SystemExit(f"error: {reason}")
        import maturin

        return getattr(maturin, hook)(*arguments, **named)

    return run


for _hook in (
    "get_requires_for_build_wheel", "get_requires_for_build_editable", "get_requires_for_build_sdist", "prepare_metadata_for_build_wheel",
    "prepare_metadata_for_build_editable", "build_wheel", "build_editable", "build_sdist",
):
    globals()[_hook] = checked(_hook)
