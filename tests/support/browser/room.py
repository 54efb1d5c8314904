"""Code that several tests share: room."""

from tests.support.browser.studio import unfold


def field(page, path):
    unfold(page)
    return page.locator(f'[data-path="/problem/space/{path}"]')
