"""Walking over footsteps: balance, swing and joint motion."""
