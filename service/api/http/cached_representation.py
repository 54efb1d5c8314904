"""Responses equal for all clients: built and compressed once, and sent only to clients with another version."""

from __future__ import annotations

import gzip
import hashlib
from dataclasses import dataclass
from functools import cached_property

from fastapi import Request, Response

from service.api.http import etag

GZIP = "gzip"

MIN_PACKED_BYTES = 2048
"""Minimum size for compression, bytes; smaller answers fill one or two packets in either case."""

_GZIP_LEVEL = 6
"""Compression level; the highest makes the API description 3 % smaller and takes three times as long."""


def is_gzip_accepted(request: Request) -> bool:
    """Return whether the client accepts answers in gzip."""
    return GZIP in request.headers.get("accept-encoding", "")


def pack(content: bytes) -> bytes:
    """Compress content with gzip. Equal content gives equal bytes."""
    return gzip.compress(content, _GZIP_LEVEL, mtime=0)


@dataclass(frozen=True)
class Representation:
    """Content of a response."""

    content: bytes
    media_type: str

    @classmethod
    def from_packed(cls, packed: bytes, media_type: str) -> Representation:
        """Create the representation of content that is compressed with gzip."""
        representation = cls(gzip.decompress(packed), media_type)
        # The cached property finds its value here and does not compress the content again.
        representation.__dict__["gzip_content"] = packed
        return representation

    @cached_property
    def version(self) -> str:
        """Sixteen hexadecimal digits of the content's SHA-256."""
        return hashlib.sha256(self.content).hexdigest()[:16]

    @cached_property
    def gzip_content(self) -> bytes:
        """The content compressed with gzip."""
        return pack(self.content)

    def respond(self, request: Request, headers: dict[str, str]) -> Response:
        """Return a response with the content and its entity tag, or 304 if the client has this version."""
        tag = etag.format_tag(self.version)
        headers = {**headers, "ETag": tag}
        if etag.is_current_tag(request.headers.getlist("if-none-match"), tag):
            # A 304 has the headers that the whole answer would have (RFC 9110, section 15.4.5).
            return Response(status_code=304, headers={**headers, "Vary": "Accept-Encoding"})
        if not is_gzip_accepted(request) or len(self.content) < MIN_PACKED_BYTES:
            return Response(self.content, headers=headers, media_type=self.media_type)
        headers |= {"Content-Encoding": GZIP, "Vary": "Accept-Encoding"}
        return Response(self.gzip_content, headers=headers, media_type=self.media_type)
