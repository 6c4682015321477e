"""Ejecta predicts which particles an air-jet sorter ejects.

    import ejecta
    case = ejecta.Case.load("tutorial")
    case["valve.supply_pressure"] = "650 kPa gauge"
    print(ejecta.check(case))
    result = ejecta.run(case)
    print(result.verdict)

Every command of the command line is here by its name, in the same words. `help(ejecta.run)`, `help(ejecta.Case)`,
`help(ejecta.keys.valve)` tell more; docs/python.md tells all. Files of runs
(`ejecta.Run`) can be read without the compiled part of the module.
"""

from .errors import CaseError, DivergedError, Error, InputError
from .quantity import Array, Quantity
from .run_files import Run, Table, read_vtr, rotation

try:
    from . import _core
except ImportError as _missing:
    _reason = _missing

    def __getattr__(name):
        if name.startswith("_"):
            raise AttributeError(name)
        raise ImportError(f"ejecta.{name} needs the compiled part of the module ({_reason})\n"
                          "  expected: build it with pybind11-dev and python3-dev installed, then PYTHONPATH=build/release/python")
else:
    from . import keys
    from .case import Case, shape
    from .many import Campaign, Margin, Share, Sorting, Study, campaign, commands, map, sort, study
    from .running import Check, Job, Result, Sweep, check, jet, paraview, report, run, submit, sweep, table
    from .tools import (
        Operator, Plan, Server, Validation, Validations, bench, cache, clear_cache, explain, new, plan, serve, validate,
        validation_cases,
    )

    __version__ = _core.version
    Shape, Progress = _core.Shape, _core.Progress
