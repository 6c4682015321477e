"""Plots a run: path, vertical velocity, force of the air, and the air in the slice with the bodies in it.

    /usr/bin/python3 plot_run.py 10mm-cubic.run [picture.png]
"""

import sys

import matplotlib

matplotlib.use("Agg")
import matplotlib.pyplot as pyplot
import numpy

import ejecta


def strongest_moment(run, bodies):
    """When the air pushes hardest on the first body, s."""
    if not bodies:
        return 0.0
    table = run.history(bodies[0])
    force = numpy.linalg.norm([table[f"force_{d}"] for d in "xyz"], axis=0)
    return table["time"][force.argmax()]


def plot_slice(axes, run, time):
    header = run.replay_header()
    frames = [frame for frame in run.frames() if frame.slices]
    if not frames:
        axes.set_axis_off()
        axes.set_title("no air recorded")
        return
    frame = min(frames, key=lambda f: abs(f.time - time))
    air = frame.slices[0]
    image = axes.pcolormesh(air.first * 1e3, air.second * 1e3, air.speed, cmap="viridis", shading="nearest")
    pyplot.colorbar(image, ax=axes, label="air speed [m/s]", shrink=0.6)
    across = [d for d in range(3) if d != air.axis]
    for body, pose in zip(header["bodies"], frame.poses):
        corners = body["vertices"] @ ejecta.rotation(pose[3:]).T + pose[:3]
        for triangle in body["triangles"]:
            axes.fill(*(corners[triangle][:, across] * 1e3).T, color="0.8")
    axes.set_aspect("equal")
    axes.set_title(f"{air.name}, {frame.time * 1e3:.1f} ms")
    axes.set_xlabel(f"{'xyz'[across[0]]} [mm]")
    axes.set_ylabel(f"{'xyz'[across[1]]} [mm]")


def main(directory, picture):
    run = ejecta.Run(directory)
    bodies = [name for name in run.histories() if name.startswith("body-")]
    figure, axes = pyplot.subplot_mosaic(
        [["path", "path"], ["air", "velocity"], ["air", "force"]], figsize=(12, 10), layout="constrained")
    path, air, velocity, force = (axes[name] for name in ("path", "air", "velocity", "force"))
    for name in bodies:
        table = run.history(name)
        label = name[len("body-"):]
        path.plot(table["x"] * 1e3, table["z"] * 1e3, label=label)
        velocity.plot(table["time"] * 1e3, table["velocity_z"], label=label)
        force.plot(table["time"] * 1e3, table["force_z"], label=label)
    for plate in (run.replay_header() or {"plates": []})["plates"]:
        ends = numpy.array(plate["edge"]) + numpy.outer([0, plate["length"]], plate["along"])
        path.plot(ends[:, 0] * 1e3, ends[:, 2] * 1e3, "k", linewidth=3, label=plate["name"])
    path.set(xlabel="x [mm]", ylabel="z [mm]", title="Path")
    path.set_aspect("equal")
    velocity.set(xlabel="time [ms]", ylabel="vertical velocity [m/s]")
    force.set(xlabel="time [ms]", ylabel="vertical force of the air [N]")
    for chart in (path, velocity, force):
        chart.grid(alpha=0.3)
        if chart.lines:
            chart.legend()
    plot_slice(air, run, strongest_moment(run, bodies))
    figure.savefig(picture, dpi=110)


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2] if len(sys.argv) > 2 else "run.png")
