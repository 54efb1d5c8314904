"""Code that several tests share: studio."""

import json

LINKAGES = {
    "motion", "path", "function", "quick_return", "straight_line", "steering", "dwell", "parallel_motion",
}  # fmt: skip

# Everything is chosen, so that there is one design and nothing to search.
PLAIN = {
    "kind": "motion",
    "positions": [{"x": 0.0, "y": 0.0, "angle": 0.0}, {"x": 10.0, "y": 5.0, "angle": 30.0}],
    "input_side": {"fixed_pivot": [0.0, -20.0], "rotations": [60.0]},
    "output_side": {"fixed_pivot": [20.0, -20.0], "rotations": [50.0]},
}


def stated(page):
    return json.loads(page.input_value("#json-text"))


def state(page, problem):
    page.locator("#json").evaluate("details => details.open = true")
    page.fill("#json-text", json.dumps(problem))


def unfold(page):
    """Show the fields that nobody has stated."""
    page.locator("#fields details.more").evaluate_all("all => all.forEach(one => { one.open = true; })")


def written(page):
    """All words of an answer, whichever tab is shown."""
    return page.evaluate(
        "['#answers', '#stage', '#design'].map(at => document.querySelector(at).textContent).join(' ')"
    )


def solved(studio, problem, shown="#scrub"):
    """Solve a problem, and when this is shown put the motion of its first design to its beginning."""
    state(studio.page, problem)
    studio.solve()
    studio.page.wait_for_selector(shown)
    studio.page.focus("#scrub")
    studio.page.keyboard.press("Home")


def drag(page, selector, by):
    page.locator(selector).scroll_into_view_if_needed()
    box = page.locator(selector).bounding_box()
    x, y = box["x"] + box["width"] / 2, box["y"] + box["height"] / 2
    page.mouse.move(x, y)
    page.mouse.down()
    page.mouse.move(x + by[0] / 2, y + by[1] / 2)
    page.mouse.move(x + by[0], y + by[1])
    page.mouse.up()


def drawn(page):
    return page.locator(".drawing img").evaluate_all("images => images.some((one) => one.naturalWidth > 0)")
