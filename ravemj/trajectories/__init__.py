"""Joint values and other configurations over time.

``Motion`` is the simplest form: the joint values of one body, piecewise linear between given times. ``Waypoints`` is
the general form, with any layout and interpolation; OpenRAVE's ``Trajectory`` wraps it. ``BodyMotion`` moves bodies
along either, for viewers.

``groups`` describe the values of a configuration, ``layout`` works on lists of groups, ``extraction`` and
``conversion`` on the values. ``interpolation`` computes values between two waypoints, ``serialization`` writes and
reads files.
"""
