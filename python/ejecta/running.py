"""Running a case: in this process, or in one of its own."""

from __future__ import annotations

import json
import logging
import math
import os
import shlex
import signal
import subprocess
import time
from pathlib import Path
from typing import Any, Callable, Sequence, Union

from . import _core
from .case import CaseLike, as_case
from .errors import DivergedError, Error, InputError
from .quantity import Array
from .run_files import Run, Table

_log = logging.getLogger("ejecta")


_told = set()


def note(line):
    """What a run says by the way goes to the logger `ejecta`; what is unlikely to be meant in a case, once: an optimiser
    runs it many times."""
    if ": warning: " in line.partition("\n")[0]:
        if line in _told:
            return
        _told.add(line)
        _log.warning(line.strip())
    else:
        _log.log(logging.WARNING if line.startswith("warning: ") else logging.INFO, line.removeprefix("warning: "))


class Check:
    """What a run will be. `print` shows it as `ejecta check` does; `values` has the same for programs
    (docs/files.md: ejecta check --json); `problems` are what is only unlikely to be meant."""

    def __init__(self, report, values):
        self._report = report
        self.values = values

    @property
    def problems(self):
        return self.values["problems"]

    def __getitem__(self, name):
        return self.values[name]

    def __repr__(self):
        return self._report


class Result:
    """The result of a run.

        result.end                         # "decided", "undecided" (at its end, before the verdict) or "stopped"
        result.verdict                     # in a sentence
        result["bodies"][0]["clearance_at_splitter_m"]   # result.json, see docs/files.md
        result.history("body-particle")["force_z"]       # an array with `unit`; to_pandas() gives the whole table
        result.fields["velocity"]          # of a run with fields=True: [z, y, x] or [z, y, x, component]
    """

    def __init__(self, raw, directory=None):
        self.end = raw["end"]
        self.time, self.steps, self.wall_time = raw["time"], raw["steps"], raw["wall_time"]
        self.quantities = raw["quantities"]
        self.verdict = raw["verdict"]
        self.later_end = raw["later_end"]
        self.directory = Path(directory) if directory else None
        self._histories = {
            name: Table({column: Array(values, unit) for column, (values, unit) in table.items()})
            for name, table in raw["histories"].items()
        }
        faces, fields = raw["fields"] or ([], {})
        self.faces = [Array(face, "m") for face in faces]
        self.fields = {name: Array(values, unit) for name, (values, unit) in fields.items()}

    def __getitem__(self, name):
        return self.quantities[name]

    @property
    def bodies(self):
        return self.quantities.get("bodies", []) if self.quantities else []

    @property
    def centres(self):
        """Of the cells along x, y and z, m: the axes of `fields`, from last to first."""
        return [Array(0.5 * (face[1:] + face[:-1]), "m") for face in self.faces]

    @property
    def run(self):
        """The files of the run; None where it wrote none."""
        return Run(self.directory) if self.directory else None

    def histories(self) -> list[str]:
        """Names that `history` takes."""
        return self.run.histories() if self.directory else sorted(self._histories)

    def history(self, name: str) -> Table:
        return self.run.history(name) if self.directory else self._histories[name]

    def margin(self, body: str | None = None) -> float:
        """By how much (m) a body clears the edge of the dividing plate, negative where it falls short: of the flight that
        the air gave it. Of the first body unless one is named; NaN where it did not get past the plate."""
        for b in self.bodies:
            if body is None or b["name"] == body:
                return b["flight_clearance_m"] if "clearance_at_splitter_m" in b else math.nan
        raise KeyError(f"no body {body!r} in the result; it has {', '.join(b['name'] for b in self.bodies)}")

    def __repr__(self):
        return f"<ejecta.Result {self.end}: {self.verdict or f'at {self.time:.6g} s'}>"


def check(case: CaseLike, *, threads: int = 0) -> Check:
    """Checks a case (a Case, a file or a dict) and says what a run of it will be; runs nothing. Of a study all its runs are
    looked at, of a campaign all its parts. Raises CaseError. threads: those for which it says how long; 0 for all cores."""
    require_count("threads", threads)
    return Check(*as_case(case)._tree.check(threads))


def _sets(case):
    """What was changed, as words of the command line."""
    return [word for path, toml in case._changes.items() if toml for word in ("--set", f"{path}={toml}")]


def _command(kind, case, directory):
    """The line that runs it again, for the files of the run."""
    return shlex.join(["ejecta", *kind.split(), case.name, *_sets(case), "--out", directory])


def require_count(name, count):
    if not 0 <= count <= 4096:
        raise ValueError(f"{name}={count}\n  expected: 0 for as many as there is room for, or how many")


def _run(kind, case, out, overwrite, resume, threads, callback, fields):
    case = as_case(case)
    directory = os.fspath(out) if out is not None else None
    if resume and not directory:
        raise ValueError("resume goes on with the run in a directory: say which, e.g. out=\"my-case.run\"")
    require_count("threads", threads)
    raw = _core.run(case._tree, kind, directory, overwrite, resume, threads, callback, fields,
                    _command(kind, case, directory) if directory else "", note)
    return Result(raw, directory)


def run(case: CaseLike, *, out: str | os.PathLike[str] | None = None, overwrite: bool = False, resume: bool = False,
        threads: int = 0, callback: Callable[[_core.Progress], object] | None = None, fields: bool = False) -> Result:
    """Runs a case to its end in this process. The same bits as `ejecta run`.

    out: directory for its files, as the command writes them; None: nothing is written, histories are in the Result.
    overwrite, resume: a run that is there. threads: 0 for all cores.
    callback: called with a Progress before the first step and after each; True from it stops the run.
    fields: keep those of the last moment in the Result.

    Other threads of Python go on. ^C and exceptions of the callback stop it at a step, with a checkpoint where it has a
    directory, and are raised.
    """
    return _run("run", case, out, overwrite, resume, threads, callback, fields)


def jet(case: CaseLike, *, out: str | os.PathLike[str] | None = None, overwrite: bool = False, resume: bool = False,
        threads: int = 0, callback: Callable[[_core.Progress], object] | None = None) -> Result:
    """Computes only the jet of a case and stores it for later runs, as `ejecta jet` does."""
    return _run("jet", case, out, overwrite, resume, threads, callback, False)


class Sweep:
    """Settled jets. `compressible` and `incompressible` are lists of dicts, one a pressure and one a velocity; `result` is
    the whole result.json (docs/files.md)."""

    def __init__(self, result, directory=None):
        self.result = result
        self.directory = Path(directory) if directory else None

    @property
    def compressible(self) -> list[dict[str, Any]]:
        return self.result["compressible"]

    @property
    def incompressible(self) -> list[dict[str, Any]]:
        return self.result["incompressible"]

    def __getitem__(self, name):
        return self.result[name]

    def __repr__(self):
        return f"<ejecta.Sweep of {len(self.compressible)} pressures and {len(self.incompressible)} velocities>"


def sweep(case: CaseLike, *, out: str | os.PathLike[str] | None = None, overwrite: bool = False, threads: int = 0) -> Sweep:
    """Computes the settled jets of jet.sweep_pressures and jet.sweep_velocities, and the equivalent velocity of each
    pressure, as `ejecta jet --sweep` does. ^C ends it; it keeps nothing before its end."""
    require_count("threads", threads)
    case = as_case(case)
    directory = os.fspath(out) if out is not None else None
    result = _core.sweep(case._tree, directory, overwrite, threads, _command("jet --sweep", case, directory) if directory else "",
                         [f"{path}={toml}" for path, toml in case._changes.items() if toml], note)
    return Sweep(result, directory)


def program():
    """The program `ejecta` that belongs to this module."""
    library = Path(_core.library)
    for folder in library.parents:
        for place in (folder / "ejecta", folder / "bin" / "ejecta"):
            if place.is_file() and os.access(place, os.X_OK):
                return str(place)
    raise FileNotFoundError(f"no program ejecta above {library}")


def file_and_changes(case, directory, kind="run"):
    """The case as words of the command line; one that is not (or no more) a file, or that a command which knows no --set
    is to take, is saved beside its directory."""
    if case._file and None not in case._changes.values() and (kind != "campaign" or not case._changes):
        return [case._file, *_sets(case)]
    file = directory.parent / f"{directory.name}.toml"
    case.save(file)
    return [os.path.join(os.curdir, file)]  # one that begins with "-" would be an option


class Job:
    """A run in a process of its own. It goes on when Python ends; Job("my-case.run") finds it again."""

    def __init__(self, directory, process=None):
        self.directory = Path(directory)
        self._process = process

    def progress(self) -> dict[str, Any]:
        """How far it is: state ("starting", "running", "done", "stopped", "diverged", "failed"), and once it has begun
        fraction, time_s, end_time_s, step, wall_time_s, eta_s."""
        running = self.running  # asked first: it may end in between, and then it has said so
        file = self.directory / "progress.json"
        said = json.loads(file.read_text()) if file.exists() else {"state": "starting"}
        if said["state"] in ("starting", "running") and not running:
            said["state"] = "failed"
        return said

    @property
    def running(self) -> bool:
        if self._process:
            return self._process.poll() is None
        return _core.is_running(str(self.directory))

    def stop(self) -> None:
        """Asks it to stop with a checkpoint, and waits until it has."""
        if self._process:
            self._process.terminate()
            self._process.wait()
        elif self.running:
            os.kill(self.progress()["process"], signal.SIGTERM)
            while self.running:
                time.sleep(0.02)

    def wait(self) -> Result:
        """Waits for its end. Raises what went wrong there."""
        while self.running:
            time.sleep(0.05)
        if self._process and self._process.returncode in (1, 2, 3):
            raise error_of(self._process.returncode, _log_of(self.directory).read_text())
        return self.result()

    def result(self) -> Result:
        """Of a run that has ended."""
        said = self.progress()
        file = self.directory / "result.json"
        quantities = json.loads(file.read_text()) if file.exists() else None
        end = "stopped"
        if quantities:
            undecided = any(b.get("outcome") == "undecided" for b in quantities.get("bodies", []))
            end = "undecided" if undecided else "decided"
        return Result({
            "end": end, "time": said.get("time_s", 0.0), "steps": said.get("step", 0),
            "wall_time": said.get("wall_time_s", 0.0), "quantities": quantities,
            "verdict": _core.verdict_sentence(json.dumps(quantities)) if quantities else "", "later_end": None,
            "histories": {}, "fields": None,
        }, self.directory)

    def __repr__(self):
        return f"<ejecta.Job {self.directory}: {self.progress()['state']}>"


def _log_of(directory):
    return directory.parent / f"{directory.name}.log"


def error_of(code, words):
    """What a process of the program said, as the exception that it would have been here."""
    kind = {2: InputError, 3: DivergedError}.get(code, Error)
    return kind(words.strip().removeprefix("error: "))


def submit(case: CaseLike, *, out: str | os.PathLike[str], overwrite: bool = False, resume: bool = False,
           threads: int = 0) -> Job:
    """Runs a case in a process of its own, which outlives this one: a Job with progress(), stop() and wait(). What the
    process says stands in OUT.log. Raises CaseError before anything is started."""
    require_count("threads", threads)
    case, directory = as_case(case), Path(out)
    case._tree.check()
    words = [program(), "run", *file_and_changes(case, directory), "--out", str(directory)]
    words += ["--force"] * overwrite + ["--resume"] * resume + [f"--threads={threads}"] * (threads > 0)
    with open(_log_of(directory), "w") as log:
        return Job(directory, subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                               start_new_session=True))


RunLike = Union[Result, Job, Run, str, "os.PathLike[str]"]


def directories_of(runs):
    """Of runs in whatever form they are at hand."""
    found = [getattr(run, "directory", run) for run in runs]
    if not found or None in found:
        raise ValueError("it takes runs that have written files: those of run(case, out=...), or their directories")
    return [os.fspath(directory) for directory in found]


def report(*runs: RunLike, out: str | os.PathLike[str] | None = None) -> Path:
    """Writes the page of a run again, or of several laid over each other, as `ejecta report` does: report.html in the first
    directory unless `out` says where."""
    directories = directories_of(runs)
    file = Path(out) if out is not None else Path(directories[0]) / "report.html"
    _core.write_report(directories, str(file))
    return file


def table(*runs: RunLike, out: str | os.PathLike[str] = "results.csv") -> Path:
    """Writes the results of runs as one table, .csv or .xlsx, as `ejecta table` does."""
    _core.write_results(directories_of(runs), os.fspath(out))
    return Path(out)


def paraview(run: RunLike) -> Path:
    """Writes a view of a run for ParaView, as `ejecta paraview` does: view.py in its directory."""
    directory, = directories_of([run])
    file = Path(directory) / "view.py"
    file.write_text(_core.paraview_view(directory))
    return file
