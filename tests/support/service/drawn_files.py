"""Small drawings for tests, and what the service reads in them."""

import io
import time

import ezdxf

SVG = "image/svg+xml"
DXF = "image/vnd.dxf"

PLAIN = "0\nSECTION\n2\nENTITIES\n0\nCIRCLE\n8\n0\n10\n3.0\n20\n4.0\n40\n5.0\n0\nENDSEC\n0\nEOF\n"


def read(client, content, media_type="application/octet-stream", **query):
    headers = {"Content-Type": media_type} if media_type else {}
    return client.post("/v1/outlines", content=content, headers=headers, params=query)


def page(inside, **attributes):
    told = "".join(f' {name}="{value}"' for name, value in attributes.items())
    namespaces = (
        'xmlns="http://www.w3.org/2000/svg" xmlns:xlink="http://www.w3.org/1999/xlink" '
        'xmlns:inkscape="http://www.inkscape.org/namespaces/inkscape"'
    )
    return f"<svg {namespaces}{told}>{inside}</svg>".encode()


def dxf(draw, **options):
    document = ezdxf.new(**options)
    draw(document.modelspace())
    text = io.StringIO()
    document.write(text)
    return text.getvalue().encode()


def found(client, content, **query):
    answer = read(client, content, **query)
    assert answer.status_code == 200, answer.text
    return answer.json()


def refused(client, content, status, media_type="application/octet-stream", **query):
    began = time.monotonic()
    answer = read(client, content, media_type, **query)
    assert answer.status_code == status, answer.text
    assert answer.headers["content-type"] == "application/problem+json"
    assert time.monotonic() - began < 20.0
    return answer.json()
