"""The one way in which lookstep compiles its hot loops.

Every kernel is compiled by numba to machine code that releases the GIL, is bit-reproducible (no `fastmath`, no
`parallel`) and is cached on disk; see `kernel_locator`.
"""

import ctypes
import hashlib
import os
from collections.abc import Callable
from pathlib import Path
from typing import Any, TypeVar

_THREAD_VARIABLES = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS")
_MMAP_THRESHOLD, _TRIM_THRESHOLD = -3, -1  # options of mallopt(3)
_KEPT = 1 << 28  # [bytes]
# Ours, and where its folder cannot be written, numba's own.
_LOCATORS = "skills.kernel_locator.KernelCacheLocator,InTreeCacheLocator,UserWideCacheLocator"


def prepare_runtime() -> None:
    """Pin one thread a numerical library, keep freed memory, choose the kernel cache; before numpy and numba load."""
    _keep_freed_memory()
    for variable in _THREAD_VARIABLES:
        os.environ.setdefault(variable, "1")
    os.environ.setdefault("NUMBA_CACHE_DIR", str(_default_cache()))


def kernel_cache() -> Path:
    """The folder of the compiled kernels."""
    return Path(os.environ["NUMBA_CACHE_DIR"])


def _default_cache() -> Path:
    """A folder of this checkout in the user's cache: numba takes one writer, and two checkouts may compile at once."""
    base = os.environ.get("XDG_CACHE_HOME")
    checkout = hashlib.blake2b(str(Path(__file__).resolve().parents[1]).encode(), digest_size=8).hexdigest()
    return (Path(base) if base else Path.home() / ".cache") / "lookstep" / f"kernels-{checkout}"


def _keep_freed_memory() -> None:
    """Let the C library hold on to large blocks: pages fresh from the system cost more than what is written to them."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)  # other C libraries than glibc may have none
    if mallopt is not None:
        for option in (_MMAP_THRESHOLD, _TRIM_THRESHOLD):
            mallopt(option, _KEPT)


F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function over scalars and arrays to machine code on first call."""
    return _compiled(function)


def leaf_kernel(function: F) -> F:
    """The same for a function that makes no arrays, as one that others call in their loops.

    It goes without counting references to its arrays, which costs more than a short loop does.
    """
    return _compiled(function, _nrt=False)


def _compiled(function: F, **options: bool) -> F:
    import numba

    numba.config.CACHE_LOCATOR_CLASSES = _LOCATORS  # type: ignore[attr-defined]
    return numba.njit(cache=True, nogil=True, fastmath=False, error_model="numpy", **options)(function)  # type: ignore[return-value]
