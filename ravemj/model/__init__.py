"""The scene, OpenRAVE's content of memory after loading, and everything that follows from it alone."""
