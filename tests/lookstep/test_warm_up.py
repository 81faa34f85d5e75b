"""What is compiled before the clock starts."""

import gc
import sys

from numba.core.dispatcher import Dispatcher

from lookstep.configuration import load_configuration
from lookstep.warm_up import warm_up, warm_up_beside
from skills.kernels import kernel_cache


def compiled() -> dict[str, int]:
    """For how many types each kernel is compiled."""
    found = {}
    for module in list(sys.modules.values()):
        for name, value in vars(module).items():
            if isinstance(value, Dispatcher) and value.__module__ == module.__name__:
                found[f"{module.__name__}.{name}"] = len(value.nopython_signatures)
    return found


def test_the_second_process_compiles_nothing_but_what_a_walk_uses():
    configuration = load_configuration()
    warm_up(configuration)
    of_a_walk = compiled()
    assert len(of_a_walk) > 100
    warm_up_beside(configuration)
    assert compiled() == of_a_walk


def test_what_is_compiled_is_known_and_the_collector_runs_again():
    warm_up(load_configuration())
    assert (kernel_cache() / "compiled").exists()
    assert gc.isenabled()
