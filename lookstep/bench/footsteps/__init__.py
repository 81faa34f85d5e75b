"""How well and how fast footsteps are planned: maps of others, pictures of plans, timing."""
