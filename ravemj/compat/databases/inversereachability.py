"""Where a robot can stand to reach a pose."""

from ravemj.compat.databases.model import DatabaseGenerator


class InverseReachabilityModel(DatabaseGenerator):
    """Where a robot can stand to reach a pose."""

    capability = "maps of what arms reach"
