"""Location of the files that come with taut."""

import os
import pathlib
from typing import Union

from taut import _core


def data_path(*parts: Union[str, "os.PathLike[str]"]) -> str:
    """Returns the folder with the `models`, `experiments`, `gaits`, `studies` and `fits` that come with taut, or a path
    in this folder: `taut.data_path("models", "prism3.yaml")`. `taut.load`, `taut.learn` and `taut.fit` search the
    folder for relative paths that do not exist in the current folder. The folder is share/taut inside the installed
    package, or above the package in the installation prefix or the build folder. Raises FileNotFoundError if the folder
    or the file does not exist."""
    folder = _core.data_folder()
    if folder is None:
        raise FileNotFoundError(f"the files that come with taut are neither next to {_core.__file__} nor in a "
                                "share/taut above it")
    path = pathlib.Path(folder, *parts)
    if not path.exists():
        raise FileNotFoundError(f"{path}: not among the files that come with taut")
    return str(path)
