#!/usr/bin/python3
"""The jet that comes with the paper's cases is the one that Ejecta computes. Usage: stored_jet_test.py EJECTA CASE

Takes as long as the jet: minutes. Other processors and compilers round otherwise, so the two need not be equal to the bit.
"""

import os
import pathlib
import struct
import subprocess
import sys
import tempfile

EJECTA, CASE = os.path.abspath(sys.argv[1]), pathlib.Path(sys.argv[2]).resolve()
HEAD = len(b"ejecta jet profile 1\n") + 8  # and the checksum
TOLERANCE = 1e-3  # of the largest value of its kind


def numbers(file):
    data = file.read_bytes()[HEAD:]
    return struct.unpack(f"<{len(data) // 8}d", data)


def largest_differences(a, b):
    """Of velocities, k and epsilon over all moments, each over the largest value there."""
    assert a[:3] == b[:3], f"height, radii, moments: stored {a[:3]}, computed {b[:3]}"
    radii, moments = int(a[1]), int(a[2])
    assert a[3 : 3 + radii] == b[3 : 3 + radii], "other radii"
    worst, scale = [0.0] * 4, [0.0] * 4
    for n in range(moments):
        for kind in range(4):
            at = 3 + radii + n * (1 + 4 * radii) + 1 + kind * radii
            for x, y in zip(a[at : at + radii], b[at : at + radii]):
                worst[kind] = max(worst[kind], abs(x - y))
                scale[kind] = max(scale[kind], abs(x))
    return [w / s for w, s in zip(worst, scale)]


with tempfile.TemporaryDirectory() as folder:
    here = pathlib.Path(folder)
    for file in CASE.parent.rglob("*.toml"):  # without the stored jets, and without what else the jet's case compares
        text = file.read_text().replace("compare_incompressible = true", "compare_incompressible = false")
        copy = here / file.relative_to(CASE.parent)
        copy.parent.mkdir(exist_ok=True)
        copy.write_text(text)
    environment = {**os.environ, "EJECTA_CACHE": str(here / "cache")}
    command = [EJECTA, "jet", str(here / CASE.name), "--out", str(here / "jet.run"), "--quiet"]
    subprocess.run(command, check=True, env=environment)
    (computed,) = (here / "cache").glob("jet-*.profile")
    stored = CASE.parent / "jets" / computed.name
    assert stored.is_file(), f"no {stored}: store the jet anew as cases/paper/jets/README.md says"
    found = largest_differences(numbers(stored), numbers(computed))
    print(dict(zip(("axial", "radial", "k", "epsilon"), found)))
    assert max(found) < TOLERANCE
