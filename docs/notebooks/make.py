"""Makes the notebooks of this folder from the scripts of python/examples: a cell for each part between empty lines.

    python3 docs/notebooks/make.py
"""

import json
from pathlib import Path

HERE = Path(__file__).parent
EXAMPLES = HERE.parent.parent / "python" / "examples"
NAMES = ["force_curves", "measured_map"]


def cell(kind, number, text):
    lines = text.splitlines(keepends=True)
    found = {"cell_type": kind, "id": f"part-{number}", "metadata": {}, "source": lines}
    return {**found, "execution_count": None, "outputs": []} if kind == "code" else found


def parts_of(code):
    """The imports together, then each part between empty lines."""
    parts = code.strip().split("\n\n")
    imports = [part for part in parts if part.startswith(("import ", "from "))]
    return ["\n\n".join(imports), *parts[len(imports) :]]


def notebook(name, script):
    about, code = script.split('"""', 2)[1:]
    cells = [cell("markdown", 0, f"# {name.replace('_', ' ').capitalize()}\n\n{about}")]
    parts = parts_of(code)
    cells += [cell("code", number, part) for number, part in enumerate(parts, 1)]
    kernel = {"display_name": "Python 3", "language": "python", "name": "python3"}
    return {"cells": cells, "metadata": {"kernelspec": kernel}, "nbformat": 4, "nbformat_minor": 5}


for name in NAMES:
    text = json.dumps(notebook(name, (EXAMPLES / f"{name}.py").read_text()), indent=1, ensure_ascii=False)
    (HERE / f"{name}.ipynb").write_text(text + "\n")
