import cv2
import numpy as np
import pytest

from skills.regions.outline import trace_outlines


def random_labels(seed: int) -> np.ndarray:
    noise = cv2.GaussianBlur(np.random.default_rng(seed).normal(size=(67, 131)), (0, 0), 2.0)
    return np.digitize(noise, (-0.1, 0.0, 0.1)).astype(np.int16) - 1


@pytest.mark.parametrize("seed", range(4))
def test_loops_enclose_every_pixel_of_their_label_and_no_other(seed):
    labels = random_labels(seed)
    outlines = trace_outlines(labels, 1)
    for label in range(labels.max() + 1):
        assert outlines.pixels[outlines.labels == label].sum() == np.count_nonzero(labels == label)
    pieces = sum(cv2.connectedComponents((labels == k).astype(np.uint8), connectivity=4)[0] - 1 for k in range(3))
    assert np.count_nonzero(outlines.pixels > 0) == pieces


def test_every_vertex_is_the_middle_between_a_pixel_in_and_one_out():
    labels = np.pad(random_labels(5), 1, constant_values=-1)
    outlines = trace_outlines(labels, 1)
    for loop, label in enumerate(outlines.labels):
        points = outlines.points[outlines.starts[loop] : outlines.starts[loop + 1]]
        low, high = np.floor(points).astype(int), np.ceil(points).astype(int)
        there = (labels[low[:, 1], low[:, 0]] == label).astype(int) + (labels[high[:, 1], high[:, 0]] == label)
        assert np.all(there == 1)


def test_specks_are_left_out():
    labels = np.full((20, 100), -1, np.int16)
    labels[2:12, 10:90] = 0
    labels[5, 20] = labels[15, 40] = 1
    outlines = trace_outlines(labels, 2)
    assert outlines.labels.tolist() == [0] and outlines.pixels.tolist() == [800]
    assert sorted(trace_outlines(labels, 1).pixels.tolist()) == [-1, 1, 1, 800]


def test_pixels_that_touch_at_a_corner_are_apart():
    labels = np.where(np.eye(4, dtype=bool), np.int16(0), np.int16(-1))
    assert trace_outlines(labels, 1).pixels.tolist() == [1, 1, 1, 1]


@pytest.mark.parametrize("shape", [(1, 1), (1, 200), (200, 1), (7, 5)])
def test_the_border_of_the_image_closes_loops(shape):
    outlines = trace_outlines(np.zeros(shape, np.int16), 1)
    assert outlines.pixels.tolist() == [shape[0] * shape[1]]
    assert trace_outlines(np.full(shape, -1, np.int16), 1).pixels.tolist() == []
