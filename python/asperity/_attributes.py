"""Attributes of results: their types, units and meanings, and what follows from them."""

from __future__ import annotations

import html
import re
import types
from collections.abc import Iterator, Mapping, Sequence
from typing import (
    TYPE_CHECKING,
    Any,
    ForwardRef,
    Generic,
    NoReturn,
    Self,
    TypeVar,
    Union,
    get_args,
    get_origin,
    overload,
)

from . import _native
from ._columns import COLUMNS, Cell

if TYPE_CHECKING:
    import numpy as np
    import numpy.typing as npt
    import pandas as pd


T = TypeVar("T")

#: Unit of an attribute that is the unit of the quantity to which it belongs.
OF_QUANTITY = "="
#: Largest number of rows that a notebook shows of a table.
MOST_ROWS = 12


class Attribute(Generic[T]):
    """An attribute of a result, with its type, unit and meaning.

    The type of an array is written as a text, since the program starts without NumPy: its import takes longer than a command.
    """

    name: str
    type: Any

    def __init__(self, unit: str, meaning: str) -> None:
        self.unit = unit
        self.meaning = meaning

    def __set_name__(self, owner: type, name: str) -> None:
        self.name = name
        self.type = get_args(vars(self)["__orig_class__"])[0]
        self.describe(self.unit, self.meaning)

    def describe(self, unit: str, meaning: str) -> None:
        """Sets the unit, the meaning, and with them the text that `help` shows."""
        self.unit, self.meaning = unit, meaning
        self.__doc__ = f"{self.type_in_words()}{self._unit_in_words()}: {meaning}."

    @overload
    def __get__(self, instance: None, owner: type) -> Self: ...
    @overload
    def __get__(self, instance: Values, owner: type) -> T: ...
    def __get__(self, instance: Values | None, owner: type) -> Self | T:
        if instance is None:
            return self
        value: T = instance._read(self)
        return value

    def __set__(self, instance: Values, value: T) -> NoReturn:
        raise AttributeError(f"{self.name} cannot be set: a result does not change")

    @property
    def columns(self) -> list[str]:
        """Names of the columns of a table."""
        kind = next(iter(_parts(self.type)))
        row = get_args(kind)[0] if get_origin(kind) is Table else None
        return [] if row is None else [one.name for one in row._attributes()]

    def type_in_words(self) -> str:
        """Returns the type as it is written in Python."""
        if isinstance(self.type, ForwardRef):
            return "array"
        text = self.type.__name__ if isinstance(self.type, type) and not get_args(self.type) else str(self.type)
        return re.sub(r"\b[a-z_]+\.|\b_[a-z]+\.", "", text)

    def _unit_in_words(self) -> str:
        return {"": "", OF_QUANTITY: ", in the unit of the quantity"}.get(self.unit, f", {self.unit}")


def _parts(kind: Any) -> list[Any]:
    """Returns the parts of a union of types; the type itself if it is no union."""
    return list(get_args(kind)) if get_origin(kind) in (Union, types.UnionType) else [kind]


class Values:
    """Values that belong together, as attributes. A number that does not exist for a result is None."""

    #: Names of the attributes that `repr` shows; all attributes if there are none.
    _shown: tuple[str, ...] = ()

    def __init__(self, values: Mapping[str, Any], unit: str = "") -> None:
        self._values = values
        # Unit of the quantity to which the values belong.
        self._unit = unit
        self._made: dict[str, Any] = {}

    def __setattr__(self, name: str, value: object) -> None:
        if not name.startswith("_"):
            raise AttributeError(f"{name} cannot be set: a result does not change")
        super().__setattr__(name, value)

    @classmethod
    def _attributes(cls) -> list[Attribute[Any]]:
        """Returns the attributes in the order of their definition."""
        found: dict[str, Attribute[Any]] = {}
        for base in reversed(cls.__mro__):
            found.update((name, value) for name, value in vars(base).items() if isinstance(value, Attribute))
        return list(found.values())

    def _existing(self) -> list[Attribute[Any]]:
        """Returns the attributes that this object has."""
        return self._attributes()

    def _read(self, attribute: Attribute[Any]) -> Any:
        name = attribute.name
        if name not in self._made:
            unit = self._unit if attribute.unit == OF_QUANTITY else attribute.unit
            self._made[name] = _made(attribute.type, self._values.get(name), unit)
        return self._made[name]

    def to_dict(self) -> dict[str, Any]:
        """Returns the values as a dictionary of numbers, texts, lists and dictionaries."""
        return dict(self._values)

    def __getstate__(self) -> dict[str, Any]:
        return {**vars(self), "_made": {}}

    def _in_words(self, attribute: Attribute[Any]) -> str:
        unit = self._unit if attribute.unit == OF_QUANTITY else attribute.unit
        return in_words(self._read(attribute), unit)

    def __repr__(self) -> str:
        by_name = {one.name: one for one in self._existing()}
        shown = [by_name[name] for name in self._shown or by_name]
        words = ", ".join(f"{one.name} {self._in_words(one)}" for one in shown)
        return f"<{type(self).__name__}: {words}>"

    def _repr_html_(self) -> str:
        """Returns a table of the attributes for notebooks."""
        rows = []
        for one in self._existing():
            cells = (one.name, self._in_words(one), one.meaning)
            rows.append("<tr>" + "".join(f"<td style='text-align:left'>{html.escape(cell)}</td>" for cell in cells) + "</tr>")
        return f"<table><caption>{type(self).__name__}</caption>{''.join(rows)}</table>"


class Row(Values):
    """A row of a table. Its columns are attributes, and `row["adhesion.kappa"]` is the value of any column by its name."""

    def __getitem__(self, name: str) -> Cell:
        if name not in self._values:
            raise KeyError(self._missing(name))
        value: Cell = self._values[name]
        return value

    def _missing(self, name: str) -> str:
        return f"no column {_native.shown(name)!r}; columns: {', '.join(self._values)}"

    def _existing(self) -> list[Attribute[Any]]:
        return [one for one in self._attributes() if one.name in self._values]

    def _read(self, attribute: Attribute[Any]) -> Any:
        if attribute.name not in self._values:
            raise AttributeError(self._missing(attribute.name))
        return super()._read(attribute)


class Column(Attribute[T]):
    """An attribute of a row: the value in the column with its name. The name determines the unit and the meaning."""

    def __init__(self) -> None:
        # Both follow from the name.
        super().__init__("", "")

    def __set_name__(self, owner: type, name: str) -> None:
        super().__set_name__(owner, name)
        self.describe(*(COLUMNS.get(name) or _QUANTITIES[name]))


R = TypeVar("R", bound=Row)


class Table(Sequence[R], Generic[R]):
    """A table of a result. `table["force"]` is a column as an array, and `table[0].force` a value in a row.

    A number that does not exist is NaN in a column and None in a row.
    """

    def __init__(self, rows: Sequence[dict[str, Cell]], row: type[R], units: Mapping[str, str] | None = None) -> None:
        self._rows = rows
        self._row = row
        self._units = dict(units or {})

    @property
    def columns(self) -> list[str]:
        """Names of the columns."""
        return list(self._rows[0]) if self._rows else []

    @property
    def units(self) -> dict[str, str]:
        """Unit of each column, "1" for a number without a unit; texts have none."""
        return {name: unit for name in self.columns if (unit := self._units.get(name) or unit_of(name))}

    @overload
    def __getitem__(self, key: str) -> npt.NDArray[Any]: ...
    @overload
    def __getitem__(self, key: int) -> R: ...
    @overload
    def __getitem__(self, key: slice) -> Table[R]: ...
    def __getitem__(self, key: str | int | slice) -> npt.NDArray[Any] | R | Table[R]:
        if isinstance(key, slice):
            return Table(self._rows[key], self._row, self._units)
        if not isinstance(key, str):
            return self._row(self._rows[key])
        if key not in self.columns:
            raise KeyError(f"no column {_native.shown(key)!r}; columns: {', '.join(self.columns)}")
        return _column([row.get(key) for row in self._rows])

    def __iter__(self) -> Iterator[R]:
        return map(self._row, self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def to_pandas(self) -> pd.DataFrame:
        """Returns the table as a pandas DataFrame, whose `attrs["units"]` has the units of the columns."""
        import pandas as pd

        frame = pd.DataFrame({name: self[name] for name in self.columns})
        frame.attrs["units"] = self.units
        return frame

    def __repr__(self) -> str:
        names = (f"{name} ({self.units[name]})" if self.units.get(name, "1") != "1" else name for name in self.columns)
        return f"<Table: {len(self)} rows of {', '.join(names)}>"

    def _repr_html_(self) -> str:
        """Returns the first rows for notebooks."""
        heads = "".join(f"<th>{html.escape(name)} {html.escape(self.units.get(name, ''))}</th>" for name in self.columns)
        rows = []
        for row in self._rows[:MOST_ROWS]:
            cells = (f"{value:.6g}" if isinstance(value, float) else str(value) for value in row.values())
            rows.append("<tr>" + "".join(f"<td>{html.escape(cell)}</td>" for cell in cells) + "</tr>")
        return f"<table><caption>{len(self)} rows</caption><tr>{heads}</tr>{''.join(rows)}</table>"


def unit_of(name: str) -> str:
    """Returns the unit of the quantity with this name; an empty text if it has none."""
    if name in COLUMNS:
        return COLUMNS[name][0]
    return _QUANTITIES.get(name, ("", ""))[0]


#: Unit and meaning of each quantity that a study records.
_QUANTITIES = {name: (unit, meaning) for name, _, unit, meaning in _native.quantities()}


def _column(values: list[Cell]) -> npt.NDArray[Any]:
    import numpy as np

    if any(isinstance(value, str) for value in values):
        return np.array(["" if value is None else str(value) for value in values])
    if values and all(isinstance(value, bool) for value in values):
        return np.array(values, dtype=bool)
    if values and all(isinstance(value, int) for value in values):
        return np.array(values, dtype=np.int64)
    return np.array(values, dtype=np.float64)


def _made(kind: Any, value: Any, unit: str) -> Any:
    """Returns a value of JSON as the type `kind`, such as a number, a list or an object with attributes."""
    kind = _parts(kind)[0]
    if value is None or isinstance(kind, ForwardRef):
        return value
    if get_origin(kind) is Table:
        return Table(value, get_args(kind)[0])
    if isinstance(kind, type) and issubclass(kind, Values):
        if isinstance(value, list):
            value = dict(zip([one.name for one in kind._attributes()], value, strict=True))
        return kind(value, unit)
    if get_origin(kind) is list:
        return [_made(get_args(kind)[0], entry, unit) for entry in value]
    if get_origin(kind) is tuple:
        return tuple(value)
    if get_origin(kind) is dict:
        return {key: _made(get_args(kind)[1], entry, unit_of(key) or unit) for key, entry in value.items()}
    return kind(value) if kind in (float, int) else value


def in_words(value: Any, unit: str) -> str:
    """Returns a value in words for `repr` and notebooks."""
    if value is None:
        return "none"
    if isinstance(value, bool) or isinstance(value, str):
        return str(value)
    if isinstance(value, float):
        return _native.in_words(value, unit or "1")
    if isinstance(value, tuple):
        return " to ".join(in_words(one, unit) for one in value)
    if isinstance(value, Table):
        return f"{len(value)} rows"
    if isinstance(value, dict):
        if len(value) > 8:
            return f"{len(value)} entries"
        return ", ".join(f"{name} {in_words(one, unit)}" for name, one in value.items())
    if isinstance(value, list) and len(value) <= 3:
        return f"[{', '.join(in_words(one, unit) for one in value)}]"
    if isinstance(value, list):
        return f"{len(value)} values"
    if hasattr(value, "shape"):
        return f"{' × '.join(map(str, value.shape))} values"
    return repr(value) if isinstance(value, Values) else str(value)
