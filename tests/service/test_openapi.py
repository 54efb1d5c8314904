"""What the service promises is kept with the source: it does not change by the way."""

import json
from pathlib import Path

from service.app import api_document

KEPT = Path(__file__).parents[2] / "docs" / "openapi.json"


def parts(document):
    """The document in parts that a message can name."""
    named = {f"paths {path}": value for path, value in document["paths"].items()}
    for section, members in document["components"].items():
        named |= {f"components/{section}/{name}": value for name, value in members.items()}
    return {**named, "the rest": {key: document[key] for key in document if key not in ("paths", "components")}}


def test_the_document_is_the_one_that_is_kept():
    says, kept = parts(json.loads(api_document())), parts(json.loads(KEPT.read_text(encoding="utf-8")))
    changed = sorted(name for name in says.keys() | kept.keys() if says.get(name) != kept.get(name))
    assert not changed, (
        f"docs/openapi.json is not what the service says. If the change is meant, run `make openapi` and commit the "
        f"file with it. Different: {', '.join(changed)}"
    )


def test_the_document_is_written_the_same_way_each_time():
    assert KEPT.read_text(encoding="utf-8") == api_document()
