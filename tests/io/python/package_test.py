"""The package against exact values; run by ctest with the built package in PYTHONPATH."""

import ast
import inspect
import json
import math
import os
import signal
import tempfile
import threading
import unittest

import numpy as np

import isorim

PI = math.pi
BALL = {"type": "sphere", "radius": 1.0}
DISC = """
[geometry]
type = "circle"
radius = 2
[analysis]
equation = "laplace"
[[boundary_condition]]
kind = "value"
value = "x^2 - y^2"
[discretisation]
degree = 4
refine = 3
[[probe]]
name = "middle"
points = [[0.5, 0.25], [0, 0], [5, 5]]
"""


class Shapes(unittest.TestCase):
    def test_primitives_have_exact_properties_with_error_estimates(self):
        found = isorim.load(BALL).properties(density=3.0)
        for name, value in (("volume", 4 / 3 * PI), ("area", 4 * PI), ("mass", 4 * PI)):
            self.assertLess(abs(found[name].value - value), 1e-12 * value)
            self.assertLess(found[name].error, 1e-10)
        self.assertEqual(found["centroid"].value.shape, (3,))
        self.assertEqual(found["inertia"].value.shape, (3, 3))

    def test_curves_from_arrays_bound_regions(self):
        w = math.sqrt(0.5)
        points = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], dtype=float)
        circle = isorim.nurbs_curve(2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], 3 * points, [1, w, 1, w, 1, w, 1, w, 1])
        region = isorim.load({"geometry": {"type": "region", "loops": [circle]}})
        self.assertEqual(region.dimension, 2)
        self.assertAlmostEqual(region.properties()["area"].value, 9 * PI, delta=1e-11)

    def test_surfaces_from_arrays_bound_solids(self):
        corners = np.array([[x, y, z] for z in (0, 1) for y in (0, 2) for x in (0, 3)], dtype=float)
        sides = [(0, 2, 1, 3), (4, 5, 6, 7), (0, 1, 4, 5), (2, 6, 3, 7), (0, 4, 2, 6), (1, 3, 5, 7)]
        patches = [isorim.nurbs_surface((1, 1), ([0, 0, 1, 1], [0, 0, 1, 1]), corners[list(side)].reshape(2, 2, 3),
                                        np.full((2, 2), 2.0), name=f"side_{i}") for i, side in enumerate(sides)]
        box = isorim.load({"geometry": {"type": "patches", "patches": patches}})
        self.assertEqual(box.patches, [f"side_{i}" for i in range(6)])
        self.assertAlmostEqual(box.properties()["volume"].value, 6.0, delta=1e-13)
        self.assertTrue(box.inspect()["geometry"]["closed"])

    def test_files_overrides_and_texts_are_loaded(self):
        text = '[geometry]\ntype = "sphere"\nradius = 1\n'
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.toml")
            with open(path, "w", encoding="utf-8") as file:
                file.write(text)
            for ball in (isorim.load(path, overrides=["geometry.radius=2"]),
                         isorim.load(text, overrides=["geometry.radius=2"])):
                self.assertAlmostEqual(ball.properties()["volume"].value, 32 / 3 * PI, delta=1e-11)

    def test_trimmed_surfaces_from_arrays_keep_what_their_loops_bound(self):
        square = np.array([[[-2, -2, 1], [2, -2, 1]], [[-2, 2, 1], [2, 2, 1]]], dtype=float)
        w = math.sqrt(0.5)
        turn = np.array([[1, 0], [1, 1], [0, 1], [-1, 1], [-1, 0], [-1, -1], [0, -1], [1, -1], [1, 0]], dtype=float)
        rim = isorim.nurbs_curve(2, [0, 0, 0, 1, 1, 2, 2, 3, 3, 4, 4, 4], 0.5 + 0.25 * turn,
                                 [1, w, 1, w, 1, w, 1, w, 1])
        lid = isorim.nurbs_surface((1, 1), ([0, 0, 1, 1], [0, 0, 1, 1]), square, trims=[rim])
        plate = isorim.load({"type": "patches", "patches": [lid]})
        self.assertAlmostEqual(plate.properties()["area"].value, PI, delta=1e-12)
        self.assertFalse(plate.inspect()["geometry"]["closed"])
        self.assertTrue(plate.inspect()["patches"][0]["trimmed"])

    def test_t_splines_are_written_and_come_back(self):
        ball = isorim.load({"type": "tspline", "from": BALL, "refine": {"where": "z > 0.5", "levels": 1}})
        self.assertAlmostEqual(ball.properties()["volume"].value, 4 / 3 * PI, delta=1e-12)
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.iga")
            ball.write(path)
            again = isorim.load(path)
            self.assertGreater(again.inspect()["patches"][0]["extraction"]["hanging_sides"], 0)
            self.assertAlmostEqual(again.properties()["volume"].value, 4 / 3 * PI, delta=1e-11)

    def test_meshes_have_the_volume_of_the_solid_to_their_tolerance(self):
        ball = isorim.load({"geometry": BALL, "output": {"stl_tolerance": 1e-3}})
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.stl")
            ball.write(path)
            with open(path, "rb") as file:
                data = file.read()
        (count,) = np.frombuffer(data, dtype="<u4", count=1, offset=80)
        facets = np.frombuffer(data, dtype=[("normal", "<f4", 3), ("corner", "<f4", (3, 3)), ("_", "<u2")], offset=84)
        self.assertEqual(len(facets), count)
        corner = facets["corner"].astype(float)
        volume = np.einsum("ij,ij->i", corner[:, 0], np.cross(corner[:, 1], corner[:, 2])).sum() / 6
        self.assertLess(abs(volume - 4 / 3 * PI), 1e-3 * 4 * PI)
        self.assertGreater(abs(volume - 4 / 3 * PI), 0)

    def test_boundaries_are_written_and_come_back(self):
        with tempfile.TemporaryDirectory() as folder:
            path = os.path.join(folder, "ball.igs")
            ball = isorim.load(BALL)
            ball.write(path)
            volume = isorim.load(path).properties(tolerance=1e-10)["volume"].value
            self.assertAlmostEqual(volume, 4 / 3 * PI, delta=1e-9)
            ball.write(os.path.join(folder, "ball.vtu"))
            with open(os.path.join(folder, "ball.vtu"), "rb") as file:
                self.assertIn(b"RationalWeights", file.read())


class Integrals(unittest.TestCase):
    def test_callables_and_expressions_agree_with_the_exact_value(self):
        ball = isorim.load(BALL)
        exact = 4 * PI / 15
        for integrand in (lambda x: x[:, 0] ** 2, "x^2"):
            found = ball.integrate(integrand)
            self.assertAlmostEqual(found.value, exact, delta=1e-12)
            self.assertLess(found.error, 1e-10)
            self.assertGreater(found.evaluations, 0)

    def test_integrands_on_the_boundary_see_normals(self):
        ball = isorim.load(BALL)
        found = ball.integrate(lambda x, n: (x * n).sum(axis=1), over="boundary")
        self.assertAlmostEqual(found.value, 4 * PI, delta=1e-11)
        self.assertAlmostEqual(ball.integrate("x*nx + y*ny + z*nz", over="boundary").value, 4 * PI, delta=1e-11)

    def test_one_value_stands_for_all_points(self):
        self.assertAlmostEqual(isorim.load(BALL).integrate(lambda x: 2.0).value, 8 / 3 * PI, delta=1e-11)

    def test_exceptions_of_callables_come_through(self):
        class Odd(Exception):
            pass

        def bad(points):
            raise Odd("not today")

        with self.assertRaisesRegex(Odd, "not today"):
            isorim.load(BALL).integrate(bad)
        with self.assertRaisesRegex(isorim.InputError, "one a point"):
            isorim.load(BALL).integrate(lambda x: x)

    def test_results_do_not_depend_on_the_number_of_threads(self):
        ball = isorim.load(BALL)
        values = {ball.integrate("exp(x)*cos(y)", threads=threads).value for threads in (1, 2, 3)}
        self.assertEqual(len(values), 1)


class Sections(unittest.TestCase):
    def test_sections_of_a_ball_are_discs(self):
        for section in isorim.load(BALL).sections([0, 0, 1], [-0.5, 0.0, 0.6]):
            squared = 1 - section["offset"] ** 2
            self.assertEqual(section["failure"], "")
            self.assertAlmostEqual(section["area"], PI * squared, delta=1e-11)
            self.assertAlmostEqual(section["perimeter"], 2 * PI * math.sqrt(squared), delta=1e-11)
            (loop,) = section["loops"]
            self.assertEqual(loop["points"].shape[1], 3)
            self.assertTrue(np.allclose(loop["points"][:, 2], section["offset"], atol=1e-12))


class Fits(unittest.TestCase):
    def test_fitted_curves_meet_their_points_and_bound_regions(self):
        angle = np.linspace(0, 2 * PI, 200, endpoint=False)
        points = np.column_stack([2 * np.cos(angle), np.sin(angle)])
        found = isorim.fit(points, tolerance=1e-5)
        self.assertTrue(found.tolerance_met)
        self.assertLess(found.distances.max(), 1e-5)
        region = isorim.load({"geometry": {"type": "region", "loops": [found.curve]}})
        self.assertAlmostEqual(region.properties()["area"].value, 2 * PI, delta=1e-4)


class Analyses(unittest.TestCase):
    def test_probes_and_points_have_the_exact_solution(self):
        disc = isorim.load(DISC)
        probe = disc.run()["analysis"]["probes"]["middle"]
        self.assertIsInstance(probe["value"], np.ndarray)
        self.assertAlmostEqual(probe["value"].ravel()[0], 0.1875, delta=1e-6)
        found = disc.evaluate([[0.5, 0.25], [3, 0]])
        self.assertEqual(list(found.location), [1, -1])
        self.assertAlmostEqual(found.value[0, 0], 0.1875, delta=1e-6)
        self.assertTrue(np.allclose(found.gradient[0, 0], [1.0, -0.5], atol=1e-5))
        self.assertTrue(np.isnan(found.value[1]).all())

    def test_fields_on_the_boundary_are_arrays_that_integrate(self):
        disc = isorim.load(DISC)
        disc.run()
        fields = disc.boundary_fields()
        x, y = fields.points.T
        self.assertTrue(np.allclose(np.hypot(x, y), 2, atol=1e-13))
        self.assertTrue(np.allclose(fields.normals, fields.points / 2, atol=1e-13))
        self.assertAlmostEqual(fields.weight.sum(), 4 * PI, delta=1e-11)
        self.assertTrue(np.allclose(fields.value[:, 0], x**2 - y**2, atol=1e-5))
        self.assertTrue(np.allclose(fields.flux[:, 0], x**2 - y**2, atol=1e-3))
        # The energy: the integral of |grad u|^2 = 4 r^2 over the disc.
        self.assertAlmostEqual((fields.weight * fields.value[:, 0] * fields.flux[:, 0]).sum(), 32 * PI, delta=1e-4)
        self.assertEqual(set(fields.patch), {0})
        self.assertGreater(len(set(fields.element)), 4)

    def test_tractions_on_the_boundary_are_those_of_the_load(self):
        block = isorim.load({
            "geometry": {"type": "box", "size": [1, 1, 2]},
            "analysis": {"equation": "elasticity"},
            "material": {"young": 2.0, "poisson": 0.0},
            "boundary_condition": [
                {"where": "abs(x) < 1e-9 || abs(y) < 1e-9 || abs(z) < 1e-9", "kind": "symmetry"},
                {"where": "z > 2 - 1e-9", "kind": "traction", "value": ["0", "0", "3"]},
                {"kind": "traction"}],
        })
        block.run()
        fields = block.boundary_fields()
        self.assertEqual(fields.value.shape, (len(fields.weight), 3))
        top = fields.points[:, 2] > 2 - 1e-9
        self.assertTrue(np.allclose(fields.value[top, 2], 3.0, atol=1e-8))
        self.assertTrue(np.allclose(fields.weight @ fields.flux, 0.0, atol=1e-7))
        self.assertTrue(np.allclose(fields.weight[top] @ fields.flux[top], [0, 0, 3], atol=1e-7))

    def test_runs_write_the_files_of_the_program(self):
        with tempfile.TemporaryDirectory() as folder:
            output = os.path.join(folder, "new", "disc")
            results = isorim.run(DISC, output=output)
            self.assertLessEqual({"boundary.vtu", "solution.vtu", "fields.vtu", "probe_middle.csv", "results.h5",
                                  "results.json"}, set(os.listdir(output)))
            with open(os.path.join(output, "results.json"), encoding="utf-8") as file:
                written = json.load(file)
            self.assertEqual(written["analysis"]["unknowns"], results["analysis"]["unknowns"])
            with self.assertRaisesRegex(isorim.InputError, "cannot make the folder"):
                isorim.run(DISC, output=os.path.join(output, "results.json"))

    def test_there_is_no_solution_before_the_run(self):
        for early in (lambda case: case.evaluate([[0, 0]]), lambda case: case.boundary_fields()):
            with self.assertRaisesRegex(isorim.InputError, "no solution"):
                early(isorim.load(DISC))


class Errors(unittest.TestCase):
    def test_classes_are_those_of_python(self):
        self.assertTrue(issubclass(isorim.InputError, ValueError))
        self.assertTrue(issubclass(isorim.GeometryError, ValueError))
        self.assertTrue(issubclass(isorim.NumericalError, ArithmeticError))

    def test_wrong_keys_are_told_with_the_nearest(self):
        with self.assertRaisesRegex(isorim.InputError, 'did you mean "radius"'):
            isorim.load({"type": "sphere", "radus": 1.0})
        with self.assertRaisesRegex(TypeError, "geometry.radius: found object"):
            isorim.load({"type": "sphere", "radius": object()})

    def test_integrands_that_are_not_finite_are_numerical_errors(self):
        with self.assertRaises(isorim.NumericalError):
            isorim.load(BALL).integrate(lambda x: np.full(len(x), np.nan))

    def test_other_mistakes_are_told(self):
        ball = isorim.load(BALL)
        for wrong in (lambda: ball.integrate("x", over="surface"), lambda: ball.integrate("x", pole=[0, 0]),
                      lambda: ball.sections([0, 0]), lambda: ball.write("ball.step"), lambda: isorim.fit([1, 2, 3])):
            with self.assertRaises(isorim.InputError):
                wrong()
        with self.assertRaises(TypeError):
            ball.integrate(3)

    def test_integrands_give_real_numbers(self):
        ball = isorim.load(BALL)
        for wrong in (lambda x: "abc", lambda x: None, lambda x: x[:, 0] + 1j, lambda x: [object()] * len(x),
                      lambda x: [[1], [1, 2]]):
            with self.assertRaisesRegex(TypeError, "the integrand gave"):
                ball.integrate(wrong)
        with self.assertRaisesRegex(isorim.InputError, r"shape \(\d+, 1\) for"):
            ball.integrate(lambda x: x[:, :1])
        for dtype in (np.int8, np.uint64, np.float32, bool):
            found = ball.integrate(lambda x, dtype=dtype: np.ones(2 * len(x), dtype)[::2])
            self.assertAlmostEqual(found.value, 4 / 3 * PI, delta=1e-11)

    def test_arrays_of_other_numbers_than_reals_are_type_errors(self):
        ball = isorim.load(BALL)
        disc = isorim.load(DISC)
        disc.run()
        for wrong in (lambda: disc.evaluate([[1j, 0]]), lambda: isorim.fit(np.ones((9, 2), complex)),
                      lambda: ball.sections("abc"), lambda: isorim.nurbs_curve(1, [0, 0, 1, 1], [["a", "b"]]),
                      lambda: ball.integrate("x", pole=[None, 0, 0])):
            with self.assertRaisesRegex(TypeError, "expected real numbers"):
                wrong()
        points = np.asfortranarray(np.array([[0.5, 0.25, 9], [0.1, 0.2, 9]]))[::-1, :2]
        self.assertTrue(np.allclose(disc.evaluate(points).value, disc.evaluate(points.copy()).value, rtol=0, atol=0))

    def test_numbers_out_of_range_are_told(self):
        ball = isorim.load(BALL)
        nan, inf = math.nan, math.inf
        for text, wrong in (("tolerance: found nan", lambda: ball.properties(tolerance=nan)),
                            ("tolerance: found -1", lambda: ball.integrate("x", tolerance=-1)),
                            ("tolerance: found 0", lambda: ball.integrate("x", tolerance=0)),
                            ("fit_tolerance: found -1", lambda: ball.sections([0, 0, 1], fit_tolerance=-1)),
                            ("density: found -1", lambda: ball.properties(density=-1)),
                            ("pole: found nan", lambda: ball.properties(pole=[0, nan, 0])),
                            ("pole: found inf", lambda: ball.integrate("x", pole=[0, inf, 0])),
                            ("pole: found 2 coordinates", lambda: ball.properties(pole=[0, 0])),
                            ("threads: found -1", lambda: ball.properties(threads=-1)),
                            ("threads: found -1", lambda: ball.integrate("x", threads=-1)),
                            ("threads: found 5000", lambda: isorim.load(BALL, threads=5000)),
                            ("radius: found the integer 1000", lambda: isorim.load({**BALL, "radius": 10**30}))):
            with self.assertRaisesRegex(isorim.InputError, text):
                wrong()

    def test_lists_that_hold_themselves_are_refused(self):
        endless = []
        endless.append(endless)
        with self.assertRaisesRegex(isorim.InputError, "more than 256 levels"):
            isorim.load({**BALL, "centre": endless})

    def test_a_single_override_needs_no_list(self):
        for overrides in ("geometry.radius=2", ["geometry.radius=2"]):
            found = isorim.load(BALL, overrides=overrides).properties()["area"].value
            self.assertAlmostEqual(found, 16 * PI, delta=1e-11)

    def test_properties_compute_nothing_else(self):
        raft = {"geometry": {"type": "box", "size": [4, 2, 1]}, "hydrostatics": {"draught": 0.5}}
        self.assertIn("hydrostatics", isorim.load(raft).run())
        case = isorim.load({**raft, "added_mass": {}})._case
        alone = json.loads(case.properties(1e-12, None, None, 0))
        self.assertNotIn("hydrostatics", alone)
        self.assertNotIn("added_mass", alone)
        self.assertAlmostEqual(alone["properties"]["volume"]["value"], 8, delta=1e-12)

    def test_ctrl_c_ends_integrals(self):
        timer = threading.Timer(0.5, lambda: os.kill(os.getpid(), signal.SIGINT))
        timer.start()
        with self.assertRaises(KeyboardInterrupt):
            while True:
                isorim.load(BALL).integrate("abs(sin(40*x)*sin(50*y))", tolerance=1e-12)
        timer.cancel()


def signatures(tree):
    """Names of classes, functions and methods of a module, with the names of their arguments."""
    found = {}
    for node in tree.body:
        if isinstance(node, ast.FunctionDef):
            found[node.name] = [a.arg for a in node.args.posonlyargs + node.args.args + node.args.kwonlyargs]
        elif isinstance(node, ast.ClassDef):
            found[node.name] = []
            for name, arguments in signatures(node).items():
                found[f"{node.name}.{name}"] = arguments
    return found


class Stubs(unittest.TestCase):
    def test_stubs_have_all_that_is_public_and_nothing_else(self):
        source = inspect.getsourcefile(isorim)
        with open(source, encoding="utf-8") as file:
            code = signatures(ast.parse(file.read()))
        with open(source + "i", encoding="utf-8") as file:
            stubs = signatures(ast.parse(file.read()))
        code, stubs = ({name: arguments for name, arguments in found.items()
                        if not any(part.startswith("_") for part in name.split("."))} for found in (code, stubs))
        errors = {"GeometryError": [], "InputError": [], "NumericalError": []}
        self.assertEqual(stubs, {**code, **errors})

    def test_everything_public_has_a_docstring(self):
        for name in isorim.__all__:
            thing = getattr(isorim, name)
            if name.endswith("Error"):
                continue
            self.assertTrue(inspect.getdoc(thing), name)
            for member, value in vars(thing).items() if inspect.isclass(thing) else ():
                if not member.startswith("_") and (inspect.isfunction(value) or isinstance(value, property)):
                    self.assertTrue(inspect.getdoc(value), f"{name}.{member}")


if __name__ == "__main__":
    unittest.main()
