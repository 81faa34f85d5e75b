"""Leaves of the user's own, from a Python file or a module, without a package of their own."""

from __future__ import annotations

import importlib
import importlib.util
import sys
from pathlib import Path

from lookstep.errors import UserError


def load_leaves(name: str) -> None:
    """Import a file or module, so that the leaves in it register themselves.

    Args:
        name: a path that ends in `.py`, or the name of a module that Python finds.

    Raises:
        UserError: where it cannot be imported; says why.
    """
    try:
        if name.endswith(".py"):
            _load_file(Path(name))
        else:
            importlib.import_module(name)
    except Exception as error:
        # Whatever user code raises while it is imported is the user's to mend, and needs its place more than ours.
        raise UserError(f"--leaves {name}: {_place(error, name)}{type(error).__name__}: {error}") from error


def _load_file(path: Path) -> None:
    if not path.is_file():
        raise FileNotFoundError("there is no such file")
    if path.stem in sys.modules:
        return
    spec = importlib.util.spec_from_file_location(path.stem, path)
    assert spec is not None and spec.loader is not None, "the path ends in .py"
    module = importlib.util.module_from_spec(spec)
    # Dataclasses look their module up while they are made.
    sys.modules[path.stem] = module
    try:
        spec.loader.exec_module(module)
    except BaseException:
        del sys.modules[path.stem]
        raise


def _place(error: Exception, name: str) -> str:
    """The line of the user's file that raised, where there is one."""
    if isinstance(error, SyntaxError):
        return f"line {error.lineno}: "
    place, trace = "", error.__traceback__
    while trace is not None:
        if trace.tb_frame.f_code.co_filename.endswith(name):
            place = f"line {trace.tb_lineno}: "
        trace = trace.tb_next
    return place
