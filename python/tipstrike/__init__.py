"""Corner contact in spur and helical gear pairs: position, force and duration of the tip impact.

    import tipstrike

    case = tipstrike.read("pair.toml")
    result = tipstrike.solve(case, "dynamic", **{"operation.speed": "3000 rpm"})
    print(result["dynamic_peak_force"])

Results are in SI units. A value of a field is a text with its unit ("3000 rpm"), a pair of number and
unit ((3000, "rpm")), or a number in SI. The names are those of `tipstrike fields` and `tipstrike
fields --results`.

Parameters of most functions
----------------------------
case : Case, path or dict
    The pair: `read`, `case` and `example` make a Case.
method : str, optional
    "paper", "exact", "static", "dynamic" or "auto", in place of the method of the case.
only : str or list of str, optional
    The quantities to compute; by default all, or the headline quantities of a study.
variant : str, optional
    A variant of the case.
jobs : int, optional
    The number of threads; by default one per core.
progress : bool or function, optional
    True shows a percentage on standard error; a function receives the done and all points.
**changes
    Values of fields in place of those of the case.
"""

import json as _json
import os as _os
import sys as _sys
from collections.abc import Mapping as _Mapping
from importlib import machinery as _machinery


class _NumPy:
    """NumPy, imported at its first use: the command `tipstrike` does without."""

    def __getattr__(self, name):
        global _np
        try:
            import numpy
        except ImportError as error:
            raise ImportError("tipstrike needs NumPy: pip install 'numpy>=1.21'") from error
        if tuple(int(part) for part in numpy.__version__.split(".")[:2]) < (1, 21):
            raise ImportError(
                f"tipstrike needs NumPy 1.21 or newer, this is {numpy.__version__}: pip install -U numpy"
            )
        _np = numpy
        return getattr(numpy, name)


_np = _NumPy()


class CaseError(ValueError):
    """A case that cannot be read or solved: `problems` has place, field, cause and fix of each problem.

    `place`, `field`, `cause` and `fix` are those of the first problem.
    """

    def __init__(self, problems):
        self.problems = [dict(zip(("place", "field", "cause", "fix"), problem)) for problem in problems]
        self.place, self.field, self.cause, self.fix = problems[0]
        super().__init__("\n".join(": ".join(problem) for problem in problems))

    def __reduce__(self):
        return CaseError, ([tuple(problem.values()) for problem in self.problems],)


try:
    from . import _tipstrike
except ImportError as error:
    _name = f"{_sys.implementation.name} {_sys.version_info.major}.{_sys.version_info.minor} on {_sys.platform}"
    raise ImportError(
        f"tipstrike has no wheel for this interpreter ({_name}): use CPython 3.9 or newer on Linux x86_64, or build "
        f"it with Rust 1.89: pip install --no-binary tipstrike tipstrike ({error})"
        if _machinery.EXTENSION_SUFFIXES else
        f"this interpreter ({_name}) loads no shared library, and so no wheel: use one with dynamic loading, such "
        "as that of the system or of python.org"
    ) from error

Case = _tipstrike.Case
__version__ = _tipstrike.version()
_UNITS = dict(_tipstrike.units())


class Quantity(float):
    """A value in SI with its `unit`; `value` is a bool for a yes or no."""

    __slots__ = ("unit", "value")

    def __new__(cls, value, unit):
        self = super().__new__(cls, value)
        self.value, self.unit = value, unit
        return self

    def __getnewargs__(self):
        return self.value, self.unit

    def __repr__(self):
        return repr(self.value) if self.unit in ("", "1") else f"{self.value!r} {self.unit}"


class Columns(dict):
    """Columns by name: NumPy arrays, or lists of texts. `units` has the unit of each column.

    A column without a value has NaN there. `notes` has the warnings of a study.
    """

    def __init__(self, columns, notes=()):
        self.units = {name: unit for name, unit, _ in columns}
        self.notes = list(notes)
        super().__init__((name, _array(values)) for name, _, values in columns)

    def to_dict(self):
        """The columns as lists, with None where a value is absent."""
        plain = lambda value: None if isinstance(value, float) and value != value else value
        return {name: [plain(value) for value in _list(values)] for name, values in self.items()}


def _list(values):
    return values.tolist() if isinstance(values, _np.ndarray) else list(values)


def _array(values):
    return _np.frombuffer(values, dtype=float) if isinstance(values, bytearray) else values


class Result(_Mapping):
    """The results of a solve: `result["impact_force"]` by name or symbol, in SI with its unit."""

    def __init__(self, solved):
        self._solved = solved

    def __getitem__(self, name):
        found = self._solved.get(name)
        if found is None:
            raise KeyError(f"{name}: {self._solved.absence(name)}")
        return Quantity(*found)

    def __iter__(self):
        return iter(self._solved.keys())

    def __len__(self):
        return len(self._solved.keys())

    @property
    def value(self):
        """The values by name."""
        return {name: quantity.value for name, quantity in self.items()}

    @property
    def unit(self):
        """The units by name."""
        return {name: quantity.unit for name, quantity in self.items()}

    @property
    def method(self):
        return self._solved.method

    @property
    def outcome(self):
        """`corner-contact` or `no-corner-contact`."""
        return self._solved.outcome

    @property
    def notes(self):
        """The messages by their codes; several messages of a code are lines."""
        notes = {}
        for code, message in self._solved.notes:
            notes[code] = f"{notes[code]}\n{message}" if code in notes else message
        return notes

    @property
    def stations(self):
        """The values of the incoming tooth from the first to the last contact, as columns.

        Of a pair in slices also `line_load`, over `line_load_roll_angle_driver` (of the middle of the face,
        counted as `roll_angle_driver`) and `line_load_z`.
        """
        columns = Columns(self._solved.stations())
        if "line_load" in columns:
            columns["line_load"] = columns["line_load"].reshape(-1, len(columns["line_load_z"]))
        return columns

    def to_json(self):
        """The line of `tipstrike solve --format json`."""
        return self._solved.json()

    def to_dict(self):
        """The same as a dict."""
        return _json.loads(self.to_json())

    def __str__(self):
        return self._solved.text()

    def __repr__(self):
        return f"<Result by {self.method}: {self.outcome}, {len(self)} quantities>"


class Study(dict):
    """The results of a study, as its command writes them in JSON. `columns` has its table as arrays.

    `print` shows the text of the command.
    """

    def __init__(self, columns, text, notes=(), json=None):
        super().__init__(_json.loads(json))
        self.columns, self.notes, self._json, self._text = Columns(columns), list(notes), json, text

    def to_json(self):
        return self._json

    def to_dict(self):
        return dict(self)

    def __str__(self):
        return self._text.rstrip("\n")


class Excitation(Study):
    """Constants by name, and the parts `period`, `passage` and `harmonics` as columns."""

    def __init__(self, *found):
        super().__init__(*found)
        self.period, self.passage, self.harmonics = (
            _rows(self.pop(part)) for part in ("period", "passage", "harmonics")
        )
        self.units = {name: constant["unit"] for name, constant in self["constants"].items()}
        self.units.update(self.columns.units)

    def __getattr__(self, name):
        constants = self.get("constants", {})
        if name in constants:
            return constants[name]["value"]
        raise AttributeError(name)

    def to_dict(self):
        return _json.loads(self.to_json())


def _rows(rows):
    names = rows[0] if rows else ()
    return {name: _np.array([row.get(name, _np.nan) for row in rows]) for name in names}


class Picture(str):
    """A picture as SVG, which a notebook shows."""

    def _repr_svg_(self):
        return str(self)

    def save(self, path):
        with open(path, "w", encoding="utf-8") as file:
            file.write(self)


def _value(key, value):
    """A value in the words of a case file."""
    if isinstance(value, str):
        return value
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, tuple) and len(value) == 2 and isinstance(value[1], str):
        number, unit = value
    elif isinstance(value, (list, _np.ndarray)):
        return repr([float(item) for item in value])
    else:
        number, unit = value, _UNITS.get(key, "")
    return f"{_number(number)} {unit}".rstrip()


def _number(value):
    value = float(value)
    return str(int(value)) if value.is_integer() and abs(value) < 2**53 else repr(value)


def _toml(data):
    """A dict as the text of a case file; a nested table may also have keys with a dot."""
    lines = ["format = 1"] if "format" not in data else []
    tables = []
    for name, value in data.items():
        if not isinstance(value, _Mapping):
            lines.append(f"{name} = {_assigned(name, value)}")
            continue
        tables.append((name, value))
    for name, table in tables:
        deep = {key: value for key, value in table.items() if isinstance(value, _Mapping)} if name == "variants" else {}
        lines.append(f"[{name}]")
        for key, value in table.items():
            if key not in deep:
                lines.append(f"{_json.dumps(key)} = {_assigned(f'{name}.{key}', value)}")
        for key, values in deep.items():
            lines.append(f"[{name}.{_json.dumps(key)}]")
            lines.extend(f"{_json.dumps(inner)} = {_assigned(inner, value)}" for inner, value in values.items())
    return "\n".join(lines) + "\n"


def _assigned(key, value):
    key = key.split(".", 1)[1] if key.startswith("spread.") else key
    if isinstance(value, _Mapping):
        return "{ " + ", ".join(f"{name} = {_assigned(key, part)}" for name, part in value.items()) + " }"
    text = _value(key, value)
    is_bare = not isinstance(value, str) and " " not in text or isinstance(value, (list, _np.ndarray))
    return text if is_bare else _json.dumps(text)


def read(path):
    """The case of a file, or the first stage of a REXS model (.rexs, .rexsj, .rexsz)."""
    return Case.read(_os.fspath(path))


def case(data, name="case"):
    """The case of a dict with the keys of a case file, or of its text."""
    if isinstance(data, str):
        return Case.parse(name, data)
    try:
        return Case.parse(name, _toml(data))
    except CaseError as error:
        # A dict has no lines.
        raise CaseError([(name, *list(problem.values())[1:]) for problem in error.problems]) from None


def examples():
    """The names of the built-in examples."""
    return _tipstrike.examples()


def example(name):
    """A built-in example, such as "zhou-chen-2014"."""
    return Case.parse(name, _tipstrike.example(name))


def _opened(source, changes=None, variant=None, method=None, stations=None):
    if isinstance(source, _Mapping):
        source = case(source)
    elif not isinstance(source, Case):
        source = read(source)
    changes = [(key, _value(key, value)) for key, value in (changes or {}).items()]
    if stations is not None:
        changes.append(("model.stations", str(stations)))
    if method is not None:
        changes.append(("model.method", method))
    return source.changed(changes, variant) if changes or variant is not None else source


def _names(only):
    return [only] if isinstance(only, str) else list(only or ())


def _progress(progress):
    if progress is True:
        return lambda done, of: _sys.stderr.write(f"\r{100 * done // max(of, 1):3d} %")
    return progress or None


def solve(case, method=None, *, only=None, stations=None, variant=None, **changes):
    """The results of a case; `only` names the quantities to compute, else all are."""
    opened = _opened(case, changes, variant, method, stations)
    return Result(opened.solve(_names(only), stations is not None))


def _varied(key, values):
    if isinstance(values, str):
        return f"{key}={values}"
    unit = None
    if isinstance(values, tuple) and len(values) == 2 and isinstance(values[1], str):
        values, unit = values
    items = [item if isinstance(item, str) else _number(item) for item in _np.ravel(values).tolist()]
    unit = _UNITS.get(key, "") if unit is None else unit
    if any(isinstance(item, str) for item in _np.ravel(values).tolist()):
        unit = ""
    return f"{key}={','.join(items)} {unit}".rstrip()


def sweep(case, vary, *, only=None, points=None, log=False, method=None, variant=None, jobs=None,
          progress=None, **changes):
    """A case over every combination of values: `vary` has a field's array in SI, (array, unit), or the
    text of the command, such as "500..3000 rpm" with `points`. The first field varies slowest."""
    opened = _opened(case, changes, variant, method)
    twice = [key for key in vary if key in changes]
    if twice:
        raise ValueError(f"{twice[0]}: the sweep varies this field: leave one of both out")
    vary = [_varied(key, values) for key, values in vary.items()]
    points = [] if points is None else [int(count) for count in _np.ravel(points)]
    return Columns(*opened.sweep(vary, points, log, _names(only), jobs, _progress(progress)))


def tolerance(case, *, samples=10_000, seed=1, ranking=None, only=None, method=None, variant=None, jobs=None,
              progress=None, **changes):
    """Percentiles, probabilities and ranking by the distributions [spread]; `columns` has every solve."""
    opened = _opened(case, changes, variant, method)
    samples = max(samples, 0)
    columns, json, text, notes = opened.tolerance(samples, seed, ranking, _names(only), jobs, _progress(progress))
    return Study(columns, text, notes, json)


def _study(kind, found):
    columns, json, text, notes = found
    return kind(columns, text, notes, json)


def _range(vary):
    if isinstance(vary, str):
        return vary
    if len(vary) != 1:
        raise ValueError(f"vary: a search varies one field, and not {len(vary)}: give one field with its range")
    [text] = [_varied(key, values) for key, values in vary.items()]
    first, *rest = text.split(",")
    return f"{first}..{rest[-1]}" if rest else text


def seek(case, vary, until, *, points=201, method=None, variant=None, jobs=None, progress=None, **changes):
    """Where a condition changes: seek(case, {"deviations.base_pitch": "0..40 um"}, "impact_force<=2500 N").

    `vary` has one field with its range as in `sweep`, from the first to the last value of an array, or the
    text of the command, such as "deviations.base_pitch=0..40 um"."""
    opened = _opened(case, changes, variant, method)
    return _study(Study, opened.seek(_range(vary), until, points, jobs, _progress(progress)))


def relief(case, *, load="25..110%", spectrum=None, tolerance="5 um", tolerance_length=None,
           misalignment="0 um", minimise="te", method=None, variant=None, progress=None, **changes):
    """The tip relief to specify on both gears, and what each kind of relief gains and costs."""
    opened = _opened(case, changes, variant, method)
    options = (load, spectrum, tolerance, tolerance_length, misalignment, minimise)
    return _study(Study, opened.relief(*options, _progress(progress)))


def stiffness(case, *, points=9, variant=None, **changes):
    """The tooth compliance of every model over the flanks, beside finite elements."""
    return _study(Study, _opened(case, changes, variant).stiffness(points))


def excitation(case, *, points=256, variant=None, progress=None, **changes):
    """Stiffness, transmission error, force and damping of the mesh for other solvers."""
    return _study(Excitation, _opened(case, changes, variant).excitation(points, _progress(progress)))


def compare(*cases, only=None, method=None, variants=None, progress=None, **changes):
    """Cases side by side; a single case with its variants."""
    opened = []
    for source in cases:
        plain = _opened(source)
        names = [None, *(plain.variants if variants is None and len(cases) == 1 else variants or ())]
        opened.extend(_opened(plain, changes, name, method) for name in names)
    json, text = _tipstrike.compare(opened, _names(only), _progress(progress))
    return Study([], text, (), json)


def report(*cases, out, title=None, appendix=True, method=None, progress=None, **changes):
    """Writes cases to a page with charts (.html), or to .md, .csv or .json."""
    opened = [_opened(source, changes, None, method) for source in cases]
    text = _tipstrike.report(opened, _os.fspath(out), title, not appendix, _progress(progress))
    with open(out, "w", encoding="utf-8", newline="") as file:
        file.write(text)


def plot(case, chart="force", *, method=None, variant=None, progress=None, **changes):
    """A chart of a case, or its teeth, as SVG; a notebook shows it, `save` writes it."""
    return Picture(_opened(case, changes, variant, method).plot(chart, _progress(progress)))
