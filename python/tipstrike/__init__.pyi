from collections.abc import Callable, Iterator, Mapping, Sequence
from os import PathLike
from typing import Any, Optional, TypedDict, Union, final, overload

import numpy as np
from numpy.typing import NDArray

_Array = NDArray[np.float64]
_Number = Union[float, int, str]
#: A text with its unit, a number in SI, or a number with the name of its unit.
_Value = Union[_Number, bool, tuple[float, str], Sequence[float]]
_Axis = Union[str, Sequence[_Number], _Array, tuple[Union[Sequence[float], _Array], str]]
_Source = Union[Case, str, PathLike[str], Mapping[str, Any]]
_Only = Union[str, Sequence[str], None]
#: True for a percentage on standard error, or a function of the done and all points.
_Progress = Union[bool, None, Callable[[int, int], object]]

class _Problem(TypedDict):
    place: str
    field: str
    cause: str
    fix: str

class CaseError(ValueError):
    problems: list[_Problem]
    place: str
    field: str
    cause: str
    fix: str

@final
class Case:
    @property
    def name(self) -> str: ...
    @property
    def title(self) -> str: ...
    @property
    def variants(self) -> list[str]: ...
    def get(self, key: str) -> Optional[str]:
        """The text of a field, given or by default."""
    def text(self) -> str:
        """The text of the case file."""
    def changed(self, changes: Sequence[tuple[str, str]], variant: Optional[str]) -> Case: ...

class Quantity(float):
    @property
    def value(self) -> Union[float, bool]: ...
    @property
    def unit(self) -> str: ...

class Columns(dict[str, Any]):
    units: dict[str, str]
    notes: list[str]
    def to_dict(self) -> dict[str, list[Any]]: ...

class Result(Mapping[str, Quantity]):
    def __getitem__(self, name: str) -> Quantity: ...
    def __iter__(self) -> Iterator[str]: ...
    def __len__(self) -> int: ...
    @property
    def value(self) -> dict[str, Union[float, bool]]: ...
    @property
    def unit(self) -> dict[str, str]: ...
    @property
    def method(self) -> str: ...
    @property
    def outcome(self) -> str: ...
    @property
    def notes(self) -> dict[str, str]: ...
    @property
    def stations(self) -> Columns: ...
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...

class Study(dict[str, Any]):
    columns: Columns
    notes: list[str]
    def to_json(self) -> str: ...
    def to_dict(self) -> dict[str, Any]: ...

class Excitation(Study):
    period: dict[str, _Array]
    passage: dict[str, _Array]
    harmonics: dict[str, _Array]
    units: dict[str, str]
    mesh_period: float
    mesh_frequency: float
    base_pitch: float
    speed_driver: float
    base_radius_driver: float
    base_radius_driven: float
    inertia_driver: float
    inertia_driven: float
    reduced_mass: float
    damping: float
    mean_stiffness: float
    mean_torsional_stiffness: float
    mesh_force: float
    torque_driver: float

class Picture(str):
    def save(self, path: Union[str, PathLike[str]]) -> None: ...

def read(path: Union[str, PathLike[str]]) -> Case: ...
def case(data: Union[Mapping[str, Any], str], name: str = "case") -> Case: ...
__version__: str

def examples() -> list[str]: ...
def example(name: str) -> Case: ...
# A type checker holds the values of `**{"pair.module": 5e-3}` against every named parameter: the first
# form has none.
@overload
def solve(case: _Source, method: Optional[str] = None, /, **changes: _Value) -> Result: ...
@overload
def solve(
    case: _Source, method: Optional[str] = None, *, only: _Only = None, stations: Union[int, str, None] = None,
    variant: Optional[str] = None, **changes: _Value,
) -> Result: ...
@overload
def sweep(case: _Source, vary: Mapping[str, _Axis], /, **changes: _Value) -> Columns: ...
@overload
def sweep(
    case: _Source, vary: Mapping[str, _Axis], *, only: _Only = None, points: Union[int, Sequence[int], None] = None,
    log: bool = False, method: Optional[str] = None, variant: Optional[str] = None, jobs: Optional[int] = None,
    progress: _Progress = None, **changes: _Value,
) -> Columns: ...
def tolerance(
    case: _Source, *, samples: int = 10_000, seed: int = 1, ranking: Optional[int] = None, only: _Only = None,
    method: Optional[str] = None, variant: Optional[str] = None, jobs: Optional[int] = None,
    progress: _Progress = None, **changes: _Value,
) -> Study: ...
def seek(
    case: _Source, vary: Union[str, Mapping[str, _Axis]], until: str, *, points: int = 201, method: Optional[str] = None,
    variant: Optional[str] = None, jobs: Optional[int] = None, progress: _Progress = None, **changes: _Value,
) -> Study: ...
def relief(
    case: _Source, *, load: str = "25..110%", spectrum: Optional[str] = None, tolerance: str = "5 um",
    tolerance_length: Optional[str] = None, misalignment: str = "0 um", minimise: str = "te", method: Optional[str] = None,
    variant: Optional[str] = None, progress: _Progress = None, **changes: _Value,
) -> Study: ...
def stiffness(case: _Source, *, points: int = 9, variant: Optional[str] = None, **changes: _Value) -> Study: ...
def excitation(
    case: _Source, *, points: int = 256, variant: Optional[str] = None, progress: _Progress = None, **changes: _Value,
) -> Excitation: ...
def compare(
    *cases: _Source, only: _Only = None, method: Optional[str] = None, variants: Optional[Sequence[str]] = None,
    progress: _Progress = None, **changes: _Value,
) -> Study: ...
def report(
    *cases: _Source, out: Union[str, PathLike[str]], title: Optional[str] = None, appendix: bool = True,
    method: Optional[str] = None, progress: _Progress = None, **changes: _Value,
) -> None: ...
def plot(
    case: _Source, chart: str = "force", *, method: Optional[str] = None, variant: Optional[str] = None,
    progress: _Progress = None, **changes: _Value,
) -> Picture: ...
