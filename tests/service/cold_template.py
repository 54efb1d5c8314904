"""What processes that answer requests are forked from where few tests ask them: the core, not warmed up."""

import synthesis.analyses  # noqa: F401  (for its loading alone)
from service.jobs.confined import use_one_thread
from service.jobs.orphans import forget_parent

use_one_thread()
forget_parent()
