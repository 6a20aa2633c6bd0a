"""Joint values and other configurations over time.

``Motion`` is the simplest form: the joint values of one body, with straight lines between given times. ``Waypoints``
is the general one, with any layout and interpolation; OpenRAVE's ``Trajectory`` gives it OpenRAVE's names.
``BodyMotion`` moves bodies by samples of either, for viewers.

Layouts: ``groups`` say what the numbers of a configuration are, ``layout`` works on lists of groups, ``extraction`` and
``conversion`` on the numbers. ``interpolation`` finds what lies between two waypoints, ``serialization``
writes and reads files.
"""
