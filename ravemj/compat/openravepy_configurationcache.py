"""``openravepy.openravepy_configurationcache``: configurations whose collisions are known. Nothing is kept here."""

from typing import NoReturn

from ravemj.errors import UnsupportedError


class ConfigurationCache:
    """Refuses to be made, and says what answers the same questions."""

    def __init__(self, robot: object) -> NoReturn:
        del robot
        remedy = "ask env.CheckCollision(robot) again, or batch_collides for many configurations"
        raise UnsupportedError(f"ConfigurationCache ({remedy})", "caching of collisions")
