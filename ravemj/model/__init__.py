"""The scene, OpenRAVE's in-memory content after loading, and computations on it alone."""
