"""OpenRAVE's sub-modules, and what scripts for openravepy need to run unchanged."""
