"""What a tick of a tree costs, beside the same tree in plain py_trees."""
