#!/usr/bin/env python3
"""Ejecta and OpenFOAM 1912 (Debian packages `openfoam`, `openfoam-examples`) on the same cells, by turns.

    bench/against_openfoam.py build/release/ejecta [flow] [bed] [--repeats 3]

flow  The 571,200 cells of `ejecta bench`, k-epsilon, Courant number about 1, two processes or threads each: wall time
      of a step of pimpleFoam (one outer, two pressure corrections; no body) and of Ejecta (with its body).
bed   OpenFOAM's own tutorial of DPMFoam: 24,750 beads of 2.5 mm in 2 x 30 x 90 cells, gas at 1.875 m/s (Goldschmidt
      2004), from the tutorial's start, a loose lattice; 20 us a step, contacts as stiff; one core each: wall time of a
      step, of ten after the first ten (of Ejecta 250 after the first 250).

Says so and ends where OpenFOAM is not installed.
"""
import argparse
import os
import pathlib
import re
import shutil
import statistics
import subprocess
import sys
import tempfile
import time

TUTORIAL = pathlib.Path("/usr/share/doc/openfoam-examples/examples/lagrangian/DPMFoam/Goldschmidt")
HEAD = "FoamFile {{ version 2.0; format ascii; class {}; object {}; }}\n"
# The grid of `ejecta bench` (src/bench/bench.cpp): points in mm, cells, last cell over first.
AXES = [
    ([-42, -16.875, 16.875, 42], [15, 54, 15], [0.1822, 1, 5.489]),
    ([-40, -12, 12, 40], [20, 40, 20], [0.2246, 1, 4.452]),
    ([40, 64, 92, 125], [22, 45, 18], [0.3557, 1, 6.404]),
]
ENVIRONMENT = os.environ | {"WM_PROJECT_DIR": "/usr/share/openfoam"}
STEP, STEPS = 5e-6, 12  # s; the first two of them are not timed

BED = """
[run]
title = "bed of DPMFoam's tutorial"
end_time = "{end} ms"
time_step = "20 us"
[fluid]
ideal_gas = false
density = "1.2 kg/m3"
viscosity = "1.8e-5 Pa s"
[grid.x]
points = ["0 mm", "150 mm"]
cells = [30]
[grid.y]
points = ["0 mm", "15 mm"]
cells = [2]
[grid.z]
points = ["0 mm", "450 mm"]
cells = [90]
[boundary]
x_min = {{ type = "wall" }}
x_max = {{ type = "wall" }}
y_min = {{ type = "slip" }}
y_max = {{ type = "slip" }}
z_min = {{ type = "velocity", velocity = ["0 m/s", "0 m/s", "1.875 m/s"] }}
z_max = {{ type = "pressure-outlet" }}
{walls}
[[material]]
name = "glass"
density = "2526 kg/m3"
youngs_modulus = "100 MPa"
poisson_ratio = 0.35
restitution = 0.97
friction = 0.1
[[grains]]
name = "bed"
size = "2.5 mm"
count = 24750
packing = "lattice"
region = [["0 mm", "0 mm", "0 mm"], ["150 mm", "15 mm", "298.5 mm"]]
[coupling]
drag = "gidaspow"
kernel_width = 6
[output]
report = false
"""


def call(command, folder, log):
    with open(folder / log, "w") as out:
        subprocess.run(command, cwd=folder, env=ENVIRONMENT, stdout=out, stderr=subprocess.STDOUT, check=True)
    return (folder / log).read_text()


def dictionary(folder, path, text, kind="dictionary"):
    file = folder / path
    file.parent.mkdir(parents=True, exist_ok=True)
    file.write_text(HEAD.format(kind, file.name) + text)


def block_mesh():
    """27 blocks, their vertices counted along x, y, z."""
    points = [(x, y, z) for z in AXES[2][0] for y in AXES[1][0] for x in AXES[0][0]]
    at = lambda i, j, k: i + 4 * (j + 4 * k)
    quad = lambda *corners: "(" + " ".join(str(at(*c)) for c in corners) + ")"
    blocks, inlet, rest = [], [], []
    for k in range(3):
        for j in range(3):
            for i in range(3):
                corners = [(i, j, k), (i + 1, j, k), (i + 1, j + 1, k), (i, j + 1, k)]
                corners += [(a, b, c + 1) for a, b, c in corners]
                cells = " ".join(str(axis[1][n]) for axis, n in zip(AXES, (i, j, k)))
                grading = " ".join(str(axis[2][n]) for axis, n in zip(AXES, (i, j, k)))
                blocks.append(f"hex {quad(*corners)} ({cells}) simpleGrading ({grading})")
    for a in range(3):
        for b in range(3):
            inlet.append(quad((a, b, 0), (a, b + 1, 0), (a + 1, b + 1, 0), (a + 1, b, 0)))
            rest.append(quad((a, b, 3), (a + 1, b, 3), (a + 1, b + 1, 3), (a, b + 1, 3)))
            rest.append(quad((0, a, b), (0, a, b + 1), (0, a + 1, b + 1), (0, a + 1, b)))
            rest.append(quad((3, a, b), (3, a + 1, b), (3, a + 1, b + 1), (3, a, b + 1)))
            rest.append(quad((a, 0, b), (a + 1, 0, b), (a + 1, 0, b + 1), (a, 0, b + 1)))
            rest.append(quad((a, 3, b), (a, 3, b + 1), (a + 1, 3, b + 1), (a + 1, 3, b)))
    vertices = " ".join(f"({x} {y} {z})" for x, y, z in points)
    return (f"scale 0.001;\nvertices ({vertices});\nblocks ({' '.join(blocks)});\nedges ();\nboundary (\n"
            f"inlet {{ type patch; faces ({' '.join(inlet)}); }}\nrest {{ type patch; faces ({' '.join(rest)}); }}\n);\n")


def set_up_flow(folder):
    field = lambda name, dimensions, kind, inside, inlet, rest: dictionary(
        folder, f"0/{name}",
        f"dimensions [{dimensions}];\ninternalField uniform {inside};\n"
        f"boundaryField {{ inlet {{ {inlet} }} rest {{ {rest} }} }}\n", f"vol{kind}Field")
    outflow = "type inletOutlet; inletValue uniform {0}; value uniform {0};"
    field("U", "0 1 -1 0 0 0 0", "Vector", "(0 0 0)",
          "type exprFixedValue; value uniform (0 0 0); valueExpr "
          '"vector(0, 0, 200*exp(-(sqr(pos().x()) + sqr(pos().y()))/sqr(0.0045)))";',
          "type pressureInletOutletVelocity; value uniform (0 0 0);")
    field("p", "0 2 -2 0 0 0 0", "Scalar", "0", "type zeroGradient;",
          "type totalPressure; p0 uniform 0; value uniform 0;")
    field("k", "0 2 -2 0 0 0 0", "Scalar", "0.1", "type fixedValue; value uniform 600;", outflow.format(0.1))
    field("epsilon", "0 2 -3 0 0 0 0", "Scalar", "100", "type fixedValue; value uniform 2e6;", outflow.format(100))
    field("nut", "0 2 -1 0 0 0 0", "Scalar", "0", "type calculated; value uniform 0;",
          "type calculated; value uniform 0;")
    dictionary(folder, "constant/transportProperties", "transportModel Newtonian; nu 1.5e-5;\n")
    dictionary(folder, "constant/turbulenceProperties",
               "simulationType RAS;\nRAS { RASModel kEpsilon; turbulence on; printCoeffs off; }\n")
    dictionary(folder, "system/blockMeshDict", block_mesh())
    dictionary(folder, "system/controlDict",
               f"application pimpleFoam; startFrom startTime; startTime 0; stopAt endTime; endTime {STEP * STEPS};\n"
               f"deltaT {STEP}; writeControl timeStep; writeInterval 1000000; timePrecision 9;\n")
    dictionary(folder, "system/fvSchemes",
               "ddtSchemes { default Euler; }\ngradSchemes { default Gauss linear; }\n"
               "divSchemes { default none; div(phi,U) Gauss linearUpwind grad(U); div(phi,k) Gauss limitedLinear 1;\n"
               "div(phi,epsilon) Gauss limitedLinear 1; div((nuEff*dev2(T(grad(U))))) Gauss linear; }\n"
               "laplacianSchemes { default Gauss linear corrected; }\ninterpolationSchemes { default linear; }\n"
               "snGradSchemes { default corrected; }\n")
    dictionary(folder, "system/fvSolution",
               "solvers { p { solver GAMG; tolerance 1e-6; relTol 0.01; smoother GaussSeidel; }\n"
               "pFinal { $p; relTol 0; }\n"
               '"(U|k|epsilon).*" { solver smoothSolver; smoother symGaussSeidel; tolerance 1e-6; relTol 0; } }\n'
               "PIMPLE { nOuterCorrectors 1; nCorrectors 2; nNonOrthogonalCorrectors 0; }\n")
    dictionary(folder, "system/decomposeParDict", "numberOfSubdomains 2; method simple; coeffs { n (2 1 1); }\n")
    call(["blockMesh"], folder, "log.blockMesh")
    call(["decomposePar"], folder, "log.decomposePar")


def times_of_steps(command, folder):
    """Wall time at the end of each step, s."""
    times = []
    with subprocess.Popen(command, cwd=folder, env=ENVIRONMENT, stdout=subprocess.PIPE, text=True) as program:
        for line in program.stdout:
            if line.startswith("ExecutionTime"):
                times.append(time.monotonic())
    if program.returncode:
        sys.exit(f"{command[-1]} failed")
    return times


def of_flow(folder):
    times = times_of_steps(["mpirun", "--allow-run-as-root", "--oversubscribe", "-np", "2", "pimpleFoam", "-parallel"],
                           folder)
    return (times[-1] - times[1]) / (len(times) - 2)


def our_flow(program):
    text = subprocess.run([program, "bench", "--threads", "2", "--only", "flow"], capture_output=True, text=True,
                          check=True).stdout
    return 1e-3 * float(re.search(r"median step ([0-9.]+) ms", text).group(1))


def compare(name, unit, theirs, ours, repeats):
    a, b = [], []
    for n in range(repeats):
        a.append(theirs())
        b.append(ours())
        print(f"{n + 1}: OpenFOAM {a[-1]:.3f}, Ejecta {b[-1]:.4f} {unit}", flush=True)
    print(f"{name}, median: OpenFOAM {statistics.median(a):.3f}, Ejecta {statistics.median(b):.4f} {unit}, "
          f"ratio {statistics.median(a) / statistics.median(b):.1f}")


def flow(program, folder, repeats):
    set_up_flow(folder)
    compare("a step of the flow", "s", lambda: of_flow(folder), lambda: our_flow(program), repeats)


def set_up_bed(folder):
    shutil.copytree(TUTORIAL, folder, dirs_exist_ok=True)
    for packed in folder.rglob("*.gz"):
        subprocess.run(["gunzip", str(packed)], check=True)
    control = folder / "system/controlDict"
    control.write_text(re.sub(r"endTime\s+5;", "endTime 0.0004;", control.read_text()).replace("0.01;", "1;"))
    call(["blockMesh"], folder, "log.blockMesh")


def of_bed(folder):
    shutil.rmtree(folder / "0.0004", ignore_errors=True)
    times = times_of_steps(["DPMFoam"], folder)
    return (times[-1] - times[9]) / 10


def our_bed(program, folder):
    walls = "\n".join(f'[[wall]]\nname = "{name}"\nkind = "plane"\npoint = {point}\nnormal = {normal}' for
                      name, point, normal in [
                          ("plate", '["0 mm", "0 mm", "0 mm"]', "[0, 0, 1]"),
                          ("left", '["0 mm", "0 mm", "0 mm"]', "[1, 0, 0]"),
                          ("right", '["150 mm", "0 mm", "0 mm"]', "[-1, 0, 0]"),
                          ("front", '["0 mm", "0 mm", "0 mm"]', "[0, 1, 0]"),
                          ("back", '["0 mm", "15 mm", "0 mm"]', "[0, -1, 0]"),
                      ])
    taken = []
    for end in (5, 10):
        (folder / f"bed-{end}.toml").write_text(BED.format(end=end, walls=walls))
        out = folder / f"bed-{end}.run"
        shutil.rmtree(out, ignore_errors=True)
        text = call([program, "run", f"bed-{end}.toml", "--threads", "1", "--out", str(out)], folder, f"log.bed-{end}")
        taken.append(float(re.search(r"^all +([0-9.]+)", text, re.M).group(1)))
    return (taken[1] - taken[0]) / 250


def bed(program, folder, repeats):
    if not TUTORIAL.is_dir():
        print("the tutorials of OpenFOAM are not installed (Debian: openfoam-examples)")
        return
    set_up_bed(folder / "of")
    compare("a step of the bed", "s", lambda: of_bed(folder / "of"), lambda: our_bed(program, folder), repeats)


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("program")
    parser.add_argument("what", nargs="*", choices=["flow", "bed"], default=["flow", "bed"])
    parser.add_argument("--repeats", type=int, default=3)
    options = parser.parse_args()
    if not shutil.which("pimpleFoam"):
        sys.exit("OpenFOAM is not installed (Debian: openfoam)")
    program = str(pathlib.Path(options.program).resolve())
    for name in options.what:
        with tempfile.TemporaryDirectory() as folder:
            {"flow": flow, "bed": bed}[name](program, pathlib.Path(folder), options.repeats)


if __name__ == "__main__":
    main()
