"""Walks by the dozen: which ones, each a pure function of its specification, and what they add up to."""
