"""OpenRAVE's sub-modules, and how scripts written for openravepy run unchanged."""
