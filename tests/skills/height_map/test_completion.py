"""Cleaning a map: spikes and lone cells go, small holes are filled, steps and large holes stay."""

from __future__ import annotations

import numpy as np
import pytest

from skills.height_map.cell_ring import Window, empty_ring
from skills.height_map.completion import FILLED, SPIKES, complete

N = 12


def completed(heights: np.ndarray, *, first: tuple[int, int] = (0, 0)) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Heights, flags of filled cells and counts of a map whose corner is some cell of the world."""
    ring, window = empty_ring(N), Window(*first, N, 0.05)
    rows, columns = (np.arange(start, start + N) % N for start in first)
    ring.height[np.ix_(rows, columns)] = heights
    out, variances, filled = np.empty(N * N, np.float32), np.empty(N * N, np.float32), np.empty(N * N, np.bool_)
    counts = np.zeros(2, np.int64)
    complete(ring, window, 0.0, 0.0, 0.04, 3, 0.08, out, variances, filled, counts)
    assert (np.isnan(variances) == np.isnan(out)).all()
    return out.reshape(N, N), filled.reshape(N, N), counts


@pytest.fixture
def level() -> np.ndarray:
    """A map that slopes a little along x."""
    return np.broadcast_to(0.01 * np.arange(N), (N, N)).astype(np.float32)


@pytest.mark.parametrize("first", [(0, 0), (-7, 5), (1001, -1003)])
def test_a_map_without_flaws_stays_as_it_is_wherever_it_lies(level, first):
    out, filled, counts = completed(level, first=first)
    np.testing.assert_array_equal(out, level)
    assert not filled.any() and not counts.any()


@pytest.mark.parametrize("cell", [(5, 5), (0, 5), (11, 11)])
def test_a_spike_takes_the_mean_of_its_neighbours(level, cell):
    heights = level.copy()
    heights[cell] += 0.3
    out, _, counts = completed(heights)
    i, j = cell
    around = level[max(i - 1, 0) : i + 2, max(j - 1, 0) : j + 2]
    assert out[cell] == pytest.approx((around.sum() - level[cell]) / (around.size - 1), abs=1e-6)
    assert counts[SPIKES] == 1


def test_an_edge_or_a_pair_of_high_cells_is_no_spike(level):
    heights = level.copy()
    heights[:, 6:] += 0.3
    heights[3, 2:4] += 0.2
    np.testing.assert_array_equal(completed(heights)[0], heights)


def test_cells_that_stand_alone_are_dropped():
    heights = np.full((N, N), np.nan, np.float32)
    heights[2, 2] = heights[8, 8] = heights[8, 9] = 0.1
    heights[5, 5] = heights[5, 6] = heights[6, 5] = 0.2
    out, _, counts = completed(heights)
    assert sorted(zip(*np.nonzero(~np.isnan(out)), strict=True)) == [(5, 5), (5, 6), (6, 5)]
    assert counts[SPIKES] == 3


def test_small_holes_are_filled_on_the_line_between_their_sides(level):
    heights = level.copy()
    heights[4, 3:6] = np.nan
    heights[6:9, 8] = np.nan
    out, filled, counts = completed(heights)
    np.testing.assert_allclose(out, level, atol=1e-6)
    np.testing.assert_array_equal(filled, np.isnan(heights))
    assert counts[FILLED] == 6


def test_holes_between_sides_of_different_height_and_wide_holes_stay(level):
    heights = np.full((N, N), np.nan, np.float32)
    heights[2:5, 0:3], heights[2:5, 5:8] = 0.0, 0.1
    assert not completed(heights)[1].any()
    heights = level.copy()
    heights[2:10, 2:10] = np.nan
    assert np.isnan(completed(heights)[0][2:10, 2:10]).sum() == 64


def test_only_cells_near_to_both_sides_of_a_hole_are_filled(level):
    heights = np.full((N, N), np.nan, np.float32)
    heights[4:7] = level[4:7]
    heights[4:7, 3:8] = np.nan
    _, filled, _ = completed(heights)
    assert sorted(zip(*np.nonzero(filled), strict=True)) == [(row, 5) for row in (4, 5, 6)]
