"""What tells, checks and measures: the rest of the command line."""

from __future__ import annotations

import atexit
import os
import subprocess
from pathlib import Path
from typing import Any, NamedTuple

from . import _core
from .case import CaseLike, as_case
from .running import error_of, note, program, require_count


class Operator(NamedTuple):
    """One operator of a time step."""

    name: str
    equation: str


class Plan(list):
    """The operators of a time step in their order, each with name and equation; `print` shows it as `ejecta plan` does."""

    def __init__(self, text, operators):
        super().__init__(Operator(*one) for one in operators)
        self._text = text

    def __repr__(self):
        return self._text


def plan(case: CaseLike) -> Plan:
    """The operators of a time step of a case with their equations; computes nothing. Raises CaseError."""
    return Plan(*_core.plan(as_case(case)._tree))


def explain(topic: str = "") -> str:
    """What `ejecta explain` says of keys of a case and words of results: a section, a key, or words to search for; all keys
    without one."""
    return _core.explain(topic)


def new(kind: str = "ejection") -> str:
    """The text of a commented case to start from, as `ejecta new` prints it: Case.parse(new()) is a case of it, and a file
    of it can be edited and loaded. Kinds:
    """
    return _core.new(kind)


new.__doc__ += "".join(f"\n    {kind:<12} {words}" for kind, words in _core.new_kinds().items())


class Validation:
    """A case held against its [[expect]] tables. `passed`; `comparisons`, a list of dicts: quantity, computed, reference,
    error, source, series, passed; `failure` ("bad input", "diverged", "failed") and `message` where it did not run."""

    name: str
    failure: str
    message: str
    comparisons: list[dict[str, Any]]
    passed: bool

    def __init__(self, values):
        self.__dict__.update(values)

    def __repr__(self):
        met = sum(comparison["passed"] for comparison in self.comparisons)
        return f"<ejecta.Validation {self.name}: {self.failure or f'{met} of {len(self.comparisons)} met'}>"


class Validations(list):
    """What became of each case; `passed`: of all. `print` shows the table of `ejecta validate`."""

    def __init__(self, table, validations):
        super().__init__(Validation(values) for values in validations)
        self._table = table

    @property
    def passed(self) -> bool:
        return all(validation.passed for validation in self)

    def __repr__(self):
        return self._table


def validate(*names: str | os.PathLike[str], out: str | os.PathLike[str] = "validation.runs", threads: int = 0) -> Validations:
    """Runs validation cases into directories below `out` and compares them with their references. `names`: parts of names of
    shipped cases, case files or directories; none: all shipped ones."""
    require_count("threads", threads)
    return Validations(*_core.validate([os.fspath(name) for name in names], os.fspath(out), threads, note))


def validation_cases(*names: str | os.PathLike[str]) -> list[Path]:
    """The files that validate() would run."""
    return [Path(file) for file in _core.validation_cases([os.fspath(name) for name in names])]


def bench(*, threads: int = 0, steps: int = 20, only: str = "") -> str:
    """Measures cell-steps and particle-steps per second on standard cases, operator by operator: the tables of
    `ejecta bench`. only: "dem", "settled" or "grains", and nothing else."""
    require_count("threads", threads)
    if only not in ("", "dem", "settled", "grains"):
        raise ValueError(f"only={only!r}\n  expected: one of dem, settled, grains")
    if not 1 <= steps <= 100000:
        raise ValueError(f"steps={steps}\n  expected: timed steps, 1 to 100000")
    lines = []
    _core.bench(threads, steps, only, lines.append)
    return "\n".join(lines)


def cache() -> list[Path]:
    """The stored jets, which later runs of the same jet take from there."""
    folder = Path(_core.cache_directory())
    return sorted(file for file in folder.glob("jet-*") if file.is_file())


def clear_cache() -> int:
    """Removes the stored jets; later runs compute theirs again. Returns how many there were."""
    return _core.clear_cache()


class Server:
    """The workbench, a process of its own that ends with stop() or with Python; its runs go on. `address`: open it in a
    browser of this machine."""

    def __init__(self, process, address):
        self._process, self.address = process, address

    def stop(self) -> None:
        self._process.terminate()
        self._process.wait()
        self._process.stdout.close()

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.stop()

    def __repr__(self):
        return f"<ejecta.Server {self.address}>"


def serve(folder: str | os.PathLike[str] = ".", *, port: int = 0) -> Server:
    """Starts the workbench on a folder of cases, as `ejecta serve` does. port: 0 for any that is free."""
    words = [program(), "serve", os.path.join(os.curdir, os.fspath(folder))] + [f"--port={port}"] * (port != 0)
    process = subprocess.Popen(words, stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True)
    address = process.stdout.readline().strip()
    if not address:
        said = process.communicate()[1]
        raise error_of(process.returncode, said)
    atexit.register(process.terminate)
    process.stderr.close()
    return Server(process, address)
