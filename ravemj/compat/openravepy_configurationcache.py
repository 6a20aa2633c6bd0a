"""``openravepy.openravepy_configurationcache``: cache of collision checks, which ravemj does not support."""

from typing import NoReturn

from ravemj.errors import UnsupportedError


class ConfigurationCache:
    """Cache of collision checks; its constructor raises ``UnsupportedError``, which names alternatives."""

    def __init__(self, robot: object) -> NoReturn:
        del robot
        remedy = "ask env.CheckCollision(robot) again, or batch_collides for many configurations"
        raise UnsupportedError(f"ConfigurationCache ({remedy})", "caching of collisions")
