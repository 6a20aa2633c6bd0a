"""Configurations, how they are laid out, and how they change over time; without knowing robots.

``groups`` say what values are; ``layout`` works on lists of them; ``extraction`` and ``conversion`` on data;
``waypoints`` keep data over time, between which ``interpolation`` finds the rest; ``text`` and ``serialization`` write
and read them.
"""
