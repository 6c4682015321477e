"""Reads the files of a run with numpy alone: it needs no compiled module.

    import ejecta
    run = ejecta.Run("10mm-cubic.run")
    run.result["bodies"][0]["velocity_change_z_m_s"]
    cube = run.history("body-cube")
    cube["time"], cube["force_z"], cube.units["force_z"]
    for frame in run.frames(): frame.time, frame.poses, frame.slices[0].speed   # m/s, [second, first] direction
    run.field("air", -1)["velocity"]                                            # [z, y, x, component]

The files are described in docs/files.md. All numbers are in SI units.
"""

import base64
import json
import re
import xml.etree.ElementTree as ElementTree
import zlib
from pathlib import Path

import numpy

from .quantity import Array


class Table(dict):
    """Columns of a history by name, as numpy arrays with a `unit`; `units` gives the units of all, `provenance` the head
    lines of its file."""

    def __init__(self, columns, provenance=()):
        super().__init__(columns)
        self.provenance = list(provenance)

    @classmethod
    def read(cls, path):
        text = Path(path).read_text()
        lines = text[: text.rfind("\n") + 1].splitlines()  # a run that is still going may have a torn last line
        provenance = [line[2:] for line in lines if line.startswith("#")]
        lines = [line for line in lines if not line.startswith("#")]
        heads = [re.fullmatch(r"(.*) \[(.*)\]", head).groups() for head in lines[0].split(",")]
        rows = numpy.array([[float(cell) for cell in line.split(",")] for line in lines[1:]])
        columns = rows.reshape(-1, len(heads)).T
        return cls({name: Array(column, unit) for (name, unit), column in zip(heads, columns)}, provenance)

    @property
    def units(self):
        return {name: column.unit for name, column in self.items()}

    def to_pandas(self):
        """The table as a DataFrame; `attrs["units"]` has the units."""
        import pandas

        frame = pandas.DataFrame({name: numpy.asarray(column) for name, column in self.items()})
        frame.attrs["units"] = self.units
        return frame


class Slice:
    """Air speed (m/s) on a raster; `first` and `second` are the pixels' centres (m) along its two directions."""

    def __init__(self, raster, data):
        width, height = raster["pixels"]
        bytes_ = numpy.frombuffer(zlib.decompress(base64.b64decode(data["data"])), numpy.uint8)
        self.name = raster["name"]
        self.axis = raster["axis"]
        self.position = raster["position"]
        self.speed = bytes_.reshape(height, width) / 255 * data["full_scale"]
        (a0, b0), (a1, b1) = raster["lower"], raster["upper"]
        self.first = a0 + (numpy.arange(width) + 0.5) * (a1 - a0) / width
        self.second = b0 + (numpy.arange(height) + 0.5) * (b1 - b0) / height


class Frame:
    """One moment of the replay: time (s), poses (one row x y z qw qx qy qz a body; NaN before it has come and after it has
    gone), slices."""

    def __init__(self, header, line):
        self.time = line["time"]
        absent = [numpy.nan] * 7
        self.poses = numpy.array([absent if pose is None else pose for pose in line["bodies"]]).reshape(-1, 7)
        self.slices = [Slice(header["rasters"][s["raster"]], s) for s in line["slices"]]


def rotation(quaternion):
    """Matrix that turns body axes into the world."""
    w, x, y, z = quaternion
    return numpy.array([
        [1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y)],
        [2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x)],
        [2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y)],
    ])


def read_vtr(path):
    """Cell fields of a .vtr file by name, indexed [z, y, x] or [z, y, x, component], and the faces `x`, `y`, `z`."""
    content = Path(path).read_bytes()
    mark = b'<AppendedData encoding="raw">\n_'
    start = content.index(mark) + len(mark)
    root = ElementTree.fromstring(content[: start - len(mark)] + b"</VTKFile>")
    types = {"Float32": numpy.float32, "Float64": numpy.float64, "Int64": numpy.int64}

    def values(array):
        at = start + int(array.get("offset"))
        length = int.from_bytes(content[at : at + 8], "little")
        return numpy.frombuffer(content, types[array.get("type")], length // types[array.get("type")]().itemsize, at + 8)

    fields = {a.get("Name"): values(a) for a in root.iter("DataArray") if a.get("format") == "appended"}
    shape = tuple(len(fields[d]) - 1 for d in "zyx")
    for array in root.find(".//CellData"):
        name, components = array.get("Name"), int(array.get("NumberOfComponents"))
        fields[name] = fields[name].reshape(shape + ((components,) if components > 1 else ()))
    return fields


class Run:
    """The directory of a run."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.manifest = json.loads((self.directory / "manifest.json").read_text())
        result = self.directory / "result.json"
        self.result = json.loads(result.read_text()) if result.exists() else None

    def histories(self):
        """Names that `history` takes."""
        return sorted(path.stem for path in (self.directory / "history").glob("*.csv"))

    def history(self, name):
        return Table.read(self.directory / "history" / f"{name}.csv")

    def _replay_lines(self):
        file = self.directory / "replay.jsonl"
        text = file.read_text() if file.exists() else ""  # a case with output.report = false has none
        return text[: text.rfind("\n") + 1].splitlines()

    def replay_header(self):
        """Domain, rasters, plates, nozzles; bodies with `vertices` (n, 3) in body axes and `triangles` (n, 3). None for
        a run without a replay."""
        lines = self._replay_lines()
        if not lines:
            return None
        header = json.loads(lines[0])
        for body in header["bodies"]:
            for key, kind in (("vertices", numpy.float32), ("triangles", numpy.uint32)):
                body[key] = numpy.frombuffer(base64.b64decode(body[key]), kind).reshape(-1, 3)
        return header

    def frames(self):
        lines = self._replay_lines()
        header = json.loads(lines[0]) if lines else None
        return [Frame(header, json.loads(line)) for line in lines[1:]]

    def times(self, series):
        """Moments (s) of fields/SERIES.pvd."""
        root = ElementTree.parse(self.directory / "fields" / f"{series}.pvd")
        return numpy.array([float(entry.get("timestep")) for entry in root.iter("DataSet")])

    def field(self, series, index):
        """Fields of the moment `index` of fields/SERIES.pvd (.vtr)."""
        root = ElementTree.parse(self.directory / "fields" / f"{series}.pvd")
        entries = [entry.get("file") for entry in root.iter("DataSet")]
        return read_vtr(self.directory / "fields" / entries[index])
