"""Numbers that know their unit."""

import numpy


class Quantity(float):
    """A number in SI units; `unit` says which ("1": a plain number). Calculates as the float that it is."""

    def __new__(cls, value, unit):
        self = super().__new__(cls, value)
        self.unit = unit
        return self

    def __repr__(self):
        return f"{float(self)!r} {self.unit}"

    def __reduce__(self):
        return Quantity, (float(self), self.unit)


class Array(numpy.ndarray):
    """An array in SI units; `unit` says which. Views and slices keep it; what is calculated is a plain array."""

    def __new__(cls, values, unit):
        self = numpy.asarray(values).view(cls)
        self.unit = unit
        return self

    def __array_finalize__(self, of):
        self.unit = getattr(of, "unit", None)

    def __array_wrap__(self, result, context=None, return_scalar=False):
        plain = numpy.asarray(result)
        return plain[()] if plain.ndim == 0 else plain
