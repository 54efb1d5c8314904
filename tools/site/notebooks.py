"""The notebooks of ``docs/notebooks/``, run anew, as pages of the site."""

from __future__ import annotations

import shutil
from pathlib import Path
from typing import Any

FOLDER = "notebooks"
CELL_TIMEOUT_S = 120


def executed(path: Path) -> Any:
    """A notebook with the outputs of its run.

    Raises
    ------
    nbclient.exceptions.CellExecutionError
        Where a cell raises.
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
    """A notebook that has run, as Markdown: its texts, its code and what that put out."""
    parts = []
    for cell in notebook.cells:
        if cell.cell_type == "markdown":
            parts.append(cell.source)
        elif cell.cell_type == "code":
            parts.append(f"```python\n{cell.source}\n```")
            parts += [shown for output in _joined(cell.outputs) if (shown := _shown(output))]
    return "\n\n".join(parts) + "\n"


def _joined(outputs: list[Any]) -> list[Any]:
    """The outputs of a cell, of which what was printed comes in pieces."""
    joined: list[Any] = []
    for output in outputs:
        if joined and output.output_type == joined[-1].output_type == "stream":
            joined[-1].text += output.text
        else:
            joined.append(output)
    return joined


def _shown(output: Any) -> str:
    """An output: HTML or a drawing as such, everything else as text."""
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
    """Run all notebooks of a folder and write their pages below another; returns titles and paths, for the nav."""
    pages = []
    (folder / FOLDER).mkdir(parents=True, exist_ok=True)
    for path in sorted(source.glob("*.ipynb")):
        page = f"{FOLDER}/{path.stem}.md"
        link = f"[Take this notebook with you]({path.name}).\n"
        (folder / page).write_text(f"{as_page(executed(path))}\n{link}", encoding="utf-8")
        shutil.copyfile(path, folder / FOLDER / path.name)
        pages.append(("", page))
    return pages
