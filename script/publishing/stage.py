"""Copies the project's pages for Sphinx. Links to code or data on GitHub become links to pages that show them."""

import os
import pathlib
import re
import shutil
import subprocess

PICTURES = {".png", ".svg", ".gif"}
LANGUAGES = {".yaml": "yaml", ".yml": "yaml", ".cff": "yaml", ".json": "json", ".py": "python", ".h": "cpp",
             ".cpp": "cpp", ".inl": "cpp", ".mjs": "javascript", ".ts": "typescript", ".cmake": "cmake", ".css": "css"}
SHOWN_BYTES = 200_000  # longer files are download only


class Problem(Exception):
    """Describes an error of a page."""


def relative(target, page):
    return os.path.relpath(target, os.path.dirname(page) or ".")


def language(path, text):
    if path.suffix in LANGUAGES:
        return LANGUAGES[path.suffix]
    if path.name == "CMakeLists.txt":
        return "cmake"
    first = text.partition("\n")[0]
    return "bash" if "bash" in first else "python" if first.startswith("#!") and "python" in first else "text"


class Stage:
    """Pages of `root`, staged in the folder `to`. Pages are identified by their paths in root."""

    def __init__(self, root, to):
        self.root, self.to = pathlib.Path(root).resolve(), pathlib.Path(to)
        self.done, self.waiting = set(), []
        listed = subprocess.run(["git", "ls-files", "--cached", "--others", "--exclude-standard"], cwd=self.root,
                                capture_output=True, text=True)
        self.files = set(listed.stdout.split("\n")) if listed.returncode == 0 else None

    def belongs(self, name):
        """Returns whether a file belongs to the project: tracked, neither built nor private."""
        return (self.root / name).is_file() and (self.files is None or name in self.files)

    def pages(self, pages):
        """Copies these pages and all files that they link to; returns the names of all Markdown pages."""
        self.waiting = list(pages)
        while self.waiting:
            name = self.waiting.pop()
            if name not in self.done:
                self.done.add(name)
                self.copy(name)
        return {name for name in self.done if name.endswith(".md")}

    def write(self, name, text):
        path = self.to / name
        path.parent.mkdir(parents=True, exist_ok=True)
        path.write_text(text)

    def copy(self, name):
        path = self.root / name
        if path.is_dir():
            self.write(f"{name}/index.md", self.listing(name))
        elif path.suffix == ".md":
            self.write(self.staged(name), self.with_links(name, path.read_text()))
        else:
            (self.to / name).parent.mkdir(parents=True, exist_ok=True)
            shutil.copy(path, self.to / name)
            if path.suffix not in PICTURES:
                self.write(name + ".md", self.code_page(name))

    @staticmethod
    def staged(name):
        return "index.md" if name == "README.md" else name

    def listing(self, folder):
        lines = ["---", "orphan: true", "---", f"# {folder}/", ""]
        inside = sorted(str(path.relative_to(self.root)) for path in (self.root / folder).iterdir())
        for name in inside:
            if self.belongs(name) and not name.rsplit("/", 1)[1].startswith("."):
                lines.append(f"- [{name.rsplit('/', 1)[1]}]({self.target(name, f'{folder}/index.md')})")
        return "\n".join(lines) + "\n"

    def code_page(self, name):
        path = self.root / name
        begin = ["---", "orphan: true", "---", f"# {name}", ""]
        try:
            text = path.read_text()
        except UnicodeDecodeError:
            text = None
        if text is None or len(text) > SHOWN_BYTES:
            return "\n".join([*begin, f"{path.stat().st_size / 1000:.0f} kB: {{download}}`{path.name}`", ""])
        return "\n".join([*begin, f"{{download}}`{path.name}`", "", f"```{{literalinclude}} {path.name}",
                          f":language: {language(path, text)}", "```", ""])

    def target(self, name, page):
        """Returns the replacement of a link on `page` to `name`, and schedules the target for copying."""
        path = self.root / name
        if path.is_dir():
            if self.belongs(f"{name}/README.md"):
                return self.target(f"{name}/README.md", page)
            self.waiting.append(name)
            return relative(f"{name}/index.md", page)
        if not self.belongs(name):
            raise Problem(f"{page}: there is no {name}")
        self.waiting.append(name)
        if path.suffix == ".md" or path.suffix in PICTURES:
            return relative(self.staged(name), page)
        return relative(f"{name}.md", page)

    def with_links(self, page, text):
        """Returns the page with its links replaced by links to pages of the website."""
        folder = os.path.dirname(page)

        def changed(match):
            target, _, anchor = match[1].partition("#")
            if re.match(r"[a-z]+:", match[1]) or not target:
                return match[0]
            name = os.path.normpath(os.path.join(folder, target))
            if name.startswith(".."):
                raise Problem(f"{page}: {match[1]} leads out of the project")
            return f"]({self.target(name, self.staged(page))}{'#' if anchor else ''}{anchor})"

        lines, fenced = [], False
        for line in text.splitlines():
            if line.startswith("```"):
                fenced = not fenced
            elif not fenced:  # code between backticks contains no links
                line = "".join(part if part.startswith("`") else re.sub(r"\]\(([^)\s]+)\)", changed, part)
                               for part in re.split(r"(`[^`]*`)", line))
            lines.append(line)
        return "\n".join(lines) + "\n"
