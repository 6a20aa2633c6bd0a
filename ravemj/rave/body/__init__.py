"""The methods of bodies and robots, one class for each topic. ``KinBody`` and ``Robot`` inherit them."""
