"""Plan logs: every request for a footstep plan with its search, in files to list, to look at, to plan again."""

from lookstep.plan_log.plan_file import PLAN_SUFFIX, LoggedPlan, PlanFileError, read_plan, write_plan
from lookstep.plan_log.plan_recorder import PlanRecorder

__all__ = ["PLAN_SUFFIX", "LoggedPlan", "PlanFileError", "PlanRecorder", "read_plan", "write_plan"]
