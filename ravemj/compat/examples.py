"""OpenRAVE's example programs are not part of ravemj; the module is here for scripts that import it."""
