"""Checks the examples of a page: commands run and print the output shown, and files equal the real ones.

Usage: run_page.py TAUT PAGE

In a page,
  ```console            lines that start with "$ " are run, in order, in a new folder; the lines
                        below a command are its expected output. A line "..." stands for any lines.
  ```console status=3   the last command of the block ends with this exit status instead of 0
  ```yaml FILE          the block equals that file, relative to the page's folder (any language)
  ```yaml in FILE       the block equals consecutive lines of that file
  ```python cell        notebook cell: all cells of a page run in order, in one session. A block ```text output
                        directly after a cell is its expected output; without one the cell prints nothing.

Blocks of other kinds are ignored. A page docs/x.md with a folder docs/x/ runs among copies of
that folder's files, other pages among the folders of the project.

With TAUT_BLESS=1 in the environment, the actual output of the commands is written into the page instead, and
pictures written by cells are copied to the page's images/, where the page shows them. Exit status 77: no errors, but
some commands were left out because a Python module is missing.
"""

import importlib.util
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys
import tempfile

sys.dont_write_bytecode = True
from page import ROOT, Page  # noqa: E402

SKIPPED = 77
SHOWN_FOLDERS = ["docs", "examples", "share"]


class Command:
    """A command of a page and its expected output"""

    def __init__(self, line, text):
        self.line, self.text = line, text
        self.output, self.status = [], 0


def commands_of(block):
    commands, status = [], 0
    status_word = re.search(r"\bstatus=(\d+)", block.info)
    if status_word:
        status = int(status_word[1])
    continued = False
    for number, line in enumerate(block.lines, block.line):
        if continued:
            commands[-1].text += "\n" + line
        elif line.startswith("$ "):
            commands.append(Command(number, line[2:]))
        elif commands:
            commands[-1].output.append(line)
        else:
            raise SystemExit(f"line {number}: a console block begins with a command")
        continued = line.endswith("\\") and (continued or line.startswith("$ "))
    commands[-1].status = status
    return commands


def steady(line):
    """Returns a line without parts that differ between runs and machines."""
    line = re.sub(r"; [\d:]+ \(\S+ simulated s/s\)", "; ...", line)
    return re.sub(r"simulated in \S+ s \(\S+ times real time\)", "simulated in ...", line)


def printed_lines(text):
    """Returns the lines without the progress lines that only slow machines print."""
    return [line for line in text.splitlines() if not re.match(r"(t = .* s|\d+ of \d+ evaluations .*) left$", line)]


def same(expected, printed):
    """Returns whether `printed` matches `expected`, in which one line may be "..."."""
    expected, printed = [steady(x) for x in expected], [steady(x) for x in printed]
    if "..." not in expected:
        return expected == printed
    at = expected.index("...")
    head, tail = expected[:at], expected[at + 1 :]
    return (
        len(printed) >= len(head) + len(tail)
        and printed[:at] == head
        and printed[len(printed) - len(tail) :] == tail
    )


def shortened(expected, printed):
    """Returns `printed`, shortened at the place where `expected` has "..."."""
    if "..." not in expected:
        return printed
    at = expected.index("...")
    tail = len(expected) - at - 1
    return printed[:at] + ["..."] + printed[len(printed) - tail :]


def prepare(page, folder, taut):
    """Returns a working folder and an environment whose search path leads to the given `taut` and this `python3`."""
    programs = folder / "programs"
    programs.mkdir()
    (programs / "taut").symlink_to(taut)
    (programs / "python3").symlink_to(sys.executable)
    work = folder / "work"
    own = page.path.with_suffix("")
    if own.is_dir():
        shutil.copytree(own, work)
    else:
        work.mkdir()
        for name in SHOWN_FOLDERS:
            (work / name).symlink_to(ROOT / name)
    environment = dict(os.environ, MPLBACKEND="Agg", MPLCONFIGDIR=str(folder), LC_ALL="C.UTF-8")
    module = taut.parent / "python"
    if module.is_dir():
        environment["PYTHONPATH"] = str(module)
        sys.path.insert(0, str(module))  # for missing_module
    environment["PATH"] = f"{programs}{os.pathsep}{environment['PATH']}"
    return work, environment


def missing_import(text):
    """Returns a module that a Python program imports and this machine lacks, or None."""
    for module in re.findall(r"^(?:import|from) (\w+)", text, re.MULTILINE):
        if importlib.util.find_spec(module) is None:
            return module
    return None


def missing_module(command, work):
    """Returns a missing module of the program that a command runs, or None."""
    program = re.match(r"python3 (\S+)", command.text)
    return missing_import((work / program[1]).read_text()) if program else None


def check_files(page):
    """Returns the number of blocks that show a file, and their errors."""
    count, wrong = 0, []
    for block in page.blocks:
        match = re.fullmatch(r"\w+ (in )?(\S+\.\w+)", block.info)
        if not match or block.info.startswith("console"):
            continue
        count += 1
        path = page.path.parent / match[2]
        text = path.read_text() if path.is_file() else None
        if text is None:
            wrong.append(f"{page.name}:{block.line}: there is no file {match[2]}")
        elif not match[1] and block.text != text:
            wrong.append(f"{page.name}:{block.line}: this is not {match[2]}")
        elif match[1] and "\n" + block.text not in "\n" + text:
            wrong.append(f"{page.name}:{block.line}: these lines are not in {match[2]}")
    return count, wrong


def cells_of(page):
    """Returns [(block, block of its output or None), ...]."""
    found = []
    for block in page.blocks:
        if block.info == "python cell":
            found.append((block, None))
        elif block.info == "text output":
            before = found[-1][0] if found else None
            if not before or block.line != before.line + len(before.lines) + 3:
                raise SystemExit(f"{page.name}:{block.line}: output, but right before it there is no cell")
            found[-1] = (before, block)
    return found


def run_cells(page, work, environment, bless):
    """Runs the cells of a page. Returns the values of `run`, and the replacements as (line, number of lines, lines)."""
    cells = cells_of(page)
    if not cells:
        return 0, [], [], []
    missing = missing_import("\n".join(block.text for block, _ in cells))
    if missing:
        return 0, [], [f"{page.name}: its cells need the Python module {missing} (Debian: python3-{missing})"], []
    done = subprocess.run([sys.executable, pathlib.Path(__file__).with_name("cells.py")], cwd=work, env=environment,
                          input=json.dumps([block.text for block, _ in cells]), capture_output=True, text=True)
    if done.returncode != 0:
        return 0, [f"{page.name}: its cells ended with status {done.returncode}:\n{done.stderr}"], [], []
    said, wrong, replaced = json.loads(done.stdout), [], []
    for (block, output), text in zip(cells, said["outputs"]):
        printed = text.rstrip("\n").splitlines()
        if same(output.lines if output else [], printed):
            continue
        end = block.line + len(block.lines) + 1  # the line after the cell
        if output and printed:
            replaced.append((output.line - 1, len(output.lines), shortened(output.lines, printed)))
        elif printed:
            replaced.append((end - 1, 0, ["", "```text output", *printed, "```"]))
        else:
            replaced.append((end - 1, len(output.lines) + 3, []))
        if not bless:
            wrong.append(f"{page.name}:{block.line}: the cell prints\n{text}\nand the page says\n" +
                         (output.text if output else "nothing"))
    if not said["good"]:
        wrong.append(f"{page.name}:{cells[len(said['outputs']) - 1][0].line}: the cell raises:\n{said['outputs'][-1]}")
    elif bless:
        for name in re.findall(r"\]\(images/(\w+\.png)\)", "\n".join(page.lines)):
            if (work / name).is_file():
                shutil.copyfile(work / name, page.path.parent / "images" / name)
    return len(said["outputs"]), wrong, [], replaced


def run(page, taut, bless):
    """Returns the number of commands that ran, their errors, and the commands that were left out."""
    count, wrong, left_out, replaced = 0, [], [], []
    with tempfile.TemporaryDirectory() as folder:
        work, environment = prepare(page, pathlib.Path(folder), taut)
        for block in page.blocks:
            if block.info.split()[:1] != ["console"]:
                continue
            for command in commands_of(block):
                missing = missing_module(command, work)
                if missing:
                    left_out.append(f"{page.name}:{command.line}: `{command.text}` needs the Python "
                                    f"module {missing} (Debian: python3-{missing})")
                    continue
                count += 1
                done = subprocess.run(
                    ["bash", "-o", "pipefail", "-c", command.text], cwd=work, env=environment,
                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, stdin=subprocess.DEVNULL,
                    text=True, errors="replace",
                )
                where, printed = f"{page.name}:{command.line}", printed_lines(done.stdout)
                if done.returncode != command.status:
                    wrong.append(f"{where}: `{command.text}` ended with status {done.returncode}, "
                                 f"not {command.status}:\n" + "\n".join(printed))
                elif not same(command.output, printed):
                    first = command.line + command.text.count("\n")
                    replaced.append((first, len(command.output), shortened(command.output, printed)))
                    if not bless:
                        wrong.append(f"{where}: `{command.text}` printed\n" + "\n".join(printed) +
                                     "\nand the page says\n" + "\n".join(command.output))
        ran, more, without, cells = run_cells(page, work, environment, bless)
    count, wrong, left_out = count + ran, wrong + more, left_out + without
    replaced = sorted(replaced + cells)
    if bless and replaced:
        lines = list(page.lines)
        for first, length, output in reversed(replaced):
            lines[first : first + length] = output
        page.path.write_text("\n".join(lines) + "\n")
        print(f"wrote {len(replaced)} outputs into {page.name}")
    return count, wrong, left_out


def main():
    if len(sys.argv) != 3:
        print(__doc__.strip(), file=sys.stderr)
        return 2
    taut, bless = pathlib.Path(sys.argv[1]).resolve(), os.environ.get("TAUT_BLESS") == "1"
    page = Page(sys.argv[2])
    file_count, wrong = check_files(page)
    command_count, more, left_out = run(page, taut, bless)
    wrong += more
    if file_count + command_count == 0:
        wrong.append(f"{page.name}: shows neither a file nor a command")
    print("\n".join(wrong) or f"{page.name}: {file_count} files, {command_count} commands: good")
    for text in left_out:
        print(f"skipped: {text}")
    return 1 if wrong else SKIPPED if left_out else 0


if __name__ == "__main__":
    sys.exit(main())
