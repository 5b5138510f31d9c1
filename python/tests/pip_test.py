"""pip install . gives a package that works outside of the source tree.

    pip_test.py BUILD_FOLDER      takes the extension module from a finished build
"""

import os
import pathlib
import subprocess
import sys
import tempfile

root = pathlib.Path(__file__).resolve().parents[2]
with tempfile.TemporaryDirectory() as folder:
    environment = {**os.environ, "LOBELIA_BUILD": sys.argv[1], "PIP_DISABLE_PIP_VERSION_CHECK": "1"}
    environment.pop("PYTHONPATH", None)
    subprocess.run(
        [sys.executable, "-m", "pip", "install", "--quiet", "--no-build-isolation", "--no-deps", "--no-index",
         "--target", folder, str(root)],
        check=True, env=environment)
    code = """
import lobelia, pathlib
codec = lobelia.Codec("sh2/least-squares/convolution")
print(lobelia.__version__, codec.encode(lobelia.Environment.sky((64, 32))).shape)
assert (pathlib.Path(lobelia.__file__).parent / "py.typed").exists()
"""
    printed = subprocess.run([sys.executable, "-c", code], check=True, env={**environment, "PYTHONPATH": folder},
                             cwd=folder, capture_output=True, text=True).stdout
    metadata = next(pathlib.Path(folder).glob("lobelia-*.dist-info/METADATA")).read_text()
    version = printed.split()[0]
    assert f"\nVersion: {version}\n" in metadata, metadata
    assert f"version: {version}\n" in (root / "CITATION.cff").read_text()
    print(printed, end="")
