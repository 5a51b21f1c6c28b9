"""Where the files are that come with taut."""

import os
import pathlib
from typing import Union

from taut import _core


def data_path(*parts: Union[str, "os.PathLike[str]"]) -> str:
    """The folder with `models`, `experiments`, `gaits`, `studies` and `fits` that come with taut, or what is below
    it: `taut.data_path("models", "prism3.yaml")`. `taut.load`, `taut.learn` and `taut.fit` look there for a relative
    path that the current folder does not have. It is share/taut inside the installed package, or else above
    it: in the prefix, in the build. FileNotFoundError if there is none, or no such file in it."""
    folder = _core.data_folder()
    if folder is None:
        raise FileNotFoundError(f"the files that come with taut are neither beside {_core.__file__} nor in a "
                                "share/taut above it")
    path = pathlib.Path(folder, *parts)
    if not path.exists():
        raise FileNotFoundError(f"{path}: not among the files that come with taut")
    return str(path)
