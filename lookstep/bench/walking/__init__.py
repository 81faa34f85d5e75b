"""Walking over known footsteps: success over seeds, compute times, solvers side by side."""
