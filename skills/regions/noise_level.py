"""How noisy a depth image is, measured on the image itself.

Two parts differ in what averaging does to them. The white part is the spread of a patch's pixels about its own plane.
The correlated part is what the pixels of a patch share: the second difference of the mean inverse depths of patches in
a row or column is zero on a plane, and what the white part leaves of it is correlated. Both are taken as medians over
the patches of a range of depths, so that edges and curved things do not count, and both follow s + g z^2 over depth z:
triangulation and time of flight lose precision about so.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from skills.geometry.pose import Array
from skills.kernels import leaf_kernel

_STRIDE = 5  # every fifth row of patches is looked at
_RANGE = 1.25  # ratio of the bounds of a range of depths
_SAMPLES_MIN = 24  # ranges of depth with fewer patches tell nothing
_CHI_QUARTILE = 0.94  # first quartile of the estimated spread of 64 pixels less 3 parameters, where the true one is 1
_NORMAL_MEDIAN = 0.6745  # median of |x| of a standard normal x
_FLAT = 1.3  # patches that spread more about their planes than this times the usual have an edge in them


@dataclass(frozen=True, slots=True)
class NoiseLevel:
    """Standard deviations of measured depth, each s + g z^2 over depth z.

    Attributes:
        white, white_growth: s and g of a pixel's own error [m, 1/m].
        correlated, correlated_growth: s and g of the error that the pixels of a patch share [m, 1/m].
    """

    white: float = 0.0
    white_growth: float = 0.0
    correlated: float = 0.0
    correlated_growth: float = 0.0

    @property
    def law(self) -> Array:
        """The four numbers as kernels take them."""
        return np.array((self.white, self.white_growth, self.correlated, self.correlated_growth))

    def own(self, depth: float) -> float:
        """Standard deviation of a pixel's own error at a depth [m]."""
        return self.white + self.white_growth * depth**2

    def shared(self, depth: float) -> float:
        """Standard deviation of the error that the pixels of a patch share at a depth [m]."""
        return self.correlated + self.correlated_growth * depth**2


def estimate_noise(sums: Array, pixels: float) -> NoiseLevel:
    """Noise of the image behind the sums of patches, (rows, columns, 10), whose full patches have so many pixels."""
    depth, white, second = np.empty((3, -(-sums.shape[0] // _STRIDE) * sums.shape[1]))
    count = _probe(sums, 0.5 * pixels, depth, white, second)
    depth, white, second = depth[:count], white[:count], second[:count]
    s, g = _law([(n, z, q / _CHI_QUARTILE, q) for n, z, q in _quantiles(depth, white, 0.25)])
    flat = white <= _FLAT * (s + g * depth**2)
    inner = np.flatnonzero((second >= 0.0) & flat & np.roll(flat, 1) & np.roll(flat, -1))
    rows = _quantiles(depth[inner], second[inner], 0.5)
    mean = [(n, z, max((m / _NORMAL_MEDIAN) ** 2 - (s + g * z**2) ** 2 / pixels, 0.0) ** 0.5, m) for n, z, m in rows]
    return NoiseLevel(s, g, *_law(mean))


def _quantiles(depth: Array, values: Array, share: float) -> list[tuple[int, float, float]]:
    """Number of samples, mean depth and a quantile of the values, for each range of depth that has enough samples."""
    if not len(depth):
        return []
    ranges = (np.log(depth / depth.min()) / np.log(_RANGE)).astype(np.int64)
    rows = []
    for k, count in enumerate(np.bincount(ranges).tolist()):
        if count >= _SAMPLES_MIN:
            inside = np.flatnonzero(ranges == k)
            rank = int(share * (count - 1))
            rows.append((count, float(depth[inside].mean()), float(np.partition(values[inside], rank)[rank])))
    return rows


def _law(rows: list[tuple[int, float, float, float]]) -> tuple[float, float]:
    """The s and g, neither below zero, of sigma = s + g z^2 that fits samples best.

    A row has the number of samples, their depth, their sigma, and the measurement that sigma was taken from.
    """
    if not rows:
        return 0.0, 0.0
    count, depth, sigma, measured = np.array(rows).T
    # What matters is the relative error; it also keeps ranges of depth full of edges, seen far away, from deciding.
    weights = count / np.maximum(measured, 1e-5) ** 2
    square, total = depth**2, weights.sum()
    sigma_mean, square_mean = weights @ sigma / total, weights @ square / total
    spread = weights @ (square - square_mean) ** 2
    g = weights @ ((square - square_mean) * (sigma - sigma_mean)) / spread if spread > 1e-9 * total else 0.0
    g = min(max(g, 0.0), sigma_mean / square_mean)
    return float(sigma_mean - g * square_mean), float(g)


@leaf_kernel
def _probe(sums: Array, pixels_min: float, depth: Array, white: Array, second: Array) -> int:
    """Depth and spread of the patches of some rows, and how far each one's mean is off those beside it; their number.

    The last is the second difference of the means, scaled to the standard deviation of one; below zero where a
    neighbour has few pixels.
    """
    columns = sums.shape[1]
    count = 0
    for i in range(0, sums.shape[0], _STRIDE):
        row = sums[i]
        for column in range(columns):
            s = row[column]
            n = s[0]
            if n < pixels_min:
                continue
            x, y, w = s[1] / n, s[2] / n, s[3] / n
            xx, xy, yy = s[4] / n - x * x, s[5] / n - x * y, s[6] / n - y * y
            xw, yw, ww = s[7] / n - x * w, s[8] / n - y * w, s[9] / n - w * w
            det = xx * yy - xy * xy
            if det <= 1e-3 * (xx + yy) ** 2:
                continue
            a, b = (xw * yy - yw * xy) / det, (yw * xx - xw * xy) / det
            depth[count] = 1.0 / w
            white[count] = np.sqrt(max(ww - a * xw - b * yw, 0.0) * n / (n - 3.0)) / (w * w)
            second[count] = -1.0
            if column > 0 and column < columns - 1:
                left, right = row[column - 1], row[column + 1]
                if left[0] >= pixels_min and right[0] >= pixels_min:
                    off = left[3] / left[0] - 2.0 * w + right[3] / right[0]
                    # Where pixels are missing the means are not in a row: the patch's own slope makes up for that.
                    off -= a * (left[1] / left[0] - 2.0 * x + right[1] / right[0])
                    off -= b * (left[2] / left[0] - 2.0 * y + right[2] / right[0])
                    second[count] = abs(off) / (w * w * np.sqrt(6.0))
            count += 1
    return count


@leaf_kernel
def depth_noise(law: Array, depth: float, pixels: float) -> float:
    """Standard deviation of the mean measured depth of neighbouring pixels, that many of them [m]."""
    square = depth * depth
    white, shared = law[0] + law[1] * square, law[2] + law[3] * square
    return np.sqrt(white * white / pixels + shared * shared)
