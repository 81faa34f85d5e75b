"""The one way in which lookstep compiles its hot loops.

Every kernel is compiled by numba to machine code that releases the GIL, is bit-reproducible (no `fastmath`, no
`parallel`) and is cached on disk. Numba's cache does not notice an edited callee in another file, so the cache folder
is named by a hash of all sources that hold kernels.
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
_KERNEL_FOLDERS = ("skills", "sim_envs", "lookstep")


def prepare_runtime() -> None:
    """Pin one thread a numerical library, keep freed memory, choose the kernel cache; before numpy and numba load."""
    _keep_freed_memory()
    for variable in _THREAD_VARIABLES:
        os.environ.setdefault(variable, "1")
    os.environ.setdefault("NUMBA_CACHE_DIR", str(_cache_root() / f"kernels-{_source_hash()}"))


def kernel_cache() -> Path:
    """The folder of the compiled kernels."""
    return Path(os.environ["NUMBA_CACHE_DIR"])


def _keep_freed_memory() -> None:
    """Let the C library hold on to large blocks: pages fresh from the system cost more than what is written to them."""
    mallopt = getattr(ctypes.CDLL(None), "mallopt", None)  # other C libraries than glibc may have none
    if mallopt is not None:
        for option in (_MMAP_THRESHOLD, _TRIM_THRESHOLD):
            mallopt(option, _KEPT)


def _cache_root() -> Path:
    base = os.environ.get("XDG_CACHE_HOME")
    return (Path(base) if base else Path.home() / ".cache") / "lookstep"


def _source_hash() -> str:
    digest = hashlib.blake2b(digest_size=8)
    root = Path(__file__).resolve().parents[1]
    for folder in _KERNEL_FOLDERS:
        for source in sorted((root / folder).rglob("*.py")):
            text = source.read_bytes()
            if b"skills.kernels" in text:
                digest.update(str(source.relative_to(root)).encode())
                digest.update(text)
    return digest.hexdigest()


F = TypeVar("F", bound=Callable[..., Any])


def kernel(function: F) -> F:
    """Compile a function over scalars and arrays to machine code on first call."""
    import numba

    return numba.njit(cache=True, nogil=True, fastmath=False, error_model="numpy")(function)  # type: ignore[return-value]


def leaf_kernel(function: F) -> F:
    """The same for a function that makes no arrays, as one that others call in their loops.

    It goes without counting references to its arrays, which costs more than a short loop does.
    """
    import numba

    return numba.njit(cache=True, nogil=True, fastmath=False, error_model="numpy", _nrt=False)(function)  # type: ignore[return-value]
