"""The Python module with failing calls: allocations by its libraries (not by the interpreter), and file operations.

An allocation that fails must become MemoryError, or taut.InputError where a child process reads a trace. The same work,
done again in the same process without faults, must then have the right result."""

import os
import pathlib
import re

from robustness import fits
from robustness.scenarios import CRAWL, Reader, STUDY, SWING, digest
from validation.runs import ROOT

# Parts of the names of the libraries whose allocations fail. The interpreter and NumPy use none of them.
LIBRARIES = "taut/_core.:libstdc++:libyaml-cpp:libsqlite3:libnlopt:libpng:libz.:libfmt"
ALLOCATIONS = ("malloc", "calloc", "realloc", "memalign", "aligned_alloc", "posix_memalign", "strdup")
MAIN = """\
import ctypes, sys
import numpy
{imports}
library = ctypes.CDLL(None)
begin, end = (getattr(library, f"taut_faults_{{word}}", lambda: None) for word in ("begin", "end"))

def work():
{work}
    return result

begin()
try:
    result = work()
    end()
except BaseException as error:
    end()
    print("error: " + type(error).__name__ + ": " + str(error), file=sys.stderr)
    if {again}:
        print(work())
    sys.exit(1)
print(result)
"""


class Module(Reader):
    """A program whose calls within `work` fail. `work` sets `result`, which is printed. `again`: after an error, the
    program repeats the work without faults."""
    kinds = ("memory", "hdf5", "open", "close", "read")
    imports, work, again = "import taut", "", True

    def __init__(self, program, folder):
        self.taut = program
        module = pathlib.Path(program.command).parent / "python"
        variables = {"TAUT_FAULT_LIBRARIES": LIBRARIES, "PYTHONDONTWRITEBYTECODE": "1",
                     "PYTHONPATH": os.pathsep.join(filter(None, [str(module), os.environ.get("PYTHONPATH")]))}
        super().__init__(program.instead(program.python, variables), folder)

    def prepare(self):
        work = "\n".join("    " + line for line in self.work.splitlines())
        (self.before / "main.py").write_text(MAIN.format(imports=self.imports, work=work, again=self.again))
        (self.before / "swing.yaml").write_text(SWING)

    def words(self):
        return ("main.py",)

    def made_by_taut(self, *words):
        run = self.taut.plain(words, self.before)
        assert run.returncode == 0, run.stderr

    def lacks_reason(self, outcome):
        """Describes an error that does not report missing memory, or after which the module works no longer; returns
        None for other outcomes."""
        if outcome.status != 1:
            return None
        if outcome.first.split(" ")[0] in ALLOCATIONS and not re.search("MemoryError|InputError|[Mm]emory", outcome.errors):
            return f"no memory, but {outcome.errors!r}"
        if self.again and outcome.output != self.right.output:
            return f"the same work after the error: {outcome.output!r} {outcome.errors!r}"
        return None

    def check(self, outcome, folder):
        return self.lacks_reason(outcome) or super().check(outcome, folder)


class Import(Module):
    """The import of the module. An import after a failed one is not tried: types of pybind11 stay registered."""
    kinds = ("memory",)
    imports, work, again = "", "import taut\nresult = taut.__version__", False


class Run(Module):
    work = """\
run = taut.run(taut.load("swing.yaml"))
result = run.state_hash, len(run.trace), run.trace["cable/cable/tension_n"].tolist(), run.max_tension_n"""


class Trace(Module):
    work = """\
result = [(len(trace), [trace[name].sum() for name in trace.channels], trace.metadata)
          for trace in (taut.read_trace("run"), taut.read_trace("run/trace.csv"))]"""

    def prepare(self):
        super().prepare()
        self.made_by_taut("run", "swing.yaml", "--csv", "--quiet", "--out", "run")


class Batch(Module):
    work = """\
batch = taut.Batch(taut.load("swing.yaml"), 5, threads=2)
batch.step(0.001, 10)
saved = batch.save(1)
batch.set_parameter("gravity_z_m_per_s2", [0, -1, -2, -3, -4])
lengths_m = numpy.tile(batch.rest_length_m(), (2, 1, 1)).swapaxes(0, 1).copy()
nodes_m = batch.rollout(lengths_m, 0.001, 5)
batch.restore(saved, 2)
batch.step(0.001, 10)
result = [batch.hash(world) for world in range(5)], nodes_m.sum(), batch.contacts(0), batch.status().tolist()"""


class Simulation(Module):
    work = """\
simulation = taut.Simulation("swing.yaml", 3, threads=2)
simulation.run_until(0.02)
saved = simulation.save(1)
simulation.run_until(0.04)
simulation.restore(saved, 2)
simulation.run_until(0.04)
result = [simulation.hash(world) for world in range(3)]"""


class Environments(Module):
    imports = "import taut, taut.gym"
    work = f"""\
envs = taut.gym.make_vec("{ROOT}/share/experiments/learn_spine.yaml", 3, threads=2, judge=lambda *_: None)
envs.reset(seed=1)
for _ in range(2):
    envs.step(numpy.zeros(envs.action_space.shape))
saved = envs.save(1)
envs.restore(saved, 2)
result = [envs.hash(world) for world in range(3)]"""


class Learn(Module):
    """A search with a log. After the fault, the same search must resume to the same result."""
    kinds = ("memory", "open", "close", "read", "write", "sync", "name", "truncate")
    work = """\
study = taut.learn("study.yaml", "study", threads=1)
result = study.best, study.best_score, study.values.tolist(), study.scores.tolist()"""
    makes_folder = "study/"

    def prepare(self):
        super().prepare()
        (self.before / "crawl.yaml").write_text(CRAWL)
        (self.before / "study.yaml").write_text(STUDY)

    def inputs(self, folder):
        return {name: content for name, content in digest(folder).items() if not name.startswith(self.makes_folder)}

    def check(self, outcome, folder):
        if wrong := self.lacks_reason(outcome):
            return wrong
        if self.inputs(folder) != self.inputs(self.before):
            return "an input is not as it was"
        if outcome.status == 0 and outcome.output != self.right.output:
            return "status 0, and it printed something else"
        again = self.program.plain(self.words(), folder)
        if again.returncode != 0:
            return f"cannot go on: {again.stderr}"
        return None if again.stdout == self.right.output else "gone on, it has another result"


class Fit(Learn):
    kinds = ("memory", "hdf5", "open", "close", "read", "write", "sync", "name", "truncate")
    work = """\
fitted = taut.fit("fit.yaml", "out", threads=1)
result = fitted.values, fitted.standard_errors, fitted.good"""
    makes_folder = "out/"

    def prepare(self):
        super().prepare()
        for name, text in fits.INPUTS.items():
            (self.before / name).write_text(text)
