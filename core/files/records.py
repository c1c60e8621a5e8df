# ruff: noqa: D102
"""Records: JSON objects declared once, as dataclasses whose annotations say what each field may hold.

A field's annotation is `bool`, a `StrEnum`, a `Record`, or `Annotated[type, kind]` with one of `kinds`; the
docstring below it is its description in the JSON Schema, in the help of the command line and in Blender. A
field that may be missing has a default; null counts as missing. `Record.from_json` checks an object and makes
the record, `to_json` is its inverse.
"""

import ast
import dataclasses
import inspect
import sys
import types
from collections.abc import Callable, Mapping, Sequence
from dataclasses import dataclass, replace
from difflib import get_close_matches
from enum import StrEnum
from functools import cache
from itertools import pairwise
from pathlib import Path
from typing import (
    Annotated,
    Any,
    ClassVar,
    Generic,
    NamedTuple,
    Self,
    TypeVar,
    Union,
    get_args,
    get_origin,
    get_type_hints,
)

from ..errors import InputError, shown
from .fields import Fields, child_location, listed
from .json_file import json_files, read_json
from .kinds import ByName, Choice, Flag, Items, Kind, Nullable, Whole, read_field, refuse

MISSING = dataclasses.MISSING


class Record:
    """Base of the dataclasses that are records."""

    STRICT: ClassVar[bool] = False
    """Whether unknown fields are refused: what they mean would be lost."""
    SCHEMA: ClassVar[str] = ""
    """The field `schema` of a file; empty where it has none."""
    VERSION: ClassVar[int] = 0
    """Newest `schema_version` that is read; 0 for objects that have none."""
    SPARSE: ClassVar[bool] = True
    """Whether fields that hold nothing are not written."""
    TITLE: ClassVar[str] = ""
    ORDER: ClassVar[tuple[str, ...]] = ()
    """The fields in the order of files; () for that of the class."""
    REQUIRED: ClassVar[tuple[str, ...]] = ()
    """Fields that files must have although they have a default."""

    def mistake(self) -> str:
        """What is wrong with the fields together, as a clause; empty for nothing."""
        return ""

    def to_json(self) -> dict[str, Any]:
        """The record as a JSON object."""
        value: dict[str, Any] = {"schema": self.SCHEMA} if self.SCHEMA else {}
        value |= {"schema_version": self.VERSION} if self.VERSION else {}
        for name, one in declared(type(self)).items():
            item = one.kind.write(getattr(self, name))
            if one.required or not self.SPARSE or item not in (None, "", [], {}):
                value[name] = item
        return value

    @classmethod
    def from_json(cls, value: Any, where: str) -> Self:
        """Read a record from JSON that is not trusted; `where` begins sentences."""
        return read_record(cls, Fields.of(value, where))


R = TypeVar("R", bound=Record)


@dataclass(frozen=True)
class Object(Kind):
    """A record in a field."""

    record: type[Record]
    makes: type[Record] | None = None
    """The class that is made of the fields; by default `record`."""
    strict: bool = False
    """Whether unknown fields are refused although they are not in other objects of the class."""

    @property
    def valid(self) -> str:  # type: ignore[override]
        required = [name for name, one in declared(self.record).items() if one.required]
        return f"an object with {listed(required, 5)}" if required else "an object"

    def read(self, value: Any, where: str, name: str) -> Any:
        if not isinstance(value, Mapping):
            refuse(where, name, value, self.valid)
        return read_record(self.record, Fields(value, child_location(where, name)), self.makes, self.strict)

    def write(self, value: Record) -> dict[str, Any]:
        return value.to_json()


class Declared(NamedTuple):
    """A declared field of a record."""

    kind: Kind
    required: bool
    default: Any


def declared(record: Any) -> Mapping[str, Declared]:
    """The fields of a record, a class, by name."""
    return _declared(record)  # the types of a cache know no hash of classes of records


@cache
def _declared(record: Any) -> Mapping[str, Declared]:
    hints = get_type_hints(record, include_extras=True)
    found: dict[str, Declared] = {}
    known = {field.name: field for field in dataclasses.fields(record)}
    for field in [known[name] for name in record.ORDER or known]:
        kind = kind_of(hints[field.name])
        default = field.default if field.default_factory is MISSING else field.default_factory()
        required = field.name in record.REQUIRED or (default is MISSING and not isinstance(kind, Nullable))
        found[field.name] = Declared(kind, required, None if default is MISSING else default)
    return found


def kind_of(hint: Any) -> Kind:
    """The kind of an annotation."""
    if get_origin(hint) is Annotated:
        base, *marks = get_args(hint)
        (kind,) = (mark for mark in marks if isinstance(mark, Kind))
        if isinstance(kind, Items | ByName) and type(kind.item) is Kind:
            items = get_args(base)
            return replace(kind, item=kind_of(items[1] if isinstance(kind, ByName) else items[0]))
        return kind
    if get_origin(hint) in (Union, types.UnionType):
        (item,) = (one for one in get_args(hint) if one is not types.NoneType)
        return Nullable(kind_of(item))
    if issubclass(hint, StrEnum):
        return Choice(tuple(map(str, hint)), hint)
    return Flag() if hint is bool else Object(hint)


def descriptions(one: type[Any]) -> dict[str, str]:
    """The docstrings of a record's fields or an enumeration's members, those of bases too, each a line."""
    found: dict[str, str] = {}
    for base in reversed(one.__mro__):
        if base.__module__.startswith(__package__.partition(".core")[0]):
            found |= _documented(sys.modules[base.__module__]).get(base.__qualname__, {})
    return found


@cache
def _documented(module: types.ModuleType) -> dict[str, dict[str, str]]:
    """The docstrings below the attributes of each class of a module."""
    classes = [one for one in ast.parse(inspect.getsource(module)).body if isinstance(one, ast.ClassDef)]
    found: dict[str, dict[str, str]] = {one.name: {} for one in classes}
    for one in classes:
        for field, after in pairwise(one.body):
            if isinstance(field, ast.AnnAssign | ast.Assign) and isinstance(after, ast.Expr):
                target = field.target if isinstance(field, ast.AnnAssign) else field.targets[0]
                assert isinstance(after.value, ast.Constant)
                found[one.name][ast.unparse(target)] = " ".join(str(after.value.value).split())
    return found


def read_record(record: type[R], fields: Fields, makes: type[Any] | None = None, strict: bool = False) -> R:
    """Read a record from the fields of an object; `makes` and `strict` are those of `Object`."""
    known = declared(record)
    schema = fields.values.get("schema")
    if record.SCHEMA and schema != record.SCHEMA:
        wanted = f'a {record.TITLE} has "{record.SCHEMA}" there'
        raise InputError(f"{fields.where}: schema is {shown(schema)}; {wanted}")
    if record.VERSION:
        check_version(fields, record.VERSION)
    if strict or record.STRICT:
        header = ["schema"] * bool(record.SCHEMA) + ["schema_version"] * bool(record.VERSION)
        fields.refuse_others([*header, *known])
    values = {}
    for name, one in known.items():
        if one.required:
            fields.required(name, one.kind.valid)
        values[name] = read_field(fields, name, one.kind, one.default)
    try:
        made: R = (makes or record)(**values)
    except InputError as error:
        raise InputError(f"{fields.where}: {error}") from error
    mistake = record.mistake(made)
    if mistake:
        raise InputError(f"{fields.where}: {mistake}")
    return made


def check_version(fields: Fields, newest: int) -> None:
    """Refuse the `schema_version` of a newer Keymark; `newest` is the highest that is read."""
    kind = Whole(1, 10**6)
    fields.required("schema_version", kind.valid)
    version = read_field(fields, "schema_version", kind, None)
    if version > newest:
        source = fields.source_of("schema_version")
        raise InputError(
            f"{source}: schema_version is {version}, made by a newer Keymark; this one reads up to {newest}"
        )


E = TypeVar("E", bound="Registered[Any]")


@dataclass(frozen=True)
class Registered(Generic[R]):
    """A file in a registered folder."""

    path: Path
    content: R | None  # what it holds; None if the file is invalid
    problem: str = ""  # the sentence of the error that makes it invalid

    @property
    def title(self) -> str:
        """The title of what it holds; an invalid file's name."""
        return self.path.name if self.content is None else str(getattr(self.content, "title"))  # noqa: B009

    @property
    def valid(self) -> R:
        """What the file holds; raises its `InputError` where it is invalid."""
        if self.content is None:
            raise InputError(self.problem)
        return self.content


def registered_files(
    folders: Sequence[Path],
    record: type[R],
    largest_bytes: int,
    key: Callable[[R], str],
    version: Callable[[R], int] = lambda _content: 0,
) -> tuple[Registered[R], ...]:
    """All files of a format in some folders, in order of title; missing folders count as empty.

    Of several with one key only the one in the earliest folder is registered, and within a folder the one of
    the highest version, else the first by file name; the others are available by path only.
    """
    found: dict[str, Registered[R]] = {}
    broken: list[Registered[R]] = []
    for folder in folders:
        here: dict[str, Registered[R]] = {}
        for path in json_files(folder):
            try:
                value = read_json(path, largest_bytes)
                schema = value.get("schema")
                if isinstance(schema, str) and schema.startswith("keymark-") and schema != record.SCHEMA:
                    continue  # another of Keymark's formats, which may lie in the same folder
                entry = Registered(path, record.from_json(value, str(path)))
            except InputError as error:
                broken.append(Registered(path, None, str(error)))
                continue
            name = key(entry.valid)
            if name not in here or version(entry.valid) > version(here[name].valid):
                here[name] = entry
        found = here | found
    return tuple(sorted([*found.values(), *broken], key=lambda entry: (entry.title.casefold(), entry.path)))


def find_registered(
    text: str,
    entries: Sequence[E],
    names: Callable[[E], Sequence[str]],
    fold: Callable[[str], str],
    what: str,
) -> E:
    """The file that has a name, as far as people can tell names apart, which `fold` makes equal.

    Valid ones come first, then those with an earlier of their names: a damaged file may have any name, and a
    stranger's file any title. Where there is none, the error says which there are.
    """
    wanted = fold(text)
    ranks = [(entry, [fold(name) for name in names(entry)]) for entry in entries]
    named = [(entry.content is None, known.index(wanted), entry) for entry, known in ranks if wanted in known]
    if named:
        return min(named, key=lambda each: each[:2])[2]
    known = [names(entry)[0] for entry in entries if entry.content is not None]
    close = get_close_matches(text[:100], known, n=1, cutoff=0.6)
    hint = f" (is {shown(close[0])} meant?)" if close else ""
    raise InputError(
        f"there is no {what} {shown(text)}{hint}; known are {listed(known) or 'none'}, "
        "and the path of a file ends in .json"
    )
