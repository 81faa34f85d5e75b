"""Benchmarks: figures beside ground truth and baselines, one package a subject."""
