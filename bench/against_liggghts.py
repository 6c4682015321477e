#!/usr/bin/env python3
"""Ejecta and LIGGGHTS 3.8 (Debian package `liggghts`) on the same 10,000 settled spheres, by turns, one core.

    bench/against_liggghts.py build/release/ejecta [repeats]

Both: Hertz with tangential history and friction, the paper's material, step 5e-5 s, 4,000 steps to settle in an open
box and 2,000 that are timed. LIGGGHTS sums up wall time of its loop; Ejecta's figure is `ejecta bench --only settled`.
"""
import math
import os
import re
import statistics
import subprocess
import sys
import tempfile

COUNT, RADIUS, STEPS = 10000, 5e-3, 2000
PITCH, SIDE = 2.1 * RADIUS, 22

HEAD = """atom_style granular
atom_modify map array
boundary f f f
newton off
communicate single vel yes
units si
region reg block -0.01 {box} -0.01 {box} -0.01 0.6 units box
create_box 1 reg
neighbor 0.001 bin
neigh_modify delay 0
fix m1 all property/global youngsModulus peratomtype 5.e6
fix m2 all property/global poissonsRatio peratomtype 0.45
fix m3 all property/global coefficientRestitution peratomtypepair 1 0.3
fix m4 all property/global coefficientFriction peratomtypepair 1 0.5
pair_style gran model hertz tangential history
pair_coeff * *
timestep 5e-5
fix gravity all gravity 9.81 vector 0.0 0.0 -1.0
fix floor all wall/gran model hertz tangential history primitive type 1 zplane 0.0
fix x1 all wall/gran model hertz tangential history primitive type 1 xplane 0.0
fix x2 all wall/gran model hertz tangential history primitive type 1 xplane {width}
fix y1 all wall/gran model hertz tangential history primitive type 1 yplane 0.0
fix y2 all wall/gran model hertz tangential history primitive type 1 yplane {width}
"""
TAIL = """set group all density 2700 diameter 0.01
fix move all nve/sphere
thermo 2000
run 4000
run 2000
"""


def place(n):
    """The lattice with scatter of src/app/bench_dem.cpp."""
    off = [math.fmod(n * q, 1.0) for q in (0.6180339887, 0.7548776662, 0.5698402910)]
    cell = (n % SIDE, n // SIDE % SIDE, n // (SIDE * SIDE))
    return [PITCH * (c + 0.5) + 0.04 * RADIUS * (o - 0.5) for c, o in zip(cell, off)]


def liggghts(path):
    text = subprocess.run(["liggghts", "-in", path, "-log", "none"], capture_output=True, text=True, check=True).stdout
    return COUNT * STEPS / float(re.findall(r"Loop time of ([0-9.e+-]+)", text)[-1]) * 1e-6


def ejecta(program):
    text = subprocess.run([program, "bench", "--threads", "1", "--only", "settled"], capture_output=True, text=True,
                          check=True).stdout
    line = next(row for row in text.splitlines() if row.startswith("10,000 spheres settled"))
    return float(line[34:].split()[1])


def main():
    program, repeats = sys.argv[1], int(sys.argv[2]) if len(sys.argv) > 2 else 5
    os.environ["OMP_NUM_THREADS"] = "1"
    width = SIDE * PITCH
    with tempfile.NamedTemporaryFile("w", suffix=".liggghts") as file:
        file.write(HEAD.format(box=width + 0.03, width=width))
        for n in range(COUNT):
            file.write("create_atoms 1 single {:.7f} {:.7f} {:.7f} units box\n".format(*place(n)))
        file.write(TAIL)
        file.flush()
        ours, theirs = [], []
        for n in range(repeats):
            theirs.append(liggghts(file.name))
            ours.append(ejecta(program))
            print(f"{n + 1}: LIGGGHTS {theirs[-1]:.2f}, Ejecta {ours[-1]:.2f} million particle-steps/s", flush=True)
    print(f"median: LIGGGHTS {statistics.median(theirs):.2f}, Ejecta {statistics.median(ours):.2f}, "
          f"ratio {statistics.median(ours) / statistics.median(theirs):.2f}")


if __name__ == "__main__":
    main()
