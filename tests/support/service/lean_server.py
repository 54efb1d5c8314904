"""The real service, except that a worker loads the kernels of a kind with its first job of that kind, not at its start,
and takes answers that a test or another worker of the session has found.

Loading all kernels takes ten seconds of CPU time, and the tests of a session ask for a part of them. Run like
``mechsynth``.
"""

import os
import sys
from pathlib import Path

from service.command.cli import main
from service.jobs.processes.limits import use_one_thread

# Worker processes import the main module of the server again, under this name.
if __name__ == "__mp_main__":
    use_one_thread()  # before numpy is imported
    from synthesis import dispatch
    from tests.support import answers

    dispatch.warm_up_rest = lambda: None
    answers.share_with_worker(Path(os.environ["SCRIPTED_FOLDER"]))

if __name__ == "__main__":
    sys.exit(main())
