"""Real robots: streaming of motions to them, and joint states from them."""
