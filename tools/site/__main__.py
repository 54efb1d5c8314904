"""Build the documentation site: ``python -m tools.site`` writes ``var/site``."""

from __future__ import annotations

import json
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

from service.server.app import build_api_document
from tools.site import decisions, gallery, http_reference, notebooks, pages, python_reference

ROOT = Path(__file__).parents[2]


def main(out: Path) -> int:
    """Gather the pages below a folder and have mkdocs build the site from them; any warning is a failure."""
    folder = out / "pages"
    shutil.rmtree(folder, ignore_errors=True)
    pages.gathered(ROOT, folder)
    # The gallery is solved in processes of its own, which take longer than everything else.
    with ThreadPoolExecutor(1) as background:
        machines = background.submit(gallery.written, ROOT / "docs" / "gallery", folder)
        folders = {
            "decisions": decisions.written(ROOT / "docs" / "decisions", folder),
            "reference/http": http_reference.written(json.loads(build_api_document()), folder),
            "reference/python": python_reference.written(ROOT, folder),
            "notebooks": notebooks.written(ROOT / "docs" / "notebooks", folder),
            "gallery": machines.result(),
        }
    template = Path(__file__).with_name("mkdocs.yml").read_text("utf-8")
    settings = out / "mkdocs.yml"
    settings.write_text(pages.settings(template, folders), encoding="utf-8")
    command = [sys.executable, "-m", "mkdocs", "build", "--strict", "--quiet", "--clean", "-f", str(settings)]
    quiet = {**os.environ, "NO_MKDOCS_2_WARNING": "1"}
    made = subprocess.run(command, cwd=ROOT, env=quiet, check=False).returncode
    if not made:
        print(f"the site: {out / 'site' / 'index.html'}")
    return made


if __name__ == "__main__":
    sys.exit(main(Path(sys.argv[1] if len(sys.argv) > 1 else "var").resolve()))
