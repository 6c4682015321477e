"""A run that is killed again and again and resumed gives the bits of the undisturbed run.
Usage: resume_test.py EJECTA CASE SCRATCH [KILLS]"""

import json
import random
import shutil
import signal
import subprocess
import sys
import time
from pathlib import Path

DONE = (0, 6)  # 6: it ends before the plate
TIMES = {"wall_time_s", "cell_steps_per_s", "operators"}  # what may differ


def start(ejecta, case, out, resume, *more):
    how = "--resume" if resume else "--force"
    return subprocess.Popen([ejecta, "run", case, "--quiet", "--threads", "1", "--out", out, how, *more])


def result(out):
    r = json.loads((Path(out) / "result.json").read_text())
    return {key: value for key, value in r.items() if key not in TIMES}


def compare(whole, disturbed):
    if result(whole) != result(disturbed):
        raise SystemExit("failed: result.json differs")
    for kind in ("history/*.csv", "fields/*.vt*", "fields/*.pvd", "replay.jsonl"):
        for file in Path(whole).glob(kind):
            if file.read_bytes() != (Path(disturbed) / file.relative_to(whole)).read_bytes():
                raise SystemExit(f"failed: {file.name} differs")


def resume_at_the_end(ejecta, case, scratch, whole):
    """A run killed between its last step and its result: resuming takes no step and says the same."""
    finished = f"{scratch}/finished.run"
    at_the_end = ("--set", f"checkpoint.every_time={result(whole)['simulated_time_s']!r} s")
    for resume in (False, True):
        if resume:
            (Path(finished) / "result.json").unlink()
        if start(ejecta, case, finished, resume, *at_the_end).wait() not in DONE:
            raise SystemExit("failed: the run with a checkpoint at its end")
        if result(whole) != result(finished):
            raise SystemExit("failed: result.json differs after resuming at the end")


def main(ejecta, case, scratch, kills=4):
    shutil.rmtree(scratch, ignore_errors=True)
    Path(scratch).mkdir(parents=True)
    whole, disturbed = f"{scratch}/whole.run", f"{scratch}/disturbed.run"
    began = time.time()
    if start(ejecta, case, whole, False).wait() not in DONE:
        raise SystemExit("failed: the undisturbed run")
    duration = time.time() - began
    resume_at_the_end(ejecta, case, scratch, whole)
    draw = random.Random(7)
    done = 0
    while done < kills:
        shutil.rmtree(disturbed, ignore_errors=True)
        resume = False
        while True:
            run = start(ejecta, case, disturbed, resume)
            try:
                code = run.wait(timeout=draw.uniform(0.2, 0.9) * duration)
            except subprocess.TimeoutExpired:
                hard = draw.random() < 0.5
                run.send_signal(signal.SIGKILL if hard else signal.SIGTERM)
                code = run.wait()
                # -SIGTERM: it had not begun to listen, while it was being set up.
                if code not in (-signal.SIGKILL, -signal.SIGTERM, 4, *DONE):
                    raise SystemExit(f"failed: exit code {code} of a run that was asked to stop")
                done += 1
            if code in DONE:
                break
            resume = bool(list((Path(disturbed) / "checkpoints").glob("*.h5")))
        compare(whole, disturbed)
    print(f"{done} kills, every resumed run equal to the bit")


if __name__ == "__main__":
    main(*sys.argv[1:4], *map(int, sys.argv[4:]))
