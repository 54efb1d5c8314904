"""The scripted server with workers that take their time before they come to the first line of ours."""

import runpy
import time

from tests.support.service.running import SCRIPTED

if __name__ == "__mp_main__":
    time.sleep(3)  # so long is the parent to be killed in
if __name__ in ("__main__", "__mp_main__"):
    runpy.run_path(SCRIPTED[0], run_name=__name__)
