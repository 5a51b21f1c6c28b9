"""List of measurements, with lookup by engine, setting, robot and size."""

from validation.runs import Problem

UNCONVERGED = "*"  # marks results with a step that reached the maximum number of linear solves, or was not solved


class Results:
    def __init__(self, items):
        self.items = items

    def of(self, **wanted):
        return [item for item in self.items if all(item[key] == value for key, value in wanted.items())]

    def one(self, **wanted):
        found = self.of(**wanted)
        if len(found) > 1:
            raise Problem(f"{len(found)} results for {wanted}")
        return found[0] if found else None

    def rate(self, **wanted):
        found = self.one(**wanted)
        return found["steps_per_s"] if found else None


def mark(item):
    return "" if item.get("converged", True) else UNCONVERGED


def shared(machine):
    """Returns whether other programs ran at the same time, which affects wall-clock times."""
    return machine["load"][0] > machine["cores"] / 2
