"""Many runs: studies, maps, sorters, campaigns, margins."""

from __future__ import annotations

import json
import math
import os
import subprocess
from pathlib import Path
from typing import Any, Sequence

from . import _core
from .case import CaseLike, as_case
from .run_files import Run
from .running import error_of, file_and_changes, note, program, require_count, run


class Study:
    """Many runs of a case, or a map; Study("my-case.study") finds one again, also while it goes on. `result` is its
    result.json, `runs` the table of them, a list of dicts."""

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = Path(directory)

    @property
    def result(self) -> dict[str, Any]:
        """As it stands now."""
        return json.loads((self.directory / "result.json").read_text())

    @property
    def runs(self) -> list[dict[str, Any]]:
        return self.result["runs"]

    def status(self) -> dict[str, Any]:
        """How far it is, as `ejecta study status` says: runs, done, running, waiting, failed, seconds_left, `lines` of what
        runs and what failed, and all in a `summary`."""
        return _core.study_status(str(self.directory))

    def stop(self) -> None:
        """Asks whoever works on it to stop: runs end with a checkpoint within a second or two."""
        _core.study_stop(str(self.directory))

    def collect(self) -> Study:
        """Writes runs.csv, result.json and the report of what is done so far."""
        _core.study_collect(str(self.directory))
        return self

    def to_pandas(self):
        """The table as a DataFrame."""
        import pandas

        return pandas.json_normalize(self.runs)

    def __getitem__(self, name):
        return self.result[name]

    def __repr__(self):
        return f"<ejecta.Study {self.directory}: {self.status()['summary']}>"


def _words(kind, case, directory, options, overwrite):
    """A command of the program on a case, as words."""
    words = [program(), kind, *file_and_changes(case, directory, kind), "--out", str(directory)]
    words += ["--force"] * overwrite
    for name, value in options.items():
        name = name.replace("_", "-")
        if isinstance(value, int) and not isinstance(value, bool):
            require_count(name, value)
        for one in value if isinstance(value, (list, tuple)) else [value]:
            words += [f"--{name}"] if one is True else [f"--{name}={one}"] if one else []
    return words


def _directory(kind, case, out):
    return Path(out if out is not None else f"{Path(case.name).stem}.{kind}")


def _has_error(said):
    return any("error: " in line for line in said)


def _error_words(said):
    """What went wrong, without the progress before it."""
    start = next((n for n, line in enumerate(said) if "error: " in line), 0)
    return "\n".join(said[start:])


def _carry_out(kind, case, out, options, overwrite):
    """A command of the program on a case, to its end: its directory. What it says on its way goes to the logger. ^C stops
    it; the same call goes on."""
    case = as_case(case)
    directory = _directory(kind, case, out)
    process = subprocess.Popen(_words(kind, case, directory, options, overwrite), stdin=subprocess.DEVNULL,
                               stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True, start_new_session=True)
    said = []
    try:
        with process.stderr:
            for line in process.stderr:
                said.append(line.rstrip("\n"))
                if not _has_error(said):  # which is raised
                    note(said[-1])
        process.wait()
    except KeyboardInterrupt:  # what is done stays
        process.terminate()
        process.wait()
        raise
    if process.returncode != 0:
        if process.returncode == 2:
            case._tree.check()  # what is wrong with the case, problem by problem
        raise error_of(process.returncode, _error_words(said))
    return directory


def study(case: CaseLike, *, out: str | os.PathLike[str] | None = None, at_once: int = 0, overwrite: bool = False,
          retry: bool = False, slurm: bool = False, sbatch: Sequence[str] = ()) -> Study:
    """Runs a case many times, as its [study] says, in processes of their own. One that was stopped by ^C goes on when it
    is called again.

    at_once: runs side by side; 0 for as many as cores and memory allow. retry: also what diverged or was refused.
    slurm: as job arrays of this machine's cluster, with the options `sbatch`, e.g. ["--time=2:00:00"].
    How far it is: `logging.basicConfig(level="INFO")`, or Study(out).status() elsewhere.
    """
    return Study(_carry_out("study", case, out, dict(at_once=at_once, retry=retry, slurm=slurm, sbatch=list(sbatch)), overwrite))


def map(case: CaseLike, *, out: str | os.PathLike[str] | None = None, at_once: int = 0,  # noqa: A001 (the name that the command has)
        overwrite: bool = False, retry: bool = False, slurm: bool = False, sbatch: Sequence[str] = ()) -> Study:
    """Finds the places around the jet from which a particle is ejected, as [map] says. Options as those of study()."""
    return Study(_carry_out("map", case, out, dict(at_once=at_once, retry=retry, slurm=slurm, sbatch=list(sbatch)), overwrite))


def commands(case: CaseLike, *, kind: str = "study", out: str | os.PathLike[str] | None = None,
             overwrite: bool = False) -> list[str]:
    """The commands that a study, a map or a campaign (`kind`) has left to run, for any scheduler; runs nothing. A map asks
    again when these are done. Study(out).collect() makes the table of what was run so."""
    if kind not in ("study", "map", "campaign"):
        raise ValueError(f"kind={kind!r}\n  expected: one of study, map, campaign")
    case = as_case(case)
    words = _words(kind, case, _directory(kind, case, out), dict(print_commands=True), overwrite)
    done = subprocess.run(words, stdin=subprocess.DEVNULL, capture_output=True, text=True)
    if done.returncode != 0:
        if done.returncode == 2:
            case._tree.check()
        raise error_of(done.returncode, _error_words(done.stderr.splitlines()))
    return done.stdout.splitlines()


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
    return Sorting(_carry_out("sort", case, out, dict(resolved=resolved, threads=threads), overwrite))


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
