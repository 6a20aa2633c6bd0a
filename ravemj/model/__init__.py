"""The scene, OpenRAVE's in-memory content after loading, and computations that need only the scene."""
