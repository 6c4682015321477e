"""Opens the fields of a run in ParaView: right times, right sizes, right ranges; and those of a run that was stopped in
its middle, which is how a run that is still going looks. Usage: pvpython paraview_test.py RUN_DIR STOPPED_RUN_DIR"""

import sys
from pathlib import Path

from paraview import simple


def opened(path):
    reader = simple.PVDReader(FileName=str(path))
    reader.UpdatePipelineInformation()
    return reader


def data_at(reader, time):
    reader.UpdatePipeline(time)
    # The reader's own output: a Fetch() of a rectilinear grid is a copy with mixed-up coordinates.
    return reader.GetClientSideObject().GetOutputDataObject(0)


def check(condition, message):
    if not condition:
        raise SystemExit(f"failed: {message}")


def close(a, b, tolerance=1e-6):
    return abs(a - b) <= tolerance * max(abs(a), abs(b), 1e-12)


EXPECTED_TIMES = [4e-3 * n for n in range(7)]


def check_stopped(run):
    air = opened(Path(run) / "fields" / "air.pvd")
    times = air.TimestepValues
    times = [times] if isinstance(times, float) else list(times)
    check(1 <= len(times) < 7 and all(close(a, b) for a, b in zip(times, EXPECTED_TIMES)), f"times of a stopped run: {times}")
    velocity = data_at(air, times[-1]).GetCellData().GetArray("velocity")
    check(velocity is not None and velocity.GetRange(2)[1] < 200, "the last moment of a stopped run is not whole")


def check_finished(run):
    fields = Path(run) / "fields"

    air = opened(fields / "air.pvd")
    times = list(air.TimestepValues)
    check(len(times) == 7 and all(close(a, b) for a, b in zip(times, EXPECTED_TIMES)), f"times of air.pvd: {times}")
    grid = data_at(air, times[2])
    check(grid.GetClassName() == "vtkRectilinearGrid", f"air is a {grid.GetClassName()}")
    check(grid.GetDimensions() == (61, 31, 51), f"air has {grid.GetDimensions()} points")
    bounds = air.GetDataInformation().GetBounds()  # Fetch() mixes up coordinates of rectilinear grids
    check(all(close(a, b, 1e-5) for a, b in zip(bounds, (-0.06, 0.06, -0.03, 0.03, 0.04, 0.14))), f"bounds {bounds}")
    cells = grid.GetCellData()
    velocity, pressure = cells.GetArray("velocity"), cells.GetArray("pressure")
    check(velocity.GetNumberOfComponents() == 3, "velocity is no vector")
    low, high = velocity.GetRange(2)
    check(low >= 0 and 150 < high < 200, f"vertical velocity from {low} to {high} m/s at 8 ms")
    # Stagnation pressure of the fastest cell: the two fields belong to the same cells.
    check(close(pressure.GetRange()[1], 0.5 * 1.18 * high * high, 1e-4), f"pressure up to {pressure.GetRange()[1]} Pa")
    still = data_at(air, times[0]).GetCellData().GetArray("velocity").GetRange(2)
    check(still == (0.0, 0.0), f"air moves at the start: {still}")

    plane = data_at(opened(fields / "slice-y0.pvd"), times[2])
    check(plane.GetDimensions() == (61, 2, 51), f"the slice has {plane.GetDimensions()} points")
    check(close(plane.GetCellData().GetArray("velocity").GetRange(2)[1], high), "the slice misses the fastest cell")

    bodies = data_at(opened(fields / "bodies.pvd"), times[6])
    ids = bodies.GetCellData().GetArray("id")
    check(ids.GetRange() == (0.0, 1.0), f"body numbers {ids.GetRange()}")
    speed = bodies.GetCellData().GetArray("velocity").GetRange(0)
    check(2.9 < speed[0] <= speed[1] < 3.3, f"bodies move at {speed} m/s along x")
    x = bodies.GetBounds()[:2]
    check(0.03 < x[0] < x[1] < 0.065, f"bodies are at x = {x} m at 24 ms")


check_finished(sys.argv[1])
check_stopped(sys.argv[2])
print("paraview: passed")
