"""The type under which kernels take structured arrays."""

from typing import Any, TypeAlias

Records: TypeAlias = Any  # structured arrays, or one element of them
