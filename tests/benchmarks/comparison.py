#!/usr/bin/env python3
"""Measures isorim beside its peers, and puts the tables into the page that compares them.

    /usr/bin/python3 tests/benchmarks/comparison.py [--programs build/bin] [--repetitions N] [--only NAME]
        [--scaling FILE] [--write]

Runs benchmark_bem, bem_scaling, benchmark_fit and occt_comparison (build with -DISORIM_BUILD_BENCHMARKS=ON) from the
root of the tree and prints Markdown; --write replaces the tables of io/manual/comparison.md, each between
"<!-- NAME -->" and "<!-- end -->". Times are the processor's, the least of N runs; those of the series over degree and
refinement are of one run on one thread, or read from what an earlier one has written (--scaling FILE). What peers reach
that are not run here is quoted from the measurements that STORED and BEMBEL_SERIES tell of.
"""

import argparse
import csv
import datetime
import importlib.util
import json
import os
import pathlib
import platform
import re
import subprocess
import sys
import tempfile

ROOT = pathlib.Path(__file__).resolve().parents[2]
PAGE = ROOT / "io/manual/comparison.md"

CAD_CASES = ("sphere_nurbs_faces_p17", "ellipsoid_nurbs_faces_p17", "torus_nurbs_faces_p17", "box_cyl_hole_nurbs_faces_p17",
             "sphere_offset_hole_nurbs_faces_p17", "steinmetz_nurbs_faces_p17", "napkin_ring_nurbs_faces_p17",
             "cube_blind_hole_nurbs_faces_p17")

# Bembel at commit 1e21364 (December 2024), built with -O3 -march=native -flto -fopenmp against Eigen 3.4; Simpson's
# isogeometric boundary-element code in Octave 7.3; both on two Xeon cores. CPU seconds of whole runs.
STORED = {
    "sphere": (("Bembel, P = 2, dense", 600, 2.1e-8, 8.8, 117, None),
               ("Bembel, P = 2, H2 and CG", 600, 2.1e-8, 10.0, 212, 102),
               ("Bembel, P = 3, H2 and CG", 2166, 5.2e-11, 466.0, 1062, 869),
               ("Bembel, P = 3, dense", 2166, 3.2e-13, 757.0, 5068, None)),
    "torus": (("Bembel, P = 1, H2 and CG", 1296, 5.4e-4, None, None, 483),
              ("Bembel, P = 2, H2 and CG", 1600, 3.8e-4, 278.0, None, 1224)),
    "kirsch": ((20, 3.5e-2), (30, 7.3e-3), (50, 1.1e-3), (90, 2.9e-4), (170, 1.3e-4)),
    # SciPy's splprep with automatic knots, its smoothing tuned until it chooses the number of control points.
    "fits": ("0.0322 / 0.0151", "0.0312 / 0.0132", "0.0291 / 0.0120", "0.146 / 0.0385"),
}


# Bembel's sphere: P, M, unknowns, relative error; CPU seconds, iterations and peak MB with H2 and CG; CPU seconds and
# peak MB dense. Iterations stop near machine precision.
BEMBEL_SERIES = (
    (0, 2, 96, 7.9e-3, 0.25, 6, 19, 0.09, 6), (0, 3, 384, 8.6e-4, 3.7, 24, 200, 0.41, 10),
    (0, 4, 1536, 1.1e-4, 28, 60, 902, 9.1, 62), (0, 5, 6144, 1.3e-5, 269, 96, 3455, 129, 878),
    (1, 2, 150, 1.7e-4, 0.44, 20, 20, 0.26, 8), (1, 3, 486, 4.1e-6, 6.0, 65, 202, 2.5, 32),
    (1, 4, 1734, 1.2e-7, 73, 185, 911, 38, 401), (1, 5, 6534, 3.7e-9, 847, 332, 3491, None, None),
    (2, 2, 216, 5.7e-6, 0.88, 29, 23, 0.78, 13), (2, 3, 600, 2.1e-8, 10, 102, 212, 8.8, 117),
    (2, 4, 1944, 1.9e-10, 176, 378, 947, 165, 1704), (3, 2, 294, 1.5e-7, 2.4, 88, 32, 2.5, 28),
    (3, 3, 726, 2.4e-10, 31, 256, 243, 38, 335), (3, 4, 2166, 5.2e-11, 466, 869, 1062, 757, 5068),
)


def figure(x, digits=2):
    """A number for a table; nothing is a dash."""
    if x is None:
        return "–"
    if x >= 100:
        return f"{x:.0f}"
    return f"{x:.{digits - 1}e}".replace("e-0", "e-") if x < 1e-3 else f"{x:.{digits}g}"


def table(heading, rows):
    lines = ["| " + " | ".join(heading) + " |", "| " + " | ".join("---" for _ in heading) + " |"]
    return "\n".join(lines + ["| " + " | ".join(str(cell) for cell in row) + " |" for row in rows])


def run(command):
    result = subprocess.run([str(word) for word in command], cwd=ROOT, capture_output=True, text=True, check=False)
    if result.returncode != 0:
        sys.exit(f"{' '.join(map(str, command))}: exit status {result.returncode}\n{result.stderr}")
    return result.stdout


def benchmark_names(program, kind):
    return [name for name in run([program, "--benchmark_list_tests"]).split() if name.startswith(kind + "/")]


def best_run(program, name, repetitions):
    """The counters of one benchmark, each time in a process of its own, with the least processor time."""
    best = None
    for _ in range(repetitions):
        found = json.loads(run([program, f"--benchmark_filter=^{re.escape(name)}$", "--benchmark_format=json"]))
        (result,) = found["benchmarks"]
        if best is None or result["cpu_time"] < best["cpu_time"]:
            best = result
    return best


def boundary_element_rows(options, kind, label):
    program = options.programs / "benchmark_bem"
    rows = []
    for name in benchmark_names(program, kind):
        found = best_run(program, name, options.repetitions)
        rows.append((label(name.split("/")), int(found["unknowns"]), found["relative_error"], found["cpu_time"],
                     found["peak_MB"], int(found["iterations"])))
    return rows


def field_table(rows):
    return table(("", "unknowns", "relative error", "CPU s", "peak MB", "iterations"),
                 [(row[0], row[1], figure(row[2]), figure(row[3]), "–" if row[4] is None else f"{row[4]:.0f}",
                   row[5] or "–") for row in rows])


def sphere(options):
    ours = boundary_element_rows(options, "sphere", lambda name: f"isorim, degree {name[1]}")
    return field_table((*STORED["sphere"], *ours))


def torus(options):
    form = ("dense", "compressed")
    ours = boundary_element_rows(options, "torus", lambda name: f"isorim, degree {name[1]}, {form[int(name[3])]}")
    return field_table((*STORED["torus"], *ours))


def scaling_rows(options, series):
    """The rows of a series of bem_scaling, dense and compressed by degree and refinement."""
    with tempfile.TemporaryDirectory() as folder:
        path = options.scaling
        if path is None:
            os.environ["OMP_NUM_THREADS"] = "1"
            run([options.programs / "bem_scaling", folder, series])
            path = pathlib.Path(folder) / "bem_scaling.csv"
        with path.open(newline="") as lines:
            found = [row for row in csv.DictReader(lines) if row["series"] == series]
    pairs = {}
    for row in found:
        key = (int(row["degree"]), int(row["refine"]), float(row["scale"]))
        pairs.setdefault(key, {})[row["method"]] = {
            name: float(row[name]) for name in ("unknowns", "error", "cpu_seconds", "iterations", "peak_MB")}
    return pairs


SERIES_HEADING = ("unknowns", "relative error", "CPU s, compressed", "iterations", "peak MB", "CPU s, dense", "peak MB")


def measured_cells(pair):
    fast, dense = pair["compressed"], pair["dense"]
    return (int(fast["unknowns"]), figure(fast["error"]), figure(fast["cpu_seconds"]), int(fast["iterations"]),
            f"{fast['peak_MB']:.0f}", figure(dense["cpu_seconds"]), f"{dense['peak_MB']:.0f}")


def bembel_series(_options):
    return table(("P", "M", *SERIES_HEADING),
                 [(*row[:3], figure(row[3]), figure(row[4]), row[5], row[6], figure(row[7]), row[8] or "–")
                  for row in BEMBEL_SERIES])


def degree_series(options, series):
    rows = [(*key[:2], *measured_cells(pair)) for key, pair in scaling_rows(options, series).items()]
    return table(("degree", "bisections", *SERIES_HEADING), rows)


def units(options):
    rows = [(f"{scale:g}", *measured_cells(pair)) for (_, _, scale), pair in scaling_rows(options, "units").items()]
    return table(("radius", *SERIES_HEADING), rows)


def kirsch(options):
    program = options.programs / "benchmark_bem"
    rows = [("Simpson's code, degree 2", unknowns, figure(error), "–") for unknowns, error in STORED["kirsch"]]
    for name in sorted(benchmark_names(program, "kirsch"), key=lambda name: [int(n) for n in name.split("/")[1:3]]):
        found = best_run(program, name, options.repetitions)
        rows.append((f"isorim, degree {name.split('/')[1]}", int(found["unknowns"]), figure(found["relative_error"]),
                     figure(found["cpu_time"])))
    return table(("", "unknowns", "relative error", "CPU s"), rows)


def volumes(options):
    paths = [path for case in CAD_CASES if (path := ROOT / f"cases/cad/{case}.toml").exists()]
    rows = []
    for line in run([options.programs / "occt_comparison", *paths]).splitlines()[2:]:
        name, *outcomes = [part.strip() for part in line.split("|")]
        cells = [name]
        for outcome in outcomes:
            words = outcome.split()
            cells.append(f"{words[0]}, {words[2]} ms" if words[-1] == "ms" else outcome)
        rows.append(cells)
    return table(("file", "isorim", "OCCT, default", "OCCT, Eps = 1e-9", "OCCT, Gauss–Kronrod"), rows)


def scipy_milliseconds():
    """Of each measured section; None without SciPy."""
    if importlib.util.find_spec("scipy") is None:
        return [None] * len(STORED["fits"])
    sys.path.insert(0, str(pathlib.Path(__file__).parent))
    import fit_against_scipy as peer
    return [peer.scipy_fit(points, count)[1]
            for points, count in zip(peer.measured_sections(), peer.CONTROL_POINTS, strict=True)]


def fits(options):
    program = options.programs / "benchmark_fit"
    rows = []
    for k, (stored, milliseconds) in enumerate(zip(STORED["fits"], scipy_milliseconds(), strict=True), 1):
        found = best_run(program, f"free_fit/{k}", options.repetitions)
        words = found["label"].split()
        rows.append((k, stored, figure(milliseconds), f"{words[1]} / {words[3]}", figure(found["cpu_time"])))
    return table(("section", "SciPy, largest / RMS", "ms", "isorim, largest / RMS", "ms"), rows)


TABLES = {"volumes": volumes, "sphere": sphere, "bembel_series": bembel_series,
          "sphere_series": lambda options: degree_series(options, "peer_sphere"), "torus": torus,
          "torus_series": lambda options: degree_series(options, "peer_torus"),
          "neumann_series": lambda options: degree_series(options, "peer_neumann"), "units": units, "kirsch": kirsch,
          "fits": fits}


def machine():
    model = re.search(r"model name\s*:\s*(.*)", pathlib.Path("/proc/cpuinfo").read_text())
    cores = subprocess.run(["nproc"], capture_output=True, text=True, check=True).stdout.strip()
    name = model.group(1) if model else platform.machine()
    return f"Measured on {datetime.date.today():%d %B %Y}: {cores} cores, {name}."


def replace(page, name, text):
    pattern = re.compile(rf"<!-- {name} -->\n.*?<!-- end -->", re.S)
    if not pattern.search(page):
        sys.exit(f"{PAGE}: found no place for the table {name!r}; expected <!-- {name} --> and <!-- end -->")
    return pattern.sub(lambda _: f"<!-- {name} -->\n{text}\n<!-- end -->", page)


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--programs", type=pathlib.Path, default=ROOT / "build/bin")
    parser.add_argument("--repetitions", type=int, default=3)
    parser.add_argument("--only", choices=TABLES, action="append")
    parser.add_argument("--scaling", type=pathlib.Path, help="bem_scaling.csv of an earlier run")
    parser.add_argument("--write", action="store_true", help="into io/manual/comparison.md")
    options = parser.parse_args()
    options.programs = options.programs.resolve()
    page = PAGE.read_text()
    for name in options.only or TABLES:
        text = TABLES[name](options)
        print(f"\n{name}\n\n{text}", flush=True)
        page = replace(page, name, text)
    page = replace(page, "machine", machine())
    if options.write:
        PAGE.write_text(page)


if __name__ == "__main__":
    main()
