"""Which poses an arm reaches."""

from ravemj.compat.databases.model import DatabaseGenerator


class ReachabilityModel(DatabaseGenerator):
    """Which poses an arm reaches."""

    capability = "maps of what arms reach"
