"""The algorithms of lookstep: plain functions and small objects that know no tree, no simulator and no screen."""

from skills import kernels as _kernels

_kernels.prepare_runtime()
