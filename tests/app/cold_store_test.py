#!/usr/bin/python3
"""Processes that start together and need the same jet: one computes it. Usage: cold_store_test.py EJECTA [PROCESSES]"""

import json
import os
import pathlib
import re
import subprocess
import sys
import tempfile

EJECTA = os.path.abspath(sys.argv[1])
PROCESSES = int(sys.argv[2]) if len(sys.argv) > 2 else 8
TESTS = pathlib.Path(__file__).resolve().parent

# A jet of a second: that of tests/app/small_jet.hpp.
JET = re.search(r'R"\((.*?)\)"', (TESTS / "small_jet.hpp").read_text(), re.S).group(1)
EJECTION = """[run]
end_time = "0.15 ms"
[flow]
turbulence = "k-epsilon"
[grid.x]
points = ["-5 mm", "5 mm"]
cells = [20]
[grid.y]
points = ["-5 mm", "5 mm"]
cells = [20]
[grid.z]
points = ["8 mm", "18 mm"]
cells = [20]
[boundary.x_min]
type = "free-stream"
[boundary.x_max]
type = "free-stream"
[boundary.y_min]
type = "free-stream"
[boundary.y_max]
type = "free-stream"
[boundary.z_min]
type = "jet"
[boundary.z_max]
type = "pressure-outlet"
[valve]
supply_pressure = "700 kPa gauge"
orifice_diameter = "1.8 mm"
rise_time = "0.02 ms"
fall_time = "0 ms"
duration = "0.1 ms"
[jet]
kind = "computed"
source_case = "jet.toml"
[[body]]
name = "cube"
shape = "box"
size = ["3 mm", "3 mm", "3 mm"]
position = ["0 mm", "0 mm", "13 mm"]
"""


def figures(directory):
    result = json.loads((directory / "result.json").read_text())
    return {"bodies": result["bodies"], "steps": result["steps"], "ledger": result["ledger"]}


def main():
    with tempfile.TemporaryDirectory(prefix="ejecta-cold-") as name:
        folder = pathlib.Path(name)
        (folder / "jet.toml").write_text(JET)
        (folder / "shot.toml").write_text(EJECTION)

        def start(n, cache):
            return subprocess.Popen([EJECTA, "run", "shot.toml", "--out", f"run-{n}", "--threads", "1"], cwd=folder, text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, env=dict(os.environ, EJECTA_CACHE=str(folder / cache)))

        alone = start("alone", "cache-of-one")
        said = alone.communicate(timeout=300)[0]
        assert alone.returncode == 0, said
        assert "computing the jet" in said, said
        together = [start(n, "cache") for n in range(PROCESSES)]
        computed = 0
        for process in together:
            said = process.communicate(timeout=300)[0]
            assert process.returncode == 0, said
            computed += "computing the jet" in said
        stored = list((folder / "cache").glob("jet-*.profile"))
        assert len(stored) == 1, stored
        for n in range(PROCESSES):
            assert figures(folder / f"run-{n}") == figures(folder / "run-alone"), n
        assert computed == 1, f"{computed} of {PROCESSES} processes computed the jet"
        print(f"{PROCESSES} processes, one jet, the same results")


main()
