"""Behavior trees: leaves, ports, the loader, the executor, the trace and the robot protocol."""
