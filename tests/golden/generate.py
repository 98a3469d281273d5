#!/usr/bin/env python3
# SPDX-License-Identifier: Apache-2.0
"""Writes variance.csv beside itself: what scipy says to the tests of equal variances.

Made with scipy 1.10.1 (python3-scipy of Debian 12); needed only to make the file anew. Rows:
    statistics, Bartlett, Levene, Brown-Forsythe, values of a, values of b     parted by spaces
    critical_value, F(significance; 1, samples - 2), significance, samples
"""

from pathlib import Path

import numpy as np
from scipy import stats

random = np.random.default_rng(2021)


def samples():
    """Pairs of samples: small and of a lidar's size, alike and not, skewed, far from 0."""
    normal, exponential, uniform = random.normal, random.exponential, random.uniform
    yield [0.0, 1.0, 5.0], [0.0, 3.0, 4.0]
    yield [1.0, 2.0, 4.0], [1.0, 2.0, 4.0, 8.0, 16.0]
    yield normal(0, 1, 5), normal(0, 2, 9)
    yield normal(0, 1, 30), normal(3, 1.02, 30)
    yield normal(0, 1, 60), normal(0, 1.3, 45)
    yield exponential(1, 50), exponential(1.2, 50)
    yield uniform(-1, 1, 40), normal(0, 0.5, 41)
    yield 1e5 + uniform(0, 1, 25), 1e5 + uniform(0, 2, 25)
    yield uniform(0.12, 3.5, 360), uniform(0.12, 3.5, 301)
    yield uniform(0.12, 3.5, 360), uniform(0.12, 1.5, 360)


def numbers(values):
    return " ".join(repr(float(value)) for value in np.atleast_1d(values))


def rows():
    for a, b in samples():
        a, b = np.round(a, 3), np.round(b, 3)
        statistics = (stats.bartlett(a, b).statistic, stats.levene(a, b, center="mean").statistic,
                      stats.levene(a, b, center="median").statistic)
        yield f"statistics,{','.join(map(numbers, statistics))},{numbers(a)},{numbers(b)}"
    for significance in (0.001, 0.01, 0.05, 0.1, 0.5):
        for samples_in_all in (3, 4, 10, 40, 720, 2880, 131072):
            critical = float(stats.f.isf(significance, 1, samples_in_all - 2))
            yield f"critical_value,{critical!r},{significance!r},{samples_in_all}"


Path(__file__).with_name("variance.csv").write_text("\n".join(rows()) + "\n")
