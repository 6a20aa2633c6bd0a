"""The MuJoCo model of all bodies, and what is computed with it."""
