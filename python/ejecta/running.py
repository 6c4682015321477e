"""Running cases: in this process, in one of their own, many of them."""

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


def _note(line):
    """What a run says by the way goes to the logger `ejecta`."""
    level = logging.WARNING if line.startswith("warning: ") else logging.INFO
    _log.log(level, line.removeprefix("warning: "))


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


def check(case: CaseLike) -> Check:
    """Checks a case (a Case, a file or a dict) and says what a run of it will be; runs nothing. Raises CaseError."""
    return Check(*as_case(case)._tree.check())


def _sets(case):
    """What was changed, as words of the command line."""
    return [word for path, toml in case._changes.items() if toml for word in ("--set", f"{path}={toml}")]


def _command(kind, case, directory):
    """The line that runs it again, for the files of the run."""
    return shlex.join(["ejecta", kind, case.name, *_sets(case), "--out", directory])


def _require_count(name, count):
    if not 0 <= count <= 4096:
        raise ValueError(f"{name}={count}\n  expected: 0 for as many as there is room for, or how many")


def _run(kind, case, out, overwrite, resume, threads, callback, fields):
    case = as_case(case)
    directory = os.fspath(out) if out is not None else None
    if resume and not directory:
        raise ValueError("resume goes on with the run in a directory: say which, e.g. out=\"my-case.run\"")
    _require_count("threads", threads)
    raw = _core.run(case._tree, kind, directory, overwrite, resume, threads, callback, fields,
                    _command(kind, case, directory) if directory else "", _note)
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


def program():
    """The program `ejecta` that belongs to this module."""
    library = Path(_core.library)
    for folder in library.parents:
        for place in (folder / "ejecta", folder / "bin" / "ejecta"):
            if place.is_file() and os.access(place, os.X_OK):
                return str(place)
    raise FileNotFoundError(f"no program ejecta above {library}")


def _file_and_changes(case, directory, kind="run"):
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
            raise _error_of(self._process.returncode, _log_of(self.directory).read_text())
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


def _error_of(code, words):
    """What a process of the program said, as the exception that it would have been here."""
    kind = {2: InputError, 3: DivergedError}.get(code, Error)
    return kind(words.strip().removeprefix("error: "))


def submit(case: CaseLike, *, out: str | os.PathLike[str], overwrite: bool = False, resume: bool = False,
           threads: int = 0) -> Job:
    """Runs a case in a process of its own, which outlives this one: a Job with progress(), stop() and wait(). What the
    process says stands in OUT.log. Raises CaseError before anything is started."""
    _require_count("threads", threads)
    case, directory = as_case(case), Path(out)
    case._tree.check()
    words = [program(), "run", *_file_and_changes(case, directory), "--out", str(directory)]
    words += ["--force"] * overwrite + ["--resume"] * resume + [f"--threads={threads}"] * (threads > 0)
    with open(_log_of(directory), "w") as log:
        return Job(directory, subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=log, stderr=log,
                                               start_new_session=True))


RunLike = Union[Result, Job, Run, str, "os.PathLike[str]"]


def _directories(runs):
    """Of runs in whatever form they are at hand."""
    found = [getattr(run, "directory", run) for run in runs]
    if not found or None in found:
        raise ValueError("it takes runs that have written files: those of run(case, out=...), or their directories")
    return [os.fspath(directory) for directory in found]


def report(*runs: RunLike, out: str | os.PathLike[str] | None = None) -> Path:
    """Writes the page of a run again, or of several laid over each other, as `ejecta report` does: report.html in the first
    directory unless `out` says where."""
    directories = _directories(runs)
    file = Path(out) if out is not None else Path(directories[0]) / "report.html"
    _core.write_report(directories, str(file))
    return file


def table(*runs: RunLike, out: str | os.PathLike[str] = "results.csv") -> Path:
    """Writes the results of runs as one table, .csv or .xlsx, as `ejecta table` does."""
    _core.write_results(_directories(runs), os.fspath(out))
    return Path(out)


def paraview(run: RunLike) -> Path:
    """Writes a view of a run for ParaView, as `ejecta paraview` does: view.py in its directory."""
    directory, = _directories([run])
    file = Path(directory) / "view.py"
    file.write_text(_core.paraview_view(directory))
    return file


class Study:
    """Many runs of a case: `result` is its result.json, `runs` the table of them, a list of dicts."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.result = json.loads((self.directory / "result.json").read_text())

    @property
    def runs(self):
        return self.result["runs"]

    def to_pandas(self):
        """The table as a DataFrame."""
        import pandas

        return pandas.json_normalize(self.runs)

    def __getitem__(self, name):
        return self.result[name]


def _carry_out(kind, case, out, options, overwrite):
    """A command of the program on a case, to its end: its directory. ^C stops it; the same call goes on."""
    for name, count in options.items():
        _require_count(name.replace("-", "_"), count)
    case = as_case(case)
    directory = Path(out if out is not None else f"{Path(case.name).stem}.{kind}")
    words = [program(), kind, *_file_and_changes(case, directory, kind), "--out", str(directory), "-q"]
    words += ["--force"] * overwrite + [f"--{name}={value}" for name, value in options.items() if value > 0]
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                               text=True, start_new_session=True)
    try:
        said = process.communicate()[1]
    except KeyboardInterrupt:  # what is done stays
        process.terminate()
        process.wait()
        raise
    if process.returncode != 0:
        raise _error_of(process.returncode, said)
    return directory


def study(case: CaseLike, *, out: str | os.PathLike[str] | None = None, at_once: int = 0, overwrite: bool = False) -> Study:
    """Runs a case many times, as its [study] says, in processes of their own. One that was stopped by ^C goes on when it
    is called again."""
    return Study(_carry_out("study", case, out, {"at-once": at_once}, overwrite))


def map(case: CaseLike, *, out: str | os.PathLike[str] | None = None, at_once: int = 0,  # noqa: A001 (the name that the command has)
        overwrite: bool = False) -> Study:
    """Finds the places around the jet from which a particle is ejected, as [map] says."""
    return Study(_carry_out("map", case, out, {"at-once": at_once}, overwrite))


class Share(float):
    """A share of particles or of mass with the ends of its interval of 95 %: `low`, `high`."""

    low: float
    high: float

    def __new__(cls, value, low, high):
        share = super().__new__(cls, value)
        share.low, share.high = low, high
        return share

    def __repr__(self):
        return f"{float(self):.4g} ({self.low:.4g} to {self.high:.4g})"


class Sorting:
    """What became of a feed. `result` is its result.json (docs/files.md).

        sorting.recovery, sorting.purity, sorting.loss   # by mass; .low and .high: 95 %
        sorting.share("recovery")                        # by number
        sorting.fates                                    # what became of which class and why, a list of dicts
    """

    def __init__(self, directory):
        self.directory = Path(directory)
        self.result = json.loads((self.directory / "result.json").read_text())

    def share(self, name: str) -> Share:
        """A share of the result by its name; NaN where there is nothing to share."""
        numbers = (self.result[name], self.result[f"{name}_low"], self.result[f"{name}_high"])
        return Share(*(math.nan if number is None else number for number in numbers))

    @property
    def recovery(self) -> Share:
        """Of what is to be ejected, the mass that is."""
        return self.share("recovery_mass")

    @property
    def purity(self) -> Share:
        """Of the ejected product, the mass that belongs there."""
        return self.share("purity_mass")

    @property
    def loss(self) -> Share:
        """Of what is to be kept, the mass that is ejected."""
        return self.share("loss_mass")

    @property
    def fates(self) -> list[dict[str, Any]]:
        return self.result["fates"]

    def to_pandas(self):
        """fates.csv as a DataFrame."""
        import pandas

        return pandas.read_csv(self.directory / "fates.csv")

    def __getitem__(self, name):
        return self.result[name]

    def __repr__(self):
        return f"<ejecta.Sorting {self.result['summary']}>"


def sort(case: CaseLike, *, out: str | os.PathLike[str] | None = None, resolved: int = 0, threads: int = 0,
         overwrite: bool = False) -> Sorting:
    """Computes a whole sorter, from the feed to its two products, as [sorter] says; `resolved`: computes so many of its
    shots as runs, and corrects the result with them. One that was stopped by ^C goes on when it is called again."""
    return Sorting(_carry_out("sort", case, out, {"resolved": resolved, "threads": threads}, overwrite))


class Campaign:
    """A programme of runs, jets, maps and studies: `parts` is a list of dicts (docs/files.md)."""

    def __init__(self, directory):
        self.directory = Path(directory)
        self.result = json.loads((self.directory / "result.json").read_text())

    @property
    def parts(self) -> list[dict[str, Any]]:
        return self.result["parts"]

    def part(self, number: int) -> Run | Study:
        """What a part has left: the files of a run or jet, or the study or map."""
        part = self.parts[number]
        directory = self.directory / part["directory"]
        return Study(directory) if part["kind"] in ("study", "map") else Run(directory)

    def __repr__(self):
        done = sum(part["done"] for part in self.parts)
        return f"<ejecta.Campaign {self.result['title']}: {done} of {len(self.parts)} parts done>"


def campaign(case: CaseLike, *, out: str | os.PathLike[str] | None = None, overwrite: bool = False) -> Campaign:
    """Carries out a programme of runs, jets, maps and studies, as [campaign] says. Parts that are done stay: one that was
    stopped by ^C goes on when it is called again."""
    return Campaign(_carry_out("campaign", case, out, {}, overwrite))


class Margin:
    """By how much (m) a body clears the edge of the plate, as a function of some keys: what optimisers ask for.

        margin = ejecta.Margin(case, ["valve.supply_pressure", "valve.duration"])
        margin("5 bar gauge", "6 ms")       # or numbers in SI units; negative: not ejected
    """

    def __init__(self, case: CaseLike, keys: Sequence[str], *, body: str | None = None, threads: int = 0) -> None:
        self.case, self.keys, self.body, self.threads = as_case(case).copy(), list(keys), body, threads

    def __call__(self, *values: Any) -> float:
        if len(values) != len(self.keys):
            raise TypeError(f"{len(values)} values for the keys {', '.join(self.keys)}")
        self.case.update(dict(zip(self.keys, values)))
        return run(self.case, threads=self.threads).margin(self.body)
