"""Where the files are that come with taut."""

import os
import pathlib
from typing import Union

from taut import _core

_KIND = "models"  # is there wherever they are


def data_path(*parts: Union[str, "os.PathLike[str]"]) -> str:
    """The folder with `models`, `experiments`, `gaits`, `studies` and `fits` that come with taut, or what is below
    it: `taut.data_path("models", "prism3.yaml")`. It is share/taut inside the installed package, or else above
    it: in the prefix, in the build. FileNotFoundError if there is none, or no such file in it."""
    package = pathlib.Path(_core.__file__).resolve().parent
    for folder in (package, *package.parents):
        share = folder / "share" / "taut"
        if (share / _KIND).is_dir():
            path = share.joinpath(*parts)
            if not path.exists():
                raise FileNotFoundError(f"{path}: not among the files that come with taut")
            return str(path)
    raise FileNotFoundError(f"the files that come with taut are neither in {package} nor in a share/taut above it")
