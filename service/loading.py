"""One thread at a time imports: two that import a package and one of its modules at once find one of them unfinished.

Python lets a thread go on with a module that another is still executing where both would wait for each other. The
analysis core is imported by the thread that looks for missing kernels beside the server's start, and by others.
"""

from __future__ import annotations

import threading

IMPORTS = threading.Lock()
"""Held by a thread of the server while it imports a library of ours on demand."""
