"""What goes wrong, in the words of the command line."""


class Error(Exception):
    """Of anything that Ejecta says."""


class InputError(Error, ValueError):
    """The input is wrong."""


class CaseError(InputError):
    """A case is wrong. `problems` has each thing that is wrong as a dict: severity, key, what, and where they are known
    expected, nearest, example, file, line, column. `key`, `line` and `expected` are those of the first."""

    def __init__(self, text, problems):
        super().__init__(text)
        self.problems = problems
        first = problems[0] if problems else {}
        self.key = first.get("key")
        self.line = first.get("line")
        self.expected = first.get("expected")

    def __reduce__(self):  # so that it survives the way out of a process pool
        return type(self), (str(self), self.problems)


class DivergedError(Error, ArithmeticError):
    """The computation left the realm of numbers; says where, when and what to try."""
