"""All keys of a case, with their help: `help(ejecta.keys.valve)`, `ejecta.keys.valve.duration.help`. Each is the path that
a case takes: `case[ejecta.keys.valve.duration] = "6 ms"`. Names that Python keeps for itself end in an underscore:
`ejecta.keys.sorter.class_`."""

import keyword

from . import _core


class Key(str):
    """The path of a key, with what is known of it: help, takes, default, unit, source, example, words."""

    help: str
    takes: str
    default: str
    unit: str
    source: str
    example: str
    words: "dict[str, str]"

    def __new__(cls, section, entry):
        self = super().__new__(cls, f"{section}.{entry['name']}")
        self.help, self.takes, self.default = entry["help"], entry["takes"], entry["default"]
        self.unit, self.source, self.example, self.words = entry["unit"], entry["source"], entry["example"], entry["words"]
        self.__doc__ = f"{self.help}. Takes {self.takes}. Default: {self.default}."
        return self


class Section:
    """A section of the case file; its keys are its attributes."""


def attribute_name(name):
    return name + "_" if keyword.iskeyword(name) else name


def _explained(section):
    lines = [("[[{}]]" if section["repeated"] else "[{}]").format(section["name"]) + "  " + section["help"], ""]
    for key in section["keys"]:
        lines.append(f"{key['name']}: {key['help']}.")
        lines.append(f"    takes {key['takes']}; default {key['default']}")
    return "\n".join(lines)


def _sections():
    """Sections as classes, so that help() shows them; "grid.x" is an attribute of "grid"."""
    tops = {}
    for section in _core.schema("incompressible"):
        parts = section["name"].split(".")
        keys = {attribute_name(key["name"]): Key(section["name"], key) for key in section["keys"]}
        parts = [attribute_name(part) for part in parts]
        made = type(parts[-1], (Section,), {"__doc__": _explained(section), "__module__": __name__, **keys})
        if len(parts) == 1:
            tops[parts[0]] = made
            continue
        owner = tops.setdefault(parts[0], type(parts[0], (Section,), {"__doc__": parts[0], "__module__": __name__}))
        for part in parts[1:-1]:
            owner = getattr(owner, part)
        setattr(owner, parts[-1], made)
    return tops


globals().update(_sections())
