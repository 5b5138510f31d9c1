"""The type stubs name what the module has, member by member; everything public is documented."""

import ast
import pathlib
import unittest

import lobelia

STUB = ast.parse((pathlib.Path(lobelia.__file__).parent / "__init__.pyi").read_text())


def is_public(name):
    return not name.startswith("_")


def names_of(body):
    """Public names that a module or class of the stub declares."""
    names = set()
    for node in body:
        if isinstance(node, (ast.ClassDef, ast.FunctionDef)):
            names.add(node.name)
        elif isinstance(node, ast.AnnAssign):
            names.add(node.target.id)
    return set(filter(is_public, names))


class Stubs(unittest.TestCase):
    def test_module(self):
        self.assertEqual(names_of(STUB.body), set(filter(is_public, lobelia.__all__)))

    def test_classes(self):
        for node in STUB.body:
            if isinstance(node, ast.ClassDef) and node.name != "Error":
                members = set(filter(is_public, vars(getattr(lobelia, node.name))))
                self.assertEqual(names_of(node.body), members, node.name)

    def test_keywords_of_bake(self):
        import inspect

        stub = next(n for n in STUB.body if isinstance(n, ast.FunctionDef) and n.name == "bake")
        arguments = [a.arg for a in stub.args.args + stub.args.kwonlyargs]
        self.assertEqual(arguments, list(inspect.signature(lobelia.bake).parameters))

    def test_docstrings(self):
        for name in filter(is_public, lobelia.__all__):
            self.assertTrue(getattr(lobelia, name).__doc__, name)


if __name__ == "__main__":
    unittest.main()
