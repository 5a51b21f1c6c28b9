"""Checks that docs/robustness.md names a test for each promise and each attack, and that these tests exist."""

import ast
import re

from page import ROOT, Page, refuse

TESTS = ROOT / "tests"


def names():
    """Returns Suite.Name of all tests."""
    found = set()
    for path in TESTS.rglob("*.cpp"):
        found |= {f"{suite}.{name}" for suite, name in re.findall(r"^TEST(?:_[FP])?\((\w+), (\w+)\)", path.read_text(), re.M)}
    for path in TESTS.rglob("CMakeLists.txt"):
        found |= set(re.findall(r"add_test\(NAME ([\w.]+)", path.read_text()))
        found |= {f"Fuzz.{name}" for name in re.findall(r"^taut_fuzz\((\w+) ", path.read_text(), re.M)}
    found |= {f"Faults.{name}" for name in re.findall(r"^def ([A-Z]\w+)", (TESTS / "faults/faults_test.py").read_text(), re.M)}
    found |= {f"Faults.{name}" for name in re.findall(r"\b([a-z_]+):\d+", (TESTS / "faults/CMakeLists.txt").read_text())}
    for suite, script in (("NewRobot", "new_robot_test"), ("Pipes", "pipes_test")):
        found |= {f"{suite}.{name}" for name in re.findall(r"^def ([A-Z]\w+)", (TESTS / f"system/{script}.py").read_text(), re.M)}
    for path in (TESTS / "python").glob("*_test.py"):
        for suite in ast.parse(path.read_text()).body:
            if isinstance(suite, ast.ClassDef):
                found |= {f"{suite.name}.{test.name}" for test in suite.body if isinstance(test, ast.FunctionDef)}
    found |= {f"Web.{path.name.removesuffix('.test.mjs')}" for path in (ROOT / "web/test").glob("*.test.mjs")}
    return found


def main():
    lines = [line for _, line in Page(ROOT / "docs/robustness.md").prose]
    promises, tests, attacks, faults = (lines.index(f"## {title}") for title in (
        "Guaranteed behavior", "Tests", "Attacks tried", "System calls that fail"))
    tested = [line for begin, end in ((promises, tests), (attacks, faults)) for line in lines[begin:end]]
    rows = [line for line in tested if line.startswith("| ")] + [line for line in lines[faults:] if line.startswith("| ")]
    there, wrong = names(), []
    counts = r"\| \d+ \| \d+ \| \d+ \|$"  # of attacks by hand
    for row in tested:
        if re.match(r"\| (?!event|attack|part)", row) and not re.search(counts + r"|`[A-Z]\w+\.\w+`[^|]*\|$", row):
            wrong.append(f"docs/robustness.md: no test in the row: {row}")
    python = [line for line in lines[lines.index("### Attacks on the Python module"):] if "test_" in line]
    assert len(python) > 15, f"{len(python)} rows of the Python module"
    for row in rows:
        held = [text for text in re.findall(r"`([^`]+)`", row.rstrip(" |").split(" | ")[-1]) if re.fullmatch(r"[A-Z]\w+\.\w+", text)]
        wrong += [f"docs/robustness.md: there is no test {name}" for name in held if name not in there]
    assert len(rows) > 100, f"{len(rows)} rows"
    refuse(wrong)


if __name__ == "__main__":
    main()
