"""The site: the pages of ``docs/``, and beside them what is made of the code: references, a gallery, notebooks.

``python -m tools.site`` writes them all into one folder, of which mkdocs makes the site; ``make docs`` does both.
"""
