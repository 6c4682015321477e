"""Cases: what the user wrote, key by key."""

from __future__ import annotations

import functools
import json
import os
from pathlib import Path
from typing import Any, Mapping, Union

from . import _core
from .errors import CaseError
from .quantity import Array, Quantity


@functools.lru_cache(maxsize=None)
def _sections(solver):
    return {section["name"]: section for section in _core.schema(solver)}


class _Schema:
    """Which unit a key has, for a solver: pressures of boundaries are gauge in incompressible flow."""

    def __init__(self, solver):
        self._sections = _sections(solver)

    def unit(self, path):
        """Of "valve.duration", "body.0.density", "body.cube.density"; None where the key is a plain value or unknown."""
        parts = path.split(".")
        for end in range(len(parts) - 1, 0, -1):
            name, rest = ".".join(parts[:end]), parts[end:]
            section = self._sections.get(name) or self._sections.get(self._plain(name))
            if section is None:
                continue
            if section["repeated"] and len(rest) == 2:
                rest = rest[1:]
            if len(rest) == 1:
                return next((key["unit"] for key in section["keys"] if key["name"] == rest[0]), None) or None
        return None

    @staticmethod
    def _plain(name):  # "boundary.z_min.patch.0" is the section "boundary.z_min.patch"
        return ".".join(part for part in name.split(".") if not part.isdigit())

    def toml(self, value, path):
        """A value of Python as TOML: numbers of a key with a unit are in SI units."""
        if isinstance(value, os.PathLike):
            value = os.fspath(value)
        if hasattr(value, "tolist"):  # of numpy
            value = value.tolist()
        if isinstance(value, bool):
            return "true" if value else "false"
        if isinstance(value, (int, float)):
            unit = self.unit(path)
            number = float.__repr__(value) if isinstance(value, float) else repr(value)
            return json.dumps(f"{number} {unit}") if unit else number
        if isinstance(value, str):
            return json.dumps(value, ensure_ascii=False)
        if isinstance(value, dict):
            inner = (f"{json.dumps(str(k))} = {self.toml(v, self._of_study(path, value, k))}" for k, v in value.items())
            return "{" + ", ".join(inner) + "}"
        if isinstance(value, (list, tuple)):
            items = (self.toml(v, f"{path}.{n}" if isinstance(v, dict) else path) for n, v in enumerate(value))
            return "[" + ", ".join(items) + "]"
        raise TypeError(f"{path}: {type(value).__name__} has no place in a case\n  expected: a text with its unit, a number in "
                        f"SI units, a list or dict of them\n  example:  case[{path!r}] = \"650 kPa gauge\"")

    @staticmethod
    def _of_study(path, table, name):
        """The values over which [[study.vary]] goes are values of the key that it names."""
        if path.startswith("study.vary") and name in ("values", "from", "to"):
            return str(table.get("key", ""))
        return f"{path}.{name}" if path else str(name)

    def document(self, tables):
        """{"valve": {"duration": 0.008}, "body": [{...}]} as the text of a case file."""
        return "".join(f"{name} = {self.toml(value, name)}\n" for name, value in tables.items())


def _with_unit(value, unit):
    if not unit or value is None or isinstance(value, (str, bool)):
        return value
    if isinstance(value, (int, float)):
        return Quantity(value, unit)
    if any(isinstance(v, str) for v in value):  # formulas
        return value
    return Array(value, unit)


class Case:
    """A case: a file with what was set since, or a dict of its sections.

        case = ejecta.Case.load("my-case.toml")           # a file, or the name of a shipped case: "tutorial"
        case["valve.supply_pressure"] = "650 kPa gauge"   # as in the file,
        case["valve.duration"] = 0.006                    # or a number in SI units
        case["valve.duration"].unit                       # 's'
        case["body.particle.density"] = "2650 kg/m3"      # elements of lists by their name or number
        case = ejecta.Case({"run": {"end_time": "20 ms"}, "body": [{"shape": "sphere", "diameter": 0.01}]})

    Whatever is wrong raises CaseError with the words of the command line. Setting a key says what is wrong with that
    value; what contradicts something else is said when the case is used, so that several keys can be changed one after
    the other. `ejecta.keys` has all keys with their help.
    """

    def __init__(self, tables: Mapping[str, Any]) -> None:
        solver = tables.get("flow", {}).get("solver")
        if solver is None:
            solver = Case.load(tables["extends"])._tree.solver() if "extends" in tables else "incompressible"
        solver = str(solver)
        self._tree = _core.CaseTree(_Schema(solver).document(tables), "Case({...})")
        self._file: str | None = None
        self._changes: dict[str, str | None] = {}  # path -> TOML, as --set takes it

    @classmethod
    def load(cls, path: str | os.PathLike[str]) -> Case:
        """The case of a file, or the shipped case of that name."""
        case = cls.__new__(cls)
        case._tree = _core.CaseTree.load(os.fspath(path))
        case._file = case._tree.name
        case._changes = {}
        return case

    @classmethod
    def parse(cls, text: str, name: str = "case.toml") -> Case:
        """The case of the text of a case file; `name` stands for the file in messages, and files that it names are relative
        to the folder of that."""
        case = cls.__new__(cls)
        case._tree = _core.CaseTree(text, name)
        case._file = None
        case._changes = {}
        return case

    def copy(self) -> Case:
        """A case of its own with the same values."""
        other = Case.__new__(Case)
        other._tree, other._file, other._changes = self._tree.copy(), self._file, dict(self._changes)
        return other

    def __getitem__(self, path: str) -> Any:
        """The value of a key in SI units, with `unit`; a word or formula as text."""
        value, unit = self._tree.get(path)
        return _with_unit(value, unit)

    def __setitem__(self, path: str, value: Any) -> None:
        self.update({path: value})

    def update(self, values: Mapping[str, Any]) -> None:
        """Sets several keys at once: all, or none where one is wrong. None: back to the default, as another shape needs
        it: case.update({"body.cube.shape": "sphere", "body.cube.diameter": "12 mm", "body.cube.size": None})."""
        schema = _Schema(str(values.get("flow.solver") or self._tree.solver()))
        for path in (path for path, value in values.items() if value is None):
            self._tree.get(path)  # one that there is not
        changes = {path: None if value is None else schema.toml(value, path) for path, value in values.items()}
        self._tree.set([(path, toml, f"case[{json.dumps(path)}]") for path, toml in changes.items()])
        self._changes.update(changes)

    __iter__ = None  # `in` and list() would count from 0

    def __contains__(self, path: str) -> bool:
        """Whether there is such a key."""
        try:
            self._tree.get(path)
        except CaseError:
            return False
        return True

    def __delitem__(self, path: str) -> None:
        """Back to the default. Raises CaseError where there is no such key."""
        self.update({path: None})

    def toml(self) -> str:
        """The case as a file says it, resolved: defaults as comments, names of files absolute."""
        return self._tree.toml()

    def save(self, path: str | os.PathLike[str]) -> None:
        """Writes it as a case file."""
        Path(path).write_text(self.toml())

    @property
    def title(self) -> str | None:
        return self["run.title"]

    @property
    def name(self) -> str:
        """Of its file."""
        return self._tree.name

    def shape(self, body: str = "") -> _core.Shape:
        """The solid of the body of that name; of the first without one."""
        return _core.shape_of(self._tree, body)

    def __repr__(self):
        return f"<ejecta.Case {self.name}: {self.title}>" if self.title else f"<ejecta.Case {self.name}>"


CaseLike = Union[Case, str, "os.PathLike[str]", Mapping[str, Any]]


def as_case(case: CaseLike) -> Case:
    """A case from a Case, a path or a dict."""
    if isinstance(case, Case):
        return case
    return Case(case) if isinstance(case, Mapping) else Case.load(case)


def shape(**keys: Any) -> _core.Shape:
    """The solid that the keys of a [[body]] describe, with their units.

        rock = ejecta.shape(shape="mesh", file="rock.stl", scale=1e-3)
        rock.signed_distance([[0, 0, 0]]), rock.mass_properties(2650), rock.surface()
    """
    return Case({"run": {"end_time": "1 s"}, "flow": {"solver": "none"}, "body": [keys]}).shape()
