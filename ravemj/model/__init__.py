"""What OpenRAVE has in memory after loading, and what follows from it alone."""
