"""What processes that answer requests are forked from where few tests ask them: the core, not warmed up."""

import synthesis.analyses  # noqa: F401  (for its loading alone)
from service.jobs.processes.limits import use_one_thread
from service.jobs.processes.parent_death import forget_parent

use_one_thread()
forget_parent()
