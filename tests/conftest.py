"""Makes the suite deterministic: one thread a numerical library, the same hypothesis examples, no swallowed errors."""

import os

# Before numpy loads, and whatever the caller's shell says: another thread count sums in another order.
for _variable in ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NUMEXPR_NUM_THREADS"):
    os.environ[_variable] = "1"
# A mistake in a recording call is a warning for a user on the road and an error here.
os.environ["RERUN_STRICT"] = "1"

from hypothesis import settings  # noqa: E402  # After the environment is set.

settings.register_profile("lookstep", derandomize=True, deadline=None, database=None)
settings.load_profile("lookstep")
