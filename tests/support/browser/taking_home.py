"""Code that several tests share: taking home."""

from pathlib import Path

from playwright.sync_api import TimeoutError

# The example of each kind that is soon solved, where that is not the first.
EXAMPLES = {"motion": 3, "path": 1, "function": 2, "dwell": 1}


def taken(page, name):
    page.click("#tab-files")
    try:
        with page.expect_download(timeout=90_000) as waiting:
            page.locator("#downloads").get_by_role("button", name=name, exact=True).click()
    except TimeoutError as error:
        raise AssertionError(f"{name}: {page.inner_text('#downloads')}") from error
    return Path(waiting.value.path())
