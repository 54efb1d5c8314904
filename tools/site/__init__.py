"""Generator of the documentation site: the pages of ``docs/``, and references, a gallery and notebooks from the code.

``python -m tools.site`` gathers all pages in one folder and has mkdocs build the site from them. ``make docs`` runs it.
"""
