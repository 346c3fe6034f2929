#!/usr/bin/env python3
"""Times of benchmark_fit beside SciPy's periodic splprep with automatic knots, in one run.

    tests/benchmarks/fit_against_scipy.py build/bin/benchmark_fit

SciPy's smoothing is first tuned until it chooses the same number of control points, or the next smaller one; the time
is that of one call with it, the tuning not counted. Times are of the processor: a busy machine disturbs them less.
"""

import json
import pathlib
import re
import subprocess
import sys
import time

try:
    import numpy
    from scipy.interpolate import splprep
except ImportError:
    sys.exit("SciPy is not installed: nothing to compare with")

CONTROL_POINTS = (28, 21, 54, 37)


def sections():
    """The points of the four sections, from the header of the tests."""
    header = pathlib.Path(__file__).parents[1] / "geometry/fitting/measured_sections.h"
    number = r"\s*(-?[\d.]+)\s*"
    for block in re.findall(r"\{to_points\(\{(.*?)\}\),", header.read_text(), re.S):
        yield numpy.array(re.findall(r"\{" + number + "," + number + r"\}", block), dtype=float)


def scipy_time(points, count):
    closed = numpy.vstack([points, points[:1]]).T
    for smoothing in numpy.logspace(-5, 2, 300):
        (knots, _, _), _ = splprep(closed, s=smoothing, per=1, quiet=1)
        if len(knots) - 7 <= count:
            break
    calls = 500
    start = time.process_time()
    for _ in range(calls):
        splprep(closed, s=smoothing, per=1, quiet=1)
    return 1e3 * (time.process_time() - start) / calls, len(knots) - 7


def main():
    command = [sys.argv[1], "--benchmark_filter=fi", "--benchmark_format=json"]
    results = json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]
    for k, (points, count) in enumerate(zip(sections(), CONTROL_POINTS), 1):
        milliseconds, found = scipy_time(points, count)
        print(f"section {k}, {len(points)} points, {count} control points")
        print(f"  {'SciPy':24}{milliseconds:8.3f} ms  {found} control points")
        for result in results:
            name, _, number = result["name"].partition("/")
            if number == str(k):
                ratio = milliseconds / result['cpu_time']
                print(f"  {name:24}{result['cpu_time']:8.3f} ms  {ratio:5.2f} x  {result['label']}")


main()
