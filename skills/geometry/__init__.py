"""Rigid transforms, polygons and cameras."""
