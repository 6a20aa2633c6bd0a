"""OpenRAVE's models, tutorial, Python API and GUI, on MuJoCo."""
