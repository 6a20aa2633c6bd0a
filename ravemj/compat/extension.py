"""``%load_ext ravemj`` in IPython and notebooks: ``import openravepy`` then gives ravemj."""

from typing import Any


def load_ipython_extension(ipython: Any) -> None:  # noqa: ANN401 - IPython's shell; IPython is not imported here
    """Make ``import openravepy`` give ravemj, in this session; IPython calls it on ``%load_ext ravemj``.

    Args:
        ipython: The session.
    """
    from ravemj.compat.alias import install_finder  # noqa: PLC0415 - slow to import

    del ipython
    install_finder()
