"""isorim: integrals, sections, fits and boundary elements on CAD boundaries, without a mesh.

A boundary comes from a file or from a dictionary with the keys of case files (``isorim help case`` lists them), in
which numpy arrays may stand for lists::

    ball = isorim.load({"geometry": {"type": "sphere", "radius": 1.0}})
    ball.properties()["volume"].value
    ball.integrate(lambda x: x[:, 0] ** 2).value

Wrong input raises `InputError` or `GeometryError` (both are ValueErrors), numbers that fail `NumericalError` (an
ArithmeticError). Ctrl-C ends computations.
"""

from __future__ import annotations

import json
import os
from dataclasses import dataclass
from typing import Any

import numpy as np

from . import _isorim
from ._isorim import GeometryError, InputError, NumericalError

__version__ = _isorim.version
__all__ = [
    "Boundary",
    "BoundaryFields",
    "Evaluation",
    "Fit",
    "GeometryError",
    "InputError",
    "Integral",
    "NumericalError",
    "Quantity",
    "fit",
    "load",
    "nurbs_curve",
    "nurbs_surface",
    "run",
]


@dataclass(frozen=True)
class Quantity:
    """A number, vector or matrix with the program's own estimate of its absolute error.

    Attributes
    ----------
    value : float or numpy.ndarray or None
        None if the quantity was refused; then `reason` says why.
    error : float or numpy.ndarray or None
        Absolute; one an entry, or one for all of them.
    status : str or None
        "exact", "converged", "limited_by_rounding", "fixed_rule" or "tolerance_not_reached".
    reason : str
    """

    value: Any
    error: Any = None
    status: str | None = None
    reason: str = ""


@dataclass(frozen=True)
class Integral:
    """An integral with the estimate of its absolute error.

    Attributes
    ----------
    value, error : float
    evaluations : int
        Points at which the integrand was evaluated.
    status : str
        As of `Quantity`.
    """

    value: float
    error: float
    evaluations: int
    status: str


@dataclass(frozen=True)
class Evaluation:
    """The solution of an analysis at n points.

    Attributes
    ----------
    location : numpy.ndarray of int8, shape (n,)
        1 inside, 0 on the boundary, -1 outside; what follows is NaN there.
    value : numpy.ndarray, shape (n, components)
        Potential (one component) or displacement.
    gradient : numpy.ndarray, shape (n, components, dimension)
    """

    location: np.ndarray
    value: np.ndarray
    gradient: np.ndarray


@dataclass(frozen=True)
class BoundaryFields:
    """The solution of an analysis on the boundary, at n nodes of rules that integrate products of the fields.

    ``(fields.weight * fields.flux[:, 0]).sum()`` is the total flux.

    Attributes
    ----------
    element, patch : numpy.ndarray of int, shape (n,)
        Of each node; `patch` counts as `Boundary.patches` does.
    points, normals : numpy.ndarray, shape (n, dimension)
        Normals are unit vectors that point outward.
    weight : numpy.ndarray, shape (n,)
        Of the node in an integral over the boundary; some are negative on trimmed elements.
    value : numpy.ndarray, shape (n, components)
        Potential (one component) or displacement.
    flux : numpy.ndarray, shape (n, components)
        Normal derivative times conductivity, or traction.
    """

    element: np.ndarray
    patch: np.ndarray
    points: np.ndarray
    normals: np.ndarray
    weight: np.ndarray
    value: np.ndarray
    flux: np.ndarray


@dataclass(frozen=True)
class Fit:
    """A curve fitted to points.

    Attributes
    ----------
    curve : dict
        "type", "degree", "knots", "points" and "weights", as case files have curves.
    parameters, distances : numpy.ndarray, shape (n,)
        Of the nearest point of the curve to each of the points.
    tolerance_met : bool
    """

    curve: dict[str, Any]
    parameters: np.ndarray
    distances: np.ndarray
    tolerance_met: bool


def _reals(values: Any, name: str) -> np.ndarray:
    """An array of floats; complex numbers and what is no number are a TypeError."""
    array = np.asarray(values)
    if array.size and array.dtype.kind not in "biuf":
        raise TypeError(f"{name}: found values of the type {array.dtype}; expected real numbers")
    return array.astype(float, copy=False)


def _coordinates(values: Any, name: str) -> list[float]:
    array = _reals(values, name)
    if array.ndim != 1:
        raise InputError(f"{name}: found an array of the shape {array.shape}; expected a list of numbers")
    return array.tolist()


def _arrays(tree: Any) -> Any:
    """Lists of numbers (None: not finite) become arrays, all the way down."""
    if isinstance(tree, dict):
        return {key: _arrays(entry) for key, entry in tree.items()}
    if isinstance(tree, list):
        if tree and _is_numeric(tree):
            return np.array(_with_nan(tree))
        return [_arrays(entry) for entry in tree]
    return tree


def _with_nan(tree: Any) -> Any:
    if isinstance(tree, list):
        return [_with_nan(entry) for entry in tree]
    return np.nan if tree is None else tree


def _shape(tree: Any) -> tuple[int, ...] | None:
    """Of nested lists of numbers; None if they are ragged or hold anything else."""
    if not isinstance(tree, list):
        is_number = tree is None or (isinstance(tree, (int, float)) and not isinstance(tree, bool))
        return () if is_number else None
    shapes = {_shape(entry) for entry in tree}
    if len(shapes) != 1 or None in shapes:
        return None
    return (len(tree), *shapes.pop())


def _is_numeric(tree: list[Any]) -> bool:
    return _shape(tree) is not None


def _quantity(entry: dict[str, Any]) -> Quantity:
    return Quantity(entry.get("value"), entry.get("error"), entry.get("status"), entry.get("reason", ""))


class Boundary:
    """The boundary of a region of the plane or of a solid, oriented; made by `load`.

    A boundary knows the whole case that it was loaded from: `run` computes everything that the case asks for.
    """

    def __init__(self, case: _isorim.Case) -> None:
        self._case = case

    def __repr__(self) -> str:
        return f"<isorim.Boundary {self.title!r}: {self.dimension}D, {len(self.patches)} patches>"

    @property
    def title(self) -> str:
        """Title of the case, or the name of the file."""
        return self._case.title

    @property
    def dimension(self) -> int:
        """2 or 3."""
        return self._case.dimension

    @property
    def patches(self) -> list[str]:
        """Names of the patches."""
        return self._case.patches

    def inspect(self, *, threads: int = 0) -> dict[str, Any]:
        """What there is to know without integrating, as ``isorim check --json`` prints it."""
        return _arrays(json.loads(self._case.inspection(threads)))

    def properties(self, *, density: float | None = None, tolerance: float = 1e-12, pole: Any = None,
                   threads: int = 0) -> dict[str, Quantity]:
        """Measures, centroid and moments.

        Parameters
        ----------
        density : float, optional
            Adds mass; moments are then those of the mass.
        tolerance : float
            Relative.
        pole : array_like, shape (dimension,), optional
            Of the radial integration.
        threads : int
            0: all. Results are the same bits for any number.

        Returns
        -------
        dict of str to Quantity
            "perimeter" and "area" in the plane, "area" and "volume" in space, "centroid", "inertia",
            "principal_moments", ...
        """
        at = None if pole is None else _coordinates(pole, "pole")
        text = self._case.properties(tolerance, density, at, threads)
        return {name: _quantity(entry) for name, entry in _arrays(json.loads(text))["properties"].items()}

    def integrate(self, integrand: Any, *, over: str = "domain", tolerance: float = 1e-12, pole: Any = None,
                  threads: int = 0) -> Integral:
        """Integrates over the domain or its boundary.

        Parameters
        ----------
        integrand : str or callable
            An expression in x, y, z (and nx, ny, nz on the boundary) as in case files; or a function of points, shape
            (n, dimension), and on the boundary of outward unit normals of the same shape, that returns n values (or
            one for all). It is called for blocks of points, from the calling thread; its exceptions come through.
        over : {"domain", "boundary"}
        tolerance : float
            Relative to the integral.
        pole : array_like, shape (dimension,), optional
        threads : int
            For expressions.
        """
        if over not in ("domain", "boundary"):
            raise InputError(f"over: found {over!r}; expected 'domain' or 'boundary'")
        if not isinstance(integrand, str) and not callable(integrand):
            raise TypeError(f"integrand: found {type(integrand).__name__}; expected a text or a callable")
        at = None if pole is None else _coordinates(pole, "pole")
        return Integral(*_isorim.integrate(self._case, integrand, over == "boundary", tolerance, at, threads))

    def sections(self, normal: Any, offsets: Any = (0.0,), *, point: Any = (0.0, 0.0, 0.0),
                 fit_tolerance: float = 1e-8, threads: int = 0) -> list[dict[str, Any]]:
        """Cuts a solid by parallel planes.

        Parameters
        ----------
        normal : array_like, shape (3,)
        offsets : float or array_like
            Distances of the planes from `point` along the normal.
        point : array_like, shape (3,)
        fit_tolerance : float
            Of the curves, relative to the size of the boundary.

        Returns
        -------
        list of dict
            One a plane: "offset", "failure" ("" if there is none), "area", "perimeter" and their "..._error",
            "centroid" (None without loops), "loops" and "chains": curves in space as `nurbs_curve` gives them, with
            "length" and "error"; None for one that could not be fitted.
        """
        distances = _coordinates(np.atleast_1d(_reals(offsets, "offsets")), "offsets")
        return _isorim.sections(self._case, _coordinates(normal, "normal"), distances, _coordinates(point, "point"),
                                fit_tolerance, threads)

    def run(self, *, output: str | os.PathLike[str] | None = None, threads: int = 0) -> dict[str, Any]:
        """Computes everything that the case asks for: the content of results.json, lists of numbers as arrays.

        What is not finite is NaN in arrays, None by itself.

        Parameters
        ----------
        output : path, optional
            A folder for the files that ``isorim run`` writes; it is made if need be.
        threads : int
            0: all.
        """
        return _arrays(json.loads(self._case.run(threads, None if output is None else os.fspath(output))))

    def boundary_fields(self) -> BoundaryFields:
        """The solution of an analysis on the boundary, after `run`."""
        return BoundaryFields(*self._case.boundary_fields())

    def evaluate(self, points: Any, *, threads: int = 0) -> Evaluation:
        """The solution of an analysis, after `run`, at points of shape (n, dimension)."""
        return Evaluation(*self._case.evaluate(_reals(points, "points"), threads))

    def write(self, path: str | os.PathLike[str], *, unit: str | None = None) -> None:
        """Writes the boundary as ``isorim convert`` does.

        Parameters
        ----------
        path : path
            Its extension tells the format: .vtu (exact Bézier cells), .igs, .iges, .iga (T-splines by their
            extraction), .stl (a watertight mesh of a solid), .svg (a region of the plane).
        unit : str, optional
            IGES: of the lengths of a shape that tells none; mm if absent.
        """
        self._case.write_boundary(os.fspath(path), unit)

    def write_solution(self, path: str | os.PathLike[str]) -> None:
        """Writes the fields of an analysis, after `run`, on exact Bézier cells (.vtu)."""
        self._case.write_solution(os.fspath(path))


def load(source: Any, *, overrides: Any = (), folder: str | os.PathLike[str] = ".", threads: int = 0) -> Boundary:
    """Loads a case or CAD file, or builds a case.

    Parameters
    ----------
    source : path, str or dict
        A case (.toml) or CAD file; the text of a case (it has a line break); or a dictionary with its keys. Numpy
        arrays stand for lists, entries that are None are left out. A dictionary without "geometry" but with "type" is
        the geometry.
    overrides : sequence of str, or a single one
        "key.path=value", as ``--set`` takes them.
    folder : path
        Where relative paths in texts and dictionaries begin.
    threads : int
        0: all.
    """
    changes = [overrides] if isinstance(overrides, str) else list(overrides)
    if isinstance(source, dict):
        tree = {"geometry": source} if "geometry" not in source and "type" in source else source
        return Boundary(_isorim.Case.from_dict(tree, os.fspath(folder), changes, threads))
    if isinstance(source, str) and "\n" in source:
        return Boundary(_isorim.Case.from_toml(source, os.fspath(folder), changes, threads))
    return Boundary(_isorim.Case.from_file(os.fspath(source), changes, threads))


def run(source: Any, *, overrides: Any = (), folder: str | os.PathLike[str] = ".",
        output: str | os.PathLike[str] | None = None, threads: int = 0) -> dict[str, Any]:
    """Loads a case and computes everything that it asks for; see `load` and `Boundary.run`."""
    return load(source, overrides=overrides, folder=folder, threads=threads).run(output=output, threads=threads)


def nurbs_curve(degree: int, knots: Any, points: Any, weights: Any = None, **keys: Any) -> dict[str, Any]:
    """A NURBS curve as case files have it, for loops of regions, profiles and sections.

    Parameters
    ----------
    degree : int
    knots : array_like, shape (n + degree + 1,)
    points : array_like, shape (n, 2) or (n, 3)
        Cartesian, not multiplied by the weights.
    weights : array_like, shape (n,), optional
    **keys
        Further keys, such as ``role="hole"`` or ``name="rim"``.
    """
    return {"type": "nurbs", "degree": degree, "knots": _reals(knots, "knots"),
            "points": _reals(points, "points"),
            "weights": None if weights is None else _reals(weights, "weights"), **keys}


def nurbs_surface(degree: Any, knots: Any, points: Any, weights: Any = None, **keys: Any) -> dict[str, Any]:
    """A NURBS surface as case files have it, for the patches of a solid.

    Parameters
    ----------
    degree : (int, int)
        In u and v.
    knots : pair of array_like
        In u and v.
    points : array_like, shape (nv, nu, 3)
        Rows in each of which u runs.
    weights : array_like, shape (nv, nu), optional
    **keys
        Further keys, such as ``name="deck"``.
    """
    weight_rows = None if weights is None else _reals(weights, "weights")
    return {"type": "nurbs", "degrees": [int(p) for p in degree], "knots_u": _reals(knots[0], "knots"),
            "knots_v": _reals(knots[1], "knots"), "points": _reals(points, "points"),
            "weights": weight_rows, **keys}


def fit(points: Any, *, closed: bool = True, degree: int = 3, control_points: int = 0, tolerance: float = 0.0,
        corner_angle: float = 0.0) -> Fit:
    """Fits a B-spline curve to ordered points.

    Parameters
    ----------
    points : array_like, shape (n, 2) or (n, 3)
    closed : bool
        The last point is followed by the first.
    degree : int
    control_points : int
        0: as many as `tolerance` needs, or by a rule if that is 0 too.
    tolerance : float
        Largest distance of a point from the curve.
    corner_angle : float
        Degrees; points at which the polygon turns by more become corners. 0: none.
    """
    found = _isorim.fit(_reals(points, "points"), closed, degree, control_points, tolerance, corner_angle)
    curve = {key: found[key] for key in ("type", "degree", "knots", "points", "weights")}
    return Fit(curve, found["parameters"], found["distances"], found["tolerance_met"])
