"""`lookstep bench footsteps`: the footstep planner on planar-region maps, and on the way over the rough course."""

from lookstep.bench.footsteps.report import FootstepReport, bench_footsteps

__all__ = ["FootstepReport", "bench_footsteps"]
