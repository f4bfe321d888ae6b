"""The stub of the extension module says what is there, and everything public has a docstring."""

import ast
import doctest
import inspect
import pathlib
import unittest

import luthier
from luthier import _luthier

STUB = pathlib.Path(luthier.__file__).with_name("_luthier.pyi")


def arguments(node):
    return [argument.arg for argument in node.args.args if argument.arg != "self"]


def parameters(function):
    return [name for name in inspect.signature(function).parameters if name != "self"]


class Stubs(unittest.TestCase):
    def setUp(self):
        self.tree = ast.parse(STUB.read_text())

    def test_names_agree(self):
        defined = {node.name for node in self.tree.body if isinstance(node, (ast.FunctionDef, ast.ClassDef))}
        there = {name for name in dir(_luthier) if not name.startswith("__")}
        self.assertEqual(defined, there)

    def test_functions_agree(self):
        for node in self.tree.body:
            if isinstance(node, ast.FunctionDef):
                self.assertEqual(arguments(node), parameters(getattr(_luthier, node.name)), node.name)

    def test_classes_agree(self):
        for node in self.tree.body:
            if not isinstance(node, ast.ClassDef) or node.name == "MaterialError":
                continue
            found = getattr(_luthier, node.name)
            own = {member.name: member for member in node.body if isinstance(member, ast.FunctionDef)}
            self.assertEqual(set(own), {name for name in vars(found) if not name.startswith("__")}, node.name)
            for name, member in own.items():
                is_property = any(isinstance(decorator, ast.Name) and decorator.id == "property" for decorator in member.decorator_list)
                self.assertEqual(is_property, inspect.isgetsetdescriptor(vars(found)[name]), f"{node.name}.{name}")
                if not is_property:
                    self.assertEqual(arguments(member), parameters(vars(found)[name]), f"{node.name}.{name}")


class Documentation(unittest.TestCase):
    def test_all_that_is_public_has_a_docstring(self):
        for name in luthier.__all__:
            found = getattr(luthier, name)
            if name == "__version__":
                continue
            self.assertTrue(inspect.getdoc(found), name)
            if inspect.isclass(found) and name != "MaterialError":
                for member, value in vars(found).items():
                    if not member.startswith("_") and (callable(value) or isinstance(value, property)):
                        self.assertTrue(inspect.getdoc(value), f"{name}.{member}")

    def test_the_package_is_typed(self):
        self.assertTrue(STUB.with_name("py.typed").exists())

    def test_the_readme_names_all_functions(self):
        readme = pathlib.Path(__file__).resolve().parents[1] / "README.md"
        text = readme.read_text()
        for name in luthier.__all__:
            if name != "__version__":
                self.assertIn(name, text, name)

    def test_samples_of_the_readme_run(self):
        readme = pathlib.Path(__file__).resolve().parents[1] / "README.md"
        for block in readme.read_text().split("```python\n")[1:]:
            code = block.split("```", 1)[0]
            with self.subTest(code=code.splitlines()[0]):
                exec(compile(code, str(readme), "exec"), {})

    def test_docstrings_run(self):
        failed, run = doctest.testmod(luthier)
        self.assertEqual(failed, 0)
        self.assertGreater(run, 0)


if __name__ == "__main__":
    unittest.main()
