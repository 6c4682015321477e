"""Writes the stub of ejecta.keys from the schema: make_key_stubs.py FILE. An editor completes and explains keys with it."""

import sys
from pathlib import Path

import ejecta.keys


def documented(what, indent):
    return [f'{indent}    """{what.__doc__}'.replace("\\", "\\\\"), f'{indent}    """']


def stub(section, indent=""):
    lines = [f"{indent}class {section.__name__}(Section):", *documented(section, indent)]
    for name, value in vars(section).items():
        if isinstance(value, ejecta.keys.Key):
            lines += [f"{indent}    {name}: ClassVar[Key]", *documented(value, indent)]
        elif isinstance(value, type):
            lines += stub(value, indent + "    ")
    return lines


lines = ["from typing import ClassVar", "", "class Key(str):"]
lines += [f"    {name}: str" for name in ("help", "takes", "default", "unit", "source", "example")]
lines += ["    words: dict[str, str]", "", "class Section: ..."]
for name, value in vars(ejecta.keys).items():
    if isinstance(value, type) and issubclass(value, ejecta.keys.Section) and value is not ejecta.keys.Section:
        lines += [""] + stub(value)
Path(sys.argv[1]).write_text("\n".join(lines) + "\n")
