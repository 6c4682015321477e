"""Kills a program that writes a run at random moments and reads what it left: every file in place is whole, but for a
torn last line of those that grow. Usage: kill_test.py PYTHON_DIR MAKE_SAMPLE_RUN RUN_DIR. Ends with 77 (skipped)
where numpy is absent."""

import random
import shutil
import subprocess
import sys
import time
from pathlib import Path

python_dir, program, run_dir = sys.argv[1:]
sys.path.insert(0, python_dir)
try:
    import ejecta
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

KILLS = 8
random.seed(1)


def kill_after(seconds):
    shutil.rmtree(run_dir, ignore_errors=True)
    process = subprocess.Popen([program, run_dir])
    time.sleep(seconds)
    process.kill()
    return process.wait() != 0


def read_what_is_left():
    """Number of rows, frames and fields that came back; raises where a file in place is not whole."""
    run = ejecta.Run(run_dir)
    rows = sum(len(run.history(name)["time"]) for name in run.histories())
    frames = len(run.frames()) if (run.directory / "replay.jsonl").exists() else 0
    series = {path.stem for path in run.directory.glob("fields/*.pvd")} - {"bodies"}
    fields = sum(len(run.field(name, n)) for name in series for n in range(len(run.times(name))))
    return rows, frames, fields


start = time.monotonic()
subprocess.run([program, run_dir], check=True)
whole = time.monotonic() - start

killed = read = most = 0
while killed < KILLS:
    killed += kill_after(random.uniform(0.0, 0.9 * whole))
    if not (Path(run_dir) / "manifest.json").exists():
        continue  # killed before there was a run
    rows, frames, fields = read_what_is_left()
    read += 1
    most = max(most, frames)
# The last one is left for the ParaView test: a run in its middle.
assert kill_after(0.5 * whole)
read_what_is_left()
assert read >= KILLS // 2 and most > 10, f"{read} runs read, at most {most} frames: the kills came too early"
print(f"kill test: {killed} kills, {read} runs read, up to {most} frames")
