"""Families of arms with closed-form inverse kinematics."""
