"""Parser of a documentation page: fenced blocks, links, headings"""

import pathlib
import re

ROOT = pathlib.Path(__file__).resolve().parent.parent.parent


def refuse(wrong):
    """Ends the test with these complaints, if there are any."""
    if wrong:
        raise SystemExit("\n".join(wrong))


class Block:
    """A fenced block. `info` is the text after the opening fence, `line` the number of the line after the fence."""

    def __init__(self, info, line, lines):
        self.info, self.line, self.lines = info, line, lines

    @property
    def text(self):
        return "".join(line + "\n" for line in self.lines)


class Page:
    def __init__(self, path):
        self.path = pathlib.Path(path).resolve()
        self.lines = self.path.read_text().splitlines()
        self.blocks, self.prose = [], []  # prose: (line number, text) outside of blocks
        block = None
        for number, line in enumerate(self.lines, 1):
            fence = re.match(r"```+(.*)$", line)
            if fence and block is None:
                block = Block(fence[1].strip(), number + 1, [])
            elif fence:
                self.blocks.append(block)
                block = None
            elif block is not None:
                block.lines.append(line)
            else:
                self.prose.append((number, line))
        if block is not None:
            raise SystemExit(f"{self.name}:{block.line}: a block that is never closed")

    @property
    def name(self):
        return str(self.path.relative_to(ROOT))

    def links(self):
        """Yields (line number, target) of every link except links to the web."""
        for number, line in self.prose:
            for target in re.findall(r"\]\(([^)\s]+)\)", re.sub(r"`[^`]*`", "", line)):
                if not re.match(r"[a-z]+:", target):
                    yield number, target

    def anchors(self):
        """Returns the anchors that GitHub generates for the headings."""
        found = set()
        for _, line in self.prose:
            heading = re.match(r"#+ (.*)", line)
            if heading:
                words = re.sub(r"[^\w\- ]", "", heading[1].lower())
                found.add(words.replace(" ", "-"))
        return found
