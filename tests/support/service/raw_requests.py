"""Requests as bytes: a whole one, and ones that break off. No module here may have the name of a package: a script of
this folder would import it in its place."""

import json

from tests.support.service.running import PROBLEM
from tests.support.service.scripted_server import INSTANT

BODY = json.dumps({"problem": {**PROBLEM, "seed": INSTANT}}).encode()
HEAD = b"POST /v1/jobs HTTP/1.1\r\nHost: localhost\r\nContent-Type: application/json\r\n"
WHOLE = HEAD + b"Content-Length: %d\r\n\r\n" % len(BODY) + BODY
HALVES = {
    "nothing": b"",
    "half a line": b"GET /heal",
    "half a head": HEAD + b"X-Slow",
    "no body": HEAD + b"Content-Length: 500\r\n\r\n",
    "half a body": WHOLE[:-10],
    "a chunk and no end": HEAD + b"Transfer-Encoding: chunked\r\n\r\n5\r\nhello\r\n",
    "a request and a half": b"GET /healthz HTTP/1.1\r\nHost: localhost\r\n\r\n" + HEAD,
    "a refused head and no body": HEAD.replace(b"json", b"xml") + b"Content-Length: 500\r\n\r\n",
}
