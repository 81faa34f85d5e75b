"""Planar regions out of depth images."""
