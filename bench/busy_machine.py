#!/usr/bin/python3
"""How much of its speed ejecta keeps while other programs are at work on the same cores.

Runs the first milliseconds of the tutorial on all cores: alone, with one core taken by another program, with all
of them taken. The programs that take cores are loops started here. Aims on two cores: at least 45 % of the speed
alone with one taken, at least 35 % with both.

Usage: bench/busy_machine.py EJECTA [EJECTA...] [--rounds N] [--end TIME]
Several programs (an old and a new one) run in turns, so that a machine that changes its speed favours none.
"""

import argparse
import json
import os
import pathlib
import statistics
import subprocess
import sys
import tempfile

UNDECIDED = 6  # exit status of a run that ends before the verdict
TUTORIAL = pathlib.Path(__file__).resolve().parent.parent / "cases" / "tutorial.toml"


def speed(ejecta, end, busy):
    """Cell-steps a second while `busy` other programs are at work."""
    others = [subprocess.Popen([sys.executable, "-c", "while True: pass"]) for _ in range(busy)]
    try:
        with tempfile.TemporaryDirectory() as folder:
            command = [ejecta, "run", TUTORIAL, "--out", f"{folder}/run", "--quiet", "--set", f"run.end_time={end}"]
            status = subprocess.run(command, stdout=subprocess.DEVNULL).returncode
            if status not in (0, UNDECIDED):
                raise SystemExit(f"{ejecta} run ended with {status}")
            return json.loads(pathlib.Path(folder, "run", "result.json").read_text())["cell_steps_per_s"]
    finally:
        for other in others:
            other.kill()
            other.wait()


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("programs", nargs="+", metavar="EJECTA")
    parser.add_argument("--rounds", type=int, default=3)
    parser.add_argument("--end", default="4 ms", help="simulated time of a run")
    options = parser.parse_args()
    cores = len(os.sched_getaffinity(0))
    loads = {"alone": 0, "one core taken": 1, f"all {cores} taken": cores}
    speeds = {(p, load): [] for p in options.programs for load in loads}
    for _ in range(options.rounds):
        for load, busy in loads.items():
            for program in options.programs:
                speeds[program, load].append(speed(program, options.end, busy))
    for program in options.programs:
        alone = statistics.median(speeds[program, "alone"])
        print(program)
        for load in loads:
            s = statistics.median(speeds[program, load])
            print(f"  {load:<16} {s * 1e-6:7.2f} million cell-steps/s  {100 * s / alone:4.0f} %")


if __name__ == "__main__":
    main()
