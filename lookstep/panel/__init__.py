"""The operator panel: what the robot sees and plans, in a browser, and what the operator says to it.

The server runs in a process of its own (`process`), joined to the robot's by two pipes: frozen snapshots go out, and
the newest wins; commands come in as JSON, are read with mistrust, and take effect at tick borders (`link`). Only
modules that run in the panel's process import viser.
"""
