"""Grasps: approach rays, closing fingers, contacts and force closure."""
