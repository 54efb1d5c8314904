"""A lock for imports: two threads that import a package and one of its modules at once may see an unfinished module.

To avoid a deadlock, Python lets a thread continue with a module that another thread is still executing. Several threads
import the analysis core, among them the one that checks for missing kernels during the server's start.
"""

from __future__ import annotations

import threading

IMPORTS = threading.Lock()
"""Lock held by a thread of the server while it imports one of our packages on demand."""
