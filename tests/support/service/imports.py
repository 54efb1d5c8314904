"""Code that several tests share: imports."""

import io

from PIL import Image, ImageDraw


def read(client, content, media_type="application/octet-stream", **query):
    return client.post("/v1/imports", content=content, headers={"Content-Type": media_type}, params=query)


def found(client, content, media_type="application/octet-stream", **query):
    answer = read(client, content, media_type, **query)
    assert answer.status_code == 200, answer.text
    return answer.json()


# Tables.

TABLES = {
    "named": "x,y\n0,1.5\n2,-3\n",
    "not named": "0,1.5\n2,-3\n",
    "Windows": "\ufeffx,y\r\n0,1.5\r\n2,-3\r\n",
    "semicolons and decimal commas": "x;y\n0;1,5\n2,0;-3\n",
    "tabs": "x\ty\n0\t1.5\n2\t-3\n",
    "blanks": "0   1.5\n 2 -3\n",
    "quoted": '"x","y"\n"0","1.5"\n"2","-3"\n',
    "remarked": "# a path\nx,y  # in mm\n0,1.5\n2,-3e0\n2,-3\n",
    "columns in another order": "t,y,x\n7,1.5,0\n8,-3,2\n",
}


# Pictures.


def picture(size, draw, finer=8, mode="L", ground=255, colours=None, **options):
    """A PNG picture, with grey rims where it was drawn finer; with a palette of so many colours."""
    image = Image.new(mode, (size * finer, size * finer), ground)
    draw(ImageDraw.Draw(image), finer)
    if finer > 1:
        image = image.resize((size, size), Image.Resampling.BOX)
    if colours is not None:
        image = image.convert("RGB").quantize(colours)
    file = io.BytesIO()
    image.save(file, "PNG", **options)
    return file.getvalue()


def blob(fill=0):
    """An ellipse about (60, 80) of a picture 200 high, with y down, half as high as wide."""

    def draw(pen, k):
        pen.ellipse([20 * k, 60 * k, 100 * k - 1, 100 * k - 1], fill=fill)

    return draw
