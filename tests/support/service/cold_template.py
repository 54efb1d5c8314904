"""What processes that answer requests are forked from where few tests ask them: the core, not warmed up."""

import synthesis.analyses  # noqa: F401  (for its loading alone)
from service.jobs.processes.limits import use_one_thread
from service.jobs.processes.parent_death import clear_parent_pid

use_one_thread()
clear_parent_pid()
