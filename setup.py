"""Builds the extension module of the Python package by CMake; pyproject.toml has the rest."""

import os
import pathlib
import re
import shutil
import subprocess
import sys

from setuptools import Extension, setup
from setuptools.command.build_ext import build_ext

ROOT = pathlib.Path(__file__).resolve().parent


def version():
    """The version, from its one place."""
    return re.search(r"project\(lobelia VERSION ([0-9.]+)", (ROOT / "CMakeLists.txt").read_text()).group(1)


class BuildByCMake(build_ext):
    """Builds in a temporary folder, or takes the module from the build folder that LOBELIA_BUILD names."""

    def build_extension(self, extension):
        build = os.environ.get("LOBELIA_BUILD")
        if build is None:
            build = pathlib.Path(self.build_temp).resolve()
            options = ["-DCMAKE_BUILD_TYPE=Release", "-DLOBELIA_PYTHON=ON", "-DLOBELIA_TESTS=OFF", "-DLOBELIA_BENCH=OFF",
                       f"-DPython_EXECUTABLE={sys.executable}"]
            subprocess.run(["cmake", "-S", ROOT, "-B", build, "-G", "Ninja", *options], check=True)
            subprocess.run(["cmake", "--build", build, "--target", "lobelia_python"], check=True)
        module, = (pathlib.Path(build) / "python" / "lobelia").glob("_native*.so")
        target = pathlib.Path(self.get_ext_fullpath(extension.name))
        target.parent.mkdir(parents=True, exist_ok=True)
        shutil.copyfile(module, target)


setup(version=version(), ext_modules=[Extension("lobelia._native", sources=[])], cmdclass={"build_ext": BuildByCMake})
