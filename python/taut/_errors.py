"""What is wrong with an input, as data."""

import warnings
from typing import NamedTuple


class Complaint(NamedTuple):
    """One complaint. `line` and `column` count from 1; 0: not known."""

    file: str
    line: int
    column: int
    what: str
    hint: str

    def __str__(self):
        at = self.file + (f":{self.line}:{self.column}" if self.line else "")
        return (f"{at}: " if at else "") + self.what + (f" ({self.hint})" if self.hint else "")


class InputError(ValueError):
    """An input that cannot be used: `items` has all that is wrong with it, as `Complaint`s."""

    def __init__(self, items):
        self.items = list(items)
        super().__init__("\n".join(str(item) for item in self.items))

    def __reduce__(self):
        return (InputError, (self.items,))


class InputWarning(UserWarning):
    """What can be used, but is hardly meant."""


def warn(complaint):
    warnings.warn(str(complaint), InputWarning, stacklevel=3)
