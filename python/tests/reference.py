"""Writes docs/python.md, the reference of the package, from the descriptions in it: `python python/tests/reference.py docs/python.md`."""

import inspect
import re
import sys
from functools import cached_property
from pathlib import Path

import asperity
from asperity._attributes import OF_QUANTITY, Row, Table, Values
from asperity._functions import Reading

HEAD = """# Python reference

[The page of the package](../python/README.md) is a tour; this page lists all functions and results. `help(asperity.load)` shows
the same texts. In the examples `asp` is the package and `np` is NumPy. A quantity is a number in SI units, or a text with a unit
such as `"50 mJ/m²"`.

All functions of scenes take `modulus` (E\\*, Pa), `work` (γ, J/m²), `closing_work` (γ₁, J/m²) and `stages`, as `load` does, and each
[field of a scene](scene-file.md) with two underscores for each point of its path: `adhesion__kappa=6`. `profiles` is the number of
random profiles, and `jobs` the number of threads, by default one for each core. No result depends on `jobs` or on an `executor`.
"""

FUNCTIONS = {
    "Forms and roughness": [
        "sphere",
        "cone",
        "rounded_cone",
        "punch",
        "power",
        "wavy_sphere",
        "spheres",
        "revolve",
        "table",
        "self_affine",
        "spectrum",
        "measured",
    ],
    "Bodies and scenes": ["profile", "scene", "presets"],
    "Computations": ["load", "run", "ensemble", "find", "preloads", "reversals", "study", "reference", "criteria", "press"],
    "Measured data": ["surface", "fit"],
}
EXECUTORS = """
`ensemble`, `study` and `fit` of several curves take an `executor` of `concurrent.futures`. It gets parts of the profiles or of the
curves. Its processes need this package:

```python
import concurrent.futures
import asperity as asp

if __name__ == "__main__":
    with concurrent.futures.ProcessPoolExecutor() as executor:
        asp.ensemble("pressure-sensitive", profiles=100, executor=executor)
```

The executors `joblib.externals.loky.get_reusable_executor()` and `dask.distributed.Client().get_executor()` are used in the same way.
"""
ERRORS = """
| exception | attributes | cause |
| --- | --- | --- |
| `FieldError`, a `ValueError` | `field`, `value`, `allowed` | a value that is not allowed, or of a wrong type |
| `LoadingError`, a `ValueError` | `stage`, `smallest_force` | a stage whose target the contact cannot reach |
| `OSError` | | a file that cannot be read or written |
| `MemoryError` | | too little memory |

A contact that does not meet a premise of the model has a warning of the category `PremiseWarning` and an entry in `warnings`.
"""
SCENE = """### Scene

A checked scene: material, form, roughness, adhesion and loading of a contact, and how they are computed. `asp.scene` makes it.

| attribute | type | meaning |
| --- | --- | --- |
| `text` | str | text of the scene, as in a [scene file](scene-file.md) |
"""
#: Results that other results contain.
PARTS_LAST = ("Values", "Result", "Row")


def anchor(name: str) -> str:
    return name.lower().replace(" ", "-")


def in_markdown(text: str) -> str:
    """Escapes the characters of a table of Markdown."""
    return text.replace("|", "\\|").replace("*", "\\*").replace("<", "&lt;")


def signature(function: object, name: str) -> str:
    """Returns the signature in one line, or with one parameter on each line."""
    parameters = inspect.signature(function).parameters.values()
    words, kind = [], None
    for parameter in parameters:
        if parameter.name == "self":
            continue
        if parameter.kind is parameter.KEYWORD_ONLY and kind not in (parameter.KEYWORD_ONLY, parameter.VAR_POSITIONAL):
            words.append("*")
        kind = parameter.kind
        default = "" if parameter.default is parameter.empty else f"={parameter.default!r}"
        stars = {parameter.VAR_KEYWORD: "**", parameter.VAR_POSITIONAL: "*"}.get(parameter.kind, "")
        words.append(f"{stars}{parameter.name}{default}")
    return f"{name}({', '.join(words)})"


def wrapped(call: str, width: int = 110) -> str:
    """Returns a call in lines of at most `width` characters."""
    lines = [""]
    for word in re.split(r"(?<=,) ", call):
        if len(lines[-1]) + len(word) > width:
            lines.append("    ")
        lines[-1] += word + " "
    return "\n".join(line.rstrip() for line in lines)


def documented(function: object) -> tuple[str, str]:
    """Returns the text and the example of a documented function."""
    text, _, example = (inspect.getdoc(function) or "").partition(">>> ")
    return text.strip().replace("E*", "E\\*"), f">>> {example}".strip() if example else ""


def functions() -> str:
    parts = []
    for group, names in FUNCTIONS.items():
        parts.append(f"## {group}\n")
        for name in names:
            function = getattr(asperity, name)
            text, example = documented(function)
            returned = str(inspect.signature(function).return_annotation)
            parts.append(f"### asp.{name}\n\n```python\n{wrapped(signature(function, name))} -> {returned}\n```\n\n{text}\n")
            if name == "surface":
                parts.append(reading())
            parts.append(f"```pycon\n{example}\n\n```\n")
    return "\n".join(parts)


def reading() -> str:
    """Returns the options of reading a measured surface, from the comments before them."""
    lines = ["| option | meaning |", "| --- | --- |"]
    source = inspect.getsource(Reading)
    for comment, name in re.findall(r"#: (.*)\n    (\w+): ", source):
        lines.append(f"| `{name}` | {in_markdown(comment.rstrip('.'))} |")
    assert len(lines) == 2 + len(Reading.__annotations__)
    return "\n".join(lines) + "\n"


def methods(one: type) -> list[str]:
    """Returns a row for each method and property of a class itself, with the first paragraph of its documentation."""
    rows = []
    for name, value in vars(one).items():
        if name.startswith("_") or not (
            inspect.isfunction(value) or isinstance(value, (property, cached_property, staticmethod))
        ):
            continue
        text = (inspect.getdoc(value) or "").split("\n\n")[0].replace("\n", " ").rstrip(".")
        shown = signature(value, name) if inspect.isfunction(value) else name
        rows.append(f"| `{shown}` | | {in_markdown(text)} |")
    return rows


def described(one: type[Values]) -> str:
    """Returns the description of a class of results."""
    text = (inspect.getdoc(one) or "").split("\n\n")[0].replace("\n", " ").replace("E*", "E\\*")
    rows = ["| attribute | type, unit | meaning |", "| --- | --- | --- |"]
    inherited = {base for base in one.__mro__[1:] if base.__name__ in ("ProfileStatistics", "MeasuredFace")}
    own = [attribute for attribute in one._attributes() if attribute.name in vars(one) or inherited]
    if issubclass(one, asperity.Result) and one is not asperity.Result:
        own += [attribute for attribute in asperity.Result._attributes() if attribute.name not in {known.name for known in own}]
    for attribute in own:
        unit = {OF_QUANTITY: ", unit of the quantity", "": ""}.get(attribute.unit, f", {attribute.unit}")
        kind = re.sub(r"\b([A-Z]\w+)\b", linked, in_markdown(attribute.type_in_words()))
        meaning = in_markdown(attribute.meaning)
        rows.append(f"| `{attribute.name}` | {kind}{unit} | {meaning} |")
    rows += methods(one)
    for base in inherited:
        rows += methods(base)
    return f"### {one.__name__}\n\n{text}\n\n" + "\n".join(rows) + "\n"


def linked(match: re.Match[str]) -> str:
    name = match[1]
    return f"[{name}](#{anchor(name)})" if name in asperity.__all__ else name


def classes() -> list[type[Values]]:
    found = [getattr(asperity, name) for name in asperity.__all__]
    return [one for one in found if inspect.isclass(one) and issubclass(one, Values) and one.__name__ not in PARTS_LAST]


def other(one: type, text: str = "") -> str:
    """Returns the description of a class that is no result."""
    text = (inspect.getdoc(one) or "").replace("E*", "E\\*")
    rows = ["| attribute | | meaning |", "| --- | --- | --- |", *methods(one)]
    return f"### {one.__name__}\n\n{text}\n\n" + "\n".join(rows) + "\n"


def common() -> str:
    rows = ["| method | | meaning |", "| --- | --- | --- |", *methods(Values), *methods(asperity.Result)]
    return "\n".join(rows) + "\n"


def page() -> str:
    results = [one for one in classes() if issubclass(one, (asperity.Result, asperity.Loop, asperity.Pressed))]
    rows = [one for one in classes() if issubclass(one, Row)]
    parts = [one for one in classes() if one not in [*results, *rows]]
    text = [
        HEAD,
        functions(),
        "## Executors",
        EXECUTORS,
        "## Errors and warnings",
        ERRORS,
        "## Results",
        """
All numbers are in SI units; the unit 1 is that of a number without a unit. A number that does not exist for a result is None. All
results can be copied and pickled, and a notebook shows them as a table or a figure. These methods are common to all results of a
computation:
""",
        common(),
        *map(described, results),
        "## Parts of results\n",
        *map(described, parts),
        other(Table),
        "## Rows of tables\n",
        f"{inspect.getdoc(Row)}\n",
        *map(described, rows),
        "## Profiles and scenes\n",
        other(asperity.Profile),
        SCENE,
    ]
    return "\n".join(part.strip("\n") + "\n" for part in text)


if __name__ == "__main__":
    Path(sys.argv[1]).write_text(page(), encoding="utf-8")
