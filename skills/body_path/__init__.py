"""The way of the body from start to goal."""
