"""Families of arms that can be solved in closed form."""
