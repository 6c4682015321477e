"""Opens the fields of a run in ParaView while it is going: the moments written so far, each of them whole, and after
"Reload Files" the later ones. Usage: pvpython live_test.py EJECTA CASE RUN_DIR"""

import shutil
import subprocess
import sys
import time
from pathlib import Path

from paraview import simple

ejecta, case, out = sys.argv[1:]
shutil.rmtree(out, ignore_errors=True)  # not the fields of an earlier run
run = subprocess.Popen([ejecta, "run", case, "--quiet", "--force", "--threads", "1", "--out", out,
                        "--set", "run.end_time=10 s", "--set", "output.fields_interval=0.4 ms"])
pvd = Path(out) / "fields" / "air.pvd"


def wait_for(moments):
    for _ in range(600):
        if run.poll() is not None:
            raise SystemExit(f"failed: the run ended early with {run.returncode}")
        if pvd.exists() and pvd.read_text().count("<DataSet") >= moments:
            return
        time.sleep(0.1)
    raise SystemExit(f"failed: no {moments} moments within a minute")


def check_now(reader, least):
    """Every moment that ParaView lists can be read, with the air faster than before."""
    reader.UpdatePipelineInformation()
    times = list(reader.TimestepValues)
    if len(times) < least or any(abs(t - 4e-4 * n) > 1e-9 for n, t in enumerate(times)):
        raise SystemExit(f"failed: times {times}")
    for t in times:
        reader.UpdatePipeline(t)
        velocity = reader.GetClientSideObject().GetOutputDataObject(0).GetCellData().GetArray("velocity")
        if velocity.GetNumberOfTuples() != 30 * 24 * 30 or not (t == 0 or 0 < velocity.GetRange(2)[1] < 400):
            raise SystemExit(f"failed: {velocity.GetNumberOfTuples()} cells, {velocity.GetRange(2)} m/s at {t} s")
    if run.poll() is not None:
        raise SystemExit("failed: the run had ended while it was read")
    return len(times)


try:
    wait_for(2)
    air = simple.PVDReader(FileName=str(pvd))
    seen = check_now(air, 2)
    wait_for(seen + 2)
    simple.ReloadFiles(air)
    check_now(air, seen + 2)
finally:
    run.terminate()
    code = run.wait()
if code != 4:
    raise SystemExit(f"failed: the stopped run ended with {code}")
print("paraview, while running: passed")
