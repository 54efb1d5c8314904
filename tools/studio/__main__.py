"""Update the files of the studio that contain answers of the service: ``python -m tools.studio URL``.

URL is the address of a running service.
"""

from __future__ import annotations

import argparse
import json
from pathlib import Path

import httpx

from tools.studio.opening import opening
from tools.studio.sprite import renewed

FOLDER = Path(__file__).parents[2] / "service" / "studio"


def main() -> None:
    """Query the service and write the files of the page that show its answers."""
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("url", help="where a service without keys runs, as http://127.0.0.1:8000")
    parser.add_argument("--only", choices=("opening", "gallery"), help="one of the files; both where it is not said")
    parser.add_argument("--patience", type=float, default=600.0, help="seconds that an example has to be solved in")
    asked = parser.parse_args()
    with httpx.Client(base_url=asked.url, timeout=120.0) as client:
        if asked.only != "gallery":
            text = json.dumps(opening(client), ensure_ascii=False, separators=(",", ":"))
            (FOLDER / "opening.json").write_text(f"{text}\n", encoding="utf-8")
        if asked.only != "opening":
            slow = renewed(FOLDER / "gallery.svg", client, asked.url, asked.patience)
            if slow:
                parser.error(f"not solved in time: {', '.join(slow)}; try again with more --patience")


if __name__ == "__main__":
    main()
