"""The build of the wheel says what is missing, before it compiles."""

import importlib.util
import os
import pathlib
import sys
import tempfile
import unittest
from unittest import mock

BACKEND = pathlib.Path(__file__).resolve().parents[1] / "backend.py"


def backend():
    specification = importlib.util.spec_from_file_location("backend", BACKEND)
    module = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(module)
    return module


class Backends(unittest.TestCase):
    def missing(self, **programs):
        """What is missing where the path has these programs, each with what it prints."""
        with tempfile.TemporaryDirectory() as folder:
            for name, says in programs.items():
                program = pathlib.Path(folder, name)
                program.write_text(f"#!/bin/sh\necho '{says}'\n")
                program.chmod(0o755)
            with mock.patch.dict(os.environ, {"PATH": folder}, clear=True):
                return backend().missing()

    @unittest.skipUnless(sys.platform.startswith("linux"), "the linker of Linux")
    def test_no_linker(self):
        self.assertRegex(self.missing(cargo="cargo 1.999.0"), "no `cc`.*apt-get install gcc")

    def test_an_old_rust(self):
        said = self.missing(cc="", cargo="cargo 1.63.0 (fd9c4297c 2022-07-01)")
        self.assertRegex(said, r"cargo is of Rust 1\.63, and luthier needs 1\.\d+ or later")

    def test_nothing_is_missing(self):
        self.assertIsNone(self.missing(cc=""))
        self.assertIsNone(self.missing(cc="", cargo="cargo 1.999.0 (0123 2030-01-01)"))
        self.assertIsNone(self.missing(cc="", cargo="cargo 2.0.0-nightly"))

    def test_a_hook_ends_with_the_reason(self):
        module = backend()
        with mock.patch.object(module, "missing", lambda: "glue"), self.assertRaisesRegex(SystemExit, "error: glue"):
            module.build_wheel("nowhere")


if __name__ == "__main__":
    unittest.main()
