"""The Python reader against the sample run, and its example. Usage: python_reader_test.py PYTHON_DIR RUN_DIR PICTURE.
Ends with 77 (skipped) where numpy or matplotlib is absent."""

import subprocess
import sys
from pathlib import Path

try:
    import matplotlib  # noqa: F401
    import numpy
except ImportError as missing:
    print(f"skipped: {missing}")
    sys.exit(77)

python_dir, run_dir, picture = sys.argv[1:]
sys.path.insert(0, python_dir)
import ejecta  # noqa: E402

run = ejecta.Run(run_dir)
body = run.result["bodies"][0]
table = run.history("body-cube")
assert table.units["torque_y"] == "N m" and table.units["time"] == "s", table.units
assert [table[d][-1] for d in "xyz"] == body["final_position_m"], "the history ends elsewhere than the result"
assert any(line.startswith("input sha256") for line in table.provenance)

frames = run.frames()
assert all(a.time < b.time for a, b in zip(frames, frames[1:]))
last = frames[-1].poses[0]
assert numpy.allclose(last[:3], body["final_position_m"]) and abs(numpy.linalg.norm(last[3:]) - 1) < 1e-12

waiting = ejecta.run_files.Frame({"rasters": []}, {"time": 0.0, "bodies": [None, [0, 0, 0, 1, 0, 0, 0]], "slices": []})
assert numpy.isnan(waiting.poses[0]).all() and waiting.poses[1][3] == 1, "a body that has not come yet"

# The quantised slice and the field in full are the same air: compare in the plane y = 0 at 8 ms.
times = run.times("slice-y0")
index = int(numpy.argmin(abs(times - 8e-3)))
field = run.field("slice-y0", index)
speed = numpy.linalg.norm(field["velocity"][:, 0, :, :], axis=-1)
air = min((f for f in frames if f.slices), key=lambda f: abs(f.time - times[index])).slices[0]
x, z = (0.5 * (field[d][1:] + field[d][:-1]) for d in "xz")
middle = speed[:, len(x) // 2]
shown = numpy.interp(z, air.second, air.speed[:, air.speed.shape[1] // 2])
assert abs(shown - middle).max() < 0.02 * middle.max(), abs(shown - middle).max()

subprocess.run([sys.executable, str(Path(python_dir) / "plot_run.py"), run_dir, picture], check=True)
assert Path(picture).stat().st_size > 20_000
print("python reader: passed")
