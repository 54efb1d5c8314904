"""Code that several tests share: layout."""

WATCH = """
window.outside = [];
window.seen = new Set();
const look = () => {
  if (window.watching) {
    const parts = {stage: "#boards", player: ".board:not(#other) .player", progress: "progress", cancel: "#cancel"};
    for (const [name, selector] of Object.entries(parts)) {
      const box = document.querySelector(selector)?.getBoundingClientRect();
      if (!box?.width || !box.height) continue;
      seen.add(name);
      const place = document.querySelector(selector);
      const middle = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
      if (!place.contains(middle) && !middle?.contains(place)) outside.push(`${name} is covered`);
      if (box.left < -0.5 || box.top < -0.5 || box.right > innerWidth + 0.5 || box.bottom > innerHeight + 0.5) {
        outside.push(`${name}: ${Math.round(box.left)} ${Math.round(box.top)} `
          + `${Math.round(box.right)} ${Math.round(box.bottom)}`);
      }
    }
  }
  requestAnimationFrame(look);
};
requestAnimationFrame(look);
"""

COVERED = """selector => {
  const place = document.querySelector(selector);
  const box = place.getBoundingClientRect();
  const middle = document.elementFromPoint(box.left + box.width / 2, box.top + box.height / 2);
  return !place.contains(middle) && !middle?.contains(place);
}"""


def inside(page, selector):
    """Whether a part of the page lies in the window, and nothing over it."""
    box = page.locator(selector).first.bounding_box()
    assert box is not None, f"{selector} is not shown"
    size = page.viewport_size
    assert box["width"] > 0, selector
    assert box["height"] > 0, selector
    within = (
        box["x"] > -0.5
        and box["y"] > -0.5
        and box["x"] + box["width"] < size["width"] + 0.5
        and box["y"] + box["height"] < size["height"] + 0.5
    )
    assert within, (selector, box)
    assert not page.evaluate(COVERED, selector), f"{selector} is covered"
    return box


def watch(page):
    """Look in every frame from now on whether stage, player, progress and Cancel are in view."""
    page.evaluate(f"{WATCH}; window.watching = true")


def assert_in_view(page):
    """Since `watch` nothing has left the window, and what is shown with an answer is in its place."""
    size = page.viewport_size
    page.wait_for_selector(".moving .stage .canvas")
    assert page.evaluate("outside") == []
    # From Solve on the stage is there, and progress with Cancel where the job took any time.
    seen = set(page.evaluate("[...seen]"))
    assert "stage" in seen
    assert ("progress" in seen) == ("cancel" in seen)
    stage = inside(page, ".moving .stage .canvas")
    assert stage["width"] >= 0.4 * size["width"], "the stage is the largest part"
    assert stage["height"] >= 0.25 * size["height"]
    inside(page, ".moving .player button")
    inside(page, "#scrub")
    inside(page, "#solve")
    # The page itself does not scroll, and is no wider than the window.
    away = page.evaluate("""() => {
      const whole = document.documentElement;
      return [whole.scrollWidth - innerWidth, whole.scrollHeight - innerHeight];
    }""")
    assert max(away) <= 0, away
    wide = page.locator("#statement .table").evaluate_all(
        "all => all.filter(one => one.scrollWidth > one.clientWidth + 1).map(one => one.textContent)"
    )
    assert wide == [], "what is stated lies within its panel"
    # The drawing lies on the stage, and fills a fair part of it.
    drawn = page.evaluate("""() => {
      const boxes = [...document.querySelectorAll(
        ".moving .canvas :is(.live, .wheel, .cam, .profile, .link, .drum)")].map(one => one.getBoundingClientRect())
        // What stands upright has no width of its own.
        .filter(one => one.width || one.height);
      return [Math.min(...boxes.map(one => one.left)), Math.min(...boxes.map(one => one.top)),
              Math.max(...boxes.map(one => one.right)), Math.max(...boxes.map(one => one.bottom))];
    }""")
    share = max((drawn[2] - drawn[0]) / stage["width"], (drawn[3] - drawn[1]) / stage["height"])
    assert share > 0.25, "what moves can be seen"
