"""Where compiled kernels are kept, so that an edited source compiles anew what depends on it, and nothing else.

numba's own cache looks at the file of a kernel alone and does not notice that a kernel or a constant has changed which
it takes from another file. Here the folder of a module's kernels is named by a hash of its source and of all sources of
ours that it imports, and those import in turn.
"""

from __future__ import annotations

import hashlib
import re
from collections.abc import Iterator
from functools import cache
from pathlib import Path
from typing import Any

from numba.core.caching import UserProvidedCacheLocator

from skills.kernels import kernel_cache

_FOLDERS = ("skills", "sim_envs", "lookstep")
_ROOT = Path(__file__).resolve().parents[1]
_IMPORTED = re.compile(rb"^[ \t]*(?:from|import)[ \t]+(skills|sim_envs|lookstep)([.\w]*)", re.MULTILINE)


class KernelCacheLocator(UserProvidedCacheLocator):
    """Tells numba the folder of a module's kernels; numba makes one for each kernel.

    Args:
        py_func: the kernel.
        py_file: its source.
    """

    def __init__(self, py_func: Any, py_file: str) -> None:
        super().__init__(py_func, py_file)
        source = Path(py_file).resolve()
        self._cache_path = str(kernel_cache() / f"{source.parent.name}.{source.stem}-{source_hash(source)}")

    @classmethod
    def from_function(cls, py_func: Any, py_file: str) -> KernelCacheLocator | None:
        """The locator; None where its folder cannot be written."""
        locator = cls(py_func, py_file)
        try:
            locator.ensure_cache_path()
        except OSError:
            return None
        return locator


@cache
def kernels_hash() -> str:
    """Hash of all sources behind all kernels."""
    digest = hashlib.blake2b(digest_size=8)
    for folder in _FOLDERS:
        for source in sorted((_ROOT / folder).rglob("*.py")):
            if b"skills.kernels" in source.read_bytes():
                digest.update(source_hash(source).encode())
    return digest.hexdigest()


@cache
def source_hash(source: Path) -> str:
    """Hash of a source and of all of ours that it imports, directly or not."""
    found, waiting = {source}, [source]
    while waiting:
        fresh = set(_imports(waiting.pop())) - found
        found |= fresh
        waiting += fresh
    digest = hashlib.blake2b(digest_size=8)
    for file in sorted(found):
        digest.update(str(file.relative_to(_ROOT) if _ROOT in file.parents else file.name).encode())
        digest.update(file.read_bytes())
    return digest.hexdigest()


@cache
def _imports(source: Path) -> tuple[Path, ...]:
    return tuple(_modules(source.read_bytes()))


def _modules(text: bytes) -> Iterator[Path]:
    for top, rest in _IMPORTED.findall(text):
        module = _ROOT / (top + rest).decode().replace(".", "/")
        for file in (module.with_suffix(".py"), module / "__init__.py"):
            if file.is_file():
                yield file
