"""Errors and warnings about input files, as data."""

import warnings
from typing import NamedTuple


class Complaint(NamedTuple):
    """One error or warning. `line` and `column` count from 1; 0: unknown. `what` is the message, `hint` a possible
    remedy. `id` is a stable identifier that does not change with the wording."""

    file: str
    line: int
    column: int
    what: str
    hint: str
    id: str = ""

    def __str__(self):
        at = self.file + (f":{self.line}:{self.column}" if self.line else "")
        return (f"{at}: " if at else "") + self.what + (f" ({self.hint})" if self.hint else "")


class InputError(ValueError):
    """Raised for an input with errors: `items` lists all of them as `Complaint` objects."""

    def __init__(self, items):
        self.items = list(items)
        super().__init__("\n".join(str(item) for item in self.items))

    def __reduce__(self):
        return (InputError, (self.items,))


class InputWarning(UserWarning):
    """Warning about an input that is valid, but probably a mistake."""


def warn(complaint):
    warnings.warn(str(complaint), InputWarning, stacklevel=3)
