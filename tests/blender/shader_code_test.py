#!/usr/bin/env python3
"""The Blender add-on's translation of shader code: run with numbers, it gives what `lobelia eval` gives, for every basis
and evaluator. tests/blender/shader_code_test.py LOBELIA"""
import csv
import json
import subprocess
import sys
import tempfile
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender" / "lobelia_bake"))
from shader_code import Numbers, Program, Run, Unsupported  # noqa: E402

lobelia = sys.argv[1]


def run(*arguments):
    return subprocess.run([lobelia, *arguments], check=True, capture_output=True, text=True).stdout


def main():
    first, worst, refused, failures = {}, 0.0, [], 0
    for codec in run("list").split():
        basis, _, evaluator = codec.split("/")
        first.setdefault((basis, evaluator), codec)
    with tempfile.TemporaryDirectory() as folder:
        for (basis, evaluator), codec in first.items():
            if basis.startswith("oct"):
                continue  # hundreds of images: the code says so below
            file, values = Path(folder) / f"{basis}.json", Path(folder) / "values.csv"
            if not file.exists():
                run("encode", "sky", "--sky-size", "32x16", "--codec", codec, "-o", str(file))
            try:
                program = Program(run("shader", codec))
            except subprocess.CalledProcessError:
                continue  # no shader code, for a reason that the command states
            light = [tuple(c) for c in json.loads(file.read_text())["coefficients"]]
            run("eval", str(file), "--evaluator", evaluator, "--latlong", "8x4", "-o", str(values))
            rows = [list(map(float, row)) for row in list(csv.reader(values.open()))[1:]]
            largest = max(abs(v) for row in rows for v in row[3:])
            try:
                off = max(abs(found - v) for row in rows
                          for found, v in zip(Run(program, Numbers(), light).call("irradiance", [tuple(row[:3])]), row[3:]))
            except Unsupported as error:
                refused.append(f"{codec}: {error}")
                continue
            worst = max(worst, off / largest)
            if off > 2e-5 * largest:
                failures += 1
                print(f"{codec}: off by {off / largest:.1e} of the largest E")
    for line in refused:
        print(line)
    print(f"{len(first)} evaluators, largest difference {worst:.1e}, {len(refused)} refused, {failures} wrong")
    sys.exit(1 if failures or len(refused) > 8 else 0)


main()
