"""How far the links of a robot reach, for the weights and resolutions of planners."""

from ravemj.databases.model import DatabaseGenerator


class LinkStatisticsModel(DatabaseGenerator):
    """How far the links of a robot reach."""

    capability = "statistics of links"
