import os
from collections.abc import Callable, Sequence
from dataclasses import dataclass
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

_Path = str | os.PathLike[str]
_Floats = NDArray[np.float64]
_Integrand = str | Callable[[_Floats], ArrayLike] | Callable[[_Floats, _Floats], ArrayLike]

__version__: str
__all__: list[str]

class InputError(ValueError): ...
class GeometryError(InputError): ...
class NumericalError(ArithmeticError): ...

@dataclass(frozen=True)
class Quantity:
    value: Any
    error: Any = ...
    status: str | None = ...
    reason: str = ...

@dataclass(frozen=True)
class Integral:
    value: float
    error: float
    evaluations: int
    status: str

@dataclass(frozen=True)
class Evaluation:
    location: NDArray[np.int8]
    value: _Floats
    gradient: _Floats

@dataclass(frozen=True)
class BoundaryFields:
    element: NDArray[np.int32]
    patch: NDArray[np.int32]
    points: _Floats
    normals: _Floats
    weight: _Floats
    value: _Floats
    flux: _Floats

@dataclass(frozen=True)
class Fit:
    curve: dict[str, Any]
    parameters: _Floats
    distances: _Floats
    tolerance_met: bool

class Boundary:
    def __init__(self, case: object) -> None: ...
    @property
    def title(self) -> str: ...
    @property
    def dimension(self) -> int: ...
    @property
    def patches(self) -> list[str]: ...
    def inspect(self, *, threads: int = ...) -> dict[str, Any]: ...
    def properties(
        self,
        *,
        density: float | None = ...,
        tolerance: float = ...,
        pole: ArrayLike | None = ...,
        threads: int = ...,
    ) -> dict[str, Quantity]: ...
    def integrate(
        self,
        integrand: _Integrand,
        *,
        over: Literal["domain", "boundary"] = ...,
        tolerance: float = ...,
        pole: ArrayLike | None = ...,
        threads: int = ...,
    ) -> Integral: ...
    def sections(
        self,
        normal: ArrayLike,
        offsets: ArrayLike = ...,
        *,
        point: ArrayLike = ...,
        fit_tolerance: float = ...,
        threads: int = ...,
    ) -> list[dict[str, Any]]: ...
    def run(self, *, output: _Path | None = ..., threads: int = ...) -> dict[str, Any]: ...
    def boundary_fields(self) -> BoundaryFields: ...
    def evaluate(self, points: ArrayLike, *, threads: int = ...) -> Evaluation: ...
    def write(self, path: _Path, *, unit: str | None = ...) -> None: ...
    def write_solution(self, path: _Path) -> None: ...

def load(
    source: _Path | dict[str, Any], *, overrides: Sequence[str] = ..., folder: _Path = ..., threads: int = ...
) -> Boundary: ...
def run(
    source: _Path | dict[str, Any],
    *,
    overrides: Sequence[str] = ...,
    folder: _Path = ...,
    output: _Path | None = ...,
    threads: int = ...,
) -> dict[str, Any]: ...
def nurbs_curve(
    degree: int, knots: ArrayLike, points: ArrayLike, weights: ArrayLike | None = ..., **keys: Any
) -> dict[str, Any]: ...
def nurbs_surface(
    degree: Sequence[int], knots: Sequence[ArrayLike], points: ArrayLike, weights: ArrayLike | None = ..., **keys: Any
) -> dict[str, Any]: ...
def fit(
    points: ArrayLike,
    *,
    closed: bool = ...,
    degree: int = ...,
    control_points: int = ...,
    tolerance: float = ...,
    corner_angle: float = ...,
) -> Fit: ...
