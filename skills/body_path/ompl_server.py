"""Runs planners of OMPL in a process of their own.

While OMPL calls back into Python no other thread of its process gets on, and its random numbers can be seeded only
before their first use. So a server loads OMPL and the kernels once, and forks a child for every request: no thread of
ours starves, and the same request gives the same path. A child ends by counting, never by time.
"""

from __future__ import annotations

import atexit
import importlib.util
import sys

from skills.body_path.ompl_solver import OmplProblem
from skills.forking_server import ForkingServer, ServerError, serve
from skills.geometry.pose import Array
from skills.kernels import prepare_runtime

SERVER = ForkingServer((sys.executable, "-c", f"from {__name__} import serve_ompl; serve_ompl()"))
"""The one server of this process; it starts with the first request."""
atexit.register(SERVER.close)


def ask_ompl(problem: OmplProblem) -> Array | None:
    """Points of the best way that a planner of OMPL finds (N, 2); None where it finds none.

    Raises:
        ServerError: where there is no OMPL, or its process dies.
    """
    if importlib.util.find_spec("ompl") is None:
        raise ServerError('it needs the package "ompl" (pip install "ompl>=2.0.1"); the planner "lattice" does not')
    return SERVER.ask(problem)


def serve_ompl() -> None:
    """Load OMPL and the kernels, then serve."""
    prepare_runtime()
    import numpy as np
    from ompl import base, geometric, util  # noqa: F401  # Loaded here once, and not in each child.

    from skills.body_path.ground_layers import LAYERS, SCALE
    from skills.body_path.ompl_solver import solve_with_ompl
    from skills.body_path.path_cost import body_fits, motion_cost, motion_fits

    layers, cells, scale = np.zeros((LAYERS, 2, 2)), np.zeros((2, 2), np.float32), np.ones(1, SCALE)[0]
    layers.flags.writeable = cells.flags.writeable = False
    body_fits(layers, cells, scale, 0.0, 0.0, 1.0, 0.0)
    motion_cost(layers, scale, 0.0, 0.0, 0.5, 0.0)
    motion_fits(layers, cells, scale, 0.0, 0.0, 0.5, 0.0)
    serve(solve_with_ompl)
