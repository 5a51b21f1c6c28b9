"""script/including.py, which chooses the headers to check by the files that changed

Usage: including_test.py TEST. TEST is the name of a function of this file.
"""

import os
import pathlib
import subprocess
import sys
import tempfile

SCRIPT = pathlib.Path(__file__).resolve().parent.parent.parent / "script/including.py"
FILES = {
    "include/taut/a.h": "#include <vector>\n",
    "include/taut/b.h": '#include "taut/a.h"\n',
    "include/taut/c.h": "#pragma once\n",
    "src/x/private.h": '#include "taut/b.h"\n',
    "src/x/y/law.inl": '# include "x/private.h"\n',
    "src/x/y/near.inl": '#include "law.inl"  // from its own folder\n',
    "src/x/y/other.inl": '// not #include "x/private.h"\n',
}


def chosen(*changed):
    """Returns the files that the script chooses of FILES."""
    with tempfile.TemporaryDirectory() as folder:
        for path, text in FILES.items():
            (pathlib.Path(folder) / path).parent.mkdir(parents=True, exist_ok=True)
            (pathlib.Path(folder) / path).write_text(text)
        listed = pathlib.Path(folder, "changed")
        listed.write_text("\n".join(changed))
        run = subprocess.run([sys.executable, SCRIPT, listed], cwd=folder, input="\n".join(FILES), text=True,
                             capture_output=True, check=True, env=dict(os.environ, PYTHONDONTWRITEBYTECODE="1"))
        return run.stdout.split()


def FilesThatIncludeAChangedOneAreChosenToo():
    assert chosen("include/taut/a.h") == ["include/taut/a.h", "include/taut/b.h", "src/x/private.h", "src/x/y/law.inl",
                                          "src/x/y/near.inl"]
    assert chosen("src/x/y/law.inl") == ["src/x/y/law.inl", "src/x/y/near.inl"]


def OthersAreNot():
    assert chosen("include/taut/c.h", "docs/page.md", "src/x/deleted.h") == ["include/taut/c.h"]
    assert chosen() == []


if __name__ == "__main__":
    globals()[sys.argv[1]]()
