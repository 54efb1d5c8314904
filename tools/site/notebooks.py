"""Pages of the site from the notebooks in ``docs/notebooks/``, which are executed at every build."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

FOLDER = "notebooks"
CELL_TIMEOUT_S = 120


def executed(path: Path) -> Any:
    """Execute a notebook and return it with its outputs.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        If a cell raises an exception.
    """
    import nbformat
    from nbclient import NotebookClient
    from traitlets.config import Config

    notebook = nbformat.read(path, as_version=4)
    nobody_else_listens = Config(KernelManager={"transport": "ipc"})
    client = NotebookClient(notebook, timeout=CELL_TIMEOUT_S, kernel_name="python3", config=nobody_else_listens)
    client.execute(cwd=str(path.parents[2]))
    return notebook


def as_page(notebook: Any) -> str:
    """Convert an executed notebook to Markdown: its text, its code and the outputs."""
    parts = []
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            parts.append(cell.source)
        elif cell.cell_type == "code":
            parts.append(f"```python\n{cell.source}\n```")
            parts += [shown for output in _joined(cell.outputs) if (shown := _shown(output))]
    return "\n\n".join(parts) + "\n"


def _joined(outputs: list[Any]) -> list[Any]:
    """Return the outputs of a cell with consecutive pieces of printed text joined."""
    joined: list[Any] = []
    for output in outputs:
        if joined and output.output_type == joined[-1].output_type == "stream":
            joined[-1].text += output.text
        else:
            joined.append(output)
    return joined


def _shown(output: Any) -> str:
    """Return an output as HTML or as a drawing if it has such a form, otherwise as text."""
    if output.output_type == "stream":
        return _text(output.text)
    data = output.get("data", {})
    for form in ("text/html", "image/svg+xml"):
        if form in data:
            lines = [line for line in data[form].splitlines() if line.strip()]
            return '<div class="output">' + "\n".join(lines) + "</div>"
    return _text(data.get("text/plain", ""))


def _text(text: str) -> str:
    return f"```text\n{text.rstrip()}\n```" if text.strip() else ""


def written(source: Path, folder: Path) -> list[tuple[str, str]]:
    """Execute all notebooks of a folder and write their pages below another.

    Return the titles and paths of the pages for the navigation.
    """
    pages = []
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    for path in sorted(source.glob("*.ipynb")):
        page = f"{FOLDER}/{path.stem}.md"
        link = f"[Take this notebook with you]({path.name}).\n"
        (folder / page).write_text(f"{as_page(executed(path))}\n{link}", encoding="utf-8")
        shutil.copyfile(path, folder / FOLDER / path.name)
        pages.append(("", page))
    return pages
