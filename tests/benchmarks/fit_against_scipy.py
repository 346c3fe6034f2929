#!/usr/bin/env python3
"""Times of benchmark_fit beside SciPy's periodic splprep with automatic knots, in one run.

    tests/benchmarks/fit_against_scipy.py build/bin/benchmark_fit

First the four measured sections, then sections that the rules of the fit were not chosen by, whose true curves are
known. SciPy's smoothing is first tuned until it chooses the same number of control points, or the next smaller one; the
time is that of one call with it, the tuning not counted. Times are of the processor, the least of many repetitions: a
busy machine disturbs them less.
"""

import json
import pathlib
import re
import subprocess
import sys
import time

try:
    import numpy
    from scipy.interpolate import splev, splprep
    from scipy.spatial import cKDTree
except ImportError:
    sys.exit("SciPy is not installed: nothing to compare with")

CONTROL_POINTS = (28, 21, 54, 37)
HELD_OUT_COUNT, HELD_OUT_NOISE, HELD_OUT_CONTROL_POINTS = 100, 1e-4, 28
SHAPES = ("ellipse", "lobes", "bump", "foil")


def measured_sections():
    """The points of the four sections, from the header of the tests."""
    header = pathlib.Path(__file__).parents[1] / "geometry/fitting/measured_sections.h"
    number = r"\s*(-?[\d.]+)\s*"
    for block in re.findall(r"\{to_points\(\{(.*?)\}\),", header.read_text(), re.S):
        yield numpy.array(re.findall(r"\{" + number + "," + number + r"\}", block), dtype=float)


def held_out_point(shape, t):
    """As in tests/geometry/fitting/held_out_sections.h."""
    pi, c, s = numpy.pi, numpy.cos(2 * numpy.pi * t), numpy.sin(2 * numpy.pi * t)
    if shape == 0:
        return numpy.stack([1.5 * c, 0.5 * s], 1)
    if shape == 1:
        r = 1 + 0.25 * numpy.cos(6 * pi * t) + 0.1 * numpy.sin(10 * pi * t)
        return numpy.stack([r * c, r * s], 1)
    if shape == 2:
        r = 1 + 0.3 * numpy.exp(-360 * (t - 0.48) ** 2)
        return numpy.stack([1.4 * r * c, r * s], 1)
    x = 0.5 * (1 + c)
    return numpy.stack([2 * x, 0.24 * s * (1 - 0.9 * x * x) + 0.1 * numpy.sin(pi * x)], 1)


def held_out_scan(shape):
    i = numpy.arange(HELD_OUT_COUNT)
    scatter = numpy.stack([numpy.sin(12.9898 * i * i), numpy.sin(78.233 * i * i)], 1)
    points = held_out_point(shape, (i + 0.2 * numpy.sin(7.1 * i)) / HELD_OUT_COUNT)
    return points + numpy.sqrt(2) * HELD_OUT_NOISE * scatter


def scipy_fit(points, count):
    """The curve, the milliseconds of one call, and the number of control points."""
    closed = numpy.vstack([points, points[:1]]).T
    for smoothing in numpy.logspace(-8, 2, 600):
        curve, _ = splprep(closed, s=smoothing, per=1, quiet=1)
        if len(curve[0]) - 7 <= count:
            break
    best = numpy.inf
    for _ in range(40):
        start = time.process_time()
        for _ in range(20):
            splprep(closed, s=smoothing, per=1, quiet=1)
        best = min(best, (time.process_time() - start) / 20)
    return curve, 1e3 * best, len(curve[0]) - 7


def benchmarks(program):
    command = [program, "--benchmark_filter=fi", "--benchmark_format=json", "--benchmark_repetitions=10",
               "--benchmark_min_time=0.05"]
    fastest = {}
    for run in json.loads(subprocess.run(command, check=True, capture_output=True, text=True).stdout)["benchmarks"]:
        if run["run_type"] == "iteration":
            best = fastest.setdefault(run["run_name"], run)
            if run["cpu_time"] < best["cpu_time"]:
                fastest[run["run_name"]] = run
    return fastest


def report(milliseconds, found, extra, results, number, held_out):
    print(f"  {'SciPy':24}{milliseconds:8.3f} ms          {found} control points {extra}")
    for name, result in results.items():
        kind, _, index = name.partition("/")
        if index == str(number) and (kind == "fit_held_out") == held_out:
            print(f"  {kind:24}{result['cpu_time']:8.3f} ms  {milliseconds / result['cpu_time']:5.2f} x  {result['label']}")


def main():
    results = benchmarks(sys.argv[1])
    for k, (points, count) in enumerate(zip(measured_sections(), CONTROL_POINTS), 1):
        _, milliseconds, found = scipy_fit(points, count)
        print(f"section {k}, {len(points)} points, {count} control points")
        report(milliseconds, found, "", results, k, False)
    for shape, name in enumerate(SHAPES):
        curve, milliseconds, found = scipy_fit(held_out_scan(shape), HELD_OUT_CONTROL_POINTS)
        samples = numpy.stack(splev(numpy.linspace(0, 1, 200000), curve), 1)
        distances, _ = cKDTree(samples).query(held_out_point(shape, numpy.arange(1000) / 1000))
        print(f"held out: {name}, {HELD_OUT_COUNT} points, {HELD_OUT_CONTROL_POINTS} control points")
        extra = f"off the truth by {numpy.sqrt(numpy.mean(distances ** 2)):.2e}"
        report(milliseconds, found, extra, results, shape + 1, True)


if __name__ == "__main__":
    main()
