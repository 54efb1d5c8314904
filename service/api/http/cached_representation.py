"""What is the same for everybody who asks: made and packed once, and sent to those only who have another version."""

from __future__ import annotations

import gzip
import hashlib
from dataclasses import dataclass
from functools import cached_property

from fastapi import Request, Response

from service.api.http import etag

GZIP = "gzip"

WORTH_PACKING_BYTES = 2048
"""Less than that is a packet or two either way."""

_LEVEL = 6
"""The highest makes the description of the API a thirtieth smaller, and takes three times as long."""


def takes_gzip(request: Request) -> bool:
    """Whether the client takes answers in gzip."""
    return GZIP in request.headers.get("accept-encoding", "")


@dataclass(frozen=True)
class Representation:
    """The content of an answer."""

    content: bytes
    media_type: str

    @cached_property
    def version(self) -> str:
        """Sixteen hexadecimal digits of its SHA-256."""
        return hashlib.sha256(self.content).hexdigest()[:16]

    @cached_property
    def packed(self) -> bytes:
        """The same in gzip."""
        return gzip.compress(self.content, _LEVEL)

    def answer(self, request: Request, headers: dict[str, str]) -> Response:
        """The content under the entity tag of its version; 304 without it where the client has that one already."""
        tag = etag.tag(self.version)
        headers = {**headers, "ETag": tag}
        if etag.matches(request.headers.getlist("if-none-match"), tag):
            return Response(status_code=304, headers={**headers, "Vary": "Accept-Encoding"})
        if not takes_gzip(request) or len(self.content) < WORTH_PACKING_BYTES:
            return Response(self.content, headers=headers, media_type=self.media_type)
        headers |= {"Content-Encoding": GZIP, "Vary": "Accept-Encoding"}
        return Response(self.packed, headers=headers, media_type=self.media_type)
